//! [`HcSr04Ring`]: the driver. It triggers the sensors that a ring fires, and hands the ring the echoes.

use eeruf_core::{
    Edge, EdgeQueue, Instant, Micros, Ring, RingError, RingEvent, ScheduledFiring, Scheduler, SensorError,
    VerifiedSchedule,
};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::error::SetupError;
use crate::health::Health;
use crate::line::{Line, Pulse};
use crate::settings::Settings;

/// The two pins of one sensor.
#[derive(Clone, Debug)]
pub struct Pins<T, I> {
    /// The trigger.
    pub trigger: T,
    /// The echo line. It is read only just before a trigger; its edges come in through [`HcSr04Ring::edge`].
    pub echo: I,
}

/// A [`Ring`] whose firings are triggers on pins and whose echoes are pulses on lines.
#[derive(Debug)]
pub struct HcSr04Ring<S, T, I, D, const K: usize> {
    ring: Ring<S, K>,
    pins: [Pins<T, I>; K],
    delay: D,
    lines: [Line; K],
    settings: Settings,
}

impl<'s, T, I, D, const K: usize, const M: usize> HcSr04Ring<ScheduledFiring<'s, K, M>, T, I, D, K> {
    /// As [`Ring::change_schedule`].
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the schedule fires a sensor again sooner than it may be triggered, and as
    /// [`Ring::change_schedule`]. The ring then goes on as before.
    pub fn change_schedule(&mut self, schedule: &'s VerifiedSchedule<K, M>) -> Result<(), SetupError> {
        self.settings.allow(schedule.min_refire())?;
        Ok(self.ring.change_schedule(schedule)?)
    }
}

impl<S: Scheduler, T: OutputPin, I: InputPin, D: DelayNs, const K: usize> HcSr04Ring<S, T, I, D, K> {
    /// Puts a ring on its pins. Its window should exceed the longest echo by a millisecond, because the line rises only
    /// about half a millisecond after the trigger.
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the schedule fires a sensor again sooner than it may be triggered.
    pub fn new(ring: Ring<S, K>, pins: [Pins<T, I>; K], delay: D, settings: Settings) -> Result<Self, SetupError> {
        settings.allow(ring.scheduler().min_refire())?;
        Ok(Self { ring, pins, delay, lines: [Line::NEW; K], settings })
    }

    /// As [`Ring::poll`]. [`RingEvent::Fire`] is for information: the sensor has been triggered already.
    ///
    /// A trigger takes [`Settings::trigger`], 10 us, during which the driver waits: setting an alarm would take as
    /// long.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// As [`Ring::poll_expecting`].
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::Fire { sensor, .. } = event {
            self.trigger(sensor, now);
        }
        Some(event)
    }

    /// Hands in all edges in the queue, then [polls](Self::poll). Read the clock for `now` just before: then no window
    /// closes on an edge that came in time, however long the main loop was busy elsewhere.
    pub fn poll_with_edges<const N: usize>(&mut self, edges: &EdgeQueue<N>, now: Instant) -> Option<RingEvent> {
        while let Some(edge) = edges.pop() {
            // An edge of a line that the ring does not have concerns nobody here.
            _ = self.edge(edge);
        }
        self.poll(now)
    }

    /// As [`Ring::next_deadline`].
    pub fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    /// An edge on an echo line. Hand in all edges you have before you poll.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn edge(&mut self, edge: Edge) -> Result<(), SensorError> {
        match self.lines.get_mut(usize::from(edge.sensor)) {
            Some(line) => match line.edge(edge, &self.settings) {
                Some(width) => self.ring.echo(edge.sensor, line.triggered + width),
                None => Ok(()),
            },
            None => self.ring.echo(edge.sensor, edge.at),
        }
    }

    /// As [`Ring::fired`], where a sensor was triggered later than the poll said: by a clock read after it.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        self.ring.fired(sensor, at)?;
        if let Some(line) = self.lines.get_mut(usize::from(sensor)) {
            if at.has_reached(line.triggered) {
                line.triggered = at;
            }
        }
        Ok(())
    }

    /// How a sensor was at its last complete firing, as far as its line shows it; [`Health::Missing`] for one that the
    /// ring does not have.
    pub fn health(&self, sensor: u8) -> Health {
        self.lines.get(usize::from(sensor)).map_or(Health::Missing, |line| line.health)
    }

    /// The ring.
    pub const fn ring(&self) -> &Ring<S, K> {
        &self.ring
    }

    /// As [`Ring::disable`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn disable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.disable(sensor)
    }

    /// As [`Ring::enable`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn enable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.enable(sensor)
    }

    /// As [`Ring::pause`].
    pub fn pause(&mut self) {
        self.ring.pause();
    }

    /// As [`Ring::resume`].
    pub fn resume(&mut self) {
        self.ring.resume();
    }

    /// As [`Ring::restart`].
    pub fn restart(&mut self, now: Instant) {
        self.ring.restart(now);
    }

    /// As [`Ring::set_t_delta`].
    ///
    /// # Errors
    /// As there.
    pub fn set_t_delta(&mut self, t_delta: Micros) -> Result<(), RingError> {
        self.ring.set_t_delta(t_delta)
    }

    /// As [`Ring::set_window`].
    ///
    /// # Errors
    /// As there.
    pub fn set_window(&mut self, window: Micros) -> Result<(), RingError> {
        self.ring.set_window(window)
    }

    /// As [`Ring::set_blanking`].
    ///
    /// # Errors
    /// As there.
    pub fn set_blanking(&mut self, blanking: Micros) -> Result<(), RingError> {
        self.ring.set_blanking(blanking)
    }

    fn trigger(&mut self, sensor: u8, now: Instant) {
        let x = usize::from(sensor);
        let (Some(line), Some(pins)) = (self.lines.get_mut(x), self.pins.get_mut(x)) else { return };
        line.end_firing(self.settings.missing_after);
        line.triggered = now;
        line.pulse = Pulse::Idle;
        match pins.echo.is_high() {
            Ok(false) => {}
            Ok(true) => {
                line.health = Health::StuckHigh;
                // It is there: it has just fired.
                _ = self.ring.stuck(sensor);
                return;
            }
            Err(_) => {
                line.health = Health::PinError;
                _ = self.ring.stuck(sensor);
                return;
            }
        }
        line.pulse = Pulse::Awaited;
        let rose = pins.trigger.set_high();
        self.delay.delay_us(self.settings.trigger.as_micros());
        // Also after an error: a trigger must not stay high.
        if pins.trigger.set_low().is_err() || rose.is_err() {
            line.health = Health::PinError;
        }
    }
}
