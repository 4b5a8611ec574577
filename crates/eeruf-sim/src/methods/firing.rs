//! [`FiringMethod`]: firings of a ring, planned period by period by a method or by the caller's code; and the plan by
//! which core's ring fires them.

use core::fmt;

use eeruf_core::{
    Instant, MAX_PERIOD, MAX_PHASES, MAX_SENSORS, Micros, Phase,
    plan::{Plan, PlanLimits},
};

/// A rule by which the sensors of one robot's ring fire. Hand it to a simulation with [`Own`](crate::Own).
///
/// ```
/// use eeruf_core::{Micros, Phase};
/// use eeruf_sim::{FiringMethod, FiringPeriod, OwnError};
/// /// Eight sensors, each 8 ms after the one before, in the other order every second period.
/// struct BackAndForth;
/// impl FiringMethod for BackAndForth {
///     fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
///         let place = |sensor: u8| u32::from(if period % 2 == 0 { sensor } else { 7 - sensor });
///         let firings = (0..8).map(|sensor| (Micros::from_millis(8 * place(sensor)), sensor)).collect();
///         Ok(FiringPeriod { length: Micros::from_millis(100), phase: Phase((period % 2) as u8), firings })
///     }
/// }
/// assert_eq!(BackAndForth.plan(1).unwrap().firings[7], (Micros::ZERO, 7));
/// ```
pub trait FiringMethod: Send {
    /// Plans a period of the ring. Periods are counted from 0, and each begins when the previous one has ended.
    ///
    /// # Errors
    /// An error ends the simulation, with [`SimulationError::Own`](crate::SimulationError::Own).
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError>;

    /// Returns a copy that continues in the same way; `None`, the default, if the method cannot be copied. A simulation
    /// can be [copied](crate::Simulation::copy) if all of its robots' firing methods can.
    fn copy(&self) -> Option<Box<dyn FiringMethod>> {
        None
    }
}

impl<F: FiringMethod + ?Sized> FiringMethod for Box<F> {
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
        F::plan(self, period)
    }

    fn copy(&self) -> Option<Box<dyn FiringMethod>> {
        F::copy(self)
    }
}

/// A firing method, or the reason why it has ended.
struct Planner(Result<Box<dyn FiringMethod>, OwnError>);

impl Clone for Planner {
    fn clone(&self) -> Self {
        Self(match &self.0 {
            Ok(firing) => firing.copy().ok_or_else(|| "it cannot be copied".into()),
            Err(error) => Err(error.clone()),
        })
    }
}

/// One period of a [`FiringMethod`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FiringPeriod {
    /// Length of the period: 1 us to [`MAX_PERIOD`].
    pub length: Micros,
    /// Phase of the period, which its readings carry: 0 to 7.
    pub phase: Phase,
    /// Firings, each with its time after the beginning of the period and before its end, in any order. A sensor may
    /// fire several times or not at all, but never while it still listens: within the robot's
    /// [`window`](crate::Robot::window) of its last firing.
    pub firings: Vec<(Micros, u8)>,
}

/// Reason why the caller's own [`FiringMethod`](crate::FiringMethod) or [`Filter`](crate::Filter) ends a simulation: a
/// sentence.
///
/// ```
/// use eeruf_sim::OwnError;
/// fn refuse() -> Result<(), OwnError> {
///     Err("the model has not been trained")?
/// }
/// assert_eq!(refuse().unwrap_err().to_string(), "the model has not been trained");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnError(Box<str>);

impl OwnError {
    /// Returns an error with this message.
    pub fn new(why: impl Into<String>) -> Self {
        Self(why.into().into())
    }
}

impl From<&str> for OwnError {
    fn from(why: &str) -> Self {
        Self(why.into())
    }
}

impl From<String> for OwnError {
    fn from(why: String) -> Self {
        Self(why.into())
    }
}

impl fmt::Display for OwnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for OwnError {}

