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
    // One by one is what all are measured by.
    let kinds: Vec<_> = alone.kinds.iter().map(|kind| &*kind.kind).collect();
    assert_eq!(kinds, ["one by one", "groups", "two phases", "flow"]);
    assert_eq!(alone.kinds[0].cost.map(|cost| cost.value), Some(1.0));
    assert!(alone.recommended.as_deref().is_some_and(|kind| kinds.contains(&kind)), "{alone:?}");
    // The recommended kind under each condition, and how far it drives blindly.
    let recommended = alone.kinds.iter().find(|kind| Some(&kind.kind) == alone.recommended.as_ref()).unwrap();
    for (named, best) in alone.conditions.iter().zip(&recommended.best) {
        assert_eq!((named.condition, named.way, named.t95_ms), (best.condition, best.way, best.figures.t95_ms.value));
        let least_ms = named.blind_travel_m_95.map(|travel_m| 1e3 * travel_m[0] / 0.5);
        assert_eq!(least_ms.is_some(), named.condition == "driving");
        assert!(least_ms.is_none_or(|ms| ms > 0.0 && ms <= named.t95_ms_95[0] + 1e-9), "{named:?}");
    }
    assert_eq!(alone.conditions.len(), 3);
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
