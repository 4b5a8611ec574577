//! The cost of ways of firing, under the conditions that a ring file names.

use eeruf_design::{CostAnswer, RingSpec, RoomsAsked};

fn cost(more: &str) -> CostAnswer {
    let text = format!("sensors = 3\nmodule = \"hc-sr04\"\nlayout = \"ring\"\nspeed_m_s = 0.5\n{more}");
    let spec = RingSpec::from_text(&text).unwrap();
    let design = spec.shortest_to_study().unwrap();
    let asked = RoomsAsked { places: 1, first: 20_000, ..RoomsAsked::default() };
    spec.cost_in_rooms(design.as_ref(), &asked, &|_| true).unwrap()
}

#[test]
fn ring_is_judged_as_its_file_says_that_it_is_used() {
    let alone = cost("");
    let under = |answer: &CostAnswer| answer.kinds[0].best.iter().map(|best| best.condition).collect::<Vec<_>>();
    assert_eq!(under(&alone), ["standing", "driving", "turning"]);
    assert_eq!((alone.speed_m_s, alone.turn_deg_s), (0.5, 45.0));
    // All kinds are measured against one by one.
    let kinds: Vec<_> = alone.kinds.iter().map(|kind| &*kind.kind).collect();
    assert_eq!(kinds, ["one by one", "groups", "two phases", "flow"]);
    assert_eq!(alone.kinds[0].cost.map(|cost| cost.value), Some(1.0));
    assert!(alone.recommended.as_deref().is_some_and(|kind| kinds.contains(&kind)), "{alone:?}");
    let among = cost("others = true\nturn_deg_s = 90\n");
    assert_eq!(under(&among).len(), 6);
    assert_eq!(among.turn_deg_s, 90.0);
    // Figures that do not depend on others, or on how fast it turns, are equal.
    assert_eq!(among.kinds[3].best[..2], alone.kinds[3].best[..2]);
    assert_ne!(among.kinds[3].best[2], alone.kinds[3].best[2]);
    // Each condition by itself is named, whether the file names it or not, and the other gain.
    let names = |answer: &CostAnswer| answer.elsewhere.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!((names(&alone).len(), names(&alone)), (7, names(&among)));
}
