//! A ring judged as its file says it is used: how soon it sees what appears, by the one cost of
//! [`measure`](eeruf_sim::experiments::measure).

use eeruf_sim::Robot;
use eeruf_sim::experiments::measure::{
    Cell, Condition, Costs, Estimate, Family, MeasureAsked, Measured, ONE_A_MINUTE, Operating, Point, RoomWay, Speeds,
    Under, measure, with_other_gain,
};
use serde::{Serialize, Serializer};

use crate::asked::RoomsAsked;
use crate::find::RingDesign;
use crate::ring::RingSpec;
use crate::rooms::RoomRobot;
use crate::way::Way;

/// The number of the first room in which votes are chosen. Nothing is reported from them.
pub const CHOICE: u64 = 1_000;
/// A third of the rooms are looked at where the file does not say that the ring is used.
const LESS: u64 = 3;

/// Ways of firing a ring, judged in rooms: what the program and Python print.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoomsAnswer {
    /// The way to recommend; none if no way that a program has can fire the ring.
    #[serde(rename = "recommended", serialize_with = "name")]
    pub best: Option<RoomWay>,
    /// True if it has at most one false stop a minute under each condition; else it has the fewest.
    pub keeps: bool,
    /// A kind of way of less cost from which it does not surely differ.
    pub draw: Option<String>,
    /// Assumptions where the ring file is silent, each a sentence without a full stop.
    pub assumed: Vec<String>,
    /// The robot's speed in m/s.
    pub speed_m_s: f64,
    /// The rate of turn in degrees a second.
    pub turn_deg_s: f64,
    /// Number of rooms under each condition.
    pub rooms: usize,
    /// The kinds of ways, the simplest first.
    pub kinds: Vec<KindCost>,
    /// The kind to recommend where the ring is used under one condition alone, or its modules have the other gain;
    /// only where the file says it is used, if not all was asked for.
    pub elsewhere: Vec<(String, Option<String>)>,
    /// Every way under each condition, if all was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ways: Vec<JudgedWay>,
}

fn name<S: Serializer>(best: &Option<RoomWay>, serializer: S) -> Result<S::Ok, S::Error> {
    best.as_ref().map(|best| best.name).serialize(serializer)
}

/// A kind of way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindCost {
    /// The name.
    pub kind: String,
    /// The cost: the geometric mean over the conditions of its t95, relative to the best one by one.
    pub cost: Option<Estimate>,
    /// The best way of the kind under each condition.
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
    /// Votes that its readings need.
    pub votes: String,
    /// False for more than one false stop a minute where votes were chosen.
    pub keeps: bool,
    /// The figures.
    #[serde(flatten)]
    pub figures: Cell,
    /// Share of time with an echo in which its belief is right, by kinds of rooms or the caller's; none without an echo.
    #[serde(serialize_with = "in_order")]
    pub rooms: Vec<(String, Option<f64>)>,
}

/// As an object whose keys keep the order of the rooms.
fn in_order<S: Serializer>(rooms: &[(String, Option<f64>)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rooms.iter().map(|(name, right)| (name, right)))
}

/// Measurements in rooms for choosing votes, and in those that are reported.
struct Both {
    chosen: Measured,
    measured: Measured,
}

impl Both {
    fn costs(&self) -> Costs {
        self.measured.costs(&self.chosen, &self.measured.families())
    }

    /// The kind to recommend under one condition alone, or under all.
    fn recommended(&self, condition: Option<Condition>) -> Option<String> {
        let only = |of: &Measured| of.only(|it| condition.is_none_or(|condition| it == condition), |_| true);
        let Self { chosen, measured } = self;
        Self { chosen: only(chosen), measured: only(measured) }.costs().recommended.map(name_of)
    }

    /// Some of the ways, at the best of their points under each condition.
    fn judged(&self, ways: impl Fn(&RoomWay) -> bool) -> Vec<JudgedWay> {
        let Self { chosen, measured } = self;
        let of = |(chooses, under): (&Under, &Under)| {
            let operating = chooses.operating(chosen, |way| ways(&measured.ways[way]), ONE_A_MINUTE)?;
            let point @ Point { way, setting } = operating.point();
            Some(JudgedWay {
                condition: under.condition.as_str(),
                way: measured.ways[way].name,
                title: measured.ways[way].in_words(setting),
                votes: setting.to_string(),
                keeps: matches!(operating, Operating::At(_)),
                figures: under.cell(point, measured),
                rooms: under.right_by_room(under.sights(point)),
            })
        };
        chosen.under.iter().zip(&measured.under).filter_map(of).collect()
    }
}

fn name_of(family: usize) -> String {
    Family::ALL[family].to_string()
}

