//! Why an experiment cannot be run.

use core::fmt;
use core::ops::Range;

use crate::{simulation::SimulationError, world::WorldError};

/// Why an experiment cannot be run.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExperimentError {
    /// Not one geometry or course.
    NoSeeds,
    /// Geometries or courses beyond the last number.
    Numbers {
        /// The first number.
        first: u64,
        /// The number of geometries or courses.
        seeds: u64,
    },
    /// Not one method.
    NoMethods,
    /// A world of the experiment.
    World(WorldError),
    /// A simulation of the experiment.
    Simulation(SimulationError),
    /// The caller asked to stop.
    Stopped,
}

/// The numbers of geometries or courses, at least one.
pub(super) fn numbers(first: u64, seeds: u64) -> Result<Range<u64>, ExperimentError> {
    if seeds == 0 {
        return Err(ExperimentError::NoSeeds);
    }
    let end = first.checked_add(seeds).ok_or(ExperimentError::Numbers { first, seeds })?;
    Ok(first..end)
}

impl From<WorldError> for ExperimentError {
    fn from(error: WorldError) -> Self {
        Self::World(error)
    }
}

impl From<SimulationError> for ExperimentError {
    fn from(error: SimulationError) -> Self {
        match error {
            SimulationError::Stopped => Self::Stopped,
            error => Self::Simulation(error),
        }
    }
}

impl fmt::Display for ExperimentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSeeds => write!(f, "0 seeds; expected at least one"),
            Self::Numbers { first, seeds } => {
                write!(f, "{seeds} seeds from {first} on; expected a last one of at most {}", u64::MAX - 1)
            }
            Self::NoMethods => write!(f, "no methods; expected at least one"),
            Self::World(error) => error.fmt(f),
            Self::Simulation(error) => error.fmt(f),
            Self::Stopped => write!(f, "stopped"),
        }
    }
}

impl core::error::Error for ExperimentError {}
