//! A ring file of sensors that differ, and the readings of its flow ring.

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, RingEvent};
use eeruf_design::RingSpec;

const RING: &str = "
    sensors = 5
    layout = \"line\"
    neighbours = 2
    crosstalk_range_m = 2.0
    max_range_m = [4.0, 4.0, 1.0, 1.0, 4.0]
    jitter_us = 100
    retrigger_us = [45_000, 45_000, 70_000, 45_000, 45_000]
    together = [[2, 3]]
    intervals_us = [[2, 3, 0]]
    shared_lines = [[0, 4]]
    tick_us = 100
";
const FIRINGS: usize = 60;

/// Each sensor has a wall at 12 ms, which is beyond the range of two.
#[test]
fn ring_file_of_mixed_sensors_fires_by_flow() {
    let spec = RingSpec::from_text(RING).expect("a ring");
    let (requirements, robot) = (spec.problem().requirements, spec.robot_ring());
    let limits = TurnSettings::limits::<5>(5, &requirements).expect("limits");
    let window = robot.limits.iter().map(|limits| limits.window).max().unwrap();
    let now = Instant::from_micros(0);
    let turns = TurnSettings::for_module(1, window, Micros::from_millis(45), Micros::ZERO).keeping(&requirements);
    let config = RingConfig::new().with_window(window);
    let ring = FlowRing::<5, 1, _>::with_limits(5, limits, turns, BeliefSettings::DEFAULT, config, now);
    let mut ring = ring.expect("a ring");
    ring.set_silence(eeruf_core::Silence::Trusted);
    let mut fired = [const { vec![] }; 5];
    let mut kinds = [const { vec![] }; 5];
    while fired.iter().any(|fired| fired.len() < FIRINGS) {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    fired[usize::from(sensor)].push(now);
                    ring.echo(sensor, now + Micros::from_millis(12)).unwrap();
                }
                RingEvent::Reading(reading) => kinds[usize::from(reading.sensor)].push(reading.kind),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    for (sensor, (kinds, fired)) in kinds.iter().zip(&fired).enumerate() {
        let last = if matches!(sensor, 2 | 3) { ReadingKind::Clear } else { ReadingKind::Accepted };
        assert!(kinds[8..FIRINGS - 1].iter().all(|kind| *kind == last), "{sensor}: {kinds:?}");
        // The module with the longest rest decides how soon all fire again.
        let soonest = fired.windows(2).map(|pair| pair[1].since(pair[0])).min().unwrap();
        assert!(soonest >= Micros::from_millis(70), "{sensor}: {soonest}");
    }
    assert_eq!(fired[2], fired[3]);
    let (mut one, mut other) = (fired[0].iter().peekable(), fired[4].iter().peekable());
    let mut before = *one.next().unwrap();
    while let (Some(&&x), Some(&&y)) = (one.peek(), other.peek()) {
        let next = if x.has_reached(y) { *other.next().unwrap() } else { *one.next().unwrap() };
        assert!(next.since(before) > window, "{before:?}, then {next:?}");
        before = next;
    }
}
