//! The shortest period over the reals, against periods in ticks that are ever finer.

mod common;

use common::{Random, accepted, claim_of, random_problem};
use eeruf_period::engine::Problem;
use eeruf_period::engine::reals::shortest_over_reals;
use eeruf_period::engine::shortest::shortest;

/// The problem in ticks of a part of those it has.
fn finer(problem: &Problem, parts: u32) -> Problem {
    let times = |list: &[u32]| list.iter().map(|time| time * parts).collect();
    let gaps = problem.gaps.iter().map(|&(x, y, after_x, after_y)| (x, y, after_x * parts, after_y * parts));
    Problem {
        tick_us: (problem.tick_us.0, problem.tick_us.1 * parts),
        separation: times(&problem.separation),
        window: times(&problem.window),
        gaps: gaps.collect(),
        ..problem.clone()
    }
}

/// The shortest period in ticks this many times as fine, by the search of whole ticks.
fn in_parts(problem: &Problem, parts: u32) -> u32 {
    let found = shortest(&finer(problem, parts), 1_000_000, &mut |_| true).expect("there is a schedule");
    assert_eq!(found.period, found.bound, "a million nodes prove it: {problem:?}");
    found.period
}

#[test]
fn no_finer_tick_beats_the_real_period() {
    let cases = std::env::var("EERUF_CASES").map_or(150, |cases| cases.parse().expect("a number"));
    let (mut proven, mut open, mut certificates, mut gained, mut largest) = (0, 0, Vec::new(), 0, 1);
    for seed in 0..cases {
        let problem = random_problem(&mut Random(seed + 1));
        let Some(found) = shortest(&problem, 1_000_000, &mut |_| true) else { continue };
        // Rarely a period is only approached by its orders, and none is given.
        let Some(reals) = shortest_over_reals(&problem, &found.fire, 100_000, |_| true) else {
            open += 1;
            continue;
        };
        let (period, parts) = (reals.period, reals.denominator);
        assert!(period <= found.period * parts, "seed {seed}: a schedule in ticks is one in reals");
        if !reals.proven {
            assert_eq!(reals.certificate, None, "seed {seed}: a certificate of what is not proven");
            open += 1;
            continue;
        }
        if let Some(text) = reals.certificate {
            let claim = claim_of(&text);
            assert!(claim.problem.over_reals, "seed {seed}");
            assert_eq!(claim.bound * parts, period * claim.problem.tick_us.1, "seed {seed}");
            certificates.push(text);
        }
        for finer in 1..=6 {
            assert!(in_parts(&problem, finer) * parts >= period * finer, "seed {seed}, a {finer}th: {problem:?}");
        }
        assert_eq!(in_parts(&problem, parts), period, "seed {seed}: {problem:?}");
        proven += 1;
        gained += u64::from(period < found.period * parts);
        largest = largest.max(parts);
    }
    accepted("over-reals", &certificates);
    let certified = certificates.len();
    println!("{proven} of {cases} proven, {open} open, {certified} certificates, {gained} gain, parts to {largest}");
    assert!(open * 100 <= cases, "{open} of {cases} open");
    assert!(proven * 10 > cases * 8 && gained * 20 > cases && largest > 1, "{proven}, {gained}, {largest} of {cases}");
}

#[test]
fn line_12_at_45_ms_alone_gains_from_finer_ticks() {
    let (mut gain, mut open) = (Vec::new(), Vec::new());
    for (name, claim) in common::table(1) {
        let reals = shortest_over_reals(&claim.problem, &claim.fire, 20_000, |_| true).expect("small numbers");
        if !reals.proven {
            open.push(name.clone());
        }
        if reals.period != claim.period * reals.denominator {
            let text = reals.certificate.unwrap_or_else(|| panic!("{name}: no certificate"));
            gain.push((name, accepted("line-12", &[text]).concat()));
        }
    }
    let says = "69500 us is the shortest period over the reals (tick 500 us)";
    assert_eq!(gain, [("line 12, window 45".to_owned(), says.to_owned())]);
    assert_eq!(open, ["ring 24, window 15"]);
}

#[test]
fn early_end_says_what_its_orders_give() {
    let (_, claim) = common::table(1).into_iter().find(|(name, _)| name == "line 12, window 45").expect("it is there");
    let all = shortest_over_reals(&claim.problem, &claim.fire, 20_000, |_| true).expect("small numbers");
    for (budget, go_on) in [(1, true), (20_000, false)] {
        let mut asked = 0;
        let ended = shortest_over_reals(&claim.problem, &claim.fire, budget, |_| {
            asked += 1;
            go_on
        });
        let ended = ended.expect("small numbers");
        assert_eq!((ended.proven, &ended.certificate, asked > 0), (false, &None, !go_on));
        assert!(ended.period * all.denominator >= all.period * ended.denominator);
        assert!(ended.period <= claim.period * ended.denominator);
    }
}
