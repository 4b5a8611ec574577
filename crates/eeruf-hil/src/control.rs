//! The control: a ring without the fault. It fires at the same instants as the board's ring and gets the same edges,
//! except for one sensor, whose line is healthy and always shows a wall.
//!
//! The readings of all other sensors are those that they would have without the fault.

use core::convert::Infallible;

use eeruf_core::{Edge, Instant, Micros, Ring, RingEvent, ScheduledRing, plan::Plan};
use eeruf_hil::{CONFIG, SCHEDULE, SENSORS};
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

use crate::reference::{HostRing, Read, on_pins};

/// Delay from trigger to rise on the line of a healthy sensor, and to its fall: a wall 2 m away.
const RISE: Micros = Micros::new(460);
const FALL: Micros = Micros::new(12_460);

/// A pin that does nothing: a trigger, or an echo line that always reads low.
struct Idle;

impl ErrorType for Idle {
    type Error = Infallible;
}

impl OutputPin for Idle {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Idle {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

/// The ring without the fault, and its readings.
pub(crate) struct Control {
    ring: HostRing<ScheduledRing<'static, SENSORS>, Idle>,
    /// The sensor that is healthy here.
    well: u8,
    /// The coming edges on the sensor's line, the latest first.
    ahead: Vec<Edge>,
    pub(crate) read: Read,
}

impl Control {
    pub(crate) fn new(now: Instant, well: u8) -> Result<Self, String> {
        let ring = Ring::new(&SCHEDULE, CONFIG, now).map_err(|error| error.to_string())?;
        Ok(Self { ring: on_pins(ring, |_| Idle)?, well, ahead: Vec::new(), read: Default::default() })
    }

    pub(crate) fn edge(&mut self, edge: Edge) -> Result<(), String> {
        if edge.sensor == self.well {
            return Ok(());
        }
        self.ring.edge(edge).map_err(|error| error.to_string())
    }

    /// Follows a poll of the board's ring at `now` that returned `event`: fires if and only if the board fired.
    pub(crate) fn after_poll(&mut self, now: Instant, event: Option<&RingEvent>) -> Result<(), String> {
        while let Some(edge) = self.ahead.pop_if(|edge| now.has_reached(edge.at)) {
            self.ring.edge(edge).map_err(|error| error.to_string())?;
        }
        let fires = match event {
            Some(&RingEvent::Fire { sensor, .. }) => Some(sensor),
            _ => None,
        };
        loop {
            let plan = self.ring.ring().plan();
            let would_fire = plan.next_firing().is_some() && now.has_reached(plan.deadline());
            if would_fire && fires.is_none() {
                // The board's ring must emit a reading before it fires; here that reading is emitted already.
                return Ok(());
            }
            match self.ring.poll(now) {
                Some(RingEvent::Fire { sensor, .. }) if fires == Some(sensor) => {
                    if sensor == self.well {
                        let edge = |high, after| Edge { sensor, high, at: now + after };
                        self.ahead = vec![edge(false, FALL), edge(true, RISE)];
                    }
                    return Ok(());
                }
                Some(RingEvent::Fire { sensor, .. }) => {
                    return Err(format!("without the fault sensor {} would fire at another time", sensor + 1));
                }
                Some(RingEvent::Reading(reading)) => {
                    if let Some(read) = self.read.get_mut(usize::from(reading.sensor)) {
                        read.push(reading);
                    }
                }
                Some(RingEvent::PeriodEnded(_)) => {}
                None if fires.is_none() => return Ok(()),
                None => return Err("without the fault nothing would fire where the board's ring fires".to_owned()),
            }
        }
    }
}
