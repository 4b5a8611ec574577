//! The cost of ways of firing, under the conditions that a ring file names.

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
    // The best one by one, with any votes, is the baseline; a program's costs as much or more, within a room's noise.
    let kinds: Vec<_> = alone.kinds.iter().map(|kind| &*kind.kind).collect();
    assert_eq!(kinds, ["one by one", "groups", "two phases", "flow"]);
    assert_eq!(alone.baseline.iter().map(|of| of.condition).collect::<Vec<_>>(), under(&alone));
    assert!(alone.kinds[0].cost.is_some_and(|cost| (0.9..3.0).contains(&cost.value)), "{:?}", alone.kinds[0]);
    let best = alone.best.as_ref().expect("a way");
    assert!(kinds.contains(&&*best.family.to_string()) && Way::of(best).is_some(), "{alone:?}");
    // The recommended way has the figures of its kind.
    let kind = alone.kinds.iter().find(|kind| kind.kind == best.family.to_string()).unwrap();
    let of_kind: Vec<_> = kind.best.iter().map(|of| (of.condition, of.figures.t95_ms.value, &*of.votes)).collect();
    assert_eq!(alone.conditions.iter().map(|of| (of.condition, of.t95_ms, "1/1")).collect::<Vec<_>>(), of_kind);
    let drives = &alone.conditions[1];
    assert!(
        drives.blind_travel_m.is_some_and(|travel_m| (travel_m - 0.5e-3 * drives.t95_ms).abs() < 1e-9),
        "{drives:?}"
    );
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