/// The way of each family that a program has: of several the one of least cost where votes are chosen.
fn with_program(chosen: &Measured) -> Vec<(Family, usize)> {
    let programs: Vec<usize> = (0..chosen.ways.len()).filter(|&way| Way::of(&chosen.ways[way]).is_some()).collect();
    let mut groups = chosen.families();
    groups.truncate(1);
    groups.extend(programs.iter().map(|&way| vec![way]));
    let costs = chosen.costs(chosen, &groups).costs;
    let cost = |way: &(usize, usize)| costs[1 + way.0].cost.map_or(f64::INFINITY, |cost| cost.value);
    let of_family = |family: Family| {
        let of = programs.iter().copied().enumerate().filter(|&(_, way)| chosen.ways[way].family == family);
        of.min_by(|one, other| cost(one).total_cmp(&cost(other))).map(|(_, way)| (family, way))
    };
    Family::ALL.into_iter().filter_map(of_family).collect()
}

impl RingSpec {
    /// The conditions under which it is used: standing, driving and turning, alone; where the file says that there are
    /// others, beside another robot of its make too.
    pub fn used_under(&self) -> &'static [Condition] {
        if self.meets_others { &Condition::ALL } else { &Condition::ALL[..3] }
    }

    /// Judges the ways of firing the ring by their cost under the conditions in which it is used, with the schedule of
    /// two phases that was found for it.
    ///
    /// `keep_going` is called by several threads with the share that is done of the part under way; when its answer is
    /// `false` the judgement stops.
    ///
    /// # Errors
    /// A ring without places, a room in which its robot cannot be, and if it was stopped, in words.
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
        let fewer = RoomsAsked { places: asked.places.div_ceil(LESS), ..asked.clone() };
        let choice = RoomsAsked { own: vec![], first: CHOICE, ..asked.clone() };
        let mut chosen = run(&ways(&robot), used, &choice)?;
        let mut programs = with_program(&chosen);
        if !asked.all {
            // What is best of its kind, and what a program has.
            let best = chosen.best_of_families();
            let kept = |way: usize| best.contains(&way) || programs.iter().any(|&(_, program)| program == way);
            let index = |way: usize| (0..way).filter(|&way| kept(way)).count();
            let only = chosen.only(|_| true, kept);
            programs = programs.iter().map(|&(family, way)| (family, index(way))).collect();
            chosen = only;
        }
        let measured = run(&chosen.ways, used, asked)?;
        let here = Both { chosen, measured };
        let Costs { costs, recommended, draw } = here.costs();
        let kinds = Family::ALL.into_iter().zip(costs).map(|(family, cost)| KindCost {
            kind: family.to_string(),
            cost: cost.cost,
            best: here.judged(|way| way.family == family),
        });
        let kinds: Vec<_> = kinds.collect();
        // Where none keeps to one a minute, the fewest false stops.
        let stops = |&&(family, _): &&(Family, usize)| {
            let of = kinds.iter().filter(|kind| kind.kind == family.to_string()).flat_map(|kind| &kind.best);
            of.map(|best| best.figures.false_stops_per_min.value).sum::<f64>()
        };
        let fires = |of: &&(Family, usize)| here.measured.under.iter().all(|under| under.sights[of.1].is_ok());
        let family = recommended.map(|family| Family::ALL[family]).or_else(|| {
            let fewest = programs.iter().filter(fires).min_by(|one, other| stops(one).total_cmp(&stops(other)));
            fewest.map(|&(family, _)| family)
        });
        let best = programs.iter().find(|of| Some(of.0) == family).map(|&(_, way)| here.measured.ways[way].clone());
        let named = |condition: Condition| condition.as_str().to_owned();
        let mut elsewhere: Vec<_> = used.iter().map(|&under| (named(under), here.recommended(Some(under)))).collect();
        let mut every = vec![];
        if asked.all {
            every = here.measured.ways.iter().flat_map(|way| here.judged(|of| of.name == way.name)).collect();
            // Only named, and so chosen where it is measured.
            let there = |robot: &Robot, conditions: &[Condition]| -> Result<Both, String> {
                let measured = run(&ways(robot), conditions, &fewer)?;
                Ok(Both { chosen: measured.clone(), measured })
            };
            let unused: Vec<_> = Condition::ALL.into_iter().filter(|condition| !used.contains(condition)).collect();
            if !unused.is_empty() && asked.own.is_empty() {
                let there = there(&robot, &unused)?;
                elsewhere.extend(unused.iter().map(|&under| (named(under), there.recommended(Some(under)))));
            }
            elsewhere.push(("other gain".to_owned(), there(&with_other_gain(&robot), used)?.recommended(None)));
        }
        let rooms = here.measured.under.first().map_or(0, |under| under.places.len());
        let (keeps, draw) = (recommended.is_some(), draw.map(name_of));
        Ok(RoomsAnswer { best, keeps, draw, assumed, speed_m_s, turn_deg_s, rooms, kinds, elsewhere, ways: every })
    }
}
