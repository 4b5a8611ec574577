//! Judgement of a ring under the conditions that its file names: by how soon it sees objects that appear, with the cost
//! of [`measure`](eeruf_sim::experiments::measure).

use core::ops::Range;

use eeruf_sim::Robot;
use eeruf_sim::experiments::measure::{
    Cell, Condition, Costs, Estimate, Family, MeasureAsked, Measured, Moving, ONE_A_MINUTE, Operating, Point, RoomWay,
    Setting, Speeds, Under, measure, with_other_gain,
};
use serde::{Serialize, Serializer};

use crate::asked::RoomsAsked;
use crate::find::RingDesign;
use crate::ring::RingSpec;
use crate::rooms::RoomRobot;
use crate::way::Way;

/// The number of the first room in which votes are chosen. They are not used for reports.
pub const CHOICE: u64 = 1_000;
/// Divisor of the number of rooms for conditions that the file does not name.
const LESS: u64 = 3;
/// Factors of the number of rooms, one after the other, while two ways do not differ significantly.
const MORE: [u64; 3] = [3, 6, 12];

/// Ways of firing a ring, judged in rooms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoomsAnswer {
    /// The way to recommend: one by one or flow; none if neither can fire the ring.
    #[serde(rename = "recommended", serialize_with = "name")]
    pub best: Option<RoomWay>,
    /// True if `best` has at most one false stop a minute under each condition; otherwise it has the fewest.
    pub keeps: bool,
    /// A kind of way that costs less, but not significantly.
    pub draw: Option<String>,
    /// Assumptions where the ring file is silent, each a sentence without a full stop.
    pub assumed: Vec<String>,
    /// The robot's speed in m/s.
    pub speed_m_s: f64,
    /// The rate of turn in degrees a second.
    pub turn_deg_s: f64,
    /// Number of rooms under each condition.
    pub rooms: usize,
    /// The recommended way under each condition.
    pub conditions: Vec<UnderCondition>,
    /// The best one by one under each condition, with any gap and votes.
    pub baseline: Vec<JudgedWay>,
    /// The kinds of ways that programs have, the simplest first.
    pub kinds: Vec<KindCost>,
    /// The kind to recommend where the ring is used under one condition alone, or its modules have the other gain. Only
    /// conditions that the ring file names are included unless everything was asked for.
    pub elsewhere: Vec<(String, Option<String>)>,
    /// Every way under each condition, with the votes that serve it best, if everything was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ways: Vec<JudgedWay>,
}

fn name<S: Serializer>(best: &Option<RoomWay>, serializer: S) -> Result<S::Ok, S::Error> {
    best.as_ref().map(|best| best.name).serialize(serializer)
}

/// A kind of way: its cheapest way that a program has, judged in the rooms where votes are chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindCost {
    /// The name.
    pub kind: String,
    /// True if it can be [recommended](Way::is_recommended).
    pub is_candidate: bool,
    /// The cost: the geometric mean over the conditions of the mean time until a thing is seen, relative to the best
    /// one by one; `None` if it has more than one false stop a minute under a condition.
    pub cost: Option<Estimate>,
    /// The way under each condition; empty if no program has one.
    pub best: Vec<JudgedWay>,
}

/// A way under a condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JudgedWay {
    /// The condition's name.
    pub condition: &'static str,
    /// The way's name.
    pub way: &'static str,
    /// The way and its votes in words.
    pub title: String,
    /// Votes that the way's readings need.
    pub votes: String,
    /// False for more than one false stop a minute in the rooms where votes are chosen.
    pub keeps: bool,
    /// False if no program fires like this: a way without quiet for each sensor, or a blocking loop.
    pub has_program: bool,
    /// The figures.
    #[serde(flatten)]
    pub figures: Cell,
    /// Share of time with an echo in which the belief is right, by kinds of rooms or the caller's; `None` without an
    /// echo.
    #[serde(serialize_with = "in_order")]
    pub rooms: Vec<(String, Option<f64>)>,
}

