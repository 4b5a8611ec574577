//! A flow ring with realistic wiring and a busy main loop: pulses are echoes, polls are late, the robot moves, and a
//! fault affects only its own sensor.

use std::convert::Infallible;

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Edge, Instant, Micros, ReadingKind, RingConfig, RingEvent, Tally};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings, SetupError};
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use embedded_hal_mock::eh1::delay::NoopDelay;

const WINDOW: Micros = Micros::from_millis(37);

/// A trigger, or an echo line that is always low or always high.
struct Line(bool);

impl ErrorType for Line {
    type Error = Infallible;
}

impl OutputPin for Line {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Line {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0)
    }
}

type Driver<const K: usize> = HcSr04Ring<FlowRing<K>, Line, Line, NoopDelay, K>;

/// A driver of modules with their usual rest time; the line of one may be stuck high.
fn driver<const K: usize>(seed: u32, high: Option<usize>, settings: Settings) -> Result<Driver<K>, SetupError> {
    let turns = TurnSettings::new(seed);
    let ring =
        FlowRing::flow(K, turns, BeliefSettings::DEFAULT, RingConfig::new().with_window(WINDOW), Instant::default());
    let pins = std::array::from_fn(|sensor| Pins { trigger: Line(false), echo: Line(high == Some(sensor)) });
    HcSr04Ring::new(ring.unwrap(), pins, NoopDelay, settings)
}

/// Counts each sensor's readings by kind in 20 s. The robot drives towards a wall for each sensor; with `told` the
/// driver knows the speed. Each wake-up is late by up to `late_us`.
fn walls<const K: usize>(
    mut driver: Driver<K>,
    late_us: u32,
    speed_mm_s: u32,
    told: bool,
) -> ([Tally<u32>; K], Driver<K>) {
    let (mut edges, mut tallies) = (Vec::<Edge>::new(), [Tally::default(); K]);
    let mut random = 0x2545_f491_u32;
    let mut below = |most: u32| {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        random % (most + 1)
    };
    let end = Instant::from_micros(20_000_000);
    loop {
        let deadline = driver.next_deadline();
        let now = deadline + Micros::new(below(late_us));
        if now.has_reached(end) {
            return (tallies, driver);
        }
        edges.sort_by_key(|edge| edge.at.as_micros());
        while edges.first().is_some_and(|edge| now.has_reached(edge.at)) {
            driver.edge(edges.remove(0)).unwrap();
        }
        if told {
            driver.moving(speed_mm_s, 0, now);
        }
        while let Some(event) = driver.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let rises = now + Micros::new(450);
                    // The robot drives towards its walls for a second, then away from them for a second.
                    let ms = now.as_micros() / 1_000 % 2_000;
                    let nearer_us = speed_mm_s * ms.min(2_000 - ms) * 2 / 343;
                    let width = 20_000 - 1_000 * u32::from(sensor % 8) - nearer_us + below(30);
                    edges.push(Edge { sensor, high: true, at: rises });
                    edges.push(Edge { sensor, high: false, at: rises + Micros::new(width) });
                }
                RingEvent::Reading(reading) => tallies[usize::from(reading.sensor)].count(reading.kind),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
}

/// Shares of accepted readings: of all sensors, and of the worst sensor.
fn accepted<const K: usize>(tallies: &[Tally<u32>; K]) -> (f64, f64) {
    let of = |tally: &Tally<u32>| {
        (tally.of(ReadingKind::Accepted), ReadingKind::ALL.map(|kind| tally.of(kind)).iter().sum())
    };
    let all: Vec<(u32, u32)> = tallies.iter().map(of).collect();
    let share = |(accepted, readings): &(u32, u32)| f64::from(*accepted) / f64::from(*readings);
    let sum = all.iter().fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    assert!(sum.1 > 300, "{all:?}");
    (share(&sum), all.iter().map(share).fold(1.0, f64::min))
}

fn own_walls_are_accepted<const K: usize>() {
    for late_us in [0, 100, 1_000, 5_000] {
        for (speed_mm_s, seed) in [(0, 1), (0, 0xdead_beef), (300, 2), (1_000, 3)] {
            let (tallies, _) = walls(driver::<K>(seed, None, Settings::default()).unwrap(), late_us, speed_mm_s, true);
            let (all, least) = accepted(&tallies);
            assert!(all >= 0.97 && least >= 0.9, "{K} sensors, {late_us} us late, {speed_mm_s} mm/s: {all} {least}");
        }
    }
}

#[test]
fn driver_polled_late_accepts_own_walls() {
    own_walls_are_accepted::<2>();
    own_walls_are_accepted::<8>();
    own_walls_are_accepted::<12>();
}

// A driver cannot allow for a speed that it is not told.
#[test]
fn driver_of_a_moving_robot_needs_its_speed() {
    let untold = walls(driver::<8>(3, None, Settings::default()).unwrap(), 1_000, 1_000, false).0;
    assert!(accepted(&untold).0 < 0.9, "{:?}", accepted(&untold));
}

// A line stuck high is never triggered and costs the others nothing.
#[test]
fn stuck_line_costs_the_others_nothing() {
    let (tallies, driver) = walls(driver::<4>(9, Some(1), Settings::default()).unwrap(), 1_000, 0, false);
    let health: Vec<_> = (0..4).map(|sensor| driver.health(sensor)).collect();
    assert_eq!(health, [Health::Well, Health::StuckHigh, Health::Well, Health::Well]);
    assert!(tallies[1].of(ReadingKind::Stuck) > 200 && tallies[1].of(ReadingKind::Accepted) == 0, "{:?}", tallies[1]);
    let (others, least) = accepted(&[tallies[0], tallies[2], tallies[3]]);
    assert!(others >= 0.97 && least >= 0.9, "{others} {least}");
}

#[test]
fn rest_shorter_than_the_modules_need_is_refused() {
    let mut settings = Settings::default();
    settings.min_retrigger = Micros::from_millis(70);
    let expected =
        SetupError::Retrigger { min_refire: Micros::from_millis(60), min_retrigger: Micros::from_millis(70) };
    assert_eq!(driver::<4>(9, None, settings).err(), Some(expected));
}
