//! Lines of a GPIO character device, whose edges the kernel stamps when they come, however late they are read.

use std::cell::Cell;
use std::hint::spin_loop;
use std::time::Duration;

use eeruf_core::Edge;
use gpiocdev::Request;
use gpiocdev::line::{EdgeDetection, EdgeKind, EventClock, Value};
use nix::time::{ClockId, clock_gettime};

use super::{Lines, instant};

/// The lines of a ring, held until the node ends.
pub(crate) struct Chip {
    triggers: Request,
    echoes: Request,
    trigger_lines: Vec<u32>,
    echo_lines: Vec<u32>,
    /// The number of the last edge, which the kernel counts from 1.
    last: Cell<u32>,
    lost: Cell<u8>,
}

impl Chip {
    pub(crate) fn open(chip: &str, trigger_lines: &[u32], echo_lines: &[u32]) -> Result<Self, String> {
        let wrong = |what: &str, lines: &[u32], error: gpiocdev::Error| {
            format!("gpio_chip: {chip}: {what} {lines:?}: {error}; `gpioinfo` lists lines and their users")
        };
        let mut triggers = Request::builder();
        triggers.on_chip(chip).with_consumer("eeruf").with_lines(trigger_lines).as_output(Value::Inactive);
        let mut echoes = Request::builder();
        echoes.on_chip(chip).with_consumer("eeruf").with_lines(echo_lines).as_input();
        echoes.with_edge_detection(EdgeDetection::BothEdges).with_event_clock(EventClock::Monotonic);
        Ok(Self {
            triggers: triggers.request().map_err(|error| wrong("trigger_lines", trigger_lines, error))?,
            echoes: echoes.request().map_err(|error| wrong("echo_lines", echo_lines, error))?,
            trigger_lines: trigger_lines.to_vec(),
            echo_lines: echo_lines.to_vec(),
            last: Cell::new(0),
            lost: Cell::new(0),
        })
    }
}

fn line(lines: &[u32], sensor: u8) -> Result<u32, String> {
    lines.get(usize::from(sensor)).copied().ok_or_else(|| format!("sensor {sensor} has no line"))
}

impl Lines for Chip {
    fn now_us(&self) -> u64 {
        let now = clock_gettime(ClockId::CLOCK_MONOTONIC).map(Duration::from);
        now.map_or(0, |since| since.as_micros() as u64)
    }

    fn set_trigger(&self, sensor: u8, high: bool) -> Result<(), String> {
        let value = if high { Value::Active } else { Value::Inactive };
        self.triggers
            .set_value(line(&self.trigger_lines, sensor)?, value)
            .map(|_| ())
            .map_err(|error| error.to_string())
    }

    fn is_high(&self, sensor: u8) -> Result<bool, String> {
        let value = self.echoes.value(line(&self.echo_lines, sensor)?);
        value.map(|value| value == Value::Active).map_err(|error| error.to_string())
    }

    fn delay_us(&self, us: u32) {
        let end = self.now_us() + u64::from(us);
        // Ten microseconds: the scheduler would take longer.
        while self.now_us() <= end {
            spin_loop();
        }
    }

    fn next_edge(&self, until_us: u64) -> Result<Option<Edge>, String> {
        let left = Duration::from_micros(until_us.saturating_sub(self.now_us()));
        let failed = |error: gpiocdev::Error| format!("echo lines: {error}");
        if !self.echoes.wait_edge_event(left).map_err(failed)? {
            return Ok(None);
        }
        let event = self.echoes.read_edge_event().map_err(failed)?;
        let missing = event.seqno.wrapping_sub(self.last.replace(event.seqno)).wrapping_sub(1);
        self.lost.set(self.lost.get().wrapping_add(missing as u8));
        let sensor = self.echo_lines.iter().position(|&line| line == event.offset);
        Ok(sensor.map(|sensor| Edge {
            sensor: sensor as u8,
            high: event.kind == EdgeKind::Rising,
            at: instant(event.timestamp_ns / 1000),
        }))
    }

    fn lost(&self) -> u8 {
        self.lost.get()
    }
}

#[cfg(test)]
mod tests {
    use super::Chip;

    #[test]
    fn chip_that_is_not_there_is_named_with_its_lines() {
        let error = Chip::open("/dev/gpiochip99", &[23], &[24]).err().unwrap();
        assert!(error.starts_with("gpio_chip: /dev/gpiochip99: trigger_lines [23]: "), "{error}");
    }
}