/// Serializes rooms as an object whose keys keep their order.
fn in_order<S: Serializer>(rooms: &[(String, Option<f64>)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rooms.iter().map(|(name, right)| (name, right)))
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

/// A way as programs have it: every reading that it accepts is believed.
fn as_program(way: usize) -> Vec<Point> {
    vec![Point { way, setting: Setting::ALL[0] }]
}

impl Both {
    /// The costs of the ways of some programs, relative to the best one by one.
    fn costs(&self, programs: &[(Family, usize)]) -> Costs {
        let groups: Vec<_> = programs.iter().map(|&(_, way)| as_program(way)).collect();
        self.measured.costs(&self.chosen, &self.chosen.families()[0], &groups)
    }

    /// The kind to recommend under one condition alone, or under all.
    fn recommended(&self, programs: &[(Family, usize)], condition: Option<Condition>) -> Option<String> {
        let only = |of: &Measured| of.only(|it| condition.is_none_or(|condition| it == condition), |_| true);
        let Self { chosen, measured } = self;
        let costs = Self { chosen: only(chosen), measured: only(measured) }.costs(programs);
        costs.recommended.map(|index| programs[index].0.to_string())
    }

    /// Compares the ways of two programs, the simpler first, in more and more rooms while they do not differ
    /// significantly: the one to recommend, and the other if it costs less, but not significantly, each by its index.
    /// `run` measures ways in the rooms from one multiple of the number of rooms to another.
    fn in_more_rooms(
        &self,
        two: [(Family, usize); 2],
        run: impl Fn(&[RoomWay], Range<u64>) -> Result<Measured, String>,
    ) -> Result<[Option<usize>; 2], String> {
        let kept = two.map(|(_, way)| way);
        let (chosen, two) = only(&self.chosen, &two, &kept);
        let mut measured = self.measured.only(|_| true, |way| kept.contains(&way));
        let groups: Vec<_> = two.iter().map(|&(_, way)| as_program(way)).collect();
        let (mut answer, mut done) = ([Some(0), Some(1)], 1);
        for times in MORE {
            measured.add(run(&measured.ways, done..times)?);
            let Costs { recommended, draw, rival, .. } = measured.costs(&chosen, &groups[0], &groups);
            (answer, done) = ([recommended, draw], times);
            if rival.is_none() {
                break;
            }
        }
        Ok(answer)
    }

    /// The way of the program with the fewest false stops, for rings where none keeps to one a minute.
    fn with_fewest_stops(&self, programs: &[(Family, usize)]) -> Option<usize> {
        let stops = |way: usize| {
            let judged = self.judged(&as_program(way));
            let under_all = judged.len() == self.measured.under.len();
            under_all.then(|| judged.iter().map(|of| of.figures.false_stops_per_min.value).sum::<f64>())
        };
        let fired = programs.iter().filter_map(|&(_, way)| Some((way, stops(way)?)));
        fired.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(way, _)| way)
    }

    /// The best of some points under each condition.
    fn judged(&self, points: &[Point]) -> Vec<JudgedWay> {
        let Self { chosen, measured } = self;
        let of = |(chooses, under): (&Under, &Under)| {
            let operating = chooses.operating(chosen, points, ONE_A_MINUTE)?;
            let point @ Point { way, setting } = operating.point();
            Some(JudgedWay {
                condition: under.condition.as_str(),
                way: measured.ways[way].name,
                title: measured.ways[way].in_words(setting),
                votes: setting.to_string(),
                keeps: matches!(operating, Operating::At(_)),
                has_program: Way::of(&measured.ways[way]).is_some(),
                figures: under.cell(point, measured),
                rooms: under.right_by_room(under.sights(point)),
            })
        };
        chosen.under.iter().zip(&measured.under).filter_map(of).collect()
    }

    /// A program's way under each condition.
    fn conditions(&self, way: usize) -> Vec<UnderCondition> {
        let of = |(under, judged): (&Under, JudgedWay)| {
            let Cell { t95_ms, false_stops_per_min, .. } = judged.figures;
            let drives = under.condition.moving == Moving::Driving;
            let speed_m_s = under.places.iter().map(|place| place.speed_m_s).sum::<f64>() / under.places.len() as f64;
            let travel_m = |t95_ms: f64| 1e-3 * t95_ms * speed_m_s;
            UnderCondition {
                condition: judged.condition,
                t95_ms: t95_ms.value,
                t95_ms_95: t95_ms.interval_95,
                blind_travel_m: drives.then(|| travel_m(t95_ms.value)),
                blind_travel_m_95: drives.then(|| t95_ms.interval_95.map(travel_m)),
                false_stops_per_min: false_stops_per_min.value,
                false_stops_per_min_95: false_stops_per_min.interval_95,
            }
        };
        self.measured.under.iter().zip(self.judged(&as_program(way))).map(of).collect()
    }
}

