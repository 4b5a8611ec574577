//! Owners of periods, and changes of lags, as planned.

use super::*;
use crate::judge::{EchoTracker, Firing, Heard, Judge, TrackerSettings};
use crate::reading::ReadingKind;
use crate::schedule::Phase;

const HURRIED: HoppingSettings =
    HoppingSettings { solo_after: 1, solo_spacing: 1, shift_after: 0, ..HoppingSettings::BALANCED };

/// A plan, and when each sensor last fired, which a ring knows.
struct Fooled(HoppingPlan<8>, [Instant; 8]);

fn fooled(settings: HoppingSettings) -> Fooled {
    let now = Instant::from_micros(0);
    Fooled(HoppingPlan::new(&schedule(), settings, HoppingListening::new(WINDOW), 1, now).unwrap(), [now; 8])
}

/// A judge that believes that nothing is in any sensor's range, or believes nothing.
fn judge(is_clear: bool) -> impl Judge {
    let mut tracker = EchoTracker::<8>::new(TrackerSettings::BALANCED).unwrap();
    for (sensor, phase) in (0..8).flat_map(|sensor| (0..if is_clear { 5 } else { 0 }).map(move |phase| (sensor, phase)))
    {
        tracker.push(sensor, &[], Firing::new(Phase(phase))).unwrap();
    }
    tracker
}

/// A period in which all fire on time; `hears` says of a sensor whether its reading is accepted and whether it fits.
/// Returns whose it is alone.
fn period(fooled: &mut Fooled, hears: impl Fn(u8) -> (bool, bool)) -> Option<u8> {
    let Fooled(plan, fired) = fooled;
    let solo = plan.solo();
    while let Some((sensor, _)) = plan.next_firing() {
        let now = plan.deadline();
        plan.fire(now);
        fired[usize::from(sensor)] = now;
        let (accepted, is_clear) = hears(sensor);
        let kind = if accepted { ReadingKind::Accepted } else { ReadingKind::Rejected };
        let heard =
            Heard { sensor, fired: now, echoes: &[], firing: plan.last_firing(sensor, 0), t_delta: Micros::new(150) };
        plan.judged(&heard, &heard.unjudged(Some(kind)), &judge(is_clear));
    }
    plan.end_period(plan.deadline());
    plan.begin_period(|sensor| fired[usize::from(sensor)]);
    solo
}

fn lags(fooled: &Fooled) -> Vec<Option<Micros>> {
    (0..8).map(|sensor| fooled.0.t_lag(sensor)).collect()
}

#[test]
fn two_solo_periods_are_saved_up_at_most_and_each_costs_one() {
    let mut fooled = fooled(HoppingSettings { solo_rate: 1, ..HURRIED });
    let mut solos =
        |periods, accepted| (0..periods).filter(|_| period(&mut fooled, |_| (accepted, accepted)).is_some()).count();
    assert_eq!(solos(600, true), 0);
    // A third has been earned 256 periods after the first was taken.
    assert_eq!((solos(250, false), solos(20, false)), (2, 1));
}

// A solo period is asked for after this many firings with nothing accepted.
#[test]
fn solo_period_is_asked_for_after_unaccepted_firings() {
    for solo_after in 2..=6 {
        let mut fooled = fooled(HoppingSettings { solo_rate: 255, solo_after, ..HURRIED });
        // Sensor 5 hears nothing that is accepted.
        let solos: Vec<_> = (0..=solo_after).map(|_| period(&mut fooled, |sensor| (sensor != 5, true))).collect();
        let (before, after) = solos.split_at(solo_after.into());
        assert!(before.iter().all(Option::is_none) && after == [Some(5)], "{solo_after}: {solos:?}");
    }
}

#[test]
fn lags_stay_where_settings_say_so_whatever_does_not_fit() {
    let mut fooled = fooled(HoppingSettings { shift_spacing: 1, ..HURRIED });
    let before = lags(&fooled);
    for _ in 0..100 {
        period(&mut fooled, |_| (false, false));
    }
    assert_eq!(lags(&fooled), before);
}

#[test]
fn firings_after_new_lags_are_unsettled() {
    let mut fooled = fooled(HoppingSettings { solo_rate: 0, shift_after: 1, shift_spacing: 3, ..HURRIED });
    let mut changed = 0;
    let mut before = lags(&fooled);
    for number in 0..60 {
        let now = lags(&fooled);
        period(&mut fooled, |_| (false, false));
        changed += u32::from(now != before);
        // The plan of the next period may have unsettled what was fired in this one.
        if lags(&fooled) == now {
            for sensor in 0..8 {
                assert_eq!(fooled.0.last_firing(sensor, 0).steady, now == before, "period {number}, sensor {sensor}");
            }
        }
        before = now;
    }
    assert!(changed > 10, "{changed}");
}
