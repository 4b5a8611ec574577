//! Judgement of a ring under the conditions that its file names: by how soon it sees objects that appear, with the cost
//! of [`measure`](eeruf_sim::experiments::measure).

use eeruf_sim::Robot;
use eeruf_sim::experiments::measure::{
    Cell, Condition, Costs, Estimate, Family, MeasureAsked, Measured, MeasuredWay, Moving, ONE_A_MINUTE, Operating,
    Point, Setting, Speeds, Under, measure, measured_ways,
};
use eeruf_sim::experiments::rooms::{RoomWay, with_other_gain};
use serde::Serialize;

use crate::asked::RoomsAsked;
use crate::find::RingDesign;
use crate::ring::RingSpec;
use crate::way::Way;

/// The rate of turn of a robot whose file has none, in degrees a second: a choice.
const USUAL_TURN_DEG_S: f64 = 45.0;
/// The number of the first room in which votes are chosen. They are not used for reports.
pub const CHOICE: u64 = 1_000;
/// Divisor of the number of rooms for choosing votes, and for conditions that the file does not name.
const LESS: u64 = 3;

/// Ways of firing a ring, compared by cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostAnswer {
    /// The kind of way to recommend; none if no kind has a setting of at most one false stop a minute under each
    /// condition.
    pub recommended: Option<String>,
    /// A cheaper kind that does not differ significantly from this one.
    pub draw: Option<String>,
    /// The robot's speed in m/s.
    pub speed_m_s: f64,
    /// The rate of turn in degrees a second.
    pub turn_deg_s: f64,
    /// The kinds of ways, the simplest first.
    pub kinds: Vec<KindCost>,
    /// The kind to recommend if the ring is used under one condition alone, or if its modules have the other gain.
    pub elsewhere: Vec<(String, Option<String>)>,
}

/// A kind of way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindCost {
    /// The name.
    pub kind: String,
    /// The cost: the geometric mean over the conditions of its t95, relative to the best one by one.
    pub cost: Option<Estimate>,
    /// The best way of this kind under each condition.
    pub best: Vec<BestWay>,
}

/// The best way of a kind under a condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BestWay {
    /// The condition's name.
    pub condition: &'static str,
    /// The way's name.
    pub way: &'static str,
    /// Votes that the way's readings need.
    pub votes: String,
    /// False if the way has more than one false stop a minute in the rooms where votes were chosen; every way of its
    /// kind then has.
    pub keeps: bool,
    /// The figures.
    #[serde(flatten)]
    pub figures: Cell,
}

/// A way under a condition, each figure with its 95 % interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnderCondition {
    /// The condition's name.
    pub condition: &'static str,
    /// The time within which 95 % of appearing objects are seen, in ms; infinite, and null in JSON, if fewer are seen.
    pub t95_ms: f64,
    /// 95 % interval of `t95_ms`.
    pub t95_ms_95: [f64; 2],
    /// The distance that the robot drives within `t95_ms`, in metres; none if it does not drive.
    pub blind_travel_m: Option<f64>,
    /// 95 % interval of `blind_travel_m`.
    pub blind_travel_m_95: Option<[f64; 2]>,
    /// Number of false stops per minute.
    pub false_stops_per_min: f64,
    /// 95 % interval of `false_stops_per_min`.
    pub false_stops_per_min_95: [f64; 2],
}

/// Measurements in rooms for choosing votes, and in rooms for the report.
struct Both {
    chosen: Measured,
    measured: Measured,
}

impl Both {
    /// Returns the measurements under these conditions only.
    fn under(&self, conditions: &[Condition]) -> Self {
        let only = |of: &Measured| Measured {
            ways: of.ways.clone(),
            under: of.under.iter().filter(|under| conditions.contains(&under.condition)).cloned().collect(),
        };
        Self { chosen: only(&self.chosen), measured: only(&self.measured) }
    }

    fn costs(&self) -> Costs {
        self.measured.costs(&self.chosen, &self.measured.families())
    }

    fn recommended(&self) -> Option<String> {
        self.costs().recommended.map(name_of)
    }

    fn best(&self, family: Family) -> Vec<BestWay> {
        let Self { chosen, measured } = self;
        let of = |(chooses, under): (&Under, &Under)| {
            let operating = chooses.operating(chosen, |way| measured.ways[way].family == family, ONE_A_MINUTE)?;
            let point = operating.point();
            Some(BestWay {
                condition: under.condition.as_str(),
                way: measured.ways[point.way].way.name,
                votes: point.setting.to_string(),
                keeps: matches!(operating, Operating::At(_)),
                figures: under.cell(point, measured),
            })
        };
        chosen.under.iter().zip(&measured.under).filter_map(of).collect()
    }
}

fn name_of(family: usize) -> String {
    Family::ALL[family].to_string()
}

impl RingSpec {
    /// The rate at which the ring's robot turns in rooms, in degrees a second: the file's, or else 45, a choice.
    pub fn room_turn_deg_s(&self) -> f64 {
        self.turn_deg_s.filter(|&deg_s| deg_s > 0.0).unwrap_or(USUAL_TURN_DEG_S)
    }

