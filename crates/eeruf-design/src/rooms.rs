//! A ring file's ways of firing, judged in rooms, as the program, the page and Python print them.

use core::f64::consts::TAU;

use eeruf_core::Layout;
use eeruf_core::search::SearchError;
use eeruf_sim::experiments::ExperimentError;
use eeruf_sim::experiments::rooms::{
    Condition, JudgedWay, Judgement, RoomFigures, RoomGroup, RoomKind, RoomWay, RoomsOptions, judge,
};
use eeruf_sim::modules::POLAROID_6500;
use eeruf_sim::{Pose, Robot, Transducer};
use serde::{Serialize, Serializer};

use crate::asked::RoomsAsked;
use crate::atlas::ATLAS;
use crate::cost::CostAnswer;
use crate::find::{NoDesign, RingDesign};
use crate::ring::RingSpec;
use crate::shortest::Effort;
use crate::way::Way;

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

/// Ways of firing a ring, judged in rooms, and the assumptions of the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsAnswer {
    /// The judgement.
    pub judgement: Judgement,
    /// The names of the groups of rooms, and the number of rooms in each.
    pub groups: Vec<(String, usize)>,
    /// Assumptions about values that the ring file does not give, each a sentence without a full stop.
    pub assumed: Vec<String>,
    /// The robot's speed in m/s.
    pub speed_m_s: f64,
    /// The requested limit of the share of foreign sound.
    pub wrong: f64,
    /// Judgements under other conditions, in a third of the rooms; fewer than three if the judging was stopped.
    pub elsewhere: Vec<(Condition, Judgement)>,
    /// The ways compared by cost, if [requested](RingSpec::cost_in_rooms).
    pub by_cost: Option<CostAnswer>,
}

/// The speed of a robot whose ring file has none, in m/s: a choice.
const USUAL_SPEED_M_S: f64 = 0.3;
/// Divisor of the number of rooms under the other conditions.
const LESS_ELSEWHERE: usize = 3;

/// Budget of nodes for the schedule of two phases in the judgement.
const STUDY_BUDGET: u64 = 200_000;

