//! Temporary faults in a world: of sensors, wires, lines, clocks and tables; and people and doors in the way.

use eeruf_files::AnySchedule;
use serde::{Deserialize, Deserializer, Serialize};

use super::error::WorldError;
use super::robot::Robot;
use crate::{
    geometry::Point,
    scene::{Faces, Pole, Scene, Wall},
};

/// Latest start or end of a fault, in seconds, unless it never ends.
const LATEST_S: f64 = 1e9;

/// A fault from one time to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The kind of fault.
    pub kind: FaultKind,
    /// The robot concerned, counted from 0.
    pub robot: usize,
    /// The sensors concerned, counted from 0; empty for all.
    pub sensors: Vec<u8>,
    /// Start, in seconds.
    pub from_s: f64,
    /// End, in seconds; infinite for never.
    pub to_s: f64,
}

/// A kind of fault.
///
/// On a module that answers with a pulse, a low glitch looks like the edge of the echo, and a high glitch has no
/// effect. On a module whose line rises with the echo, the two are exchanged.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum FaultKind {
    /// This share of echoes is lost.
    Lost {
        /// 0 to 1.
        share: f64,
    },
    /// Random edges occur while a sensor listens.
    Noise {
        /// Rate, in 1/s.
        per_s: f64,
    },
    /// A random edge in this share of firings, uniform over the window.
    UniformNoise {
        /// 0 to 1.
        share: f64,
    },
    /// The echo lines of two sensors are exchanged.
    EchoWires,
    /// The trigger lines of two sensors are exchanged.
    TriggerWires,
    /// Triggers arrive late.
    LateTrigger {
        /// Delay, in us.
        us: u32,
    },
    /// The ring fires by another table than the robot's, from the end of a period on.
    OtherTable {
        /// The table.
        #[serde(deserialize_with = "boxed", serialize_with = "eeruf_files::as_file::serialize")]
        schedule: Box<AnySchedule>,
    },
    /// The clock runs too fast or too slow.
    ClockDrift {
        /// Drift, in parts per million.
        ppm: f64,
    },
    /// The sensor is missing: there is neither sound nor an edge.
    Missing,
    /// The line stays high: it does not fall, and the sensor is not triggered again.
    Stuck,
    /// The echo line is cut: there is sound, but no edge.
    Cut,
    /// One rise in every this many causes no interrupt.
    LostRises {
        /// 1 for all.
        every: u32,
    },
    /// One fall in every this many causes no interrupt.
    LostFalls {
        /// 1 for all.
        every: u32,
    },
    /// The line is low for a moment while it should be high.
    GlitchLow {
        /// Time after the rise, in us.
        after_us: u32,
        /// Duration, in us.
        width_us: u32,
    },
    /// The line is high for a moment while it should be low.
    GlitchHigh {
        /// Time in us after the line fell or, if it rises with the echo, after the trigger.
        after_us: u32,
        /// Duration, in us.
        width_us: u32,
    },
    /// A leg walks by in a straight line during the fault.
    Leg {
        /// The radius in metres.
        radius_m: f64,
        /// Start point.
        from_m: [f64; 2],
        /// End point.
        to_m: [f64; 2],
    },
    /// A door turns from one angle to another during the fault.
    Door {
        /// The hinge.
        hinge_m: [f64; 2],
        /// The width in metres.
        length_m: f64,
        /// The door's direction before the fault, in degrees counter-clockwise from the x axis.
        from_deg: f64,
        /// The door's direction after the fault, in degrees.
        to_deg: f64,
    },
}

fn boxed<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Box<AnySchedule>, D::Error> {
    eeruf_files::as_file::deserialize(deserializer).map(Box::new)
}

impl FaultKind {
    /// The names in files.
    pub const NAMES: [&'static str; 17] = [
        "lost",
        "noise",
        "uniform_noise",
        "echo_wires",
        "trigger_wires",
        "late_trigger",
        "other_table",
        "clock_drift",
        "missing",
        "stuck",
        "cut",
        "lost_rises",
        "lost_falls",
        "glitch_low",
        "glitch_high",
        "leg",
        "door",
    ];

    /// Returns the name in files.
    pub fn name(&self) -> &'static str {
        let index = match self {
            Self::Lost { .. } => 0,
            Self::Noise { .. } => 1,
            Self::UniformNoise { .. } => 2,
            Self::EchoWires => 3,
            Self::TriggerWires => 4,
            Self::LateTrigger { .. } => 5,
            Self::OtherTable { .. } => 6,
            Self::ClockDrift { .. } => 7,
            Self::Missing => 8,
            Self::Stuck => 9,
            Self::Cut => 10,
            Self::LostRises { .. } => 11,
            Self::LostFalls { .. } => 12,
            Self::GlitchLow { .. } => 13,
            Self::GlitchHigh { .. } => 14,
            Self::Leg { .. } => 15,
            Self::Door { .. } => 16,
        };
        Self::NAMES[index]
    }

    /// Returns true for faults that change the scene instead of a robot.
    pub(crate) fn is_of_scene(&self) -> bool {
        matches!(self, Self::Leg { .. } | Self::Door { .. })
    }
}

impl Fault {
    /// Makes a fault that lasts from the beginning without an end, for all sensors of the first robot.
    pub const fn new(kind: FaultKind) -> Self {
        Self { kind, robot: 0, sensors: vec![], from_s: 0.0, to_s: f64::INFINITY }
    }

    /// Returns the fault for these sensors only.
    #[must_use]
    pub fn of_sensors(self, sensors: &[u8]) -> Self {
        Self { sensors: sensors.to_vec(), ..self }
    }

