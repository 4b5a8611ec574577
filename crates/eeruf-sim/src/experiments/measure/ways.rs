//! The measured ways of firing, in families, the simplest first.

use core::fmt;

use eeruf_core::Micros;

use crate::{
    experiments::rooms::RoomWay,
    methods::Method,
    world::{AnySchedule, FiringTable, Robot},
};

/// Ways of one kind; under each condition the best of them counts. The simplest families come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// One sensor after the other: with gaps of 10, 20 and 33 ms, with the module's quiet, and as a blocking loop.
    OneByOne,
    /// Groups of sensors that are far apart.
    Groups,
    /// Two phases, at the shortest period and at longer ones.
    TwoPhases,
    /// Flow.
    Flow,
}

impl Family {
    /// All families, the simplest first.
    pub const ALL: [Self; 4] = [Self::OneByOne, Self::Groups, Self::TwoPhases, Self::Flow];

    /// Returns the family of a way, by its name; `None` for a way that is not measured.
    fn of(name: &str) -> Option<Self> {
        match name {
            "sequential" => Some(Self::OneByOne),
            "far_groups" => Some(Self::Groups),
            "eeruf" | "eeruf_x1.5" | "eeruf_x2" => Some(Self::TwoPhases),
            "flow" => Some(Self::Flow),
            _ => None,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::OneByOne => "one by one",
            Self::Groups => "groups",
            Self::TwoPhases => "two phases",
            Self::Flow => "flow",
        })
    }
}

/// A way of firing with its family.
#[derive(Clone, Debug)]
pub struct MeasuredWay {
    /// The family.
    pub family: Family,
    /// The way; every way knows the robot's motion.
    pub way: RoomWay,
}

/// Returns the measured ways for a ring, one by one first; `schedule` is as in [`RoomWay::all`].
pub fn measured_ways(robot: &Robot, schedule: Option<&AnySchedule>) -> Vec<MeasuredWay> {
    let usual = RoomWay::all(robot, schedule).into_iter().filter_map(|way| {
        let family = Family::of(way.name)?;
        Some(MeasuredWay { family, way: RoomWay { robot: Robot { odometry: true, ..way.robot }, ..way } })
    });
    let mut ways: Vec<_> = usual.collect();
    let Some(quiet) = ways.iter().find(|way| way.family == Family::OneByOne).map(|way| way.way.clone()) else {
        return ways;
    };
    let more = [("one_by_one_10ms", 10), ("one_by_one_20ms", 20), ("one_by_one_33ms", 33)].map(|(name, gap_ms)| {
        let mut robot = quiet.robot.clone();
        let sensors = robot.sensors.len() as u32;
        // No module is triggered before its rest is over, or while it listens.
        let needs = robot.module_rest().max(robot.window.saturating_add(Micros::new(1)));
        let period = Micros::from_millis(gap_ms * sensors).max(needs).as_micros();
        let row =
            (0..sensors).map(|sensor| Micros::new((u64::from(period) * u64::from(sensor) / u64::from(sensors)) as u32));
        robot.firing.table = Some(FiringTable { period: Micros::new(period), rows: vec![row.collect()] });
        RoomWay { name, method: Method::Table, robot, options: quiet.options }
    });
    let blocking = RoomWay { name: "blocking", method: Method::Blocking, ..quiet };
    ways.extend(more.into_iter().chain([blocking]).map(|way| MeasuredWay { family: Family::OneByOne, way }));
    ways.sort_by_key(|way| way.family);
    ways
}
