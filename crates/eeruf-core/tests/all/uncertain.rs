//! Edges known only to lie within an interval: their readings, and intervals that are too wide.

use eeruf_core::{
    Instant, Micros, Reading, ReadingKind, Ring, RingConfig, RingError, RingEvent, Schedule, ScheduledRing,
    SensorError,
    watch::{Doubt, SensorState, SensorWatch},
};

const BLANKING: u32 = 1_000;
const WINDOW: u32 = 30_000;
const T_DELTA: u32 = 300;

fn schedule() -> Schedule<2> {
    let ms = |times: [u32; 2]| times.map(Micros::from_millis);
    Schedule::from_firing(Micros::from_millis(100), [ms([10, 55]), ms([20, 60])]).unwrap()
}

/// An edge between two times since the firing, in microseconds.
type Between = (i32, i32);

fn after(fired: Instant, us: i32) -> Instant {
    Instant::from_micros(fired.as_micros().wrapping_add_signed(us))
}

/// Polls until all readings of sensor 0 are emitted, reporting the edges of each of its firings in turn.
fn readings<const E: usize>(firings: &[&[Between]]) -> Vec<Reading> {
    let schedule = schedule();
    let config = RingConfig::new().with_t_delta(Micros::new(T_DELTA)).with_window(Micros::new(WINDOW));
    let config = config.with_blanking(Micros::new(BLANKING)).with_echoes::<E>();
    let begin = Instant::from_micros(u32::MAX - 5_000);
    let mut ring: ScheduledRing<'_, 2, E> = Ring::unverified(&schedule, config, begin).unwrap();
    let (mut readings, mut firings) = (vec![], firings.iter());
    let wanted = firings.len();
    while readings.len() < wanted {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { sensor: 0, .. }) => {
                let fired = ring.last_firing(0).unwrap();
                for &(earliest, latest) in *firings.next().unwrap_or(&&[][..]) {
                    ring.echo_between(0, after(fired, earliest), after(fired, latest)).unwrap();
                }
            }
            Some(RingEvent::Reading(reading)) if reading.sensor == 0 => readings.push(reading),
            _ => {}
        }
    }
    readings
}

fn heard<const E: usize>(edges: &[Between]) -> (ReadingKind, Option<u32>) {
    let reading = readings::<E>(&[edges])[0];
    (reading.kind, reading.t_echo.map(Micros::as_micros))
}

#[test]
fn the_middle_of_an_interval_is_the_echo() {
    use ReadingKind::*;
    assert_eq!(heard::<1>(&[(9_000, 9_000)]), (First, Some(9_000)));
    assert_eq!(heard::<1>(&[(9_000, 9_599)]), (First, Some(9_299)));
    assert_eq!(heard::<1>(&[(9_000, 9_600)]), (First, Some(9_300)));
    assert_eq!(heard::<1>(&[(9_000, 9_601)]), (Late, None));
    // Blanking and window count by the middle, too.
    assert_eq!(heard::<1>(&[(700, 1_300)]), (First, Some(1_000)));
    assert_eq!(heard::<1>(&[(700, 1_299)]), (TooEarly, Some(999)));
    assert_eq!(heard::<1>(&[(29_700, 30_300)]), (First, Some(30_000)));
    assert_eq!(heard::<1>(&[(29_702, 30_300)]), (NoEcho, None));
}

#[test]
fn a_wide_interval_makes_a_reading_late_if_it_may_hold_the_echo() {
    use ReadingKind::*;
    // It begins before the firing, or ends after the window.
    assert_eq!(heard::<1>(&[(-5_000, BLANKING as i32)]), (Late, None));
    assert_eq!(heard::<1>(&[(WINDOW as i32, 50_000)]), (Late, None));
    assert_eq!(heard::<1>(&[(-5_000, BLANKING as i32 - 1)]), (NoEcho, None));
    assert_eq!(heard::<1>(&[(-400, BLANKING as i32 - 1)]), (TooEarly, Some(299)));
    assert_eq!(heard::<1>(&[(WINDOW as i32 + 1, 50_001)]), (NoEcho, None));
    // An echo from before the wide edge counts; one from within it or after it does not.
    assert_eq!(heard::<1>(&[(8_900, 9_100), (9_000, 15_000)]), (First, Some(9_000)));
    assert_eq!(heard::<1>(&[(8_900, 9_102), (9_000, 15_000)]), (Late, None));
    assert_eq!(heard::<1>(&[(9_000, 15_000), (16_000, 16_000)]), (Late, None));
    assert_eq!(heard::<1>(&[(300, 300), (9_000, 15_000)]), (Late, None));
    assert_eq!(heard::<4>(&[(5_000, 5_000), (9_000, 15_000), (20_000, 20_000)]), (First, Some(5_000)));
    assert_eq!(heard::<4>(&[(9_000, 15_000), (20_000, 20_000)]), (Late, None));
}