    /// Returns the fault with this start and end, in seconds.
    #[must_use]
    pub fn between(self, from_s: f64, to_s: f64) -> Self {
        Self { from_s, to_s, ..self }
    }

    /// Returns true if the fault is active at a time, in seconds.
    pub fn is_at(&self, time_s: f64) -> bool {
        (self.from_s..self.to_s).contains(&time_s)
    }

    /// Returns true if the fault concerns a sensor.
    pub fn is_of(&self, robot: usize, sensor: u8) -> bool {
        !self.kind.is_of_scene() && self.robot == robot && (self.sensors.is_empty() || self.sensors.contains(&sensor))
    }

    /// Returns the sensor whose wire is exchanged with this sensor's.
    pub(crate) fn exchanged(&self, sensor: u8) -> u8 {
        match self.sensors[..] {
            [one, other] if sensor == one => other,
            [one, other] if sensor == other => one,
            _ => sensor,
        }
    }

    /// Adds the objects that the fault puts into the scene at a time.
    pub(crate) fn obstacles(&self, time_s: f64, walls: &mut Vec<Wall>, poles: &mut Vec<Pole>) {
        let share = if self.to_s > self.from_s && self.to_s.is_finite() {
            ((time_s - self.from_s) / (self.to_s - self.from_s)).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(time_s >= self.from_s))
        };
        let between = |from: f64, to: f64| from + share * (to - from);
        match self.kind {
            FaultKind::Leg { radius_m, from_m, to_m } if self.is_at(time_s) => {
                poles.push(Pole::new(between(from_m[0], to_m[0]), between(from_m[1], to_m[1]), radius_m));
            }
            FaultKind::Door { hinge_m, length_m, from_deg, to_deg } => {
                let angle = between(from_deg, to_deg).to_radians();
                let end =
                    Point::new(hinge_m[0] + length_m * libm::cos(angle), hinge_m[1] + length_m * libm::sin(angle));
                walls.push(Wall::new(hinge_m[0], hinge_m[1], end.x, end.y).with_faces(Faces::Both));
            }
            _ => {}
        }
    }

    /// Checks the fault.
    pub(super) fn check(&self, index: usize, robots: &[Robot]) -> Result<(), WorldError> {
        let fail = |field, value, expected| Err(WorldError::Fault { fault: index, field, value, expected });
        let Some(robot) = robots.get(self.robot) else {
            return fail("robot", self.robot as f64, "a number below that of the robots: they count from 0");
        };
        if let Some(&sensor) = self.sensors.iter().find(|&&sensor| usize::from(sensor) >= robot.sensors.len()) {
            return fail(
                "sensors",
                f64::from(sensor),
                "numbers below its robot's number of sensors: they count from 0",
            );
        }
        if !(0.0..=LATEST_S).contains(&self.from_s) {
            return fail("from_s", self.from_s, "0 to 1e9");
        }
        if !(self.to_s > self.from_s) {
            return fail("to_s", self.to_s, "more than from_s");
        }
        let share = |share: f64| (0.0..=1.0).contains(&share);
        let length = |metres: f64| metres > 0.0 && metres <= 100.0;
        match self.kind {
            FaultKind::Lost { share: value } | FaultKind::UniformNoise { share: value } if !share(value) => {
                fail("share", value, "0 to 1")
            }
            FaultKind::Noise { per_s } if !(0.0..=1e5).contains(&per_s) => fail("per_s", per_s, "0 to 100000"),
            FaultKind::EchoWires | FaultKind::TriggerWires
                if self.sensors.len() != 2 || self.sensors[0] == self.sensors[1] =>
            {
                fail("sensors", self.sensors.len() as f64, "two different ones")
            }
            FaultKind::LateTrigger { us } if us > 100_000 => fail("us", f64::from(us), "0 to 100000"),
            FaultKind::OtherTable { ref schedule } if schedule.sensors() != robot.sensors.len() => {
                fail("schedule", schedule.sensors() as f64, "a table for as many sensors as the robot has")
            }
            FaultKind::ClockDrift { .. } if !self.sensors.is_empty() => {
                fail("sensors", self.sensors.len() as f64, "none: a clock is that of a robot")
            }
            FaultKind::ClockDrift { ppm } if !(-1e5..=1e5).contains(&ppm) => fail("ppm", ppm, "-100000 to 100000"),
            FaultKind::LostRises { every: 0 } | FaultKind::LostFalls { every: 0 } => fail("every", 0.0, "1 or more"),
            FaultKind::Leg { radius_m, .. } if !length(radius_m) => {
                fail("radius_m", radius_m, "more than 0, up to 100")
            }
            FaultKind::Leg { .. } if !self.to_s.is_finite() => {
                fail("to_s", self.to_s, "a time at which it has arrived")
            }
            FaultKind::Door { length_m, .. } if !length(length_m) => {
                fail("length_m", length_m, "more than 0, up to 100")
            }
            _ => Ok(()),
        }
    }
}

/// Returns the scene with the objects of faults at a time.
///
/// # Errors
/// See [`Scene::new`].
pub(crate) fn scene_with(scene: &Scene, faults: &[Fault], time_s: f64) -> Result<Scene, WorldError> {
    let (mut walls, mut poles) = (scene.walls().to_vec(), scene.poles().to_vec());
    for fault in faults {
        fault.obstacles(time_s, &mut walls, &mut poles);
    }
    Ok(Scene::new(walls, poles, scene.air())?.with_room(scene.room().copied())?)
}