/// Reason why a period cannot be fired.
enum Unfit {
    Length(Micros),
    Phase(Phase),
    Sensor { sensor: u8, sensors: usize },
    Late { sensor: u8, at: Micros, length: Micros },
    Listens { sensor: u8, at: Micros, after_us: u64, refire: Micros },
}

/// Text of the error; sensors are counted from 0, as in the plan.
impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => write!(f, "lasts {length}; expected 1 us to {MAX_PERIOD}"),
            Self::Phase(phase) => write!(f, "has phase {}; expected 0 to {}", phase.0, MAX_PHASES - 1),
            Self::Sensor { sensor, sensors } => {
                write!(f, "fires sensor {sensor}; expected one of {sensors}, counted from 0")
            }
            Self::Late { sensor, at, length } => {
                write!(f, "fires sensor {sensor} at {at}; expected a time before its end at {length}")
            }
            Self::Listens { sensor, at, after_us, refire } => write!(
                f,
                "fires sensor {sensor} at {at}, {after_us} us after its last firing; expected {refire} or more, for \
                 which it listens"
            ),
        }
    }
}

/// A core plan that fires the periods of a [`FiringMethod`].
#[derive(Clone)]
pub(crate) struct PeriodFiring {
    planner: Planner,
    sensors: usize,
    /// Least time between two firings of a sensor.
    refire: Micros,
    /// The number of the next period to be planned.
    period: u32,
    /// Firing times of the current period, in order.
    due: Vec<(Micros, u8)>,
    length: Micros,
    phase: Phase,
    /// The phase of each sensor's last firing.
    fired_in: [Phase; MAX_SENSORS],
    /// The index of the next firing.
    next: usize,
    start: Instant,
    /// Time since each sensor's last firing at the planned start of the current period; `None` for sensors without one.
    before_us: Vec<Option<u64>>,
    enabled: [bool; MAX_SENSORS],
    paused: bool,
    last_fired: Option<Instant>,
}

impl PeriodFiring {
    /// Makes a plan for this many sensors, none of which fires again within `refire`. If the first period is invalid,
    /// [`error`](Self::error) gives the reason.
    pub(crate) fn new(firing: Box<dyn FiringMethod>, sensors: usize, refire: Micros, now: Instant) -> Self {
        let mut firing = Self {
            planner: Planner(Ok(firing)),
            sensors,
            refire,
            period: 0,
            due: Vec::new(),
            length: Micros::new(1),
            phase: Phase::A,
            next: 0,
            start: now,
            before_us: vec![None; sensors],
            fired_in: [Phase::A; MAX_SENSORS],
            enabled: [true; MAX_SENSORS],
            paused: false,
            last_fired: None,
        };
        firing.begin_period(now);
        firing
    }

    /// Returns the reason why the plan no longer fires, if it has stopped.
    pub(crate) fn error(&self) -> Option<&OwnError> {
        self.planner.0.as_ref().err()
    }

    /// Returns true if a clone fires in the same way.
    pub(crate) fn copies(&self) -> bool {
        self.planner.clone().0.is_ok()
    }

    fn begin_period(&mut self, start: Instant) {
        self.start = start;
        self.next = 0;
        self.due.clear();
        if let Ok(firing) = &mut self.planner.0 {
            let number = self.period;
            let planned = firing.plan(number).and_then(|period| {
                self.take(period).map_err(|unfit| OwnError::new(format!("period {number} {unfit}")))
            });
            if let Err(error) = planned {
                self.planner.0 = Err(error);
            }
            self.period = number.wrapping_add(1);
        }
        if self.planner.0.is_err() {
            // Nothing fires any more; the caller of the ring now checks the error.
            self.due.clear();
            self.length = MAX_PERIOD;
        }
        self.skip_disabled();
    }

