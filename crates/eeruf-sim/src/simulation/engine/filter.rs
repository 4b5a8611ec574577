//! [`Filter`]: what is believed of a reading, by a method or by the caller's own code.

use eeruf_core::{Micros, Reading, ReadingKind};

use crate::methods::{Belief, OwnError};
use crate::simulation::receiver::Echo;
use crate::world::Robot;

/// Belief in the readings of one robot's ring. Hand it to a simulation with [`Own`](crate::Own); what the methods
/// believe goes through it as well.
///
/// ```
/// use std::collections::HashMap;
/// use eeruf_core::{Micros, ReadingKind};
/// use eeruf_sim::{FiredReading, Filter, Filtered, OwnError};
/// /// Believes an echo that is no farther than half a metre off the last one of its sensor.
/// #[derive(Default)]
/// struct Near(HashMap<u8, Micros>);
/// impl Filter for Near {
///     fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
///         let Some(&echo) = firing.echoes.first() else { return Ok(Filtered::SILENT) };
///         let before = self.0.insert(firing.reading.sensor, echo.t_echo());
///         let near = before.is_some_and(|before| before.abs_diff(echo.t_echo()) < Micros::new(2_900));
///         Ok(Filtered { kind: if near { ReadingKind::Accepted } else { ReadingKind::Rejected }, echo: Some(echo) })
///     }
/// }
/// ```
pub trait Filter: Send {
    /// Takes in what one firing of one sensor has heard. Firings of a sensor come in order, each once.
    ///
    /// # Errors
    /// Whatever ends the simulation, with [`SimulationError::Own`](crate::SimulationError::Own).
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError>;
}

impl<F: Filter + ?Sized> Filter for Box<F> {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        F::push(self, firing)
    }
}

/// Echoes that one firing of one sensor has heard.
#[derive(Clone, Copy, Debug)]
pub struct FiredReading<'a> {
    /// The ring's own verdict, with the filter of core: its sensor, phase and period too.
    pub reading: &'a Reading,
    /// Its echoes, earliest first: one at most, but up to eight under methods of several, such as
    /// [`Method::MultiEcho`](crate::Method::MultiEcho).
    pub echoes: &'a [Echo],
    /// When it fired, in seconds of true time.
    pub fired_s: f64,
    /// Change of a good reading since the sensor's firing before that odometry expects, in microseconds; 0 for a robot
    /// without odometry.
    pub expected_change_us: i32,
}

/// Belief in a firing.
#[derive(Clone, Copy, Debug)]
pub struct Filtered {
    /// The verdict. [`Accepted`](ReadingKind::Accepted) and [`Clear`](ReadingKind::Clear) count as believed.
    pub kind: ReadingKind,
    /// The echo that it stands for: one of this firing, or of an earlier one that the filter has kept; none for
    /// silence.
    pub echo: Option<Echo>,
}

impl Filtered {
    /// Silence, believed: nothing is in range.
    pub const SILENT: Self = Self { kind: ReadingKind::Clear, echo: None };

    /// An echo or silence, believed.
    pub const fn accepted(echo: Option<Echo>) -> Self {
        Self { kind: if echo.is_some() { ReadingKind::Accepted } else { ReadingKind::Clear }, echo }
    }
}

/// The filter of a method for a robot's readings; `median_of` is what [`Belief::Median`] takes the median of, up to
/// [`MAX_MEDIAN`].
pub(super) fn filter_of(belief: Belief, median_of: usize, robot: Option<&Robot>, sensors: usize) -> Box<dyn Filter> {
    let t_delta = robot.map_or(Micros::ZERO, |robot| robot.t_delta);
    match belief {
        Belief::AsSketched if robot.is_some_and(|robot| robot.firing.consecutive > 1) => Box::new(AsTheRing),
        Belief::TwoOfThree => Box::new(TwoOfThree { t_delta, before: vec![[None; 2]; sensors] }),
        Belief::All | Belief::AsSketched => Box::new(Everything),
        Belief::Median => Box::new(Median { of: median_of, history: vec![History::default(); sensors] }),
        Belief::Repeated => Box::new(AsTheRing),
    }
}

/// Believes the earliest echo of every firing.
struct Everything;

impl Filter for Everything {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        Ok(Filtered::accepted(firing.echoes.first().copied()))
    }
}

/// Believes what the ring's own filter accepts.
struct AsTheRing;

impl Filter for AsTheRing {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        let Reading { kind, t_echo, .. } = *firing.reading;
        Ok(Filtered { kind, echo: firing.echoes.iter().find(|echo| Some(echo.t_echo()) == t_echo).copied() })
    }
}

/// Believes the earliest echo, or silence, if one of the sensor's two readings before agrees with it.
struct TwoOfThree {
    t_delta: Micros,
    /// The last reading of each sensor and the one before, carried on by odometry; `Some(None)` for silence.
    before: Vec<[Option<Option<f64>>; 2]>,
}

impl Filter for TwoOfThree {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        let echo = firing.echoes.first().copied();
        let Some(before) = self.before.get_mut(usize::from(firing.reading.sensor)) else {
            return Ok(Filtered::accepted(echo));
        };
        for earlier in before.iter_mut().flatten().flatten() {
            *earlier += f64::from(firing.expected_change_us);
        }
        let heard = echo.map(|echo| f64::from(echo.t_echo_us));
        let within_us = f64::from(self.t_delta.as_micros());
        let agrees = before.iter().flatten().any(|&earlier| match (earlier, heard) {
            (Some(earlier), Some(heard)) => (earlier - heard).abs() <= within_us,
            (None, None) => true,
            _ => false,
        });
        let is_first = before.iter().all(Option::is_none);
        *before = [Some(heard), before[0]];
        Ok(match (agrees, echo.is_some()) {
            (true, _) => Filtered::accepted(echo),
            (false, false) => Filtered { kind: ReadingKind::NoEcho, echo },
            (false, true) if is_first => Filtered { kind: ReadingKind::First, echo },
            (false, true) => Filtered { kind: ReadingKind::Rejected, echo },
        })
    }
}

/// The most readings that a median is taken of.
pub(super) const MAX_MEDIAN: usize = 15;

/// Believes the median of a sensor's last readings.
struct Median {
    of: usize,
    history: Vec<History>,
}

/// The last few firings of a sensor: what each heard first, if anything.
#[derive(Clone, Copy, Default)]
struct History {
    heard: [Option<Echo>; MAX_MEDIAN],
    count: usize,
}

impl Filter for Median {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        let earliest = firing.echoes.first().copied();
        let Some(history) = self.history.get_mut(usize::from(firing.reading.sensor)) else {
            return Ok(Filtered::accepted(earliest));
        };
        history.heard[history.count % self.of] = earliest;
        history.count += 1;
        if history.count < self.of {
            let kind = if earliest.is_some() { ReadingKind::First } else { ReadingKind::NoEcho };
            return Ok(Filtered { kind, echo: earliest });
        }
        let mut last = history.heard;
        let last = &mut last[..self.of];
        // Without echo counts as beyond all echoes.
        last.sort_by_key(|heard| heard.map_or(Micros::MAX, |heard| heard.t_echo()));
        Ok(Filtered::accepted(last[(self.of - 1) / 2]))
    }
}