impl RingSpec {
    /// The speed at which the ring's robot drives through rooms, in m/s: the file's, or else 0.3, a choice.
    pub fn room_speed_m_s(&self) -> f64 {
        self.speed_mm_s.filter(|&mm| mm > 0).map_or(USUAL_SPEED_M_S, |mm| f64::from(mm) / 1e3)
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

    /// Judges the ways of firing the ring, with the schedule of two phases that was found for it.
    ///
    /// Several threads call `keep_going` with the finished share of the current part; if it returns `false`, the
    /// judgement stops.
    ///
    /// # Errors
    /// A ring without places, no rooms, or a stop before the first judgement was complete, in words.
    pub fn judge_in_rooms(
        &self,
        design: Option<&RingDesign>,
        asked: &RoomsAsked,
        keep_going: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<RoomsAnswer, String> {
        let Set { ways, groups, here, assumed } = self.set(design, asked)?;
        let judgement = judge(&ways, &groups, &here, keep_going).map_err(in_words)?;
        let fewer: Vec<_> = groups
            .iter()
            .map(|RoomGroup { name, rooms }| RoomGroup {
                name: name.clone(),
                rooms: rooms.iter().step_by(LESS_ELSEWHERE).cloned().collect(),
            })
            .collect();
        let mut elsewhere = vec![];
        for condition in &Condition::ALL[1..] {
            match judge(&ways, &fewer, &RoomsOptions { condition: *condition, ..here.clone() }, keep_going) {
                Ok(judgement) => elsewhere.push((*condition, judgement)),
                Err(_) => break,
            }
        }
        let groups = groups.into_iter().map(|group| (group.name, group.rooms.len())).collect();
        let (speed_m_s, wrong) = (here.speed_m_s, asked.wrong);
        Ok(RoomsAnswer { judgement, groups, assumed, speed_m_s, wrong, elsewhere, by_cost: None })
    }
}

impl RingSpec {
    /// The way of firing the ring that [`judge_in_rooms`](Self::judge_in_rooms) recommends among those that a program
    /// can use, without judging other conditions; `None` if no way can fire it.
    ///
    /// # Errors
    /// See [`judge_in_rooms`](Self::judge_in_rooms).
    pub fn recommended_in_rooms(
        &self,
        design: Option<&RingDesign>,
        asked: &RoomsAsked,
        keep_going: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Option<RoomWay>, String> {
        let Set { mut ways, groups, here, .. } = self.set(design, asked)?;
        ways.retain(|way| Way::of(way).is_some());
        let judgement = judge(&ways, &groups, &here, keep_going).map_err(in_words)?;
        Ok(judgement.best().map(|judged| judged.way.clone()))
    }

    fn set(&self, design: Option<&RingDesign>, asked: &RoomsAsked) -> Result<Set, String> {
        // With the T_delta that the schedule needs if the robot moves.
        let spec = design.map_or(self, |design| &design.spec);
        let RoomRobot { robot, assumed } = spec.room_robot()?;
        let here = RoomsOptions {
            speed_m_s: if asked.driving { spec.room_speed_m_s() } else { 0.0 },
            wrong: asked.wrong,
            ..RoomsOptions::default()
        };
        let numbers = asked.first..asked.first.saturating_add(asked.places);
        let of_kind = |kind| RoomGroup::of_kind(kind, numbers.clone(), robot.radius_m());
        let groups = if asked.own.is_empty() { RoomKind::ALL.map(of_kind).into() } else { asked.own.clone() };
        Ok(Set { ways: RoomWay::all(&robot, design.map(|design| &design.schedule)), groups, here, assumed })
    }
}

/// Rooms and the ways that are judged in them.
struct Set {
    ways: Vec<RoomWay>,
    groups: Vec<RoomGroup>,
    here: RoomsOptions,
    assumed: Vec<String>,
}

fn in_words(error: ExperimentError) -> String {
    match error {
        ExperimentError::Stopped => "stopped before the rooms were judged".to_owned(),
        error => error.to_string(),
    }
}

impl RoomsAnswer {
    /// The answer in its JSON form.
    pub fn json(&self) -> RoomsJson<'_> {
        let ways = |judgement| ways_of(&self.groups, judgement);
        let elsewhere = self.elsewhere.iter().map(|(condition, judgement)| ElsewhereJson {
            condition: *condition,
            recommended: name_of(judgement),
            keeps: judgement.keeps,
            ways: ways(judgement),
        });
        RoomsJson {
            recommended: name_of(&self.judgement),
            keeps: self.judgement.keeps,
            assumed: &self.assumed,
            ways: ways(&self.judgement),
            elsewhere: elsewhere.collect(),
            by_cost: self.by_cost.as_ref(),
        }
    }
}

fn name_of(judgement: &Judgement) -> Option<&'static str> {
    judgement.best().map(|way| way.way.name)
}

/// Ways of firing judged in rooms, as JSON.
#[derive(Debug, Serialize)]
pub struct RoomsJson<'a> {
    /// The name of the way to recommend.
    pub recommended: Option<&'static str>,
    /// True if the way keeps to the limits in each kind of room.
    pub keeps: bool,
    /// Assumptions about values that the ring file does not give.
    pub assumed: &'a [String],
    ways: Vec<WayJson<'a>>,
    elsewhere: Vec<ElsewhereJson<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    by_cost: Option<&'a CostAnswer>,
}

#[derive(Debug, Serialize)]
struct ElsewhereJson<'a> {
    condition: Condition,
    recommended: Option<&'static str>,
    keeps: bool,
    ways: Vec<WayJson<'a>>,
}

#[derive(Debug, Serialize)]
struct WayJson<'a> {
    way: &'static str,
    title: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    not_possible: Option<&'a String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    blind_90: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    times_95: Option<[f64; 2]>,
    #[serde(serialize_with = "in_order")]
    rooms: Vec<(&'a str, &'a RoomFigures)>,
}

/// Serializes an object whose keys keep the order of the rooms.
fn in_order<S: Serializer>(rooms: &[(&str, &RoomFigures)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rooms.iter().copied())
}

/// The ways of a judgement, each with its figures by the names of rooms.
fn ways_of<'a>(groups: &'a [(String, usize)], judgement: &'a Judgement) -> Vec<WayJson<'a>> {
    let way = |way: &'a JudgedWay| WayJson {
        way: way.way.name,
        title: way.way.title(),
        not_possible: way.rooms.as_ref().err(),
        blind_90: way.rooms.is_ok().then_some(way.blind_90),
        times_95: way.times_95,
        rooms: groups.iter().map(|(name, _)| &**name).zip(way.rooms.iter().flatten()).collect(),
    };
    judgement.ways.iter().map(way).collect()
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
