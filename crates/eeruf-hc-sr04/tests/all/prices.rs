//! The share of readings that healthy modules lose, in rooms where they hear each other and in the open.

use std::cell::RefCell;
use std::rc::Rc;

use crate::pins::{Lines, Pin};
use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, judge::Judge, plan::Plan, tables::PAPER_12,
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embedded_hal_mock::eh1::delay::NoopDelay;

const K: usize = 12;
const WINDOW: Micros = Micros::from_millis(36);

/// Xorshift by 13, 7 and 17 (Marsaglia, 2003).
struct Dice(u64);

impl Dice {
    fn below(&mut self, most: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % most
    }
}

#[derive(Default)]
struct High([bool; K]);

impl Lines for High {
    fn is_high(&self, sensor: u8) -> bool {
        self.0[usize::from(sensor)]
    }

    fn trigger(&mut self, _sensor: u8) {}
}

/// Numbers of firings with and without a wall, and of those judged correctly; and the number of firings until every
/// sensor had been clear.
#[derive(Default)]
struct Seen {
    walls: [u32; 2],
    open: [u32; 2],
    first_clear: u32,
}

/// Runs a ring in a room for ten seconds: three in five sensors have a wall, and each hears one of five others. In the
/// open there is no echo. A pulse ends with the first sound, or after `holds`.
fn room<P: Plan, J: Judge, const H: usize>(
    ring: Ring<P, J, K, 1, H>,
    seed: u64,
    is_open: bool,
    holds: u64,
    seen: &mut Seen,
) {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    (0..10).for_each(|_| _ = dice.below(2));
    let mut some = |most: u64, of: u64| (!is_open && dice.below(of) < most).then(|| 1_000 + dice.below(24_000));
    let walls: [_; K] = std::array::from_fn(|_| some(3, 5));
    let paths: [[_; K]; K] = std::array::from_fn(|_| std::array::from_fn(|_| some(1, 5).map(|us| us + us / 4)));
    let lines = Rc::new(RefCell::new(High::default()));
    let pins =
        std::array::from_fn(|x| Pins { trigger: Pin(lines.clone(), x as u8), echo: Pin(lines.clone(), x as u8) });
    let mut driver = HcSr04Ring::new(ring, pins, NoopDelay, Settings::default()).unwrap();
    // For each sensor: from when and until when it listens, its firings, and when its line fell without an echo.
    let (mut now, mut until, mut fired, mut clear) = (0_u64, [(0, 0); K], [0_u32; K], [None; K]);
    let instant = |at: u64| Instant::from_micros(at as u32);
    let mut edges: Vec<(u64, u8, bool)> = vec![];
    while now < 10_000_000 {
        let deadline =
            now + u64::from(driver.next_deadline().since(instant(now)).as_micros() as i32 as u32 & 0x7fff_ffff);
        edges.sort_unstable();
        now = edges.first().map_or(deadline, |edge| edge.0.min(deadline)).max(now);
        while edges.first().is_some_and(|edge| edge.0 <= now) {
            let (at, sensor, high) = edges.remove(0);
            lines.borrow_mut().0[usize::from(sensor)] = high;
            driver.edge(Edge { sensor, high, at: instant(at) }).unwrap();
        }
        while let Some(event) = driver.poll(instant(now)) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let x = usize::from(sensor);
                    fired[x] += 1;
                    if lines.borrow().is_high(sensor) {
                        // The module still listens and ignores the trigger.
                        continue;
                    }
                    let falls = now + 450 + walls[x].map_or(holds, |us| us + dice.below(30));
                    until[x] = (now + 450, falls);
                    edges.extend([(now + 450, sensor, true), (falls, sensor, false)]);
                    for (y, path) in (0..).zip(&paths) {
                        let arrives = now + path[x].unwrap_or(1 << 40) + dice.below(30);
                        let (from, falls) = &mut until[usize::from(y)];
                        if usize::from(y) != x && *from < arrives && arrives < *falls {
                            edges.retain(|edge| (edge.1, edge.2) != (y, false));
                            edges.push((arrives, y, false));
                            *falls = arrives;
                        }
                    }
                }
                RingEvent::Reading(reading) => {
                    let x = usize::from(reading.sensor);
                    let t_echo = reading.t_echo.map_or(0, |echo| u64::from(echo.as_micros()));
                    let (right, of) = match walls[x] {
                        Some(wall) => {
                            (reading.kind == ReadingKind::Accepted && t_echo.abs_diff(wall) < 100, &mut seen.walls)
                        }
                        None => (reading.kind == ReadingKind::Clear, &mut seen.open),
                    };
                    (of[0], of[1]) = (of[0] + 1, of[1] + u32::from(right));
                    if right && walls[x].is_none() {
                        clear[x].get_or_insert(fired[x]);
                    }
                }
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    let clears = (0..K).filter(|&x| walls[x].is_none()).map(|x| clear[x].unwrap_or(u32::MAX));
    seen.first_clear = clears.fold(seen.first_clear, u32::max);
}

/// Percentages of firings judged correctly, with and without a wall; and the firings until all had been clear.
fn shares(rooms: u64, is_open: bool, holds: u64, flow: bool) -> [f64; 3] {
    let mut seen = Seen::default();
    let (begin, config) = (Instant::from_micros(0), RingConfig::new().with_window(WINDOW));
    for seed in 1..=rooms {
        if flow {
            let turns = TurnSettings::for_module(seed as u32, WINDOW, Micros::from_millis(60), Micros::ZERO);
            let ring = FlowRing::<K>::flow(K, turns, BeliefSettings::DEFAULT, config, begin).unwrap();
            room(ring, seed, is_open, holds, &mut seen);
        } else {
            room(Ring::new(&PAPER_12, config, begin).unwrap(), seed, is_open, holds, &mut seen);
        }
    }
    let share = |[all, right]: [u32; 2]| 100.0 * f64::from(right) / f64::from(all.max(1));
    let shares = [share(seen.walls), share(seen.open), seen.first_clear.into()];
    println!("open {is_open}, holds {holds} us, flow {flow}: {shares:.1?}");
    shares
}

// When silence was believed without a witness, two phases were right in 91.0 % of firings at walls and 59.2 % at none,
// and in the open in 99.0 % of ten seconds, from the second firing on.
#[test]
fn healthy_modules_are_believed_as_often_as_before() {
    for flow in [false, true] {
        let [walls, none, _] = shares(200, false, 38_000, flow);
        assert!(walls > 90.0 && none > 58.2, "{walls} {none}");
        // Clones hold their line for longer.
        for (holds, first) in [(38_000, 3), (66_000, 3), (130_000, 5), (200_000, 6)] {
            let [_, none, clear] = shares(20, true, holds, flow);
            assert!(
                (holds > 38_000 || none > 97.5) && clear <= f64::from(first),
                "{holds} us: {none} % from {clear} on"
            );
        }
    }
}
