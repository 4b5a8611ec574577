//! Fake sensors for a board on its own: HC-SR04 modules, each with a wall in front, seen through their pins.
//!
//! After a trigger the line of a sensor rises, and falls when the echo arrives. A timer of the board makes both edges,
//! which raise the echo interrupt.

use core::cell::Cell;
use core::convert::Infallible;

use critical_section::{CriticalSection, Mutex};
use eeruf_core::{Edge, Instant, Micros};
use eeruf_hc_sr04::Pins;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// The largest number of sensors, as in the paper.
pub const MAX_FAKE_SENSORS: usize = 12;

/// Time from trigger to rise of the line: the burst of an HC-SR04.
const RISE: Micros = Micros::new(450);

#[derive(Clone, Copy)]
struct Line {
    /// Echo time of the object in front of the sensor; `None` for a sensor that is missing.
    t_echo: Option<Micros>,
    /// The coming edges.
    rise: Option<Instant>,
    fall: Option<Instant>,
    high: bool,
}

struct Sensors {
    lines: [Cell<Line>; MAX_FAKE_SENSORS],
}

impl Sensors {
    /// Sets the timer to the next edge of any line.
    fn set_timer(&self) {
        let mut next: Option<Instant> = None;
        for line in &self.lines {
            let line = line.get();
            if let Some(at) = line.rise.or(line.fall)
                && next.is_none_or(|next| !at.has_reached(next))
            {
                next = Some(at);
            }
        }
        if let Some(at) = next {
            crate::set_echo(at);
        }
    }
}

static SENSORS: Mutex<Sensors> = Mutex::new(Sensors {
    lines: [const { Cell::new(Line { t_echo: None, rise: None, fall: None, high: false }) }; MAX_FAKE_SENSORS],
});

fn with<R>(f: impl FnOnce(CriticalSection<'_>, &Sensors) -> R) -> R {
    critical_section::with(|token| f(token, SENSORS.borrow(token)))
}

/// Puts a wall in front of a sensor, at this echo time, or takes the sensor away.
pub fn put(sensor: usize, t_echo: Option<Micros>) {
    with(|_, sensors| {
        if let Some(line) = sensors.lines.get(sensor) {
            line.set(Line { t_echo, ..line.get() });
        }
    });
}

/// Triggers a sensor now.
fn trigger(sensor: usize) {
    let now = crate::now();
    with(|_, sensors| {
        let Some(cell) = sensors.lines.get(sensor) else { return };
        let line = cell.get();
        if let Some(t_echo) = line.t_echo {
            cell.set(Line { rise: Some(now + RISE), fall: Some(now + RISE + t_echo), ..line });
        }
        sensors.set_timer();
    });
}

/// Returns a pending edge, if any, like an interrupt controller. The handler of the echo interrupt calls this until
/// there is none.
pub fn edge() -> Option<Edge> {
    taken().map(|(edge, _)| edge)
}

/// Returns the edge that has come, if any, with the instant that a timer's capture register holds, however late the
/// interrupt is.
pub fn captured() -> Option<Edge> {
    taken().map(|(edge, at)| Edge { at, ..edge })
}

fn taken() -> Option<(Edge, Instant)> {
    let at = crate::now();
    with(|_, sensors| {
        for (x, cell) in sensors.lines.iter().enumerate() {
            let mut line = cell.get();
            let Some(due) = line.rise.or(line.fall) else { continue };
            if !at.has_reached(due) {
                continue;
            }
            line.high = line.rise.take().is_some();
            if !line.high {
                line.fall = None;
            }
            cell.set(line);
            return Some((Edge { sensor: x as u8, high: line.high, at }, due));
        }
        sensors.set_timer();
        None
    })
}

/// The trigger pin of a sensor.
#[derive(Clone, Copy, Debug)]
pub struct Trigger(u8);

/// The echo pin of a sensor.
#[derive(Clone, Copy, Debug)]
pub struct Echo(u8);

/// The pins of all sensors.
pub fn pins<const K: usize>() -> [Pins<Trigger, Echo>; K] {
    core::array::from_fn(|x| Pins { trigger: Trigger(x as u8), echo: Echo(x as u8) })
}

impl ErrorType for Trigger {
    type Error = Infallible;
}

impl OutputPin for Trigger {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    /// Triggers the module: an HC-SR04 measures from the falling edge of its trigger.
    fn set_low(&mut self) -> Result<(), Infallible> {
        trigger(self.0.into());
        Ok(())
    }
}

impl ErrorType for Echo {
    type Error = Infallible;
}

impl InputPin for Echo {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(with(|_, sensors| sensors.lines.get(usize::from(self.0)).is_some_and(|line| line.get().high)))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// A delay that waits by the clock.
#[derive(Clone, Copy, Debug)]
pub struct Delay;

impl DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        let end = crate::now() + Micros::new(ns.div_ceil(1000));
        while !crate::now().has_reached(end) {}
    }
}
