//! The table of firing methods, in which a method is added: a row has its description, its name, how its schedule is
//! made, how its ring is started, and which readings it accepts. What is new in a method, a way to make a schedule or
//! to start a ring, goes into `schedules.rs` or `ring_runner.rs`.

use core::fmt;
use core::str::FromStr;

use eeruf_core::{Instant, Micros, ScheduleError};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::adaptive;
use super::dither;
use super::firing::Firing;
use super::flow;
use super::ring_runner::{
    self, AGREEMENT_ALONE, ASKS, FiringPlan, RingRunner, RingStart, StartError, Started, planned,
};
use super::schedules::{self, Made, ScheduleQuery};
use super::sketch;
use crate::world::{AnySchedule, Robot};

/// The most echoes that a sensor reports of one firing.
pub(crate) const MAX_ECHOES: usize = 8;

/// Firing and belief of a method.
struct Row {
    name: &'static str,
    /// True if it is EERUF: waits alternate, and readings are compared.
    eeruf: bool,
    /// True if it fires by a robot's [`Sketch`](crate::Sketch).
    sketch: bool,
    /// True if it is simulated only where it is asked for.
    on_demand: bool,
    /// The schedule that a robot's ring starts with; for dither the lags alone.
    schedule: fn(&ScheduleQuery<'_>) -> Made,
    /// The ring, ready to run.
    ring: for<'s> fn(&RingStart<'s>) -> Started<'s>,
    belief: Belief,
    /// The ring's plan, from that schedule.
    plan: fn(&Robot, AnySchedule) -> Result<FiringPlan, StartError>,
    /// Number of echoes of a firing that a sensor reports.
    echoes: usize,
    /// Least time until a sensor, by its number, may fire again.
    refire: fn(&Robot, &AnySchedule, usize) -> Micros,
}

/// Defaults of a row: one schedule, one echo, no firing sooner than that schedule has it.
const DEFAULT: Row = Row {
    name: "",
    eeruf: false,
    sketch: false,
    on_demand: false,
    schedule: schedules::own,
    ring: ring_runner::scheduled::<1, ASKS>,
    belief: Belief::Repeated,
    plan: |_, schedule| Ok(FiringPlan::new(schedule)),
    echoes: 1,
    refire: |_, schedule, sensor| schedules::soonest_refire(schedule, sensor),
};

