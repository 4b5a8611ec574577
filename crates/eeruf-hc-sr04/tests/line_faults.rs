//! Faults of one echo line: never free space, and the state of each.

use std::cell::Cell;
use std::convert::Infallible;

use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, Schedule,
    watch::{SensorState, SensorWatch},
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

const K: usize = 3;
/// A wall at 1 m.
const WALL: u32 = 5_830;

/// The present level of a line, and a trigger that always works.
struct Pin<'l>(&'l Cell<bool>);

impl ErrorType for Pin<'_> {
    type Error = Infallible;
}

impl OutputPin for Pin<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Pin<'_> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.get())
    }
}

struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _ns: u32) {}
}

/// An edge of a line: microseconds after the trigger, level, and whether the interrupt sees it.
type Seen = (u32, bool, bool);

/// Runs a ring for 100 periods. A trigger of sensor 1 has the edges of `line`, on the line of sensor `on`. Returns the
/// readings of sensor 1, each with the state after it.
fn run(line: &[Seen], on: u8) -> Vec<(ReadingKind, SensorState)> {
    let ms = |ms: [u32; K]| ms.map(Micros::from_millis);
    let schedule: Schedule<K> =
        Schedule::from_firing(Micros::from_millis(100), [ms([24, 44, 64]), ms([20, 38, 56])]).unwrap();
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::from_millis(40));
    let levels: [Cell<bool>; K] = Default::default();
    let pins = levels.each_ref().map(|level| Pins { trigger: Pin(level), echo: Pin(level) });
    let start = Instant::from_micros(u32::MAX - 2_000_000);
    let ring = Ring::unverified(&schedule, config, start).unwrap();
    let mut driver = HcSr04Ring::new(ring, pins, NoDelay, Settings::default()).unwrap();
    let mut watch = SensorWatch::<K>::new(0, start);
    let mut edges: Vec<(Instant, u8, bool, bool)> = vec![];
    let (mut found, mut periods, mut now) = (vec![], 0, start);
    while periods < 100 {
        let deadline = driver.next_deadline();
        let next = edges.iter().map(|&(at, ..)| at).min_by_key(|at| at.since(now).as_micros());
        now = next.filter(|&at| deadline.has_reached(at)).unwrap_or(deadline);
        edges.retain(|&(at, sensor, high, is_seen)| {
            let has_come = now.has_reached(at);
            if has_come {
                levels[usize::from(sensor)].set(high);
                if is_seen {
                    driver.edge(Edge { sensor, high, at }).unwrap();
                }
            }
            !has_come
        });
        while let Some(event) = driver.poll(now) {
            watch.observe(&event, now);
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let wall = [(450, true, true), (450 + WALL, false, true)];
                    // A module whose line is high does not hear its trigger.
                    let (on, line) = if sensor == 1 { (on, line) } else { (sensor, &wall[..]) };
                    if !levels[usize::from(on)].get() {
                        edges.extend(line.iter().map(|&(us, high, seen)| (now + Micros::new(us), on, high, seen)));
                    }
                }
                RingEvent::Reading(reading) if reading.sensor == 1 => {
                    found.push((reading.kind, watch.state(1, now).unwrap()));
                }
                RingEvent::Reading(_) => {}
                RingEvent::PeriodEnded(_) => periods += 1,
            }
        }
    }
    found
}

#[test]
fn faulty_line_before_wall_is_never_clear() {
    let end = 450 + WALL;
    let faults: [(&str, &[Seen], u8); 7] = [
        ("cut wire, or no power", &[], 1),
        ("lost rising edge", &[(450, true, false), (end, false, true)], 1),
        ("lost falling edge", &[(450, true, true), (end, false, false)], 1),
        ("glitch high of a cut wire", &[(3_000, true, true), (3_005, false, true)], 1),
        ("wire of a line that nobody watches", &[(450, true, false), (end, false, false)], 1),
        ("wires exchanged", &[(450, true, true), (end, false, true)], 2),
        ("wire of a sensor that fires 2 ms later", &[(2_450, true, true), (2_000 + end, false, true)], 1),
    ];
    for (fault, line, on) in faults {
        let found = run(line, on);
        assert!(found.len() > 97, "{fault}");
        let is_free = |&(kind, state): &(ReadingKind, SensorState)| {
            kind == ReadingKind::Clear || matches!(state, SensorState::Clear { .. })
        };
        assert!(!found.iter().any(is_free), "{fault}: {:?}", found.iter().find(|reading| is_free(reading)));
        // Only where a falling edge got lost has the sensor shown that it listened.
        if fault != "lost falling edge" {
            let answers = |state| matches!(state, SensorState::Unanswered { .. });
            assert!(found[2..].iter().all(|&(_, state)| answers(state)), "{fault}: {:?}", found[5]);
        }
    }
}

#[test]
fn short_gap_in_pulse_is_no_end() {
    let gaps: [(u32, bool, bool); 4] =
        [(450, true, true), (3_000, false, true), (3_005, true, true), (450 + WALL, false, true)];
    let found = run(&gaps, 1);
    let wall = Micros::new(WALL);
    let right = |state| matches!(state, SensorState::Obstacle { t_echo, .. } if t_echo == wall);
    assert!(found[1..].iter().all(|&(kind, state)| kind == ReadingKind::Accepted && right(state)), "{:?}", found[3]);
}

#[test]
fn held_line_is_clear_unless_held_forever() {
    for hold_ms in [38, 66, 130, 200] {
        let line = [(450, true, true), (450 + 1_000 * hold_ms, false, true)];
        let found = run(&line, 1);
        let clear = |state| matches!(state, SensorState::Clear { .. });
        let right = found[1..].iter().filter(|&&(kind, state)| kind == ReadingKind::Clear && clear(state)).count();
        assert!(100 * right >= 99 * (found.len() - 1), "{hold_ms} ms: {right} of {}", found.len());
    }
    let found = run(&[(450, true, true)], 1);
    // For 250 ms it may be a clone that has heard nothing.
    assert!(found[4..].iter().all(|&(_, state)| matches!(state, SensorState::Unanswered { .. })), "{:?}", found[5]);
}