    /// The conditions under which the ring is used: standing, driving and turning, alone; and if the file says that
    /// there are other robots, beside one of its make.
    pub fn used_under(&self) -> &'static [Condition] {
        if self.meets_others { &Condition::ALL } else { &Condition::ALL[..3] }
    }

    /// The figures of one way, which believes what it accepts, under the conditions in which the ring is used.
    ///
    /// `keep_going` is as for [`judge_in_rooms`](Self::judge_in_rooms).
    ///
    /// # Errors
    /// A room in which the robot does not fit, or a stop by `keep_going`, in words.
    pub fn way_in_rooms(
        &self,
        way: &RoomWay,
        asked: &RoomsAsked,
        keep_going: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Vec<UnderCondition>, String> {
        let robot = Robot { odometry: true, ..way.robot.clone() };
        let ways = [(MeasuredWay { family: Family::OneByOne, way: RoomWay { robot, ..way.clone() } }, None)];
        let RoomsAsked { first, places, .. } = *asked;
        let speeds = Speeds { speed_m_s: self.room_speed_m_s(), turn_rad_s: self.room_turn_deg_s().to_radians() };
        let asked = MeasureAsked { conditions: self.used_under().into(), first, places, speeds };
        let measured = measure(&ways, &asked, keep_going).map_err(|error| error.to_string())?;
        let point = Point { way: 0, setting: Setting::ALL[0] };
        let of = |under: &Under| {
            let Cell { t95_ms, false_stops_per_min, .. } = under.cell(point, &measured);
            let drives = under.condition.moving == Moving::Driving;
            let speed_m_s = under.places.iter().map(|place| place.speed_m_s).sum::<f64>() / under.places.len() as f64;
            let travel_m = |t95_ms: f64| 1e-3 * t95_ms * speed_m_s;
            UnderCondition {
                condition: under.condition.as_str(),
                t95_ms: t95_ms.value,
                t95_ms_95: t95_ms.interval_95,
                blind_travel_m: drives.then(|| travel_m(t95_ms.value)),
                blind_travel_m_95: drives.then(|| t95_ms.interval_95.map(travel_m)),
                false_stops_per_min: false_stops_per_min.value,
                false_stops_per_min_95: false_stops_per_min.interval_95,
            }
        };
        Ok(measured.under.iter().map(of).collect())
    }

    /// Judges the ways of firing the ring by their cost under the conditions in which it is used, with the schedule of
    /// two phases that was found for it.
    ///
    /// `keep_going` is as for [`judge_in_rooms`](Self::judge_in_rooms).
    ///
    /// # Errors
    /// A ring without places, or a stop by `keep_going`, in words.
    pub fn cost_in_rooms(
        &self,
        design: Option<&RingDesign>,
        asked: &RoomsAsked,
        keep_going: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<CostAnswer, String> {
        let robot = design.map_or(self, |design| &design.spec).room_robot()?.robot;
        let (speed_m_s, turn_deg_s) = (self.room_speed_m_s(), self.room_turn_deg_s());
        let speeds = Speeds { speed_m_s, turn_rad_s: turn_deg_s.to_radians() };
        let run = |robot: &Robot, conditions: &[Condition], first, places| -> Result<Measured, String> {
            let ways = measured_ways(robot, design.map(|design| &design.schedule)).into_iter();
            // Except for one by one, only the ways that a program can use.
            let has_program = |of: &MeasuredWay| of.family == Family::OneByOne || Way::of(&of.way).is_some();
            let ways: Vec<_> = ways.filter(has_program).map(|way| (way, None)).collect();
            let asked = MeasureAsked { conditions: conditions.into(), first, places, speeds };
            measure(&ways, &asked, keep_going).map_err(|error| error.to_string())
        };
        let (used, fewer) = (self.used_under(), asked.places.div_ceil(LESS));
        let here =
            Both { chosen: run(&robot, used, CHOICE, fewer)?, measured: run(&robot, used, asked.first, asked.places)? };
        let Costs { costs, recommended, draw } = here.costs();
        let kinds = Family::ALL.into_iter().zip(costs).map(|(family, cost)| KindCost {
            kind: family.to_string(),
            cost: cost.cost,
            best: here.best(family),
        });
        // Only the name is used, so votes are chosen in the measured rooms.
        let there = |robot: &Robot, conditions: &[Condition]| -> Result<Both, String> {
            let measured = run(robot, conditions, asked.first, fewer)?;
            Ok(Both { chosen: measured.clone(), measured })
        };
        let unused: Vec<_> = Condition::ALL.into_iter().filter(|condition| !used.contains(condition)).collect();
        let unused = if unused.is_empty() { None } else { Some(there(&robot, &unused)?) };
        let alone = |condition: Condition| {
            let of = if used.contains(&condition) { Some(&here) } else { unused.as_ref() };
            (condition.as_str().to_owned(), of.and_then(|of| of.under(&[condition]).recommended()))
        };
        let mut elsewhere: Vec<_> = Condition::ALL.into_iter().map(alone).collect();
        elsewhere.push(("other gain".to_owned(), there(&with_other_gain(&robot), used)?.recommended()));
        Ok(CostAnswer {
            recommended: recommended.map(name_of),
            draw: draw.map(name_of),
            speed_m_s,
            turn_deg_s,
            kinds: kinds.collect(),
            elsewhere,
        })
    }
}
