//! [`Entry`]: a method with its settings, as simulations and experiments take it.

use core::fmt;
use core::str::FromStr;
use std::sync::Arc;

use eeruf_core::{
    MAX_SENSORS,
    flow::FlowSettings,
    hopping::{HoppingSchedule, HoppingSettings},
};

use super::engine::{self, Own};
use super::error::SimulationError;
use super::kinematics::Planned;
use super::options::Options;
use crate::{
    methods::{Method, OwnError, UnknownMethod},
    results::Readings,
    threads::Stop,
    world::{AnySchedule, Robot, Sketch, World},
};

/// Makes the caller's own firings and filters again for each simulation.
pub trait MakeOwn: fmt::Debug + Send + Sync {
    /// The firings and filters of these robots, the first of a world.
    ///
    /// # Errors
    /// Ends the simulation before it begins, with [`SimulationError::Own`].
    fn make(&self, robots: &[Robot]) -> Result<Own, OwnError>;
}

/// A method under a name, with the schedule, the settings and the caller's own code that make it another one: a value
/// that simulations and all experiments take alike. What it does not set is the robot's or the experiment's.
///
/// ```
/// use eeruf_core::hopping::HoppingSettings;
/// use eeruf_sim::{Entry, Method};
/// let quick = Entry::new("quick", Method::EerufHopping).with_hopping(HoppingSettings::QUICK);
/// assert_eq!((quick.name(), quick.method()), ("quick", Method::EerufHopping));
/// assert_eq!("eeruf".parse(), Ok(Entry::from(Method::Eeruf)));
/// assert_eq!("driving".parse::<Entry>().unwrap().method(), Method::EerufHopping);
/// ```
#[derive(Clone, Debug)]
pub struct Entry {
    name: Arc<str>,
    method: Method,
    hopping: Option<HoppingSettings>,
    hopping_schedule: Option<HoppingSchedule<MAX_SENSORS>>,
    flow: Option<FlowSettings>,
    schedule: Option<AnySchedule>,
    sketch: Option<Sketch>,
    own: Option<Arc<dyn MakeOwn>>,
}

/// The name of [`Method::EerufHopping`] by [`HoppingSettings::DRIVING`].
const DRIVING: &str = "driving";

impl Entry {
    /// A method as it is, under another name.
    pub fn new(name: &str, method: Method) -> Self {
        Self {
            name: name.into(),
            method,
            hopping: None,
            hopping_schedule: None,
            flow: None,
            schedule: None,
            sketch: None,
            own: None,
        }
    }

    /// Methods as they are, under their names.
    pub fn all(methods: impl IntoIterator<Item = Method>) -> Vec<Self> {
        methods.into_iter().map(Self::from).collect()
    }

    /// Time hopping by [`HoppingSettings::DRIVING`], under the name `driving`.
    pub fn driving() -> Self {
        Self::new(DRIVING, Method::EerufHopping).with_hopping(HoppingSettings::DRIVING)
    }

    /// Sets the name.
    #[must_use]
    pub fn with_name(self, name: &str) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Sets how [`Method::EerufHopping`] weighs readings and fires.
    #[must_use]
    pub fn with_hopping(self, hopping: HoppingSettings) -> Self {
        Self { hopping: Some(hopping), ..self }
    }

    /// Sets what [`Method::EerufHopping`] fires by, of as many sensors as the robot has.
    #[must_use]
    pub fn with_hopping_schedule(self, schedule: HoppingSchedule<MAX_SENSORS>) -> Self {
        Self { hopping_schedule: Some(schedule), ..self }
    }

    /// Sets how [`Method::Flow`] spaces its firings and weighs its readings.
    #[must_use]
    pub fn with_flow(self, flow: FlowSettings) -> Self {
        Self { flow: Some(flow), ..self }
    }

    /// Sets the robot's own schedule, of as many sensors.
    #[must_use]
    pub fn with_schedule(self, schedule: AnySchedule) -> Self {
        Self { schedule: Some(schedule), ..self }
    }

    /// Sets how the robot's ring is fired as it is.
    #[must_use]
    pub fn with_sketch(self, sketch: Sketch) -> Self {
        Self { sketch: Some(sketch), ..self }
    }

    /// Sets the caller's own firing, filter or both.
    #[must_use]
    pub fn with_own(self, own: Arc<dyn MakeOwn>) -> Self {
        Self { own: Some(own), ..self }
    }

    /// The name, under which results list it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The method that it is made of.
    pub const fn method(&self) -> Method {
        self.method
    }

    /// Returns true if it hops by [`HoppingSettings::DRIVING`].
    pub fn is_driving(&self) -> bool {
        self.hopping == Some(HoppingSettings::DRIVING)
    }

    /// The robot with what the entry changes of it.
    #[must_use]
    pub fn robot(&self, mut robot: Robot) -> Robot {
        robot.schedule = self.schedule.or(robot.schedule);
        if let Some(sketch) = &self.sketch {
            robot.firing = sketch.clone();
        }
        robot
    }

    /// The options with what the entry changes of them.
    #[must_use]
    pub fn options(&self, options: Options) -> Options {
        Options {
            hopping: self.hopping.unwrap_or(options.hopping),
            hopping_schedule: self.hopping_schedule.or(options.hopping_schedule),
            flow: self.flow.unwrap_or(options.flow),
            ..options
        }
    }

    /// The caller's own firings and filters for these robots, the first of a world.
    ///
    /// # Errors
    /// [`SimulationError::Own`] for what [`MakeOwn::make`] refuses.
    pub fn own(&self, robots: &[Robot]) -> Result<Own, SimulationError> {
        let made = self.own.as_ref().map_or_else(|| Ok(Own::new()), |own| own.make(robots));
        made.map_err(|error| SimulationError::Own { robot: 0, what: "method", at_s: 0.0, error })
    }

    /// Simulates a world whose robots are [`robot`](Self::robot)s of this entry. `stop` ends it from another thread,
    /// and so does `keep_going`, which is called now and then with the share of time that has passed.
    ///
    /// # Errors
    /// As [`simulate`](crate::simulate()), and for what the caller's own code refuses.
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

/// Own code is equal if it is the same.
impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        let Self { name, method, hopping, hopping_schedule, flow, schedule, sketch, own } = self;
        let same_own = match (own, &other.own) {
            (None, None) => true,
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        };
        let same_firing = (hopping_schedule, flow, schedule, sketch)
            == (&other.hopping_schedule, &other.flow, &other.schedule, &other.sketch);
        same_own && same_firing && (name, method, hopping) == (&other.name, &other.method, &other.hopping)
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
        if name == DRIVING { Ok(Self::driving()) } else { name.parse().map(<Self as From<Method>>::from) }
    }
}
