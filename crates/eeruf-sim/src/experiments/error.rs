//! Errors of experiments.

use core::fmt;
use core::ops::Range;

use crate::{
    simulation::{Entry, SimulationError},
    world::WorldError,
};

/// Reason why an experiment cannot be run.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExperimentError {
    /// There is no geometry or course.
    NoSeeds,
    /// The last geometry or course would be beyond the largest number.
    Numbers {
        /// The first number.
        first: u64,
        /// The number of geometries or courses.
        seeds: u64,
    },
    /// There is no method.
    NoMethods,
    /// Two methods have the same name.
    Twice {
        /// The name.
        name: String,
    },
    /// A world of the experiment is invalid.
    World(WorldError),
    /// A simulation of the experiment failed.
    Simulation(SimulationError),
    /// The caller asked to stop.
    Stopped,
}

/// Returns the numbers of geometries or courses, at least one.
pub(super) fn numbers(first: u64, seeds: u64) -> Result<Range<u64>, ExperimentError> {
    if seeds == 0 {
        return Err(ExperimentError::NoSeeds);
    }
    let end = first.checked_add(seeds).ok_or(ExperimentError::Numbers { first, seeds })?;
    Ok(first..end)
}

/// Checks that there is a method, and that no method occurs twice.
pub(super) fn distinct(methods: &[Entry]) -> Result<(), ExperimentError> {
    let mut names: Vec<_> = methods.iter().map(Entry::name).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        _ if names.is_empty() => Err(ExperimentError::NoMethods),
        Some(pair) => Err(ExperimentError::Twice { name: pair[0].to_owned() }),
        None => Ok(()),
    }
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
            Self::Twice { name } => write!(f, "two methods `{name}`; expected another name for one of them"),
            Self::World(error) => error.fmt(f),
            Self::Simulation(error) => error.fmt(f),
            Self::Stopped => write!(f, "stopped"),
        }
    }
}

impl core::error::Error for ExperimentError {}
