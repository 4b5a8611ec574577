//! Certificates of the proven periods of tests/data/shortest-periods.json, which the checker accepts.

use crate::common::{self, accepted, claim_of, nodes_of, small};
use eeruf_period::engine::prove::{NoProof, prove, prove_what_can_be, prove_while};
use eeruf_period::engine::shortest::shortest;
use eeruf_period::engine::{Claim, Problem};

#[test]
fn the_periods_of_the_table_have_a_certificate_that_is_accepted() {
    let (mut certificates, mut cut) = (Vec::new(), Vec::new());
    for (name, claim) in common::table(1) {
        let certificate = prove(&claim, 100_000).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(claim_of(&certificate), claim);
        // Without one of its lines, it is not a proof.
        let mut lines: Vec<&str> = certificate.lines().collect();
        lines.remove(lines.len() - 2);
        if nodes_of(&certificate) > 1 {
            cut.push(lines.join("\n") + "\n");
        }
        certificates.push(certificate);
    }
    let nodes: usize = certificates.iter().map(|text| nodes_of(text)).sum();
    println!("{nodes} nodes together");
    let at_root = certificates.iter().filter(|text| nodes_of(text) == 1).count();
    assert_eq!(at_root, 26, "as many are refuted by the rules alone");
    assert!(nodes < 12_000, "{nodes} nodes, there were 9,912");
    let certificates = small(certificates);
    for (text, says) in certificates.iter().zip(accepted("table", &certificates)) {
        assert_eq!(says, format!("{}000 us is the shortest period (tick 1000 us)", claim_of(text).period));
    }
    let verdicts = common::verdicts_of(&common::checker(), "cut", &small(cut));
    assert!(verdicts.iter().all(|verdict| verdict.starts_with("refused: line ")), "{verdicts:?}");
}

#[test]
fn search_proves_every_period_of_the_table() {
    for (name, claim) in common::table(1) {
        let found = shortest(&claim.problem, 100_000, &mut |_| true).expect("firing one by one at least");
        assert_eq!((found.period, found.bound), (claim.period, claim.period), "{name}");
        let claim = Claim { fire: found.fire, ..claim };
        assert_eq!(claim.check(), Ok(()), "{name}: the times serve");
    }
}

#[test]
fn fine_ticks_find_periods_between_coarse_ones() {
    let (_, claim) = common::table(2).into_iter().find(|(name, _)| name == "line 12, window 45").expect("it is there");
    let found = shortest(&claim.problem, 100_000, &mut |_| true).expect("firing one by one at least");
    assert_eq!((found.period, found.bound), (139, 139));
}

// Sensors that must fire one after the other have a bound without trying all orders.
#[test]
fn sequential_sensors_have_a_bound_without_orders() {
    let windows: Vec<u32> = (10..20).collect();
    let pairs = (0..10).flat_map(|x| (x + 1..10).map(move |y| (x, y)));
    let gaps = pairs.map(|(x, y)| (x, y, windows[x], windows[y])).collect();
    let problem = Problem {
        tick_us: (1000, 1),
        separation: vec![2; 10],
        window: windows.clone(),
        stale_echo: false,
        together: vec![],
        gaps,
    };
    let found = shortest(&problem, 20_000, &mut |_| true).expect("firing one by one at least");
    let one_by_one: u32 = windows.iter().sum();
    assert!(found.bound == one_by_one && found.period <= one_by_one + 25, "{found:?}");
}

#[test]
fn a_search_that_is_ended_has_a_schedule_and_a_bound() {
    let (name, claim) =
        common::table(1).into_iter().find(|(name, _)| name == "line 12, window 45").expect("it is there");
    for budget in [1, 100, 1_000, 3_000] {
        let found = shortest(&claim.problem, budget, &mut |_| true).expect("firing one by one at least");
        let at_most = found.bound <= claim.period && claim.period <= found.period && found.nodes <= 2 * budget + 1_000;
        assert!(at_most, "{name}: {found:?}");
        let claim = Claim { period: found.period, fire: found.fire, bound: found.bound, ..claim.clone() };
        assert!(
            prove(&claim, 100_000).is_ok(),
            "{name}: {} ticks and {} serve as schedule and bound",
            claim.period,
            claim.bound
        );
    }
    let mut asked = 0;
    let stopped = shortest(&claim.problem, u64::MAX, &mut |so_far| {
        asked += 1;
        so_far.nodes < 500
    });
    let stopped = stopped.expect("firing one by one at least");
    assert!(asked > 5 && stopped.bound < stopped.period && stopped.nodes < 700, "{asked} {stopped:?}");
}

// A proof ends when the caller or the budget wants it and says so.
#[test]
fn proof_ends_when_caller_or_budget_wants() {
    let (_, claim) = common::table(1).into_iter().find(|(name, _)| name == "ring 8, window 30").expect("it is there");
    let mut asked = Vec::new();
    let stopped = prove_while(&claim, 100_000, |nodes| {
        asked.push(nodes);
        asked.len() < 2
    });
    assert_eq!(stopped, Err(NoProof::Stopped));
    assert_eq!(asked, [64, 128], "it is asked every 64 nodes");
    let error = prove(&claim, 10).expect_err("11 nodes are needed at least");
    assert_eq!(error.to_string(), "the proof has more than 10 nodes");
    assert_eq!(prove_while(&claim, 100_000, |_| true), prove(&claim, 100_000));
}

// A proof that ends early leaves the highest bound that can be proven with less.
#[test]
fn early_proof_leaves_the_highest_cheaper_bound() {
    let (_, claim) = common::table(1).into_iter().find(|(name, _)| name == "line 12, window 45").expect("it is there");
    let bound = |text: Result<String, NoProof>| claim_of(&text.expect("a proof")).bound;
    assert_eq!(bound(prove_what_can_be(&claim, 100_000, |_| true)), claim.period);
    let by_rules_alone = bound(prove_what_can_be(&claim, 100_000, |_| false));
    let with_some_nodes = bound(prove_what_can_be(&claim, 340, |_| true));
    assert!(1 < by_rules_alone && by_rules_alone <= with_some_nodes && with_some_nodes < claim.period);
    for (bound, nodes) in [(by_rules_alone, 1), (with_some_nodes, 340 / 16)] {
        let higher = Claim { bound: bound + 1, ..claim.clone() };
        assert_eq!(prove(&higher, nodes), Err(NoProof::Budget(nodes)), "{bound}");
    }
}

#[test]
fn a_shorter_period_than_the_shortest_has_no_certificate() {
    for (name, claim) in common::table(1).into_iter().filter(|(_, claim)| claim.problem.sensors() == 8) {
        let claim = Claim { period: claim.period + 1, bound: claim.period + 1, ..claim };
        assert!(matches!(prove(&claim, 100_000), Err(NoProof::Feasible(_))), "{name}");
    }
}
