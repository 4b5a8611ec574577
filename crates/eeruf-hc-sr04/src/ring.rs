//! [`HcSr04Ring`]: the driver of a ring. It triggers the sensors that the ring fires, and reports their echoes to it.

use eeruf_core::{
    EchoFilter, Edge, EdgeQueue, Instant, Micros, Ring, RingError, RingEvent, SensorError, Silence, VerifiedSchedule,
    judge::Judge,
    plan::{OwnLimits, Plan, ScheduledFiring},
};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::error::SetupError;
use crate::hands_on::hands_on;
use crate::health::Health;
use crate::line::Shown;
use crate::lines::{FlexPin, Lines, Pins, Trigger};
use crate::settings::Settings;

/// A ring whose firings are triggers on pins and whose echoes are pulses on lines: a [`Ring`] of any plan and judge,
/// such as a [`FlowRing`](eeruf_core::flow::FlowRing), which fires by flow.
#[derive(Debug)]
pub struct HcSr04Ring<R, T, I, D, const K: usize, Q = ()> {
    ring: R,
    pub(crate) lines: Lines<T, I, D, K>,
    pub(crate) edges: Q,
}

/// The source of edges that a driver reads before each poll: a queue that interrupts fill, or `()` if the caller
/// reports them by [`HcSr04Ring::edge`].
pub trait Edges {
    /// Removes the oldest edge, if there is one.
    fn pop(&self) -> Option<Edge>;
}

impl Edges for () {
    fn pop(&self) -> Option<Edge> {
        None
    }
}

impl<const N: usize> Edges for &EdgeQueue<N> {
    fn pop(&self) -> Option<Edge> {
        EdgeQueue::pop(self)
    }
}

impl<P: Plan, J: Judge, T: OutputPin, I: InputPin, D: DelayNs, const K: usize, const H: usize>
    HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K>
{
    /// Puts a ring on its pins. The window should exceed the longest echo by a millisecond, because the line rises only
    /// about half a millisecond after the trigger.
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the ring fires a sensor again sooner than it may be triggered.
    pub fn new(
        ring: Ring<P, J, K, 1, H>,
        pins: [Pins<T, I>; K],
        delay: D,
        settings: Settings,
    ) -> Result<Self, SetupError> {
        Self::on(ring, pins, delay, settings, ())
    }
}

impl<P: Plan, J: Judge, T: OutputPin, I: InputPin, D: DelayNs, const K: usize, const H: usize, Q: Edges>
    HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K, Q>
{
    /// Like [`new`](HcSr04Ring::new), with a queue that the edge interrupt fills. Each poll first empties it.
    ///
    /// # Errors
    /// See [`new`](HcSr04Ring::new).
    pub fn with_edges(
        ring: Ring<P, J, K, 1, H>,
        pins: [Pins<T, I>; K],
        delay: D,
        settings: Settings,
        edges: Q,
    ) -> Result<Self, SetupError> {
        Self::on(ring, pins, delay, settings, edges)
    }

    /// Like [`Ring::poll`]. [`RingEvent::Fire`] is for information: the sensor has been triggered already.
    ///
    /// The queue's edges are read first. Read the clock for `now` just before the call, so that no window closes before
    /// a punctual edge is read, however long the main loop was busy.
    ///
    /// The driver busy-waits for the width of a trigger ([`Settings::trigger`], 10 us): setting an alarm would take as
    /// long.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// Like [`Ring::poll_expecting`].
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        while let Some(edge) = self.edges.pop() {
            // An edge of a line that the ring does not have is ignored.
            _ = self.edge(edge);
        }
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::Fire { sensor, .. } = event {
            let trigger = self.lines.trigger(sensor, now);
            self.has_triggered(sensor, trigger);
        }
        Some(event)
    }
}

impl<R, T, I: FlexPin, D: DelayNs, const K: usize, Q> HcSr04Ring<R, T, I, D, K, Q> {
    /// Pulls the line of a sensor low for [`Settings::recovery`] if it is stuck high, and returns true if it was; call
    /// it after each [`RingEvent::Fire`]. Some modules hold their line after a lost echo until it is pulled low. The
    /// reading of this firing is still [`Stuck`](eeruf_core::ReadingKind::Stuck); the next firing triggers the module
    /// if its line stays low.
    ///
    /// Module and pin drive against each other meanwhile: put a 1 kOhm resistor into the line.
    pub fn recover(&mut self, sensor: u8) -> bool {
        self.lines.recover(sensor)
    }
}

