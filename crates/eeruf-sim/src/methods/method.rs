//! The table of firing methods, in which a method is added: a row has its description, its name, its firing, its judge,
//! the number of echoes, and whether it adapts. A new way of firing is a [`Way`] in a file of its own.

use core::fmt;
use core::str::FromStr;

use eeruf_core::{Micros, ScheduleError};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::adaptive;
use super::dither;
use super::flow;
use super::judges::JudgeKind::{self, Agreement, AsSketched, Belief, EveryEcho, TwoOfThree};
use super::ring_runner::{FiringPlan, RingStart, StartError, Started, Way};
use super::schedules;
use super::sketch;
use crate::world::{AnySchedule, Robot};

/// The most echoes that a sensor reports of one firing.
pub(crate) const MAX_ECHOES: usize = 8;

/// A method: its firing, its judge, the number of echoes of a firing that a sensor reports, and whether it adapts.
struct Row {
    name: &'static str,
    /// True if it is simulated only where it is asked for.
    on_demand: bool,
    firing: Way,
    judge: JudgeKind,
    echoes: usize,
    /// True if it moves along a ladder of scaled schedules.
    adapts: bool,
}

/// Defaults of a row: the robot's own schedule, and one echo, which is believed if nothing foreign explains it and the
/// one before.
const DEFAULT: Row =
    Row { name: "", on_demand: false, firing: Way::OWN_TABLE, judge: JudgeKind::Unexplained, echoes: 1, adapts: false };

/// Makes the enum, its list and its rows from the table.
macro_rules! methods {
    ($( $(#[doc = $description:literal])+ $method:ident = $name:literal { $($field:ident: $value:expr,)* } )+) => {
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
                    $( Self::$method => const { &Row { name: $name, $($field: $value,)* ..DEFAULT } }, )+
                }
            }
        }
    };
}

