//! [`MeasuringRing`]: a ring of modules that measure by themselves.

use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingEvent, Silence, judge::Judge, plan::Plan};

use super::{Fault, Measured, Measures};
use crate::error::SetupError;
use crate::hands_on::hands_on;
use crate::health::Health;
use crate::settings::Settings;

/// Delay before the module is asked again after a fault, in case of noise on the bus; an arbitrary choice.
const RETRY: Micros = Micros::from_millis(1);

/// A ring whose firings start modules that measure by themselves: a [`Ring`] of any plan and judge, and one module for
/// each sensor. Different modules can be mixed as `&mut dyn Measures`.
///
/// ```no_run
/// # use embedded_hal::i2c::I2c;
/// # use eeruf_core::Instant;
/// # fn sleep_until(_: Instant) {}
/// # fn run<B: I2c>(buses: [B; 12], now: fn() -> Instant) -> Result<(), eeruf_hc_sr04::SetupError> {
/// use eeruf_core::{Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
/// use eeruf_hc_sr04::measuring::{MeasuringRing, Srf08};
///
/// let mut addresses = 0x70..;
/// let modules = buses.map(|bus| Srf08::new(bus, addresses.next().unwrap_or_default()));
/// let ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), now())?;
/// let mut ring = MeasuringRing::new(ring, modules)?;
/// loop {
///     while let Some(event) = ring.poll(now()) {
///         if let RingEvent::Reading(reading) = event {
///             if reading.kind == ReadingKind::Accepted { /* something is at reading.t_echo */ }
///         }
///     }
///     sleep_until(ring.next_deadline());
/// }
/// # }
/// ```
#[derive(Debug)]
pub struct MeasuringRing<R, M, const K: usize> {
    ring: R,
    modules: [M; K],
    states: [State; K],
}

/// The driver's state of one module.
#[derive(Clone, Copy, Debug)]
struct State {
    step: Step,
    /// The last fault of this firing.
    fault: Option<Fault>,
    /// Number of consecutive firings without an answer.
    silent: u8,
    health: Health,
}

/// The state of a module between its start and its reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// No result is expected.
    Idle,
    /// The module was started; ask it at `ask`.
    Measures { started: Instant, ask: Instant },
    /// The measurement could not be started.
    Failed,
}

impl State {
    const NEW: Self = Self { step: Step::Idle, fault: None, silent: 0, health: Health::Well };

    /// Ends the firing when its reading is emitted without an answer.
    fn end(&mut self) {
        if self.step == Step::Idle {
            return;
        }
        self.step = Step::Idle;
        match self.fault {
            None | Some(Fault::NoAnswer) => {
                self.silent = self.silent.saturating_add(1);
                if self.silent >= Settings::default().missing_after {
                    self.health = Health::Missing;
                }
            }
            Some(Fault::Bus) => self.health = Health::PinError,
            Some(Fault::Truncated) => self.health = Health::LosesEdges,
            Some(Fault::Invalid) => self.health = Health::Chatters,
        }
    }
}

impl<P: Plan, J: Judge, M: Measures, const K: usize, const H: usize> MeasuringRing<Ring<P, J, K, 1, H>, M, K> {
    /// Puts a ring on its modules. Readings without an echo are emitted when the slowest module has reported or run out
    /// of time ([`Measures::answers_within`]), or before the sensor fires again.
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the ring fires a sensor again sooner than a module rests or reports.
    pub fn new(mut ring: Ring<P, J, K, 1, H>, modules: [M; K]) -> Result<Self, SetupError> {
        let min_refire = ring.plan().min_refire();
        let mut report_after = Micros::ZERO;
        for module in modules.iter().take(ring.sensors()) {
            let needs = module.module();
            let min_retrigger = Micros::new(needs.rest_us.max(needs.report_us));
            if min_refire < min_retrigger {
                return Err(SetupError::Retrigger { min_refire, min_retrigger });
            }
            report_after = report_after.max(module.answers_within());
        }
        ring.set_report_after(report_after.min(min_refire))?;
        // Silence is not free space.
        ring.set_silence(Silence::NeedsAnswer);
        Ok(Self { ring, modules, states: [State::NEW; K] })
    }

