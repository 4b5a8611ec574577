//! The measured ways of firing, in families, the simplest first.

use core::fmt;

use eeruf_core::Micros;
use eeruf_modules::Gain;

use super::votes::Setting;
use crate::{
    acoustics::GainProfile,
    methods::Method,
    simulation::Options,
    world::{AnySchedule, FiringTable, Robot},
};

/// Ways of one kind; under each condition the best of them counts. The simplest families come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// One sensor after the other: with gaps of 10, 20 and 33 ms, with the module's quiet, and as a blocking loop.
    OneByOne,
    /// Groups of sensors that are far apart.
    Groups,
    /// Two phases, at the shortest period.
    TwoPhases,
    /// Flow.
    Flow,
}

impl Family {
    /// All families, the simplest first.
    pub const ALL: [Self; 4] = [Self::OneByOne, Self::Groups, Self::TwoPhases, Self::Flow];
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

/// A way of firing a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomWay {
    /// The family.
    pub family: Family,
    /// The name in tables and in JSON.
    pub name: &'static str,
    /// The method.
    pub method: Method,
    /// The robot, set up to fire that way; in every way its ring knows its motion.
    pub robot: Robot,
    /// Settings of the method.
    pub options: Options,
}

impl RoomWay {
    /// The ways for a ring, one by one first. All listen for the robot's window, flow for no longer than it
    /// [reaches](Robot::reach).
    ///
    /// `schedule` is a schedule of two phases for it, the shortest; without one, there is no way of two phases. No way
    /// uses `robot.period`.
    pub fn all(robot: &Robot, schedule: Option<&AnySchedule>) -> Vec<Self> {
        let way = |family, name, method, period: Micros| Self {
            family,
            name,
            method,
            robot: Robot { period, odometry: true, ..robot.clone() },
            options: Options::default(),
        };
        // The module's rest, and the time for which its own sound may still be heard.
        let rest = robot.module_rest().max(robot.audible).max(robot.window).saturating_add(Micros::new(1));
        let mut ways = vec![way(Family::OneByOne, "sequential", Method::Sequential, rest)];
        let sensors = robot.sensors.len() as u32;
        for (name, gap_ms) in [("one_by_one_10ms", 10), ("one_by_one_20ms", 20), ("one_by_one_33ms", 33)] {
            let mut apart = way(Family::OneByOne, name, Method::Table, rest);
            // No module before its rest, and none while it listens.
            let needs = robot.module_rest().max(robot.window.saturating_add(Micros::new(1)));
            let period = Micros::from_millis(gap_ms * sensors).max(needs).as_micros();
            let at = |sensor| Micros::new((u64::from(period) * u64::from(sensor) / u64::from(sensors)) as u32);
            let rows = vec![(0..sensors).map(at).collect()];
            apart.robot.firing.table = Some(FiringTable { period: Micros::new(period), rows });
            // Few sensors have one period for several gaps.
            if ways.iter().all(|way| way.robot.firing.table != apart.robot.firing.table) {
                ways.push(apart);
            }
        }
        ways.push(way(Family::OneByOne, "blocking", Method::Blocking, rest));
        ways.push(way(Family::Groups, "far_groups", Method::FarGroups, rest));
        ways.extend(schedule.map(|schedule| {
            let mut eeruf = way(Family::TwoPhases, "eeruf", Method::Eeruf, schedule.period());
            eeruf.robot.schedule = Some(*schedule);
            eeruf
        }));
        let flow = way(Family::Flow, "flow", Method::Flow, rest);
        ways.push(Self { robot: flow.robot.by_flow(), ..flow });
        ways
    }

    /// The way and its votes in words.
    pub fn in_words(&self, setting: Setting) -> String {
        let way = match self.name {
            "blocking" if setting == Setting::ALL[0] => "blocking, as sketches fire".to_owned(),
            "blocking" => "one by one, in a loop".to_owned(),
            "in_turn" => "one by one, after an echo".to_owned(),
            "sequential" => "one by one, after the sound".to_owned(),
            "far_groups" => "groups, far apart".to_owned(),
            "eeruf" => "two phases (EERUF)".to_owned(),
            name => match &self.robot.firing.table {
                // With few sensors their rest counts, not the gap that was asked for.
                Some(table) => format!("one by one, {:.0} ms apart", f64::from(table.gap().as_micros()) / 1e3),
                None => name.to_owned(),
            },
        };
        match setting {
            Setting::Votes { m: 1, .. } => way,
            Setting::Votes { m, n } => format!("{way}, {m} of {n}"),
            Setting::Median => format!("{way}, median"),
        }
    }
}

/// Returns the robot with the other gain: the chip's steps if its gain is constant, a constant gain if it grows.
pub fn with_other_gain(robot: &Robot) -> Robot {
    let other = match robot.module_of(0).gain {
        Gain::Constant if robot.module_of(0).frequency_hz > 45_000 => GainProfile::Polaroid6500,
        Gain::Constant => GainProfile::Stepped,
        _ => GainProfile::Constant,
    };
    robot.clone().with_pattern(Some(other), None)
}