    /// Starts a planned period, if it is valid.
    fn take(&mut self, period: FiringPeriod) -> Result<(), Unfit> {
        let FiringPeriod { length, phase, mut firings } = period;
        if length == Micros::ZERO || length > MAX_PERIOD {
            return Err(Unfit::Length(length));
        }
        if usize::from(phase.0) >= MAX_PHASES {
            return Err(Unfit::Phase(phase));
        }
        firings.sort_unstable();
        for &(at, sensor) in &firings {
            if at >= length {
                return Err(Unfit::Late { sensor, at, length });
            }
            let sensors = self.sensors;
            let Some(before_us) = self.before_us.get_mut(usize::from(sensor)) else {
                return Err(Unfit::Sensor { sensor, sensors });
            };
            // A sensor that has fired in this same period did so a negative time before its beginning.
            let at_us = u64::from(at.as_micros());
            let (refire, after_us) = (self.refire, before_us.map(|before_us| before_us.wrapping_add(at_us)));
            if let Some(after_us) = after_us.filter(|after_us| *after_us < u64::from(refire.as_micros())) {
                return Err(Unfit::Listens { sensor, at, after_us, refire });
            }
            *before_us = Some(at_us.wrapping_neg());
        }
        for before_us in self.before_us.iter_mut().flatten() {
            *before_us = before_us.wrapping_add(length.as_micros().into());
        }
        (self.due, self.length, self.phase) = (firings, length, phase);
        Ok(())
    }

    fn skip_disabled(&mut self) {
        while self.due.get(self.next).is_some_and(|&(_, sensor)| self.paused || !self.is_enabled(sensor)) {
            self.next += 1;
        }
    }
}

impl Plan for PeriodFiring {
    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.due.get(self.next).map(|&(_, sensor)| (sensor, self.phase))
    }

    fn fire(&mut self, now: Instant) {
        self.start += now.since(self.deadline());
        self.last_fired = Some(now);
        let next = self.next_firing().map_or(MAX_SENSORS, |(sensor, _)| sensor.into());
        if let Some(fired_in) = self.fired_in.get_mut(next) {
            *fired_in = self.phase;
        }
        self.next += 1;
        self.skip_disabled();
    }

    fn postpone(&mut self, _sensor: u8, by: Micros) {
        self.start += by;
        self.last_fired = self.last_fired.map(|fired| fired + by);
    }

    fn end_period(&mut self, _now: Instant) -> (Phase, bool) {
        let phase = self.phase;
        self.begin_period(self.deadline());
        (phase, false)
    }

    fn deadline(&self) -> Instant {
        self.start + self.due.get(self.next).map_or(self.length, |&(due, _)| due)
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(entry) = self.enabled.get_mut(usize::from(sensor)) {
            *entry = enabled;
        }
        self.skip_disabled();
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.skip_disabled();
    }

    fn sensors(&self) -> usize {
        self.sensors
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.sensors && self.enabled.get(usize::from(sensor)).is_some_and(|&enabled| enabled)
    }

    fn restart(&mut self, now: Instant) {
        // After a jump of the clock the time of the last firing is unknown.
        let settled = self.last_fired.map(|fired| fired + self.refire);
        let soon = settled.filter(|settled| settled.has_reached(now) && settled.since(now) <= self.refire);
        self.before_us.fill(None);
        self.begin_period(soon.unwrap_or(now));
    }

    fn last_firing(&self, sensor: u8, _periods_ago: u8) -> eeruf_core::judge::FiringContext {
        eeruf_core::judge::FiringContext::new(self.fired_in.get(usize::from(sensor)).copied().unwrap_or(self.phase))
    }

    fn limits(&self) -> PlanLimits<'_> {
        PlanLimits { longest_window: self.refire, verified_for: None, audible: None }
    }

    fn min_refire(&self) -> Micros {
        self.refire
    }

    fn horizon(&self) -> Micros {
        self.length.saturating_add(self.length.max(self.refire))
    }
}
