//! `Ring` under arbitrary calls: it never fires neighbours together or a sensor too soon, never panics, and goes on
//! firing.
//!
//! `PROPTEST_CASES=1000000 cargo test --release --package eeruf-core --test all claims::ring` is the long run.

use eeruf_core::tables::{TABLE_I_D, THE_ONE_WITH_19_MS};
use eeruf_core::{
    Instant, Layout, Micros, Ring, RingConfig, RingEvent, Schedule, SensorError,
    judge::Judge,
    plan::{ImmediateRefiring, Plan},
};
use proptest::prelude::*;

const LAYOUT: Layout = Layout::Line(4);

#[derive(Clone, Debug)]
enum Call {
    /// Polls until nothing is due, this much after the deadline, or at once if that has passed.
    PollLate(u32),
    /// Polls once, this long after the last call, on a clock that does not wrap.
    Poll(u64),
    Echo {
        sensor: u8,
        at: Edge,
    },
    Stuck(u8),
    Disable(u8),
    Enable(u8),
    Restart,
    ChangeSchedule(prop::sample::Index),
}

#[derive(Clone, Debug)]
enum Edge {
    AfterNow(i32),
    Anywhen(u32),
}

fn any_call() -> impl Strategy<Value = Call> {
    let sensor = 0..14_u8;
    prop_oneof![
        12 => prop_oneof![6 => Just(0), 2 => 0..2000_u32, 1 => 0..500_000_u32].prop_map(Call::PollLate),
        3 => prop_oneof![4 => 0..1000_u64, 2 => 0..200_000_u64, 1 => 0..10_000_000_000_u64].prop_map(Call::Poll),
        8 => (sensor.clone(), -60_000..60_000_i32)
            .prop_map(|(sensor, us)| Call::Echo { sensor, at: Edge::AfterNow(us) }),
        1 => (sensor.clone(), any::<u32>()).prop_map(|(sensor, us)| Call::Echo { sensor, at: Edge::Anywhen(us) }),
        1 => sensor.clone().prop_map(Call::Stuck),
        1 => sensor.clone().prop_map(Call::Disable),
        1 => sensor.prop_map(Call::Enable),
        1 => Just(Call::Restart),
        1 => any::<prop::sample::Index>().prop_map(Call::ChangeSchedule),
    ]
}

/// Watches the firings of a ring, on a clock that does not wrap.
struct Watch {
    fired: [Option<u64>; 12],
    count: [u32; 12],
}

impl Watch {
    fn note(&mut self, sensor: u8, now: u64, min_interval: Micros, min_refire: Micros) {
        let sensor = usize::from(sensor);
        for (other, fired) in self.fired.iter().enumerate() {
            let Some(fired) = fired else { continue };
            let apart = now - fired;
            if other == sensor {
                assert!(apart >= u64::from(min_refire.as_micros()), "sensor {sensor} refired after {apart} us");
            } else if LAYOUT.neighbours(12, sensor, other) {
                assert!(apart >= u64::from(min_interval.as_micros()), "{other} and {sensor} fired {apart} us apart");
            }
        }
        self.fired[sensor] = Some(now);
        self.count[sensor] += 1;
    }
}

fn config() -> RingConfig {
    let half = Micros::new(500);
    RingConfig::new().with_t_delta(half).with_window(Micros::from_millis(30)).with_blanking(half)
}

