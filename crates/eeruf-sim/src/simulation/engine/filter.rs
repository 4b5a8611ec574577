//! [`Filter`]: the caller's own filter of readings.

use eeruf_core::{Reading, ReadingKind};

use crate::methods::OwnError;
use crate::simulation::receiver::Echo;

/// A filter of one robot's readings that replaces the method's. Pass it to a simulation with [`Own`](crate::Own).
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
    /// Judges one firing of one sensor. Firings of a sensor come in order, each once.
    ///
    /// # Errors
    /// An error ends the simulation, with [`SimulationError::Own`](crate::SimulationError::Own).
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError>;

    /// Returns a copy that continues in the same way; `None`, the default, if the filter cannot be copied.
    fn copy(&self) -> Option<Box<dyn Filter>> {
        None
    }
}

impl<F: Filter + ?Sized> Filter for Box<F> {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        F::push(self, firing)
    }

    fn copy(&self) -> Option<Box<dyn Filter>> {
        F::copy(self)
    }
}

/// The echoes of one firing of one sensor.
#[derive(Clone, Copy, Debug)]
pub struct FiredReading<'a> {
    /// The ring's own verdict, by the method's judge, with sensor, phase and period.
    pub reading: &'a Reading,
    /// The echoes, earliest first: at most one, or up to eight under methods with several, such as
    /// [`Method::MultiEcho`](crate::Method::MultiEcho).
    pub echoes: &'a [Echo],
    /// Time of the firing, in seconds of true time.
    pub fired_s: f64,
    /// Change that odometry expects of a good reading since the sensor's previous firing, in microseconds; 0 for a
    /// robot without odometry.
    pub expected_change_us: i32,
}

/// The verdict on a firing.
#[derive(Clone, Copy, Debug)]
pub struct Filtered {
    /// The verdict. [`Accepted`](ReadingKind::Accepted) and [`Clear`](ReadingKind::Clear) count as believed.
    pub kind: ReadingKind,
    /// The echo of the reading, of this firing or of an earlier one that the filter has kept; `None` for silence.
    pub echo: Option<Echo>,
}

impl Filtered {
    /// A believed silence: nothing is in range.
    pub const SILENT: Self = Self { kind: ReadingKind::Clear, echo: None };

    /// Makes a believed echo, or a believed silence.
    pub const fn accepted(echo: Option<Echo>) -> Self {
        Self { kind: if echo.is_some() { ReadingKind::Accepted } else { ReadingKind::Clear }, echo }
    }
}
