//! Why an experiment cannot be run.

use core::fmt;

use crate::{simulation::SimulationError, world::WorldError};

/// Why an experiment cannot be run.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExperimentError {
    /// Not one geometry or course.
    NoSeeds,
    /// Not one method.
    NoMethods,
    /// A world of the experiment.
    World(WorldError),
    /// A simulation of the experiment.
    Simulation(SimulationError),
    /// The caller asked to stop.
    Stopped,
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
            Self::NoMethods => write!(f, "no methods; expected at least one"),
            Self::World(error) => error.fmt(f),
            Self::Simulation(error) => error.fmt(f),
            Self::Stopped => write!(f, "stopped"),
        }
    }
}

impl core::error::Error for ExperimentError {}