/// Makes the enum, its list and its rows from the table.
macro_rules! methods {
    ($( $(#[doc = $description:literal])+ $method:ident = $name:literal { $($field:ident: $value:expr,)+ } )+) => {
        /// A way to fire a ring and to decide what to believe.
        ///
        /// The first six and [`Median`](Self::Median) come from practice, the others are the paper's and what follows
        /// from it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Method {
            $( $(#[doc = $description])+ $method, )+
        }

        impl Method {
            /// Every method, in the order in which tables list them.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$method),+];

            /// Its row of the table.
            const fn row(self) -> &'static Row {
                match self {
                    $( Self::$method => const { &Row { name: $name, $($field: $value,)+ ..DEFAULT } }, )+
                }
            }
        }
    };
}

methods! {
    /// All sensors at once, once a period. Every echo is believed.
    Simultaneous = "simultaneous" {
        schedule: schedules::together,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::All,
    }
    /// One by one, each listening for the whole window before the next one fires. Every echo is believed.
    Sequential = "sequential" {
        schedule: schedules::one_by_one,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::All,
    }
    /// As sequential, but an echo is believed if one of the sensor's two readings before agrees with it: two of three
    /// votes.
    SequentialVotes = "sequential_votes" {
        schedule: schedules::one_by_one,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::TwoOfThree,
    }
    /// As sequential, but sensors as far apart as the ring's `neighbours` fire together. Every echo is believed.
    FarGroups = "far_groups" {
        schedule: schedules::far_groups,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::All,
    }
    /// The conventional lags plus a wait redrawn for each sensor in each period, from as wide a range as the paper's
    /// waits span. Consecutive readings are compared.
    Dither = "dither" {
        schedule: schedules::conventional,
        ring: dither::dithered,
        belief: Belief::Repeated,
        refire: |robot, _, _| robot.window,
    }
    /// Constant lags (Table I-a): neighbours fire `T_p / n` apart, every period alike. Every echo is believed.
    Conventional = "conventional" {
        schedule: schedules::conventional,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::All,
    }
    /// As conventional, but consecutive readings are compared: the negative control, the filter without alternation.
    Comparison = "comparison" {
        schedule: schedules::conventional,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::Repeated,
    }
    /// As conventional, but the median of a sensor's last readings is believed.
    Median = "median" {
        schedule: schedules::conventional,
        ring: ring_runner::scheduled::<1, AGREEMENT_ALONE>,
        belief: Belief::Median,
    }
    /// Immediate refiring with alternating waits (Figs. 2a, 2b): those of the paper's table, each longer by the robot's
    /// `min_refire`. Consecutive readings are compared.
    EerufImmediate = "eeruf_immediate" {
        eeruf: true,
        schedule: schedules::refiring,
        ring: ring_runner::immediate,
        belief: Belief::Repeated,
        refire: |robot, _, _| robot.min_refire,
    }
    /// Scheduled firing (Fig. 3) by the robot's own schedule, or else by the paper's table at the robot's period (see
    /// [`table_i_d_for`](crate::table_i_d_for)). Consecutive readings are compared.
    Eeruf = "eeruf" {
        eeruf: true,
        schedule: schedules::own,
        ring: ring_runner::scheduled::<1, ASKS>,
        belief: Belief::Repeated,
        plan: ring_runner::plan_own,
    }
    /// As [`Eeruf`](Self::Eeruf), by the best schedule that is known for the ring: what the caller puts in
    /// [`Options::best`](crate::Options::best).
    EerufBest = "eeruf_best" {
        eeruf: true,
        schedule: schedules::best,
        ring: ring_runner::scheduled::<1, ASKS>,
        belief: Belief::Repeated,
    }
    /// As [`Eeruf`](Self::Eeruf), moving along a ladder of scaled schedules as the rejection rate asks for (end of Sec.
    /// 3.1).
    Adaptive = "adaptive" {
        eeruf: true,
        schedule: schedules::own,
        ring: adaptive::adaptive::<1>,
        belief: Belief::Repeated,
        plan: adaptive::plan,
        refire: |robot, _, _| robot.window,
    }
    /// Flow: one sensor after the other, each with as much quiet around its firing as it has needed and dice in every
    /// gap; an echo is believed that fits what is believed, or that two readings say and nothing foreign explains
    /// ([`InTurn`](eeruf_core::flow::InTurn), [`Belief`](eeruf_core::flow::Belief)).
    Flow = "flow" {
        eeruf: true,
        schedule: schedules::conventional,
        ring: flow::flow,
        belief: Belief::Repeated,
        refire: |robot, _, _| robot.window,
    }
    /// As [`Eeruf`](Self::Eeruf), with sensors that report up to eight echoes of a firing: the earliest that repeats is
    /// believed.
    MultiEcho = "multi_echo" {
        eeruf: true,
        schedule: schedules::own,
        ring: ring_runner::scheduled::<MAX_ECHOES, ASKS>,
        belief: Belief::Repeated,
        plan: ring_runner::plan_own,
        echoes: MAX_ECHOES,
    }
    /// As [`Adaptive`](Self::Adaptive), with sensors that report up to eight echoes of a firing.
    AdaptiveMultiEcho = "adaptive_multi_echo" {
        eeruf: true,
        on_demand: true,
        ring: adaptive::adaptive::<MAX_ECHOES>,
        plan: adaptive::plan,
        echoes: MAX_ECHOES,
        refire: |robot, _, _| robot.window,
    }
    /// As [`Flow`](Self::Flow), with sensors that report up to eight echoes of a firing.
    FlowMultiEcho = "flow_multi_echo" {
        eeruf: true,
        on_demand: true,
        schedule: schedules::conventional,
        ring: flow::several,
        echoes: MAX_ECHOES,
        refire: |robot, _, _| robot.window,
    }
    /// One by one, each as soon as the one before has answered or was given up, as the loop of a sketch or a ping timer
    /// fires; see [`Sketch`](crate::Sketch). Every echo is believed, unless that says otherwise.
    InTurn = "in_turn" {
        sketch: true,
        schedule: schedules::together,
        ring: sketch::in_turn,
        belief: Belief::AsSketched,
        refire: |_, _, _| Micros::ZERO,
    }
    /// Arrays side by side, each as [`InTurn`](Self::InTurn).
    Arrays = "arrays" {
        sketch: true,
        schedule: schedules::together,
        ring: sketch::arrays,
        belief: Belief::AsSketched,
        refire: |_, _, _| Micros::ZERO,
    }
    /// As [`InTurn`](Self::InTurn), with groups of sensors that fire together.
    Groups = "groups" {
        sketch: true,
        schedule: schedules::together,
        ring: sketch::groups,
        belief: Belief::AsSketched,
        refire: |_, _, _| Micros::ZERO,
    }
    /// Modules that share a trigger: all at once, again when the slowest has answered and rested.
    SyncLine = "sync_line" {
        sketch: true,
        schedule: schedules::together,
        ring: sketch::sync_line,
        belief: Belief::AsSketched,
        refire: |_, _, _| Micros::ZERO,
    }
    /// Modules that fire themselves, each by a clock of its own.
    FreeRunning = "free_running" {
        sketch: true,
        schedule: schedules::together,
        ring: sketch::free_running,
        belief: Belief::AsSketched,
        refire: |_, _, _| Micros::ZERO,
    }
    /// One by one as a loop that blocks: fire, wait for the echo or for 38 ms, then 10 ms, and the next. Every echo is
    /// believed.
    Blocking = "blocking" {
        on_demand: true,
        schedule: schedules::together,
        ring: sketch::blocking,
        belief: Belief::All,
        refire: |_, _, _| Micros::ZERO,
    }
    /// By a table of any number of phases, the robot's own schedule unless the sketch has one.
    Table = "table" {
        sketch: true,
        schedule: schedules::own,
        ring: sketch::table,
        belief: Belief::AsSketched,
        refire: |robot, _, _| robot.window,
    }
}

impl Method {
    /// Its name in files, in `--json` and in Python.
    pub const fn as_str(self) -> &'static str {
        self.row().name
    }

    /// Returns true if it is the paper's method or follows from it: waits alternate, and consecutive readings are
    /// compared.
    pub const fn is_eeruf(self) -> bool {
        self.row().eeruf
    }

    /// Returns true if it fires as sketches and modules do today, by a robot's [`Sketch`](crate::Sketch).
    pub const fn is_sketch(self) -> bool {
        self.row().sketch
    }

    /// The methods that are compared where nothing says how a ring is fired today: all that are no sketch, and no
    /// [on demand](Self::is_on_demand).
    pub fn usual() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|method| !method.is_sketch() && !method.is_on_demand())
    }

    /// Returns true if it is simulated only where it is asked for by name: two methods in one.
    pub const fn is_on_demand(self) -> bool {
        self.row().on_demand
    }

    /// Readings that it believes.
    pub(crate) const fn belief(self) -> Belief {
        self.row().belief
    }

    /// Number of echoes of a firing that a sensor reports.
    pub(crate) const fn echoes(self) -> usize {
        self.row().echoes
    }

    /// Least time until a sensor may fire again, as long as its ring keeps to this schedule.
    pub(crate) fn soonest_refire(self, robot: &Robot, schedule: &AnySchedule, sensor: usize) -> Micros {
        (self.row().refire)(robot, schedule, sensor)
    }

    /// The schedule that a robot's ring starts with.
    pub(crate) fn schedule(self, robot: &Robot, best: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
        (self.row().schedule)(&ScheduleQuery { robot, best })
    }

    /// The plan of a robot's ring, from the schedule that it starts with.
    pub(crate) fn plan(self, robot: &Robot, schedule: AnySchedule) -> Result<FiringPlan, StartError> {
        (self.row().plan)(robot, schedule)
    }

    /// A robot's ring that fires by the caller's own code, ready to run.
    pub(crate) fn start_own<'s>(self, robot: &Robot, firing: Box<dyn Firing>, now: Instant) -> Started<'s> {
        let planned = match (self.echoes() > 1, self.is_eeruf()) {
            (true, _) => planned::<MAX_ECHOES, ASKS>,
            (false, true) => planned::<1, ASKS>,
            (false, false) => planned::<1, AGREEMENT_ALONE>,
        };
        planned(robot, firing, robot.window, now)
    }

    /// A robot's ring, ready to run.
    pub(crate) fn start<'s>(self, start: &RingStart<'s>) -> Result<Box<dyn RingRunner<'s> + 's>, StartError> {
        (self.row().ring)(start)
    }
}

