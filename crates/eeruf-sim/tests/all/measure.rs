//! The measure of what a robot needs: controls that must rank as they do, whatever the rooms.

use std::f64::consts::TAU;

use eeruf_sim::experiments::measure::{
    Condition, Control, MeasureAsked, Measured, MeasuredWay, NEVER_S, Point, Setting, Speeds, measure, measured_ways,
};
use eeruf_sim::experiments::rooms::RoomWay;
use eeruf_sim::modules::HC_SR04;
use eeruf_sim::{Method, Pose, Robot, Transducer};

const SPEEDS: Speeds = Speeds { speed_m_s: 0.5, turn_rad_s: 0.785 };

fn robot() -> Robot {
    let ring = Robot::ring(Pose::identity(), 8, TAU / 8.0, 0.2, Transducer::HC_SR04);
    Robot { window: eeruf_core::Micros::new(23_311), ..ring.with_modules(vec![HC_SR04; 8]) }
}

fn way(name: &str) -> MeasuredWay {
    measured_ways(&robot(), None).into_iter().find(|way| way.way.name == name).unwrap()
}

fn run(ways: &[(MeasuredWay, Option<Control>)], conditions: &[Condition], first: u64, places: u64) -> Measured {
    let asked = MeasureAsked { conditions: conditions.into(), first, places, speeds: SPEEDS };
    measure(ways, &asked, &|_| true).unwrap()
}

const EAGER: Setting = Setting::Votes { m: 1, n: 1 };

#[test]
fn controls_rank_as_they_must_in_every_condition() {
    let sound = way("one_by_one_33ms");
    let quick = way("one_by_one_10ms");
    let at_once = RoomWay { name: "simultaneous", method: Method::Simultaneous, ..way("sequential").way };
    let at_once = MeasuredWay { way: at_once, ..sound.clone() };
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
        assert!(always.never >= 0.5 && always.false_stops_per_min.value > 30.0, "{name}: {always:?}");
        // Most of what appears does so while an older belief is held.
        let median = |way| {
            let sights = under.sights(Point { way, setting: EAGER });
            let mut latencies: Vec<f64> = sights.iter().map(|it| it.latency_ms).filter(|ms| !ms.is_nan()).collect();
            eeruf_sim::quantile(&mut latencies, 0.5)
        };
        assert!(median(3) > 3.0 * median(0), "{name}: {} {}", median(3), median(0));
        assert!(holds.t95_ms.value >= sound.t95_ms.value, "{name}");
        assert_eq!(genie.false_stops, 0, "{name}");
        assert!(median(4) < median(0) && genie.never <= sound.never, "{name}: {} {}", median(4), median(0));
        if under.condition.others {
            let [at_once, sound] = [at_once, sound].map(|cell| cell.false_stops_per_min.value);
            assert!(at_once > 2.0 * sound.max(1.0), "{name}: {at_once} {sound}");
        }
    }
}

// A corner of what `cargo lab measure --planted 20` shows of all conditions.
#[test]
fn sound_way_is_recommended_over_planted_ones() {
    let sound = way("one_by_one_33ms");
    let controls = Control::PLANTED.map(Some).into_iter().chain([None]);
    let ways: Vec<_> = controls.map(|control| (sound.clone(), control)).collect();
    let standing = &Condition::ALL[..1];
    let (chosen, measured) = (run(&ways, standing, 0, 8), run(&ways, standing, 22_000, 8));
    for (planted, control) in Control::PLANTED.iter().enumerate() {
        // The planted one stands first, as the simpler.
        let costs = measured.costs(&chosen, &[vec![planted], vec![3]]);
        assert_eq!(costs.recommended, Some(1), "{control:?}: {costs:?}");
    }
    // A way is a draw with itself, and the first is taken.
    let same = measured.costs(&chosen, &[vec![3], vec![3]]);
    assert_eq!((same.recommended, same.draw), (Some(0), None));
}

#[test]
fn rows_are_the_same_on_any_number_of_threads() {
    let ways = [(way("blocking"), None), (way("flow"), None)];
    let both = [Condition::ALL[1], Condition::ALL[3]];
    let measured = run(&ways, &both, 23_000, 1);
    let rows = measured.csv();
    assert_eq!(rows, run(&ways, &both, 23_000, 1).csv());
    // Two conditions, seven rooms, two ways, six settings.
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
