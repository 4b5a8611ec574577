//! A row of the table of firing methods: description, name, firing, judge, number of echoes, and adaptation.

use core::fmt;
use core::str::FromStr;

use eeruf_core::{Micros, ScheduleError};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::Method;
use super::adaptive;
use super::judges::JudgeKind::{self, AsSketched};
use super::ring_runner::{FiringPlan, RingStart, StartError, Started, Way};
use crate::world::{AnySchedule, Robot};

/// Largest number of echoes that a sensor reports of one firing.
pub(crate) const MAX_ECHOES: usize = 8;

/// A firing method: its firing, its judge, the number of echoes that a sensor reports, and its adaptation.
pub(super) struct MethodRow {
    pub(super) name: &'static str,
    /// The description, from the enum's documentation.
    pub(super) about: &'static str,
    /// True if the method is simulated only on request.
    pub(super) on_demand: bool,
    pub(super) firing: Way,
    pub(super) judge: JudgeKind,
    pub(super) echoes: usize,
    /// True if the method moves along a ladder of scaled schedules.
    pub(super) adapts: bool,
}

/// Defaults of a row: the robot's own schedule, one echo, and a judge that accepts consecutive readings if they agree
/// and nothing foreign explains them.
pub(super) const DEFAULT: MethodRow = MethodRow {
    name: "",
    about: "",
    on_demand: false,
    firing: Way::OWN_TABLE,
    judge: JudgeKind::Unexplained,
    echoes: 1,
    adapts: false,
};

/// Makes the enum, its list and its rows from the table, and declares the modules of ways in files of their own.
macro_rules! methods {
    ($(
        $(#[doc = $about:literal])+
        $method:ident = $name:literal $(in $file:ident)? { $($field:ident: $value:expr,)* }
    )+) => {
        $( $( mod $file; )? )+

        /// A way to fire a ring and to judge its readings.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Method {
            $( $(#[doc = $about])+ $method, )+
        }

        impl Method {
            /// Every method, in the order in which tables list them.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$method),+];

            /// Returns the row of the table.
            pub(in crate::methods) const fn row(self) -> &'static MethodRow {
                match self {
                    $( Self::$method => const {
                        &MethodRow { name: $name, about: concat!($($about),+), $($field: $value,)* ..DEFAULT }
                    }, )+
                }
            }
        }
    };
}
pub(super) use methods;

impl Method {
    /// Returns the name in files, in `--json` and in Python.
    pub const fn as_str(self) -> &'static str {
        self.row().name
    }

    /// Returns the first sentence of the description.
    pub fn about(self) -> String {
        let text = self.row().about.trim();
        // A point as in `Fig. 3` does not end a sentence.
        let mut ends = text.match_indices(". ").filter(|(at, _)| text[at + 2..].starts_with(char::is_uppercase));
        let first = &text[..ends.next().map_or(text.len(), |(at, _)| at)];
        // Links are replaced by their texts.
        let mut shown = String::with_capacity(first.len());
        for part in first.split("](") {
            let rest = if shown.is_empty() { part } else { part.split_once(')').map_or("", |(_, rest)| rest) };
            shown += rest;
        }
        shown.replace("[`", "").replace('`', "").trim_end_matches('.').to_owned()
    }

    /// Returns true for EERUF's own methods, by table or by flow: they reject readings that another firing explains.
    pub const fn is_eeruf(self) -> bool {
        self.row().judge.asks()
    }

    /// Returns true if the method fires like today's sketches and modules, by a robot's [`Sketch`](crate::Sketch).
    pub const fn is_sketch(self) -> bool {
        matches!(self.row().judge, AsSketched)
    }

    /// Returns the methods compared by default: all except sketches and those [on demand](Self::is_on_demand).
    pub fn usual() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|method| !method.is_sketch() && !method.is_on_demand())
    }

    /// Returns true if the method is simulated only when requested by name, because it combines two others.
    pub const fn is_on_demand(self) -> bool {
        self.row().on_demand
    }

    /// Returns the judge of the method's readings.
    pub(crate) const fn judge(self) -> JudgeKind {
        self.row().judge
    }

    /// Returns the number of echoes of a firing that a sensor reports.
    pub(crate) const fn echoes(self) -> usize {
        self.row().echoes
    }

    /// Returns the least time until a sensor may fire again while its ring keeps this schedule.
    pub(crate) fn soonest_refire(self, robot: &Robot, schedule: &AnySchedule, sensor: usize) -> Micros {
        if self.row().adapts { robot.window } else { (self.row().firing.refire)(robot, schedule, sensor) }
    }

    /// Returns the schedule with which a robot's ring starts.
    pub(crate) fn schedule(self, robot: &Robot, best: Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError> {
        (self.row().firing.schedule)(robot, best)
    }

    /// Returns the plan of a robot's ring, given its first schedule.
    pub(crate) fn plan(self, robot: &Robot, schedule: AnySchedule) -> Result<FiringPlan, StartError> {
        if self.row().adapts { adaptive::plan(robot, schedule) } else { (self.row().firing.plan)(robot, schedule) }
    }

    /// Starts a robot's ring.
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

/// An unknown name of a method.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownMethod(pub String);

/// Names of removed methods.
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