/// Readings that a method believes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Belief {
    /// Every one.
    All,
    /// The median of the last few.
    Median,
    /// Readings that agree with one of the sensor's two readings before.
    TwoOfThree,
    /// Readings that the ring's own filter accepts.
    Repeated,
    /// Every one, or what the ring's own filter accepts: as the robot's sketch says.
    AsSketched,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        name.parse().map_err(de::Error::custom)
    }
}

impl FromStr for Method {
    type Err = UnknownMethod;

    /// ```
    /// use eeruf_sim::Method;
    /// assert_eq!("far_groups".parse(), Ok(Method::FarGroups));
    /// let error = "eruf".parse::<Method>().unwrap_err();
    /// assert!(error.to_string().starts_with("no method `eruf`; expected simultaneous, "));
    /// let error = "eeruf_hopping".parse::<Method>().unwrap_err();
    /// assert_eq!(error.to_string(), "method `eeruf_hopping` is gone; `flow` does it");
    /// ```
    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.into_iter().find(|method| method.as_str() == name).ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

/// A name that no method has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownMethod(pub String);

/// Names that methods had.
const GONE: [&str; 4] = ["eeruf_hopping", "driving", "adaptive_hopping", "hopping_multi_echo"];

impl fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if GONE.contains(&self.0.as_str()) {
            let does = if self.0 == "hopping_multi_echo" { Method::FlowMultiEcho } else { Method::Flow };
            return write!(f, "method `{}` is gone; `{does}` does it", self.0);
        }
        let names = Method::ALL.map(Method::as_str).join(", ");
        write!(f, "no method `{}`; expected {names}", self.0)
    }
}

impl core::error::Error for UnknownMethod {}