/// The cheapest way of each family that a program has, judged in the rooms where votes are chosen.
fn with_program(spec: &RingSpec, chosen: &Measured) -> Vec<(Family, usize)> {
    let fires =
        |way: &RoomWay| Way::of(way).is_some_and(|of| of == Way::TwoPhases || spec.fired(of, &way.robot, 1).is_ok());
    let programs: Vec<usize> = (0..chosen.ways.len()).filter(|&way| fires(&chosen.ways[way])).collect();
    let groups: Vec<_> = programs.iter().map(|&way| as_program(way)).collect();
    let costs = chosen.costs(chosen, &chosen.families()[0], &groups).costs;
    let cost = |index: usize| costs[index].cost.map_or(f64::INFINITY, |cost| cost.value);
    let of_family = |family: Family| {
        let of = programs.iter().copied().enumerate().filter(|&(_, way)| chosen.ways[way].family == family);
        of.min_by(|one, other| cost(one.0).total_cmp(&cost(other.0))).map(|(_, way)| (family, way))
    };
    Family::ALL.into_iter().filter_map(of_family).collect()
}

/// Returns the programs that can be recommended.
fn recommendable(measured: &Measured, programs: &[(Family, usize)]) -> Vec<(Family, usize)> {
    let is_usable = |of: &&(Family, usize)| Way::of(&measured.ways[of.1]).is_some_and(Way::is_recommended);
    programs.iter().filter(is_usable).copied().collect()
}

