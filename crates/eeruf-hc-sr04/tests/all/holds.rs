//! Lines that stay high: a stuck line is never free space, and a measurement counts once, however long a module without
//! an echo holds its line.

use std::cell::RefCell;
use std::rc::Rc;

use crate::pins::{self, Pin};
use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, judge::Judge, plan::Plan, tables::PAPER_12,
    watch::SensorState, watch::SensorWatch,
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embedded_hal_mock::eh1::delay::NoopDelay;
use fastrand::Rng;

const K: usize = 12;
/// The sensor whose line is watched; all others have walls.
const WATCHED: u8 = 3;
const WALL_US: u32 = 5_830;
const BEGIN: Instant = Instant::from_micros(u32::MAX - 700_000);

/// Levels of the lines, and the sensor triggered since the last look.
#[derive(Default)]
struct Lines {
    high: [bool; K],
    triggered: Option<u8>,
}

impl pins::Lines for Lines {
    fn is_high(&self, sensor: u8) -> bool {
        self.high[usize::from(sensor)]
    }

    fn trigger(&mut self, sensor: u8) {
        self.triggered = Some(sensor);
    }
}

/// A reading of the watched sensor: time of emission, kind, and the state after it.
type Said = (Instant, ReadingKind, SensorState);

/// Runs a ring for 4 s. The watched sensor's pulses take `pulse_us`; its line sticks high at an instant, if at all.
fn run<P: Plan, J: Judge, const H: usize>(
    ring: Ring<P, J, K, 1, H>,
    pulse_us: u32,
    sticks: Option<Instant>,
    speed_mm_s: u32,
) -> Vec<Said> {
    let lines = Rc::new(RefCell::new(Lines::default()));
    let pins = std::array::from_fn(|x| Pins {
        trigger: Pin(Rc::clone(&lines), x as u8),
        echo: Pin(Rc::clone(&lines), x as u8),
    });
    let mut driver = HcSr04Ring::new(ring, pins, NoopDelay, Settings::default()).unwrap();
    let mut watch = SensorWatch::<K>::new(0, BEGIN);
    let (mut said, mut now) = (vec![], BEGIN);
    // Every second line sticks at once, the others when they rise next.
    let at_once = sticks.filter(|at| at.as_micros() % 2 == 0);
    let mut edges: Vec<Edge> = at_once.map(|at| Edge { sensor: WATCHED, high: true, at }).into_iter().collect();
    while now.since(BEGIN) < Micros::from_millis(4_000) {
        let deadline = driver.next_deadline();
        let next = edges.iter().map(|edge| edge.at).min_by_key(|at| at.since(now));
        now = next.filter(|at| at.since(now) < deadline.since(now)).unwrap_or(deadline);
        let (come, later) = edges.into_iter().partition::<Vec<_>, _>(|edge| edge.at == now);
        edges = later;
        for edge in come {
            let is_stuck = edge.sensor == WATCHED && sticks.is_some_and(|at| now.has_reached(at));
            let level = edge.high || is_stuck;
            let was = std::mem::replace(&mut lines.borrow_mut().high[usize::from(edge.sensor)], level);
            if level != was {
                driver.edge(edge).unwrap();
            }
        }
        driver.moving(speed_mm_s, 0, now);
        while let Some(event) = driver.poll(now) {
            watch.observe(&event, now);
            if let Some(sensor) = lines.borrow_mut().triggered.take() {
                let pulse = if sensor == WATCHED { pulse_us } else { WALL_US };
                let edge = |us, high| Edge { sensor, high, at: now + Micros::new(us) };
                edges.extend([edge(450, true), edge(450 + pulse, false)]);
            }
            match event {
                RingEvent::Reading(reading) if reading.sensor == WATCHED => {
                    said.push((now, reading.kind, watch.state(WATCHED, now).unwrap()));
                }
                _ => {}
            }
        }
    }
    said
}

/// The rings: one with a table, and flow rings of a stationary and of a moving robot.
fn each(pulse_us: u32, sticks: Option<Instant>, seed: u32) -> [(&'static str, Vec<Said>); 3] {
    let table = || Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), BEGIN).unwrap();
    let flow = || {
        let config = RingConfig::new().with_window(Micros::from_millis(36));
        FlowRing::<K>::flow(K, TurnSettings::new(seed), BeliefSettings::DEFAULT, config, BEGIN).unwrap()
    };
    [
        ("table", run(table(), pulse_us, sticks, 0)),
        ("flow", run(flow(), pulse_us, sticks, 0)),
        ("flow, moving", run(flow(), pulse_us, sticks, 500)),
    ]
}

#[test]
fn line_that_sticks_before_an_obstacle_is_never_clear() {
    let mut random = Rng::with_seed(20_001);
    for onset in 0..20 {
        let at = BEGIN + Micros::new(random.u32(1_000_000..2_000_000));
        for (ring, said) in each(WALL_US, Some(at), random.u32(1..)) {
            let (before, after) =
                said.split_at(said.iter().position(|&(emitted, ..)| emitted.has_reached(at)).unwrap());
            let is_accepted = |&(_, kind, _): &Said| kind == ReadingKind::Accepted;
            assert!(before.iter().filter(|said| is_accepted(said)).count() > 4, "{ring}: {before:?}");
            for &(_, kind, state) in after {
                let is_clear = kind == ReadingKind::Clear || matches!(state, SensorState::Clear { .. });
                assert!(!is_clear, "onset {onset}, {ring}: {after:?}");
            }
            assert_eq!(after.last().unwrap().1, ReadingKind::Stuck, "onset {onset}, {ring}");
        }
    }
}

// A module's own time-out ends just after the window of a flow ring, a clone's much later.
#[test]
fn module_that_hears_nothing_is_clear_after_its_second_silence() {
    for hold_us in [38_000, 66_000, 130_000, 165_000, 200_000] {
        for (ring, said) in each(hold_us, None, 7) {
            let is_clear =
                |&(_, kind, state): &Said| kind == ReadingKind::Clear && matches!(state, SensorState::Clear { .. });
            let first = said.iter().position(is_clear).unwrap();
            let wrong = said[first..].iter().find(|said| !is_clear(said));
            assert_eq!(wrong, None, "{hold_us} us, {ring}");
            // It is triggered again at the first firing after a hold, and its reading takes no longer than a firing.
            let refire = said[5].0.since(said[4].0).as_micros().max(140_000);
            let waited = said[first].0.since(BEGIN).as_micros();
            assert!(waited <= 2 * hold_us + 3 * refire, "{hold_us} us, {ring}: {waited}");
            // One measurement counts once; a moving robot takes the first.
            assert!(ring == "flow, moving" || waited > 2 * hold_us, "{hold_us} us, {ring}: {waited}");
            assert!(hold_us > 40_000 || first <= 2, "{hold_us} us, {ring}: {first}");
        }
    }
}
