//! The robot of a ring file, as it is judged in rooms.

use core::f64::consts::TAU;

use eeruf_core::Layout;
use eeruf_core::search::SearchError;
use eeruf_sim::modules::POLAROID_6500;
use eeruf_sim::{Pose, Robot, Transducer};

use crate::atlas::ATLAS;
use crate::find::{NoDesign, RingDesign};
use crate::ring::RingSpec;
use crate::shortest::Effort;

/// Radius, in metres, of a ring whose file gives no places: a choice, that of a small robot.
const RADIUS_M: f64 = 0.2;
/// Angle, in degrees, between sensors of a line whose file gives no places: that of the paper's ring.
const SPACING_DEG: f64 = 15.0;

/// The robot of a ring file, and the assumptions made about it.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomRobot {
    /// The robot.
    pub robot: Robot,
    /// Assumptions, each a sentence without a full stop.
    pub assumed: Vec<String>,
}

impl RingSpec {
    /// Returns the robot. Without places in the file, a ring is evenly spaced all round and a line has 15 degrees
    /// between sensors; without modules they are Polaroid 6500.
    ///
    /// # Errors
    /// A layout of pairs without places, which does not determine a robot.
    pub fn room_robot(&self) -> Result<RoomRobot, String> {
        let mut assumed = self.places.assumed.clone();
        let mut ring = self.robot_ring();
        let places = if self.places.poses.is_empty() {
            let spacing_deg = match self.layout.layout() {
                Layout::Ring(_) => 360.0 / self.sensors as f64,
                Layout::Line(_) => SPACING_DEG.min(360.0 / self.sensors as f64),
                _ => {
                    return Err("the ring file does not say where its sensors are, and its layout does not either; \
                                expected poses, or spacing_deg and radius_m"
                        .to_owned());
                }
            };
            assumed.push(format!(
                "sensors {spacing_deg} degrees apart on a circle of {RADIUS_M} m, as the file has no poses"
            ));
            let spacing = spacing_deg / 360.0 * TAU;
            Some(Robot::ring(Pose::identity(), self.sensors, spacing, RADIUS_M, Transducer::POLAROID_6500).sensors)
        } else {
            None
        };
        if self.modules.is_empty() {
            ring.modules = vec![POLAROID_6500; self.sensors];
            assumed.push("modules like the Polaroid 6500, as the file names none".to_owned());
        }
        let robot =
            Robot { others: self.others, reach: self.reach(), ..Robot::of_ring(&ring, Pose::identity(), places)? };
        Ok(RoomRobot { robot, assumed })
    }
}

/// The speed of a robot whose ring file has none, in m/s: a choice.
const USUAL_SPEED_M_S: f64 = 0.3;
/// The rate of turn of a robot whose file has none, in degrees a second: a choice.
const USUAL_TURN_DEG_S: f64 = 45.0;

/// Node budget of the search for a schedule of two phases, when ways of firing are compared in rooms.
const STUDY_BUDGET: u64 = 200_000;

impl RingSpec {
    /// The speed at which the ring's robot drives through rooms, in m/s: the file's, or else 0.3, a choice.
    pub fn room_speed_m_s(&self) -> f64 {
        self.speed_mm_s.filter(|&mm| mm > 0).map_or(USUAL_SPEED_M_S, |mm| f64::from(mm) / 1e3)
    }

    /// The rate at which the ring's robot turns in rooms, in degrees a second: the file's, or else 45, a choice.
    pub fn room_turn_deg_s(&self) -> f64 {
        self.turn_deg_s.filter(|&deg_s| deg_s > 0.0).unwrap_or(USUAL_TURN_DEG_S)
    }

    /// A short schedule of two phases, proven or not, for judging it in rooms; `None` if there is none.
    ///
    /// # Errors
    /// As for [`RingSpec::shortest`].
    pub fn shortest_to_study(&self) -> Result<Option<RingDesign>, SearchError> {
        let search = Effort { budget: STUDY_BUDGET, what_if: false, atlas: ATLAS };
        match self.shortest(&search, &mut ()) {
            Err(NoDesign::Search(error)) => Err(error),
            found => Ok(found.ok()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_stands_all_round_a_line_ahead_and_pairs_need_places() {
        let robot = |layout: &str| {
            let text = format!("sensors = 4\n{layout}\nt_delta_us = 100\nmin_interval_us = 0\nwindow_us = 20_000");
            RingSpec::from_text(&text).unwrap().room_robot()
        };
        let ring = robot("layout = \"ring\"").unwrap();
        let headings: Vec<_> =
            ring.robot.sensors.iter().map(|pose| pose.rotation.angle().to_degrees().round()).collect();
        assert_eq!(headings, [-135.0, -45.0, 45.0, 135.0]);
        assert_eq!(ring.assumed.len(), 2);
        assert_eq!(ring.robot.window.as_micros(), 20_000);
        let line = robot("layout = \"line\"\nspacing_deg = 30\nradius_m = 0.1\nmodule = \"hc-sr04\"").unwrap();
        assert!(line.assumed.is_empty());
        assert!((line.robot.radius_m() - 0.1).abs() < 1e-12);
        assert!(robot("layout = [[0, 1], [2, 3]]").unwrap_err().contains("expected poses"));
    }
}
