//! [`Own`]: parts of a simulation that the caller replaces.

use core::fmt;
use std::collections::BTreeMap;

use super::filter::Filter;
use crate::methods::FiringMethod;
use crate::simulation::error::SimulationError;

/// The caller's own firing methods and filters, each for one robot. The method provides the rest.
///
/// ```
/// use std::sync::Arc;
/// use eeruf_core::{EchoFilter, MAX_SENSORS, Micros};
/// use eeruf_sim::*;
/// /// The paper's filter as your own: with conventional firing it gives the readings of the method `comparison`.
/// struct Mine(EchoFilter<MAX_SENSORS>);
/// impl Filter for Mine {
///     fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
///         let echo = firing.echoes.first().copied();
///         let verdict = self.0.push(firing.reading.sensor, echo.map(|echo| echo.t_echo()));
///         Ok(Filtered { kind: verdict.map_err(|error| error.to_string())?.kind, echo })
///     }
/// }
/// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
/// let wall = Wall::new(2.0, -5.0, 2.0, 5.0).with_faces(Faces::Both);
/// let world = Arc::new(World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?);
/// let (options, stop) = (Options::default(), Stop::default());
/// let own = Own::new().filter(0, Mine(EchoFilter::new(Micros::new(500), 2)?));
/// let mut mine = Simulation::with_own(Arc::clone(&world), Method::Conventional, &options, own, stop.clone())?;
/// let mut built_in = Simulation::new(world, Method::Comparison, &options, stop)?;
/// assert_eq!(mine.step(6.0, |_| true)?.kind, built_in.step(6.0, |_| true)?.kind);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct Own {
    firing: BTreeMap<usize, Box<dyn FiringMethod>>,
    filter: BTreeMap<usize, Box<dyn Filter>>,
}

impl Own {
    /// Makes an empty set: all robots follow the method.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the firing method of a robot, counted from 0.
    #[must_use]
    pub fn firing(mut self, robot: usize, firing: impl FiringMethod + 'static) -> Self {
        self.firing.insert(robot, Box::new(firing));
        self
    }

    /// Sets the filter that decides which readings of a robot, counted from 0, are believed.
    #[must_use]
    pub fn filter(mut self, robot: usize, filter: impl Filter + 'static) -> Self {
        self.filter.insert(robot, Box::new(filter));
        self
    }

    /// Returns true if all parts are for existing robots.
    pub(in crate::simulation) fn check(&self, robots: usize) -> Result<(), SimulationError> {
        let last = self.firing.keys().chain(self.filter.keys()).max().copied();
        last.filter(|&robot| robot >= robots).map_or(Ok(()), |robot| Err(SimulationError::Robot { robot, robots }))
    }

    /// Returns true if a robot has its own firing method.
    pub(super) fn fires(&self, robot: usize) -> bool {
        self.firing.contains_key(&robot)
    }

    /// Returns true if a robot has its own filter.
    pub(super) fn filters(&self, robot: usize) -> bool {
        self.filter.contains_key(&robot)
    }

    pub(super) fn take_firing(&mut self, robot: usize) -> Option<Box<dyn FiringMethod>> {
        self.firing.remove(&robot)
    }

    pub(super) fn take_filter(&mut self, robot: usize) -> Option<Box<dyn Filter>> {
        self.filter.remove(&robot)
    }
}

impl fmt::Debug for Own {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { firing, filter } = self;
        f.debug_struct("Own")
            .field("firing of robots", &firing.keys().collect::<Vec<_>>())
            .field("filter of robots", &filter.keys().collect::<Vec<_>>())
            .finish()
    }
}
