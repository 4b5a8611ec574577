//! A test of all rules: for tiny random problems, the proven shortest period equals the one found by trying all
//! schedules. A rule that refutes too much would prove a longer one.

use crate::common::{Random, accepted, claim_of, feasible, from_environment, nodes_of, random_problem};
use eeruf_period::engine::prove::{NoProof, prove};
use eeruf_period::engine::shortest::{self, Shortest};
use eeruf_period::engine::spare::most_to_spare;
use eeruf_period::engine::{Claim, Problem};

/// The shortest period, with a schedule, by trying all firing times.
fn shortest(problem: &Problem, most: u32) -> Option<(u32, [Vec<u32>; 2])> {
    (1..=most).find_map(|period| feasible(problem, period).map(|fire| (period, fire)))
}

/// The certificate of a problem's shortest period.
fn certificate(seed: u64, problem: &Problem, most: u32) -> Option<String> {
    let (period, fire) = shortest(problem, most)?;
    let claim = |bound| Claim { problem: problem.clone(), period, fire: fire.clone(), bound };
    let text = prove(&claim(period), 100_000).unwrap_or_else(|error| panic!("seed {seed}: {error}: {problem:?}"));
    assert_eq!(claim_of(&text), claim(period));
    // One tick longer has a schedule as well, and no proof may say otherwise.
    let longer = Claim { period: period + 1, bound: period + 1, ..claim(period) };
    let Err(NoProof::Feasible(fire)) = prove(&longer, 100_000) else {
        panic!("seed {seed}: there is a schedule for {period}: {problem:?}");
    };
    assert!(prove(&Claim { fire, ..claim(period) }, 100_000).is_ok(), "seed {seed}: what is left open is a schedule");
    Some(text)
}

// The period proven shortest is the one that trying all schedules gives.
#[test]
fn proven_period_is_that_of_trying_all_schedules() {
    let (first, cases) = (from_environment("EERUF_FIRST", 0), from_environment("EERUF_CASES", 300));
    let mut certificates = Vec::new();
    for seed in first..first + cases {
        let mut random = Random(seed + 1);
        let problem = random_problem(&mut random);
        let most = if problem.sensors() <= 3 { 13 } else { 9 };
        certificates.extend(certificate(seed, &problem, most));
    }
    let (solved, nodes) = (certificates.len(), certificates.iter().map(|text| nodes_of(text)).sum::<usize>());
    println!("{solved} of {cases} problems have a schedule, {nodes} nodes");
    assert!(solved as u64 * 3 > cases, "most problems should have a schedule, {solved} of {cases} do");
    accepted("brute-force", &certificates);
}

#[test]
fn the_search_finds_the_period_that_trying_all_schedules_gives() {
    let (first, cases) = (from_environment("EERUF_FIRST", 0), from_environment("EERUF_CASES", 300));
    let (mut solved, mut hopeless) = (0, 0);
    for seed in first..first + cases {
        let mut random = Random(seed + 1);
        let problem = random_problem(&mut random);
        let most = if problem.sensors() <= 3 { 13 } else { 9 };
        let found = shortest::shortest(&problem, 1_000_000, &mut |_| true);
        let tried = shortest(&problem, most);
        let Some(Shortest { period, fire, bound, .. }) = found else {
            assert_eq!(tried, None, "seed {seed}: {problem:?}");
            hopeless += 1;
            continue;
        };
        assert_eq!(period, bound, "seed {seed}: a million nodes prove it");
        match tried {
            Some((shortest, _)) => assert_eq!(period, shortest, "seed {seed}: {problem:?}"),
            None => assert!(period > most, "seed {seed}: {problem:?}"),
        }
        solved += u64::from(period <= most);
        let claim = Claim { problem, period, fire, bound };
        assert!(prove(&claim, 100_000).is_ok(), "seed {seed}");
    }
    assert!(solved * 3 > cases && hopeless * 10 < cases, "{solved} of {cases} solved, {hopeless} without a schedule");
}

/// Returns true if some schedule of this period has this much slack in separation, gaps and windows.
fn keeps(problem: &Problem, period: u32, more: [u32; 3]) -> bool {
    let each = |times: &[u32], by: u32| times.iter().map(|time| time + by).collect();
    let gaps = problem.gaps.iter().map(|&(x, y, after_x, after_y)| (x, y, after_x + more[1], after_y + more[1]));
    let harder = Problem {
        separation: each(&problem.separation, more[0]),
        window: each(&problem.window, more[2]),
        gaps: gaps.collect(),
        ..problem.clone()
    };
    feasible(&harder, period).is_some()
}

#[test]
fn spare_is_that_of_trying_all_schedules() {
    let (first, cases) = (from_environment("EERUF_FIRST", 0), from_environment("EERUF_CASES", 150));
    let (mut solved, mut spared) = (0, [0; 3]);
    for seed in first..first + cases {
        let problem = random_problem(&mut Random(seed + 1));
        let Some((period, fire)) = shortest(&problem, if problem.sensors() <= 3 { 11 } else { 7 }) else { continue };
        // One tick more, so that there is a choice.
        let spare = most_to_spare(&problem, period + 1, fire, 1_000_000, &mut |_| true);
        assert_eq!(spare.proven, [true; 3], "seed {seed}: the budget suffices");
        let [separation, gap, window] = spare.more;
        assert!(keeps(&problem, period + 1, spare.more), "seed {seed}: {spare:?}");
        let no_gaps = problem.gaps.is_empty();
        for (need, better) in [[separation + 1, 0, 0], [separation, gap + 1, 0], [separation, gap, window + 1]]
            .into_iter()
            .enumerate()
            .filter(|(need, _)| *need != 1 || !no_gaps)
        {
            assert!(!keeps(&problem, period + 1, better), "seed {seed}: need {need} could grow: {spare:?} {problem:?}");
        }
        solved += 1_u64;
        (0..3).for_each(|need| spared[need] += spare.more[need]);
    }
    println!("{solved} of {cases} problems, spared {spared:?}");
    assert!(solved * 3 > cases && spared.iter().all(|more| *more > 10), "{solved} solved, spared {spared:?}");
}
