//! A ring as a task, on an executor of one task whose clock jumps to the next edge or the end of a delay.

use std::cell::RefCell;
use std::convert::Infallible;
use std::future::{Future, poll_fn};
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, Tally};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use embedded_hal_async::digital::Wait;

/// Modules that each face a wall of their own, and the clock.
struct World {
    now_us: u32,
    /// The pulse width of each module; `None` for a missing one.
    widths_us: Vec<Option<u32>>,
    /// Edges to come: time, sensor, level.
    coming: Vec<(u32, usize, bool)>,
    high: Vec<bool>,
    edges: Vec<u32>,
    alarm_us: Option<u32>,
}

impl World {
    fn advance(&mut self) {
        let next = self.coming.iter().map(|edge| edge.0).chain(self.alarm_us).min().expect("nothing is awaited");
        self.now_us = self.now_us.max(next);
        let Self { now_us, coming, high, edges, .. } = self;
        coming.retain(|&(at_us, sensor, level)| {
            if at_us <= *now_us {
                (high[sensor], edges[sensor]) = (level, edges[sensor] + 1);
            }
            at_us > *now_us
        });
        self.alarm_us = None;
    }
}

#[derive(Clone)]
struct Line(Rc<RefCell<World>>, usize);

impl ErrorType for Line {
    type Error = Infallible;
}

impl OutputPin for Line {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        let mut world = self.0.borrow_mut();
        let rise = world.now_us + 450;
        if let Some(width) = world.widths_us[self.1] {
            world.coming.extend([(rise, self.1, true), (rise + width, self.1, false)]);
        }
        Ok(())
    }
}

impl InputPin for Line {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().high[self.1])
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

impl Wait for Line {
    async fn wait_for_any_edge(&mut self) -> Result<(), Infallible> {
        let seen = self.0.borrow().edges[self.1];
        poll_fn(|_| if self.0.borrow().edges[self.1] == seen { Poll::Pending } else { Poll::Ready(Ok(())) }).await
    }

    async fn wait_for_high(&mut self) -> Result<(), Infallible> {
        unreachable!("not waited for")
    }

    async fn wait_for_low(&mut self) -> Result<(), Infallible> {
        unreachable!("not waited for")
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), Infallible> {
        unreachable!("not waited for")
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), Infallible> {
        unreachable!("not waited for")
    }
}

struct Delay(Rc<RefCell<World>>);

impl embedded_hal::delay::DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_us += ns.div_ceil(1_000);
    }
}

impl embedded_hal_async::delay::DelayNs for Delay {
    async fn delay_ns(&mut self, ns: u32) {
        let end = self.0.borrow().now_us + ns.div_ceil(1_000);
        poll_fn(|_| {
            let mut world = self.0.borrow_mut();
            if world.now_us >= end {
                return Poll::Ready(());
            }
            world.alarm_us = Some(world.alarm_us.map_or(end, |alarm| alarm.min(end)));
            Poll::Pending
        })
        .await;
    }
}

/// Runs a task to its end; returns `None` if it has not ended by this time.
fn run<F: Future>(world: &Rc<RefCell<World>>, until_us: u32, task: F) -> Option<F::Output> {
    let mut task = pin!(task);
    loop {
        if let Poll::Ready(output) = task.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return Some(output);
        }
        if world.borrow().now_us > until_us {
            return None;
        }
        world.borrow_mut().advance();
    }
}

const WIDTHS_US: [Option<u32>; 4] = [Some(3_000), Some(9_000), None, Some(20_000)];

/// The readings of four modules in 10 s, by kind and in total, and the greatest error of an echo; each `next` lasts at
/// most `piece_us`.
fn ten_seconds(piece_us: u32) -> ([(Tally<u32>, u32); 4], u32) {
    let (widths_us, coming) = (WIDTHS_US.to_vec(), Vec::new());
    let world = World { now_us: 0, widths_us, coming, high: vec![false; 4], edges: vec![0; 4], alarm_us: None };
    let world = Rc::new(RefCell::new(world));
    let config = RingConfig::new().with_window(Micros::from_millis(37));
    let ring = FlowRing::<4>::flow(4, TurnSettings::new(7), BeliefSettings::DEFAULT, config, Instant::default());
    let line = |sensor| Line(Rc::clone(&world), sensor);
    let pins = std::array::from_fn(|sensor| Pins { trigger: line(sensor), echo: line(sensor) });
    let clock = || Instant::from_micros(world.borrow().now_us);
    let delay = Delay(Rc::clone(&world));
    let mut ring = HcSr04Ring::awaited(ring.unwrap(), pins, delay, Settings::default(), clock).unwrap();
    let (mut tallies, mut worst) = ([(Tally::default(), 0); 4], 0);
    while world.borrow().now_us < 10_000_000 {
        let until_us = world.borrow().now_us + piece_us;
        let Some(reading) = run(&world, until_us, ring.next()) else { continue };
        let sensor = usize::from(reading.sensor);
        tallies[sensor].0.count(reading.kind);
        tallies[sensor].1 += 1;
        if let (ReadingKind::Accepted, Some(t_echo)) = (reading.kind, reading.t_echo) {
            worst = worst.max(t_echo.as_micros().abs_diff(WIDTHS_US[sensor].unwrap()));
        }
    }
    (tallies, worst)
}

// The future may even be dropped all the time.
#[test]
fn next_reads_what_each_module_sees() {
    for piece_us in [u32::MAX / 2, 1] {
        let (tallies, worst) = ten_seconds(piece_us);
        for ((tally, total), width) in tallies.iter().zip(WIDTHS_US) {
            let [accepted, unanswered] = [ReadingKind::Accepted, ReadingKind::Unanswered].map(|kind| tally.of(kind));
            match width {
                Some(_) => assert!(accepted > 80 && 20 * accepted > 19 * total, "{tally:?}"),
                None => assert!(unanswered > 50 && unanswered == *total, "{tally:?}"),
            }
        }
        assert!(worst <= 10, "{worst} us");
    }
}
