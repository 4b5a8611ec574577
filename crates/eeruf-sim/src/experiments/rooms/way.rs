//! The ways of firing that are judged in rooms, made for one ring.

use eeruf_core::Micros;
use serde::Serialize;

use crate::{
    methods::Method,
    simulation::Options,
    world::{AnySchedule, Robot},
};

/// A way of firing a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomWay {
    /// The name in tables and in JSON: the method's name, with the differences.
    pub name: &'static str,
    /// The method.
    pub method: Method,
    /// The robot with the settings of this way.
    pub robot: Robot,
    /// Settings of the method.
    pub options: Options,
}

impl RoomWay {
    /// Returns the ways for a ring, the baselines first. All listen for the robot's window, but flow for no longer than
    /// its [reach](Robot::reach).
    ///
    /// `schedule` is the shortest schedule of two phases for the ring; without it there are no ways of two phases. No
    /// way uses `robot.period`.
    pub fn all(robot: &Robot, schedule: Option<&AnySchedule>) -> Vec<Self> {
        let way = |name, method, period: Micros| Self {
            name,
            method,
            robot: Robot { period, odometry: false, ..robot.clone() },
            options: Options::default(),
        };
        // A module may neither be triggered before its rest is over, nor while it may still hear its own sound.
        let rest = robot.module_rest().max(robot.audible).max(robot.window).saturating_add(Micros::new(1));
        let mut ways = vec![
            way("sequential", Method::Sequential, rest),
            way("sequential_votes", Method::SequentialVotes, rest),
            way("sequential_median", Method::SequentialMedian, rest),
            way("simultaneous", Method::Simultaneous, rest),
            way("far_groups", Method::FarGroups, rest),
        ];
        if robot.sensors.len() >= 4 {
            let mut arrays = way("arrays", Method::Arrays, rest);
            arrays.robot.firing.turn = robot.audible.max(robot.window);
            arrays.robot.firing.rest = Some(robot.module_rest());
            ways.push(arrays);
        }
        // The schedule runs at its own period, at 1.5 times, and at twice the period.
        for (name, (numerator, denominator)) in [("eeruf", (1, 1)), ("eeruf_x1.5", (3, 2)), ("eeruf_x2", (2, 1))] {
            let scaled = schedule.and_then(|schedule| schedule.scaled(numerator, denominator).ok());
            ways.extend(scaled.map(|schedule| {
                let mut way = way(name, Method::Eeruf, schedule.period());
                way.robot.schedule = Some(schedule);
                way
            }));
        }
        let flow = way("flow", Method::Flow, rest);
        ways.push(Self { robot: flow.robot.by_flow(), ..flow });
        ways
    }

    /// Returns true if a program for a board can fire this way.
    pub fn has_program(&self) -> bool {
        matches!(self.method, Method::Sequential | Method::FarGroups | Method::Flow) || self.name == "eeruf"
    }

    /// Returns the name with its meaning, for tables.
    pub fn title(&self) -> &'static str {
        match self.name {
            "sequential" => "one by one",
            "sequential_votes" => "one by one, two of three agree",
            "sequential_median" => "one by one, median of three",
            "simultaneous" => "all at once",
            "far_groups" => "groups far apart",
            "arrays" => "two arrays, each in turn",
            "eeruf" => "two phases, shortest period",
            "eeruf_x1.5" => "two phases, half as long again",
            "eeruf_x2" => "two phases, twice as long",
            _ => "flow",
        }
    }
}

/// Conditions on which answers may depend: the modules' gain, and floor and ceiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Condition {
    /// True for the gain that the modules do not have: stepped instead of constant, or constant instead of growing.
    pub other_gain: bool,
    /// True for rooms without floor and ceiling.
    pub flat: bool,
}

impl Condition {
    /// All four, the usual one first: the modules' own gain, between floor and ceiling.
    pub const ALL: [Self; 4] = [
        Self { other_gain: false, flat: false },
        Self { other_gain: true, flat: false },
        Self { other_gain: false, flat: true },
        Self { other_gain: true, flat: true },
    ];
}
