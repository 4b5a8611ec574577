//! The proven periods of tests/data/shortest-periods.json get certificates, and those are accepted.

mod common;

use eeruf_check::prove::{NoProof, prove};
use eeruf_check::{Claim, check};

#[test]
fn all_32_periods_of_the_table_have_a_certificate_that_is_accepted() {
    let (mut nodes, mut at_root) = (0, 0);
    for (name, claim) in common::table(1) {
        let certificate = prove(&claim, 100_000).unwrap_or_else(|error| panic!("{name}: {error:?}"));
        let certified = check(&certificate).unwrap_or_else(|error| panic!("{name}: {error}"));
        println!("{name}: {certified}, {} nodes", certified.nodes);
        assert_eq!(certified.to_string(), format!("{}000 us is the shortest period (tick 1000 us)", claim.period));
        assert_eq!(certified.claim, claim);
        nodes += certified.nodes;
        at_root += usize::from(certified.nodes == 1);
        // Without a tree, or with one line less, it is no proof.
        let mut lines: Vec<&str> = certificate.lines().collect();
        lines.remove(lines.len() - 2);
        if certified.nodes > 1 {
            assert!(check(&(lines.join("\n") + "\n")).is_err(), "{name}");
        }
    }
    println!("{nodes} nodes together");
    assert_eq!(at_root, 14, "as many are refuted by the rules alone");
    assert!(nodes < 35_000, "{nodes} nodes, there were 31,088");
}

#[test]
fn a_shorter_period_than_the_shortest_has_no_certificate() {
    for (name, claim) in common::table(1).into_iter().filter(|(_, claim)| claim.problem.sensors() == 8) {
        let claim = Claim { period: claim.period + 1, bound: claim.period + 1, ..claim };
        assert!(matches!(prove(&claim, 100_000), Err(NoProof::Feasible(_))), "{name}");
    }
}

#[test]
fn line_12_with_a_window_of_45_ms_can_run_at_69_5_ms_and_no_real_period_is_shorter() {
    let (_, mut claim) =
        common::table(2).into_iter().find(|(name, _)| name == "line 12, window 45").expect("it is there");
    assert_eq!(claim.period, 140);
    let Err(NoProof::Feasible(fire)) = prove(&claim, 100_000) else { panic!("139 half ticks have a schedule") };
    claim = Claim { period: 139, bound: 139, fire, ..claim };
    claim.problem.over_reals = true;
    let certified = check(&prove(&claim, 100_000).expect("a proof")).expect("accepted");
    assert_eq!(certified.to_string(), "69500 us is the shortest period over the reals (tick 500 us)");
}