impl<P: Plan, J: Judge, const K: usize, const H: usize> HcSr04Ring<Ring<P, J, K, 1, H>, (), (), (), K> {
    /// Makes a driver for hardware that owns the pins: a timer, PIO or RMT that triggers at the instants of
    /// [`upcoming`](Self::upcoming), for [`poll_triggered`](Self::poll_triggered), and stamps edges or measures pulses.
    ///
    /// # Errors
    /// As for [`new`](HcSr04Ring::new).
    pub fn by_hardware(ring: Ring<P, J, K, 1, H>, settings: Settings) -> Result<Self, SetupError> {
        Self::on(ring, [const { Pins { trigger: (), echo: () } }; K], (), settings, ())
    }
}

impl<P: Plan, J: Judge, T, I, D, const K: usize, const H: usize> HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K> {
    /// Polls like [`Ring::poll`] at the instant `at` at which hardware triggered the due sensor of [`Ring::upcoming`],
    /// without triggering it again. Call it until there is no event, after all edges up to `at` and before all later
    /// ones. The line is not checked before a trigger: a sensor that still held it counts as unanswered.
    pub fn poll_triggered(&mut self, at: Instant) -> Option<RingEvent> {
        let event = self.ring.poll(at)?;
        if let RingEvent::Fire { sensor, .. } = event {
            let trigger = self.lines.triggered(sensor, at);
            self.has_triggered(sensor, trigger);
        }
        Some(event)
    }
}

impl<P: Plan, J: Judge, T, I, D, const K: usize, const H: usize, Q> HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K, Q> {
    fn on(
        mut ring: Ring<P, J, K, 1, H>,
        pins: [Pins<T, I>; K],
        delay: D,
        settings: Settings,
        edges: Q,
    ) -> Result<Self, SetupError> {
        settings.allow(ring.plan().min_refire())?;
        // A line that does not rise is not free space.
        ring.set_silence(Silence::NeedsAnswer);
        Ok(Self { ring, lines: Lines::new(pins, delay, settings), edges })
    }

    fn has_triggered(&mut self, sensor: u8, trigger: Trigger) {
        // The sensor exists: it has just fired.
        _ = match trigger {
            Trigger::Given { lost_an_edge: false } => Ok(()),
            Trigger::Given { lost_an_edge: true } => self.ring.forget(sensor),
            Trigger::Withheld => self.ring.stuck(sensor),
            Trigger::ListensStill => self.ring.holds(sensor),
        };
    }

    /// Reports the width of a sensor's pulse from hardware that measures it, instead of edges. Call it before the
    /// reading is emitted (see [`Ring::set_report_after`]).
    ///
    /// # Errors
    /// [`SensorError`] if the sensor is out of range.
    pub fn pulse(&mut self, sensor: u8, width: Micros) -> Result<(), SensorError> {
        let shown = self.lines.pulse(sensor, width);
        self.show(sensor, shown)
    }

    fn show(&mut self, sensor: u8, shown: Shown) -> Result<(), SensorError> {
        match shown {
            // The ring reports an error if it has no such sensor.
            Shown::Nothing if usize::from(sensor) >= self.ring.sensors() => self.ring.answered(sensor),
            Shown::Nothing => Ok(()),
            Shown::Answer => self.ring.holds(sensor),
            Shown::AnswerAfterLoss => self.ring.forget(sensor).and_then(|()| self.ring.holds(sensor)),
            Shown::Disturbance => self.ring.unanswered(sensor),
            Shown::GoesOn => self.ring.unheard(sensor).and_then(|()| self.ring.holds(sensor)),
            Shown::Silence => self.ring.measured(sensor, None),
            Shown::Echo(t_echo, _) => self.ring.measured(sensor, Some(t_echo)),
        }
    }

