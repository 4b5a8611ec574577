//! The one cost of ways of firing, under the conditions that a ring's file names.

use eeruf_design::{RingSpec, RoomsAnswer, RoomsAsked, Way};

fn cost(more: &str, all: bool) -> RoomsAnswer {
    let text = format!("sensors = 2\nmodule = \"hc-sr04\"\nlayout = \"ring\"\nspeed_m_s = 0.5\n{more}");
    let spec = RingSpec::from_text(&text).unwrap();
    let design = spec.shortest_to_study().unwrap();
    let asked = RoomsAsked { places: 1, first: 20_000, all, ..RoomsAsked::default() };
    spec.judge_in_rooms(design.as_ref(), &asked, &|_| true).unwrap()
}

#[test]
fn ring_is_judged_as_its_file_says_that_it_is_used() {
    let alone = cost("", true);
    let under = |answer: &RoomsAnswer| answer.kinds[0].best.iter().map(|best| best.condition).collect::<Vec<_>>();
    assert_eq!(under(&alone), ["standing", "driving", "turning"]);
    assert_eq!((alone.speed_m_s, alone.turn_deg_s), (0.5, 45.0));
    // One by one is what all are measured by.
    let kinds: Vec<_> = alone.kinds.iter().map(|kind| &*kind.kind).collect();
    assert_eq!(kinds, ["one by one", "groups", "two phases", "flow"]);
    assert_eq!(alone.kinds[0].cost.map(|cost| cost.value), Some(1.0));
    let best = alone.best.as_ref().expect("a way");
    assert!(kinds.contains(&&*best.family.to_string()) && Way::of(best).is_some(), "{alone:?}");
    // Every way is measured, one by one with all its gaps: 10 and 20 ms apart are one, as the modules rest.
    assert_eq!(alone.ways.len(), 3 * 7);
    let among = cost("others = true\nturn_deg_s = 90\n", false);
    assert_eq!(under(&among).len(), 6);
    assert_eq!(among.turn_deg_s, 90.0);
    // Figures that do not depend on others, or on how fast it turns, are equal.
    assert_eq!(among.kinds[3].best[..2], alone.kinds[3].best[..2]);
    assert_ne!(among.kinds[3].best[2], alone.kinds[3].best[2]);
    // Each condition by itself is named, and if all is asked for those that the file does not name and the other gain.
    let names = |answer: &RoomsAnswer| answer.elsewhere.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!((names(&alone).len(), names(&among)), (7, names(&alone)[..6].to_vec()));
}
