//! Crosstalk of fixed length while the robot drives: odometry carries tracks on, and a code that moves crosstalk by the
//! same from each period to the next makes it look like a wall that the robot drives towards.

use eeruf_core::{
    Instant, Micros, ReadingKind, Ring, RingEvent,
    flow::{FlowRing, FlowSettings},
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    judge::Judge,
    plan::Plan,
};

const WINDOW: Micros = Micros::from_millis(36);
const BLANKING: u32 = 2_380;
/// Lengths of the one path, in microseconds of travel.
const LENGTHS: [u32; 4] = [9_000, 15_500, 22_000, 30_500];

/// A robot that drives straight ahead in open space, with one path from one sensor to another.
#[derive(Clone, Copy)]
struct Drive {
    from: u8,
    to: u8,
    length_us: u32,
    mm_s: i32,
}

fn listening() -> HoppingListening {
    HoppingListening::new(WINDOW).with_blanking(Micros::new(BLANKING))
}

/// Returns true if the receiver accepts an echo within this number of periods.
fn confirms<P: Plan, J: Judge, const K: usize, const E: usize>(
    mut ring: Ring<P, J, K, E, 1>,
    periods: u32,
    drive: Drive,
) -> bool {
    let (mut fired_us, mut before_us) = ([None; K], [None; K]);
    let mut ended = 0;
    while ended < periods {
        let now = ring.next_deadline();
        let expected = |sensor: u8| match (fired_us[usize::from(sensor)], before_us[usize::from(sensor)]) {
            // 343.2 m/s: 2 v dt / c, in microseconds.
            (Some(fired), Some(before)) => -((i64::from(drive.mm_s) * i64::from(fired - before)) / 171_600) as i32,
            _ => 0,
        };
        let Some(event) = ring.poll_expecting(now, expected) else { continue };
        match event {
            RingEvent::Fire { sensor, .. } => {
                let at = now.as_micros();
                (before_us[usize::from(sensor)], fired_us[usize::from(sensor)]) =
                    (fired_us[usize::from(sensor)], Some(at));
                let heard = |emitted: u32, listens: u32| {
                    let arrives = emitted + drive.length_us;
                    (arrives > listens + BLANKING && arrives <= listens + WINDOW.as_micros()).then_some(arrives)
                };
                // Whoever of the two fires later knows when the sound arrives.
                let (sent, listens) = (fired_us[usize::from(drive.from)], fired_us[usize::from(drive.to)]);
                if let (true, Some(sent), Some(listens)) = (sensor == drive.from || sensor == drive.to, sent, listens) {
                    if let Some(arrives) = heard(sent, listens) {
                        ring.echo(drive.to, Instant::from_micros(arrives)).unwrap();
                    }
                }
            }
            RingEvent::Reading(reading) => {
                if reading.sensor == drive.to && reading.kind == ReadingKind::Accepted {
                    return true;
                }
            }
            RingEvent::PeriodEnded(_) => ended += 1,
        }
    }
    false
}

/// The pairs that confirm some path at some speed from 0 to 2 m/s.
fn fooled<const K: usize>(confirms: impl Fn(Drive) -> bool) -> Vec<(u8, u8, i32)> {
    let mut found = vec![];
    for (from, to) in (0..K as u8).flat_map(|from| (0..K as u8).map(move |to| (from, to))) {
        for (mm_s, length_us) in (0..=20).flat_map(|tenths| LENGTHS.map(|length_us| (100 * tenths, length_us))) {
            let drive = Drive { from, to, length_us, mm_s };
            if from != to && confirms(drive) {
                found.push((from, to, mm_s));
                break;
            }
        }
    }
    found
}

/// The same of a hopping ring.
fn fooled_hopping<const K: usize>(code: HoppingCode, period: Micros, settings: HoppingSettings) -> Vec<(u8, u8, i32)> {
    let schedule = HoppingSchedule::<K>::spread(code, period).unwrap();
    fooled::<K>(|drive| {
        let ring = HoppingRing::<K>::hopping(&schedule, settings, listening(), 1, Instant::from_micros(0)).unwrap();
        confirms(ring, 10 * u32::from(code.phases()), drive)
    })
}

/// The same of a flow ring.
fn fooled_flow<const K: usize, const H: usize, const E: usize>(settings: FlowSettings) -> Vec<(u8, u8, i32)> {
    fooled::<K>(|drive| {
        confirms(FlowRing::<K, H, E>::flow(K, settings, listening(), Instant::from_micros(0)).unwrap(), 120, drive)
    })
}

#[test]
fn no_pair_of_a_flow_ring_is_confirmed_at_any_speed() {
    assert_eq!(fooled_flow::<8, 4, 1>(FlowSettings::DEFAULT), []);
    assert_eq!(fooled_flow::<12, 4, 1>(FlowSettings::DEFAULT), []);
    assert_eq!(fooled_flow::<8, 12, 8>(FlowSettings::DEFAULT), []);
}

#[test]
fn no_pair_of_eight_is_confirmed_at_any_speed() {
    let code = HoppingCode::new(8, 2, Micros::new(240)).unwrap();
    for settings in [HoppingSettings::BALANCED, HoppingSettings::DRIVING, HoppingSettings::QUICK] {
        assert_eq!(fooled_hopping::<8>(code, Micros::from_millis(60), settings), []);
    }
}

#[test]
fn no_pair_of_twelve_is_confirmed_at_any_speed() {
    let code = HoppingCode::new(12, 2, Micros::new(240)).unwrap();
    assert_eq!(fooled_hopping::<12>(code, Micros::from_millis(100), HoppingSettings::DRIVING), []);
}

#[test]
fn a_linear_congruence_confirms_crosstalk_while_driving() {
    let code = HoppingCode::of(8, 11, 1, Micros::new(240)).unwrap();
    let found = fooled_hopping::<8>(code, Micros::from_millis(60), HoppingSettings::DRIVING);
    assert!(found.len() >= 5, "{found:?}");
    assert!(found.iter().all(|(_, _, mm_s)| *mm_s > 0), "{found:?}");
}