methods! {
    /// All sensors at once, once a period. Every echo is believed.
    Simultaneous = "simultaneous" { firing: Way::by_table(schedules::together), judge: EveryEcho, }
    /// One by one, each listening for the whole window before the next one fires. Every echo is believed.
    Sequential = "sequential" { firing: Way::by_table(schedules::one_by_one), judge: EveryEcho, }
    /// As sequential, but an echo is believed if one of the sensor's two readings before agrees with it: two of three
    /// votes.
    SequentialVotes = "sequential_votes" { firing: Way::by_table(schedules::one_by_one), judge: TwoOfThree, }
    /// As sequential, but the median of a sensor's last three readings is believed.
    SequentialMedian = "sequential_median" {
        firing: Way::by_table(schedules::one_by_one), judge: JudgeKind::Median, on_demand: true,
    }
    /// As sequential, but sensors as far apart as the ring's `neighbours` fire together. Every echo is believed.
    FarGroups = "far_groups" { firing: Way::by_table(schedules::far_groups), judge: EveryEcho, }
    /// The conventional lags plus a wait redrawn for each sensor in each period, from as wide a range as the paper's
    /// waits span. Consecutive readings are compared.
    Dither = "dither" { firing: dither::WAY, judge: Agreement, }
    /// Constant lags (Table I-a): neighbours fire `T_p / n` apart, every period alike. Every echo is believed.
    Conventional = "conventional" { firing: Way::by_table(schedules::conventional), judge: EveryEcho, }
    /// As conventional, but consecutive readings are compared: the negative control, the filter without alternation.
    Comparison = "comparison" { firing: Way::by_table(schedules::conventional), judge: Agreement, }
    /// As conventional, but the median of a sensor's last readings is believed.
    Median = "median" { firing: Way::by_table(schedules::conventional), judge: JudgeKind::Median, }
    /// Immediate refiring with alternating waits (Figs. 2a, 2b): those of the paper's table, each longer by the robot's
    /// `min_refire`. Consecutive readings are compared.
    EerufImmediate = "eeruf_immediate" { firing: Way::IMMEDIATE, }
    /// Scheduled firing (Fig. 3) by the robot's own schedule, or else by the paper's table at the robot's period (see
    /// [`table_i_d_for`](crate::table_i_d_for)). Consecutive readings are compared.
    Eeruf = "eeruf" { }
    /// As [`Eeruf`](Self::Eeruf), by the best schedule that is known for the ring: what the caller puts in
    /// [`Options::best`](crate::Options::best).
    EerufBest = "eeruf_best" { firing: Way::by_table(schedules::best), }
    /// As [`Eeruf`](Self::Eeruf), moving along a ladder of scaled schedules as the rejection rate asks for (end of Sec.
    /// 3.1).
    Adaptive = "adaptive" { adapts: true, }
    /// Flow: one sensor after the other, each with as much quiet around its firing as it has needed and dice in every
    /// gap; an echo is believed that fits what is believed, or that two readings say and nothing foreign explains
    /// ([`InTurn`](eeruf_core::flow::InTurn), [`Belief`](eeruf_core::flow::Belief)).
    Flow = "flow" { firing: flow::WAY, judge: Belief, }
    /// As [`Eeruf`](Self::Eeruf), with sensors that report up to eight echoes of a firing: the earliest that repeats is
    /// believed.
    MultiEcho = "multi_echo" { echoes: MAX_ECHOES, }
    /// As [`Adaptive`](Self::Adaptive), with sensors that report up to eight echoes of a firing.
    AdaptiveMultiEcho = "adaptive_multi_echo" { echoes: MAX_ECHOES, adapts: true, on_demand: true, }
    /// As [`Flow`](Self::Flow), with sensors that report up to eight echoes of a firing.
    FlowMultiEcho = "flow_multi_echo" { firing: flow::WAY, judge: Belief, echoes: MAX_ECHOES, on_demand: true, }
    /// One by one, each as soon as the one before has answered or was given up, as the loop of a sketch or a ping timer
    /// fires; see [`Sketch`](crate::Sketch). Every echo is believed, unless that says otherwise.
    InTurn = "in_turn" { firing: sketch::way(sketch::in_turn), judge: AsSketched, }
    /// Arrays side by side, each as [`InTurn`](Self::InTurn).
    Arrays = "arrays" { firing: sketch::way(sketch::arrays), judge: AsSketched, }
    /// As [`InTurn`](Self::InTurn), with groups of sensors that fire together.
    Groups = "groups" { firing: sketch::way(sketch::groups), judge: AsSketched, }
    /// Modules that share a trigger: all at once, again when the slowest has answered and rested.
    SyncLine = "sync_line" { firing: sketch::way(sketch::sync_line), judge: AsSketched, }
    /// Modules that fire themselves, each by a clock of its own.
    FreeRunning = "free_running" { firing: sketch::way(sketch::free_running), judge: AsSketched, }
    /// One by one as a loop that blocks: fire, wait for the echo or for 38 ms, then 10 ms, and the next. Every echo is
    /// believed.
    Blocking = "blocking" { firing: sketch::way(sketch::blocking), judge: EveryEcho, on_demand: true, }
    /// By a table of any number of phases, the robot's own schedule unless the sketch has one.
    Table = "table" { firing: sketch::TABLE, judge: AsSketched, }
}

impl Method {
    /// Its name in files, in `--json` and in Python.
    pub const fn as_str(self) -> &'static str {
        self.row().name
    }

    /// Returns true if it is the paper's method or follows from it: waits alternate, and consecutive readings are
    /// compared.
    pub const fn is_eeruf(self) -> bool {
        self.row().judge.asks()
    }

    /// Returns true if it fires as sketches and modules do today, by a robot's [`Sketch`](crate::Sketch).
    pub const fn is_sketch(self) -> bool {
        matches!(self.row().judge, AsSketched)
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

    /// The judge of its readings.
    pub(crate) const fn judge(self) -> JudgeKind {
        self.row().judge
    }

    /// Number of echoes of a firing that a sensor reports.
    pub(crate) const fn echoes(self) -> usize {
        self.row().echoes
    }

    /// Least time until a sensor may fire again, as long as its ring keeps to this schedule.
    pub(crate) fn soonest_refire(self, robot: &Robot, schedule: &AnySchedule, sensor: usize) -> Micros {
        if self.row().adapts { robot.window } else { (self.row().firing.refire)(robot, schedule, sensor) }
    }

    /// The schedule that a robot's ring starts with.
    pub(crate) fn schedule(self, robot: &Robot, best: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
        (self.row().firing.schedule)(robot, best)
    }

    /// The plan of a robot's ring, from the schedule that it starts with.
    pub(crate) fn plan(self, robot: &Robot, schedule: AnySchedule) -> Result<FiringPlan, StartError> {
        if self.row().adapts { adaptive::plan(robot, schedule) } else { (self.row().firing.plan)(robot, schedule) }
    }

    /// A robot's ring, ready to run.
    pub(crate) fn start(self, start: &RingStart<'_>) -> Started {
        (self.row().firing.ring)(start)
    }
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