fn instant(us: u64) -> Instant {
    Instant::from_micros(us as u32)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn intervals_and_refire_times_hold_whatever_is_called(
        start: u32,
        calls in prop::collection::vec(any_call(), 0..60),
    ) {
        let ladder = [TABLE_I_D.scaled(3, 5).unwrap(), THE_ONE_WITH_19_MS.scaled(4, 5).unwrap(), TABLE_I_D];
        // The limits that every rung keeps; the first is the tightest.
        let min_interval = ladder.iter().map(|s| s.min_interval(LAYOUT).unwrap().value).min().unwrap();
        let min_refire = ladder.iter().map(Schedule::min_refire).min().unwrap();
        let mut now = u64::from(start);
        let mut ring = Ring::unverified(&ladder[0], config(), instant(now)).unwrap();
        let mut watch = Watch { fired: [None; 12], count: [0; 12] };
        for call in calls {
            match call {
                Call::PollLate(late) => {
                    let ahead = ring.next_deadline().since(instant(now)).as_micros();
                    now += u64::from(if ahead <= u32::MAX / 2 { ahead } else { 0 }) + u64::from(late);
                    // Polling at one instant comes to an end.
                    for left in (0..100).rev() {
                        match ring.poll(instant(now)) {
                            Some(RingEvent::Fire { sensor, .. }) => watch.note(sensor, now, min_interval, min_refire),
                            Some(_) => {}
                            None => break,
                        }
                        prop_assert!(left > 0, "there is always something to do");
                    }
                }
                Call::Poll(later) => {
                    now += later;
                    if let Some(RingEvent::Fire { sensor, .. }) = ring.poll(instant(now)) {
                        watch.note(sensor, now, min_interval, min_refire);
                    }
                }
                Call::Echo { sensor, at: Edge::AfterNow(us) } => {
                    known(sensor, ring.echo(sensor, instant(now.wrapping_add_signed(us.into()))));
                }
                Call::Echo { sensor, at: Edge::Anywhen(us) } => {
                    known(sensor, ring.echo(sensor, Instant::from_micros(us)));
                }
                Call::Stuck(sensor) => known(sensor, ring.stuck(sensor)),
                Call::Disable(sensor) => known(sensor, ring.disable(sensor)),
                Call::Enable(sensor) => known(sensor, ring.enable(sensor)),
                Call::Restart => ring.restart(instant(now)),
                Call::ChangeSchedule(rung) => ring.change_to_unverified(rung.get(&ladder)).unwrap(),
            }
        }
        // Two periods of the slowest rung, the silence before a change of schedule, and the rest of a period.
        let before = watch.count;
        let end = now + 5 * 100_000;
        while now < end {
            now += u64::from(ring.next_deadline().since(instant(now)).as_micros()).min(10_000);
            while let Some(event) = ring.poll(instant(now)) {
                if let RingEvent::Fire { sensor, .. } = event {
                    watch.note(sensor, now, min_interval, min_refire);
                }
            }
            now += 1;
        }
        for sensor in 0..12_u8 {
            let fired = watch.count[usize::from(sensor)] - before[usize::from(sensor)];
            if ring.is_enabled(sensor) {
                prop_assert!(fired >= 2, "sensor {sensor} fired {fired} times");
            } else {
                prop_assert_eq!(fired, 0);
            }
        }
    }

    #[test]
    fn a_clock_that_jumps_anywhere_never_stops_a_ring(
        jumps in prop::collection::vec(any::<u32>(), 1..20),
        scheduled: bool,
    ) {
        if scheduled {
            survives_jumps(Ring::unverified(&TABLE_I_D, config(), Instant::default()).unwrap(), &jumps)?;
        } else {
            let refiring = ImmediateRefiring::new(&TABLE_I_D, Micros::from_millis(40), Instant::default());
            survives_jumps(
                Ring::<_, _, 12, 1>::with_plan(refiring, config(), Instant::default()).unwrap(),
                &jumps,
            )?;
        }
    }
}

/// Checks that a call about a sensor is refused if and only if the sensor does not exist.
fn known(sensor: u8, result: Result<(), SensorError>) {
    assert_eq!(result, if sensor < 12 { Ok(()) } else { Err(SensorError { sensor, sensors: 12 }) });
}

fn survives_jumps<P: Plan, J: Judge>(mut ring: Ring<P, J, 12>, jumps: &[u32]) -> Result<(), TestCaseError> {
    for &jump in jumps {
        let mut now = Instant::from_micros(jump);
        let mut fired = 0;
        // Half a second in steps of 5 ms.
        for _ in 0..100 {
            now += Micros::from_millis(5);
            for _ in 0..100 {
                match ring.poll(now) {
                    Some(RingEvent::Fire { .. }) => fired += 1,
                    Some(_) => {}
                    None => break,
                }
            }
        }
        prop_assert!(fired >= 12, "{fired} firings in 500 ms after the clock jumped to {jump}");
    }
    Ok(())
}