#[test]
fn a_late_reading_is_the_base_of_no_pair() {
    use ReadingKind::*;
    let (good, wide) = (&[(9_000, 9_000)][..], &[(9_000, 12_000)][..]);
    let seen = readings::<1>(&[good, good, wide, good, good]);
    assert_eq!(seen.iter().map(|seen| seen.kind).collect::<Vec<_>>(), [First, Accepted, Late, First, Accepted]);
    assert_eq!((seen[2].t_echo, seen[2].previous, seen[2].age), (None, None, Some(1)));
    // It is a reading of its own, not a follow-up of another: nothing is known.
    let mut watch = SensorWatch::<2>::new(0, Instant::default());
    watch.observe(&RingEvent::Reading(Reading { kind: Clear, ..seen[2] }), Instant::default());
    watch.observe(&RingEvent::Reading(seen[2]), Instant::default());
    let state = watch.state(0, Instant::default()).unwrap();
    assert_eq!(state, SensorState::Unknown { since: Micros::ZERO, why: Doubt::Unsure });
}

#[test]
fn an_echo_that_is_taken_back_takes_its_uncertainty_with_it() {
    let schedule = schedule();
    let config = RingConfig::new().with_t_delta(Micros::new(T_DELTA)).with_window(Micros::new(WINDOW));
    let mut ring: ScheduledRing<'_, 2> = Ring::unverified(&schedule, config, Instant::default()).unwrap();
    let mut kinds = vec![];
    while kinds.len() < 4 {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { sensor: 0, .. }) => {
                ring.measured_between(0, Micros::new(4_000), Micros::new(4_000 + 590 * (kinds.len() as u32))).unwrap();
                ring.unheard(0).unwrap();
                ring.measured(0, Some(Micros::new(9_000))).unwrap();
            }
            Some(RingEvent::Reading(reading)) if reading.sensor == 0 => kinds.push(reading.kind),
            _ => {}
        }
    }
    assert_eq!(kinds[1..], [ReadingKind::Accepted; 3]);
}

// Found by fuzzing: an early edge was reported without its time.
#[test]
fn a_wide_edge_that_is_taken_back_leaves_silence() {
    let schedule = schedule();
    let config = RingConfig::new().with_t_delta(Micros::new(T_DELTA)).with_window(Micros::new(WINDOW));
    let config = config.with_blanking(Micros::new(BLANKING));
    let mut ring: ScheduledRing<'_, 2> = Ring::unverified(&schedule, config, Instant::default()).unwrap();
    loop {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { sensor: 0, .. }) => {
                ring.measured(0, Some(Micros::new(300))).unwrap();
                ring.measured_between(0, Micros::new(4_000), Micros::new(6_000)).unwrap();
                ring.unheard(0).unwrap();
            }
            Some(RingEvent::Reading(reading)) if reading.sensor == 0 => {
                break assert_eq!((reading.kind, reading.t_echo), (ReadingKind::NoEcho, None));
            }
            _ => {}
        }
    }
}

#[test]
fn an_interval_that_ends_before_it_begins_is_refused() {
    let schedule = schedule();
    let config = RingConfig::new().with_t_delta(Micros::new(T_DELTA)).with_window(Micros::new(WINDOW));
    let mut ring: ScheduledRing<'_, 2> = Ring::unverified(&schedule, config, Instant::default()).unwrap();
    let [at, before] = [5, 4].map(Instant::from_micros);
    let error = ring.echo_between(0, at, before).unwrap_err();
    assert_eq!(error, RingError::Interval { earliest: 5, latest: 4 });
    assert_eq!(error.to_string(), "an echo between 5 and 4 us; expected the latest after the earliest, likely swapped");
    let [at, before] = [9_000, 8_999].map(Micros::new);
    assert_eq!(ring.measured_between(0, at, before), Err(RingError::Interval { earliest: 9_000, latest: 8_999 }));
    let no_such = SensorError { sensor: 2, sensors: 2 };
    assert_eq!(ring.echo_between(2, Instant::default(), Instant::default()), Err(RingError::Sensor(no_such)));
    assert_eq!(ring.measured_between(2, before, at).unwrap_err().to_string(), no_such.to_string());
}