impl RingSpec {
    /// The conditions under which the ring is used: standing, driving and turning, alone; and if the file says that
    /// there are other robots, beside one of its make.
    pub fn used_under(&self) -> &'static [Condition] {
        if self.meets_others { &Condition::ALL } else { &Condition::ALL[..3] }
    }

    /// Judges the ways of firing the ring by their cost under the conditions in which it is used, with the schedule of
    /// two phases that was found for it.
    ///
    /// `keep_going` is called by several threads with the finished share of the current part, 0 to 1; if it returns
    /// `false`, the judgement stops.
    ///
    /// # Errors
    /// The reason, in words, if the ring has no places, a room cannot hold its robot, or `keep_going` stopped
    /// the judgement.
    pub fn judge_in_rooms(
        &self,
        design: Option<&RingDesign>,
        asked: &RoomsAsked,
        keep_going: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<RoomsAnswer, String> {
        // With the T_delta that the schedule needs where the robot moves.
        let RoomRobot { robot, assumed } = design.map_or(self, |design| &design.spec).room_robot()?;
        let (speed_m_s, turn_deg_s) = (self.room_speed_m_s(), self.room_turn_deg_s());
        let speeds = Speeds { speed_m_s, turn_rad_s: turn_deg_s.to_radians() };
        // A loop that blocks is no better than one by one 33 ms apart.
        let ways = |robot: &Robot| {
            let mut ways = RoomWay::all(robot, design.map(|design| &design.schedule));
            ways.retain(|way| asked.all || way.name != "blocking");
            ways
        };
        let run = |ways: &[RoomWay], conditions: &[Condition], asked: &RoomsAsked| -> Result<Measured, String> {
            let ways: Vec<_> = ways.iter().map(|way| (way.clone(), None)).collect();
            let RoomsAsked { own, places, first, .. } = asked.clone();
            let asked = MeasureAsked { conditions: conditions.into(), own, first, places, speeds };
            measure(&ways, &asked, keep_going).map_err(|error| error.to_string())
        };
        // In rooms of the caller's own there is no other robot.
        let used = if asked.own.is_empty() { self.used_under() } else { &Condition::ALL[..3] };
        let choice = RoomsAsked { own: vec![], first: CHOICE, ..asked.clone() };
        let chosen = run(&ways(&robot), used, &choice)?;
        let programs = with_program(design.map_or(self, |design| &design.spec), &chosen);
        // Without the rest of the ways: the best one by one, and what a program has.
        let one_by_one =
            chosen.under.iter().filter_map(|of| of.operating(&chosen, &chosen.families()[0], ONE_A_MINUTE));
        let kept: Vec<usize> =
            one_by_one.map(|of| of.point().way).chain(programs.iter().map(|&(_, way)| way)).collect();
        let (chosen, programs) = if asked.all { (chosen, programs) } else { only(&chosen, &programs, &kept) };
        let measured = run(&chosen.ways, used, asked)?;
        let here = Both { chosen, measured };
        let costs = here.costs(&programs).costs;
        let usable = recommendable(&here.measured, &programs);
        let Costs { mut recommended, mut draw, rival, .. } = here.costs(&usable);
        if let (Some(one), Some(other), true) = (recommended, rival, asked.own.is_empty()) {
            let of_two = here.in_more_rooms([usable[one], usable[other]], |ways, times| {
                let first = asked.first.saturating_add(asked.places * times.start);
                let more = RoomsAsked { first, places: asked.places * (times.end - times.start), ..asked.clone() };
                run(ways, used, &more)
            })?;
            [recommended, draw] = of_two.map(|of| of.map(|index| [one, other][index]));
        }
        let kind_of = |family: Family| {
            let index = programs.iter().position(|of| of.0 == family);
            KindCost {
                kind: family.to_string(),
                is_candidate: usable.iter().any(|of| of.0 == family),
                cost: index.and_then(|index| costs[index].cost),
                best: index.map_or_else(Vec::new, |index| here.judged(&as_program(programs[index].1))),
            }
        };
        let best = recommended.map_or_else(|| here.with_fewest_stops(&usable), |index| Some(usable[index].1));
        let alone = |both: &Both, under: Condition| (under.as_str().to_owned(), both.recommended(&usable, Some(under)));
        let mut elsewhere: Vec<_> = used.iter().map(|&under| alone(&here, under)).collect();
        let mut every = vec![];
        if asked.all {
            let of_way = |way| here.judged(&here.measured.points(|of| of == way));
            every = (0..here.measured.ways.len()).flat_map(of_way).collect();
            // Only named, and so chosen where it is measured.
            let fewer = RoomsAsked { places: asked.places.div_ceil(LESS), ..asked.clone() };
            let there = |robot: &Robot, conditions: &[Condition]| -> Result<Both, String> {
                let measured = run(&ways(robot), conditions, &fewer)?;
                Ok(Both { chosen: measured.clone(), measured })
            };
            let unused: Vec<_> = Condition::ALL.into_iter().filter(|condition| !used.contains(condition)).collect();
            if !unused.is_empty() && asked.own.is_empty() {
                let there = there(&robot, &unused)?;
                elsewhere.extend(unused.iter().map(|&under| alone(&there, under)));
            }
            let other = there(&with_other_gain(&robot), used)?;
            elsewhere.push(("other gain".to_owned(), other.recommended(&usable, None)));
        }
        Ok(RoomsAnswer {
            keeps: recommended.is_some(),
            draw: draw.map(|index| usable[index].0.to_string()),
            assumed,
            speed_m_s,
            turn_deg_s,
            rooms: here.measured.under.first().map_or(0, |under| under.places.len()),
            conditions: best.map_or_else(Vec::new, |way| here.conditions(way)),
            baseline: here.judged(&here.chosen.families()[0]),
            best: best.map(|way| here.measured.ways[way].clone()),
            kinds: Family::ALL.into_iter().map(kind_of).collect(),
            elsewhere,
            ways: every,
        })
    }
}

/// Returns the measurement of some of the ways, and the programs with their indices in it.
fn only(chosen: &Measured, programs: &[(Family, usize)], kept: &[usize]) -> (Measured, Vec<(Family, usize)>) {
    let index = |way: usize| (0..way).filter(|way| kept.contains(way)).count();
    let programs = programs.iter().map(|&(family, way)| (family, index(way))).collect();
    (chosen.only(|_| true, |way| kept.contains(&way)), programs)
}