    /// Like [`Ring::next_deadline`].
    pub fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    /// Reports an edge on an echo line. Report all edges you have before you poll.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn edge(&mut self, edge: Edge) -> Result<(), SensorError> {
        self.edge_seen(edge, Micros::ZERO)
    }

    /// Reports an edge like [`edge`](Self::edge) that came between two instants: the line was last seen without it at
    /// `earliest`, and with it at `latest`. Meant for loops that sample lines: see [`Sampler`](crate::Sampler). The
    /// uncertainty of a pulse is the sum for both edges, handled as in [`Ring::echo_between`].
    ///
    /// # Errors
    /// As for [`Ring::echo_between`].
    pub fn edge_between(
        &mut self,
        sensor: u8,
        high: bool,
        earliest: Instant,
        latest: Instant,
    ) -> Result<(), RingError> {
        if !latest.has_reached(earliest) {
            return self.ring.echo_between(sensor, earliest, latest);
        }
        Ok(self.edge_seen(Edge { sensor, high, at: latest }, latest.since(earliest))?)
    }

    fn edge_seen(&mut self, edge: Edge, before: Micros) -> Result<(), SensorError> {
        let Some(fired) = self.ring.last_firing(edge.sensor) else {
            // The ring returns the error for a sensor out of range.
            return self.ring.echo(edge.sensor, edge.at);
        };
        match self.lines.edge(edge, before, fired) {
            // Until `settled` the line may rise again: a mere gap in the pulse.
            Shown::Echo(least, width) => {
                let settled = edge.at + self.lines.shortest();
                self.ring.echo_within(edge.sensor, fired + least, width, settled)
            }
            shown => self.show(edge.sensor, shown),
        }
    }

    /// Like [`Ring::fired`], for a sensor that was not triggered at the instant of the poll.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        self.ring.fired(sensor, at)
    }

    /// Health of a sensor at its last complete firing, judged by its line. A sensor that the ring does not have is
    /// [`Health::Missing`].
    pub fn health(&self, sensor: u8) -> Health {
        self.lines.health(sensor)
    }

    /// Like [`Ring::restart`].
    pub fn restart(&mut self, now: Instant) {
        self.ring.restart(now);
    }

    /// Like [`Ring::set_report_after`].
    ///
    /// # Errors
    /// See [`Ring::set_report_after`].
    pub fn set_report_after(&mut self, report_after: Micros) -> Result<(), RingError> {
        self.ring.set_report_after(report_after)
    }
}

impl<P: Plan, T, I, D, const K: usize, const H: usize, Q> HcSr04Ring<Ring<P, EchoFilter<K>, K, 1, H>, T, I, D, K, Q> {
    /// Like [`Ring::set_t_delta`].
    ///
    /// # Errors
    /// See [`Ring::set_t_delta`].
    pub fn set_t_delta(&mut self, t_delta: Micros) -> Result<(), RingError> {
        self.ring.set_t_delta(t_delta)
    }
}

impl<P: Plan, J: Judge, T, I, D, const K: usize, const H: usize, Q> HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K, Q> {
    /// Like [`Ring::set_window`].
    ///
    /// # Errors
    /// See [`Ring::set_window`].
    pub fn set_window(&mut self, window: Micros) -> Result<(), RingError> {
        self.ring.set_window(window)
    }

    /// Like [`Ring::set_blanking`].
    ///
    /// # Errors
    /// See [`Ring::set_blanking`].
    pub fn set_blanking(&mut self, blanking: Micros) -> Result<(), RingError> {
        self.ring.set_blanking(blanking)
    }
}

impl<'s, U: OwnLimits, J: Judge, T, I, D, const K: usize, const M: usize, const H: usize, Q>
    HcSr04Ring<Ring<ScheduledFiring<'s, K, M, U>, J, K, 1, H>, T, I, D, K, Q>
{
    /// Like [`Ring::change_schedule`].
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the schedule fires a sensor again sooner than it may be triggered, and as for
    /// [`Ring::change_schedule`]. The ring is then unchanged.
    pub fn change_schedule<L: OwnLimits<Held<'s> = U>>(
        &mut self,
        schedule: &'s VerifiedSchedule<K, M, L>,
    ) -> Result<(), SetupError> {
        self.lines.allow(schedule.min_refire())?;
        Ok(self.ring.change_schedule(schedule)?)
    }
}

hands_on!(HcSr04Ring, T, I, D; Q);
