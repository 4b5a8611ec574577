//! A loop that samples its lines and has other work: edges are known to lie between two looks, and wrong distances from
//! late looks are not accepted.

use std::cell::RefCell;
use std::rc::Rc;

use crate::pins::{self, Lines as _, Pin};
use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Edge, Instant, Micros, ReadingKind, RingConfig, RingError, RingEvent};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Sampler, Settings};
use embedded_hal_mock::eh1::delay::NoopDelay;
use fastrand::Rng;

const K: usize = 8;

/// Time for a turn of the loop, and for a look at one line.
const TURN_US: u32 = 100;
const LOOK_US: u32 = 8;

/// The time, and the pulse of each line.
#[derive(Default)]
struct Lines {
    now: u32,
    pulses: [Option<(u32, u32)>; K],
    triggered: Option<u8>,
}

impl pins::Lines for Lines {
    fn is_high(&self, sensor: u8) -> bool {
        self.pulses[usize::from(sensor)].is_some_and(|(rise, fall)| (rise..fall).contains(&self.now))
    }

    fn trigger(&mut self, sensor: u8) {
        self.triggered = Some(sensor);
    }
}

fn wall_us(sensor: u8) -> u32 {
    4_000 + 3_000 * u32::from(sensor)
}

fn driver(lines: &Rc<RefCell<Lines>>, now: Instant) -> HcSr04Ring<FlowRing<K>, Pin<Lines>, Pin<Lines>, NoopDelay, K> {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    let ring = FlowRing::flow(K, TurnSettings::new(5), BeliefSettings::DEFAULT, config, now).unwrap();
    let pin = |x| Pin(Rc::clone(lines), x as u8);
    let pins = std::array::from_fn(|x| Pins { trigger: pin(x), echo: pin(x) });
    HcSr04Ring::new(ring, pins, NoopDelay, Settings::default()).unwrap()
}

/// Runs for 20 s with `work_us` of other work every `every_us`. With `as_seen`, edges are reported with the time of the
/// look. Returns the numbers of accepted readings that are right, and wrong by 5 cm or more.
fn run([work_us, every_us]: [u32; 2], as_seen: bool) -> (u32, u32) {
    let lines = Rc::new(RefCell::new(Lines::default()));
    let mut driver = driver(&lines, Instant::from_micros(0));
    let mut sampler = Sampler::<K>::new(Instant::from_micros(0));
    let (mut random, mut works_at, mut right, mut wrong) = (Rng::with_seed(20_002), 1_000, 0, 0);
    while lines.borrow().now < 20_000_000 {
        for sensor in 0..K as u8 {
            let before = Instant::from_micros(lines.borrow().now);
            let high = lines.borrow().is_high(sensor);
            lines.borrow_mut().now += LOOK_US;
            let after = Instant::from_micros(lines.borrow().now);
            if let Some((earliest, latest)) = sampler.look(sensor, high, before, after) {
                if as_seen {
                    driver.edge(Edge { sensor, high, at: latest }).unwrap();
                } else {
                    driver.edge_between(sensor, high, earliest, latest).unwrap();
                }
            }
        }
        let now = Instant::from_micros(lines.borrow().now);
        while let Some(event) = driver.poll(now) {
            let lines = &mut *lines.borrow_mut();
            if let Some(sensor) = lines.triggered.take() {
                let rise = lines.now + 450;
                lines.pulses[usize::from(sensor)] = Some((rise, rise + wall_us(sensor) + random.u32(..=30)));
            }
            match event {
                RingEvent::Reading(reading) if reading.kind == ReadingKind::Accepted => {
                    let off = reading.t_echo.unwrap().as_micros().abs_diff(wall_us(reading.sensor));
                    if off <= 300 { right += 1 } else { wrong += 1 }
                }
                _ => {}
            }
        }
        let mut lines = lines.borrow_mut();
        lines.now += TURN_US - LOOK_US * K as u32;
        if work_us > 0 && lines.now >= works_at {
            works_at += every_us;
            lines.now += work_us;
        }
    }
    (right, wrong)
}

#[test]
fn distances_off_by_what_was_overslept_are_not_accepted() {
    let (alone, none) = run([0, 1], false);
    assert!(alone > 800 && none == 0, "{alone} right, {none} wrong");
    let mut wrong_as_seen = 0;
    for (work, least) in [
        ([900, 20_000], 85),
        ([1_000, 5_000], 50),
        ([1_600, 10_000], 60),
        ([3_000, 10_000], 40),
        ([5_000, 20_000], 40),
        ([8_000, 15_000], 10),
    ] {
        let (right, wrong) = run(work, false);
        assert_eq!(wrong, 0, "{work:?}: {right} right");
        assert!(100 * right >= least * alone, "{work:?}: {right} of {alone} right");
        wrong_as_seen += run(work, true).1;
    }
    assert!(wrong_as_seen > 100, "{wrong_as_seen}");
}

#[test]
fn edge_between_instants_that_are_swapped_is_refused() {
    let lines = Rc::new(RefCell::new(Lines::default()));
    let at = Instant::from_micros;
    let mut driver = driver(&lines, at(0));
    let refused = Err(RingError::Interval { earliest: 5, latest: 4 });
    assert_eq!(driver.edge_between(0, true, at(5), at(4)), refused);
    assert!(matches!(driver.edge_between(8, true, at(4), at(5)), Err(RingError::Sensor(_))));
    assert_eq!(driver.edge_between(7, true, at(4), at(4)), Ok(()));
}
