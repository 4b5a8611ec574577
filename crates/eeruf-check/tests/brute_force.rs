//! The judge of all rules: for tiny random problems, the period proven shortest is the one that trying all schedules
//! gives. A rule that refutes too much would prove a longer one.

mod common;

use common::{Random, feasible, random_problem};
use eeruf_check::prove::{NoProof, prove};
use eeruf_check::shortest::{self, Shortest};
use eeruf_check::{Claim, Problem, check};

/// The shortest period, with a schedule, by trying all firing times.
fn shortest(problem: &Problem, most: u32) -> Option<(u32, [Vec<u32>; 2])> {
    (1..=most).find_map(|period| feasible(problem, period).map(|fire| (period, fire)))
}

fn agree(seed: u64, problem: &Problem, most: u32) -> usize {
    let Some((period, fire)) = shortest(problem, most) else { return 0 };
    let claim = |bound| Claim { problem: problem.clone(), period, fire: fire.clone(), bound };
    let text = prove(&claim(period), 100_000).unwrap_or_else(|error| panic!("seed {seed}: {error}: {problem:?}"));
    let certified = check(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
    assert_eq!(certified.claim, claim(period));
    // One tick longer has a schedule as well, and no proof may say otherwise.
    let longer = Claim { period: period + 1, bound: period + 1, ..claim(period) };
    let Err(NoProof::Feasible(fire)) = prove(&longer, 100_000) else {
        panic!("seed {seed}: there is a schedule for {period}: {problem:?}");
    };
    assert!(prove(&Claim { fire, ..claim(period) }, 100_000).is_ok(), "seed {seed}: what is left open is a schedule");
    certified.nodes
}

#[test]
fn the_period_proven_shortest_is_the_one_that_trying_all_schedules_gives() {
    let cases = std::env::var("EERUF_CASES").map_or(300, |cases| cases.parse().expect("a number"));
    let (mut solved, mut nodes) = (0, 0);
    for seed in 0..cases {
        let mut random = Random(seed + 1);
        let problem = random_problem(&mut random);
        let most = if problem.sensors() <= 3 { 13 } else { 9 };
        let more = agree(seed, &problem, most);
        solved += u64::from(more > 0);
        nodes += more;
    }
    println!("{solved} of {cases} problems have a schedule, {nodes} nodes");
    assert!(solved * 3 > cases, "most problems should have a schedule, {solved} of {cases} do");
}

#[test]
fn the_search_finds_the_period_that_trying_all_schedules_gives() {
    let cases = std::env::var("EERUF_CASES").map_or(300, |cases| cases.parse().expect("a number"));
    let (mut solved, mut hopeless) = (0, 0);
    for seed in 0..cases {
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
        assert!(prove(&claim, 100_000).is_ok_and(|text| check(&text).is_ok()), "seed {seed}");
    }
    assert!(solved * 3 > cases && hopeless * 10 < cases, "{solved} of {cases} solved, {hopeless} without a schedule");
}