    /// Polls like [`Ring::poll`]. It first asks the modules that may have a result, or later if a firing is due.
    /// [`RingEvent::Fire`] is for information: the module has been started already. Read the clock for each call, since
    /// buses take time.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// Like [`Ring::poll_expecting`].
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let plan = self.ring.plan();
        let due = if now.has_reached(plan.deadline()) { plan.next_firing() } else { None };
        match due {
            // A firing waits for no bus, but for the sensor's own reading.
            Some((sensor, _)) => self.ask(sensor, now),
            // At most 64 sensors.
            None => (0..K as u8).for_each(|sensor| self.ask(sensor, now)),
        }
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        match event {
            RingEvent::Fire { sensor, .. } => self.start(sensor, now),
            // A late reading with an echo time follows another reading.
            RingEvent::Reading(reading) if reading.kind != ReadingKind::Late || reading.t_echo.is_none() => {
                if let Some(state) = self.states.get_mut(usize::from(reading.sensor)) {
                    state.end();
                }
            }
            RingEvent::Reading(_) | RingEvent::PeriodEnded(_) => {}
        }
        Some(event)
    }

    fn start(&mut self, sensor: u8, now: Instant) {
        let x = usize::from(sensor);
        if let (Some(state), Some(module)) = (self.states.get_mut(x), self.modules.get_mut(x)) {
            (state.step, state.fault) = match module.start() {
                Ok(after) => (Step::Measures { started: now, ask: now + after }, None),
                Err(fault) => (Step::Failed, Some(fault)),
            };
        }
    }

    fn ask(&mut self, sensor: u8, now: Instant) {
        let x = usize::from(sensor);
        let (Some(state), Some(module)) = (self.states.get_mut(x), self.modules.get_mut(x)) else { return };
        let Step::Measures { started, ask } = state.step else { return };
        if !now.has_reached(ask) {
            return;
        }
        let since = now.since(started);
        let retry = since.saturating_add(RETRY);
        let (after, fault) = match module.result(since) {
            Ok(Measured::NotYet(after)) => (after.max(retry), state.fault),
            Err(fault) => (retry, Some(fault)),
            // An echo beyond the window means silence within it.
            Ok(Measured::Echo(t_echo)) => {
                let t_echo = Some(t_echo).filter(|&t_echo| t_echo <= self.ring.window_of(sensor));
                return self.answer(sensor, t_echo);
            }
            Ok(Measured::Nothing) => return self.answer(sensor, None),
        };
        (state.step, state.fault) = (Step::Measures { started, ask: started + after }, fault);
        if since >= self.ring.report_after().max(self.ring.window_of(sensor)) {
            // The reading is due.
            state.end();
        }
    }

    fn answer(&mut self, sensor: u8, t_echo: Option<Micros>) {
        if let Some(state) = self.states.get_mut(usize::from(sensor)) {
            *state = State::NEW;
        }
        // The sensor exists: it has fired.
        _ = self.ring.measured(sensor, t_echo);
    }

    /// Returns the time of the next poll: [`Ring::next_deadline`], or when a module must be asked; in the past if an
    /// event is pending.
    pub fn next_deadline(&self) -> Instant {
        let asks = self.states.iter().filter_map(|state| match state.step {
            Step::Measures { ask, .. } => Some(ask),
            Step::Idle | Step::Failed => None,
        });
        asks.fold(self.ring.next_deadline(), |next, ask| if next.has_reached(ask) { ask } else { next })
    }

    /// Health of a sensor at its last complete firing, judged by its answers: [`Health::PinError`] for an error of its
    /// bus, [`Health::LosesEdges`] for a truncated answer, [`Health::Chatters`] for an invalid one. A sensor that the
    /// ring does not have is [`Health::Missing`].
    pub fn health(&self, sensor: u8) -> Health {
        self.states.get(usize::from(sensor)).map_or(Health::Missing, |state| state.health)
    }

    /// The module of a sensor; `None` if it is out of range.
    pub fn module_mut(&mut self, sensor: u8) -> Option<&mut M> {
        self.modules.get_mut(usize::from(sensor))
    }

    /// Like [`Ring::restart`]. Results of measurements in progress are dropped.
    pub fn restart(&mut self, now: Instant) {
        for state in &mut self.states {
            state.step = Step::Idle;
        }
        self.ring.restart(now);
    }
}

hands_on!(MeasuringRing, M);
