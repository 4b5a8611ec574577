//! The measure of a robot's needs, checked by controls whose rank is known in every room.

use std::f64::consts::TAU;

use eeruf_sim::experiments::measure::{
    Cell, Condition, Control, MeasureAsked, Measured, NEVER_S, ONE_A_MINUTE, Point, RoomWay, Setting, Speeds, measure,
};
use eeruf_sim::modules::HC_SR04;
use eeruf_sim::{Method, Pose, Robot, Transducer};

const SPEEDS: Speeds = Speeds { speed_m_s: 0.5, turn_rad_s: 0.785 };

fn robot() -> Robot {
    let ring = Robot::ring(Pose::identity(), 8, TAU / 8.0, 0.2, Transducer::HC_SR04);
    Robot { window: eeruf_core::Micros::new(23_311), ..ring.with_modules(vec![HC_SR04; 8]) }
}

fn way(name: &str) -> RoomWay {
    RoomWay::all(&robot(), None).into_iter().find(|way| way.name == name).unwrap()
}

fn run(ways: &[(RoomWay, Option<Control>)], conditions: &[Condition], first: u64, places: u64) -> Measured {
    let asked = MeasureAsked { conditions: conditions.into(), own: vec![], first, places, speeds: SPEEDS };
    measure(ways, &asked, &|_| true).unwrap()
}

const EAGER: Setting = Setting::Votes { m: 1, n: 1 };

#[test]
fn controls_rank_as_they_must_in_every_condition() {
    let sound = way("one_by_one_33ms");
    let quick = way("one_by_one_10ms");
    let at_once = RoomWay { name: "simultaneous", method: Method::Simultaneous, ..way("sequential") };
    let ways = [
        (sound.clone(), None),
        (sound.clone(), Some(Control::Never)),
        (sound.clone(), Some(Control::Always)),
        (sound, Some(Control::Holds)),
        (quick, Some(Control::Genie)),
        (at_once, None),
    ];
    let measured = run(&ways, &Condition::ALL, 21_000, 1);
    for under in &measured.under {
        let name = under.condition.as_str();
        let cell = |way| under.cell(Point { way, setting: EAGER }, &measured);
        let [sound, never, always, holds, genie, at_once] = [0, 1, 2, 3, 4, 5].map(cell);
        assert!(sound.things >= 5, "{name}: {sound:?}");
        assert_eq!((never.never, never.false_stops), (1.0, 0), "{name}");
        let half_ms = |cell: &Cell| cell.t50_t90_ms[0];
        // A robot that drives past a thing is 0.3 m away from it sooner or later.
        assert!(half_ms(&always) > 2.0 * half_ms(&sound), "{name}: {always:?}");
        assert!(always.false_stops_per_min.value > 30.0, "{name}: {always:?}");
        // Most things appear while an older belief is held.
        assert!(half_ms(&holds) > 3.0 * half_ms(&sound), "{name}: {holds:?}");
        assert!(holds.t95_ms.value >= sound.t95_ms.value, "{name}");
        assert_eq!(genie.false_stops, 0, "{name}");
        // The genie knows the paths, but not when to fire: foreign sound sometimes hides one thing of seven.
        assert!(half_ms(&genie) < half_ms(&sound) && genie.never <= sound.never + 0.15, "{name}: {genie:?}");
        if under.condition.others {
            assert!(at_once.false_stops_per_min.value > 5.0 * ONE_A_MINUTE, "{name}: {at_once:?}");
        }
    }
}

#[test]
fn sound_way_is_recommended_over_planted_ones() {
    let sound = way("one_by_one_33ms");
    let controls = Control::PLANTED.map(Some).into_iter().chain([None]);
    let ways: Vec<_> = controls.map(|control| (sound.clone(), control)).collect();
    let alone = &Condition::ALL[..3];
    let (chosen, measured) = (run(&ways, alone, 0, 5), run(&ways, alone, 22_000, 5));
    let at = |of: usize| measured.points(|way| way == of);
    for (planted, control) in Control::PLANTED.iter().enumerate() {
        // The planted one stands first, as the simpler.
        let costs = measured.costs(&chosen, &at(3), &[at(planted), at(3)]);
        assert_eq!(costs.recommended, Some(1), "{control:?}: {costs:?}");
    }
    // A way is a draw with itself, and the first is taken.
    let same = measured.costs(&chosen, &at(3), &[at(3), at(3)]);
    assert_eq!((same.recommended, same.draw), (Some(0), None));
}

#[test]
fn rows_are_the_same_on_any_number_of_threads() {
    let ways = [(way("blocking"), None), (way("flow"), None)];
    let both = [Condition::ALL[1], Condition::ALL[3]];
    let measured = run(&ways, &both, 23_000, 1);
    let rows = measured.csv();
    assert_eq!(rows, run(&ways, &both, 23_000, 1).csv());
    // There are two conditions, seven rooms, two ways and six settings.
    assert_eq!(rows.lines().count(), 2 * 7 * 2 * 6);
    let columns = Measured::CSV_HEAD.split(',').count();
    assert!(rows.lines().all(|row| row.split(',').count() == columns), "{rows}");
    for under in &measured.under {
        for place in &under.places {
            let Some((_, sensor, distance_m)) = place.thing else { continue };
            assert!(sensor < 8 && (0.3..2.0).contains(&distance_m) && place.draws.fitted > place.draws.unread);
        }
        let latencies = under.sights(Point { way: 0, setting: EAGER }).iter().map(|sight| sight.latency_ms);
        assert!(latencies.filter(|ms| ms.is_finite()).all(|ms| (0.0..=1e3 * NEVER_S).contains(&ms)));
    }
}
