//! [`Entry`]: a method with its settings, for simulations and experiments.

use core::fmt;
use core::str::FromStr;
use std::sync::Arc;

use super::engine::{self, Own};
use super::error::SimulationError;
use super::kinematics::Planned;
use super::options::Options;
use crate::{
    methods::{FlowOptions, Method, OwnError, UnknownMethod},
    results::Readings,
    threads::Stop,
    world::{AnySchedule, Robot, Sketch, World},
};

/// A factory of the caller's own firing methods and filters, called for each simulation.
pub trait MakeOwn: fmt::Debug + Send + Sync {
    /// Makes the firing methods and filters of these robots, the first of a world.
    ///
    /// # Errors
    /// An error ends the simulation before it begins, with [`SimulationError::Own`].
    fn make(&self, robots: &[Robot]) -> Result<Own, OwnError>;
}

/// A named method with its own schedule, settings and code. Simulations and all experiments accept it. The robot or the
/// experiment supplies missing settings.
///
/// ```
/// use eeruf_core::Micros;
/// use eeruf_sim::{Entry, FlowOptions, Method};
/// let mut wide = FlowOptions::default();
/// wide.least = Some(Micros::from_millis(12));
/// let wide = Entry::new("wide", Method::Flow).with_flow(wide);
/// assert_eq!((wide.name(), wide.method()), ("wide", Method::Flow));
/// assert_eq!("eeruf".parse(), Ok(Entry::from(Method::Eeruf)));
/// ```
#[derive(Clone, Debug)]
pub struct Entry {
    name: Arc<str>,
    method: Method,
    flow: Option<FlowOptions>,
    schedule: Option<AnySchedule>,
    sketch: Option<Sketch>,
    own: Option<Arc<dyn MakeOwn>>,
}

impl Entry {
    /// Makes an entry of an unchanged method under another name.
    pub fn new(name: &str, method: Method) -> Self {
        Self { name: name.into(), method, flow: None, schedule: None, sketch: None, own: None }
    }

    /// Makes entries of unchanged methods under their own names.
    pub fn all(methods: impl IntoIterator<Item = Method>) -> Vec<Self> {
        methods.into_iter().map(Self::from).collect()
    }

    /// Sets the name.
    #[must_use]
    pub fn with_name(self, name: &str) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Sets the settings of [`Method::Flow`].
    #[must_use]
    pub fn with_flow(self, flow: FlowOptions) -> Self {
        Self { flow: Some(flow), ..self }
    }

    /// Sets the robot's own schedule, for the same number of sensors.
    #[must_use]
    pub fn with_schedule(self, schedule: AnySchedule) -> Self {
        Self { schedule: Some(schedule), ..self }
    }

    /// Sets the robot's [`Sketch`].
    #[must_use]
    pub fn with_sketch(self, sketch: Sketch) -> Self {
        Self { sketch: Some(sketch), ..self }
    }

    /// Sets the caller's own firing, filter or both.
    #[must_use]
    pub fn with_own(self, own: Arc<dyn MakeOwn>) -> Self {
        Self { own: Some(own), ..self }
    }

    /// Returns the name of the entry in results.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the method on which this one is based.
    pub const fn method(&self) -> Method {
        self.method
    }

    /// Returns the robot with the entry's changes.
    #[must_use]
    pub fn robot(&self, mut robot: Robot) -> Robot {
        robot.schedule = self.schedule.or(robot.schedule);
        robot.window = self.flow.and_then(|flow| flow.window).unwrap_or(robot.window);
        if let Some(sketch) = &self.sketch {
            robot.firing = sketch.clone();
        }
        robot
    }

    /// Returns the options with the entry's changes.
    #[must_use]
    pub fn options(&self, options: Options) -> Options {
        Options { flow: self.flow.unwrap_or(options.flow), ..options }
    }

    /// Makes the caller's own firing methods and filters for these robots, the first of a world.
    ///
    /// # Errors
    /// [`SimulationError::Own`] with the error of [`MakeOwn::make`].
    pub fn own(&self, robots: &[Robot]) -> Result<Own, SimulationError> {
        let made = self.own.as_ref().map_or_else(|| Ok(Own::new()), |own| own.make(robots));
        made.map_err(|error| SimulationError::Own { robot: 0, what: "method", at_s: 0.0, error })
    }

    /// Simulates a world whose robots are [`robot`](Self::robot)s of this entry. `stop` ends it from another thread. So
    /// does `keep_going` when it returns `false`; it is called from time to time with the elapsed share of the time.
    ///
    /// # Errors
    /// Errors of [`simulate`](crate::simulate()), and of the caller's own code.
    pub fn simulate(
        &self,
        world: &World,
        options: &Options,
        stop: &Stop,
        keep_going: impl FnMut(f64) -> bool,
    ) -> Result<Readings, SimulationError> {
        let own = self.own(world.robots())?;
        engine::run(world, self.method, &self.options(*options), own, &mut Planned(world), stop, keep_going)
    }
}

impl From<Method> for Entry {
    fn from(method: Method) -> Self {
        Self::new(method.as_str(), method)
    }
}

/// Equality of all parts; own code is equal if it is the same object.
impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        let Self { name, method, flow, schedule, sketch, own } = self;
        let same_own = match (own, &other.own) {
            (None, None) => true,
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        };
        let same_firing = (flow, schedule, sketch) == (&other.flow, &other.schedule, &other.sketch);
        same_own && same_firing && (name, method) == (&other.name, &other.method)
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name)
    }
}

impl FromStr for Entry {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        name.parse().map(<Self as From<Method>>::from)
    }
}
