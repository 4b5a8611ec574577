//! Ways of firing, judged in rooms, and the recommended one.

use eeruf_modules::Gain;
use serde::Serialize;

use super::plan::{DRIVING_S, RoomKind, RoomPlan};
use super::way::{Condition, RoomWay};
use crate::experiments::error::ExperimentError;
use crate::experiments::progress::Progress;
use crate::experiments::spread::Spread;
use crate::{
    acoustics::{GainProfile, Physics},
    maps::OccupancyGrid,
    results::{BeliefShares, Readings, Summary, quantile},
    scene::Room,
    simulation::{Options, SimulationError, simulate_while},
    threads::sweep,
    world::{Robot, World},
};

/// Simulated time of each room for a robot that stands, in seconds: long compared with the time before the first
/// beliefs.
const STANDING_S: f64 = 20.0;

/// Options of a judgement.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsOptions {
    /// The robot's speed in m/s; 0, the default, for one that stands.
    pub speed_m_s: f64,
    /// The modules' gain, and floor and ceiling.
    pub condition: Condition,
    /// The largest share of foreign sound among believed readings that a recommended way may have in the median room of
    /// each kind. The default is 0.03.
    pub wrong: f64,
}

impl Default for RoomsOptions {
    fn default() -> Self {
        Self { speed_m_s: 0.0, condition: Condition::ALL[0], wrong: 0.03 }
    }
}

/// Rooms whose figures are combined.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomGroup {
    /// The name in tables and in JSON.
    pub name: String,
    /// The rooms.
    pub rooms: Vec<RoomPlan>,
}

impl RoomGroup {
    /// Makes rooms of one kind with consecutive numbers, for a robot that needs a circle of this radius. Ways are
    /// chosen on numbers below 2,000, and reported from [`FIRST`](crate::experiments::FIRST) on.
    pub fn of_kind(kind: RoomKind, numbers: core::ops::Range<u64>, radius_m: f64) -> Self {
        let rooms = numbers.map(|number| RoomPlan::random(kind, number, radius_m)).collect();
        Self { name: kind.to_string(), rooms }
    }

    /// Makes the room of a world, for a ring in the place of the world's first robot and with its free way; `None` for
    /// a world without a robot.
    pub fn of_world(name: String, number: u64, world: &World) -> Option<Self> {
        let robot = world.robots().first()?;
        let way_m = robot.motion.at(&robot.pose, DRIVING_S).pose.translation.vector - robot.pose.translation.vector;
        let scene = world.scene();
        let plan = RoomPlan::own(number, scene.walls().to_vec(), scene.poles().to_vec(), robot.pose, way_m.norm());
        Some(Self { name, rooms: vec![plan] })
    }

    /// Draws places in the known free space of a map, like the rooms of [`of_kind`](Self::of_kind): half of the robots
    /// stand square to the map.
    ///
    /// # Errors
    /// The required width, if no free space is that wide.
    pub fn of_map(
        name: String,
        grid: &OccupancyGrid,
        numbers: core::ops::Range<u64>,
        radius_m: f64,
    ) -> Result<Self, String> {
        let (free, walls) = (grid.free_m(), grid.walls(grid.default_tolerance_m()));
        let rooms = numbers.map(|number| {
            RoomPlan::in_map(grid, &free, &walls, number, radius_m).ok_or_else(|| {
                let cells = free.len();
                format!(
                    "{cells} free cells; expected some with space around them for a robot {:.2} m wide",
                    2.0 * radius_m
                )
            })
        });
        Ok(Self { name, rooms: rooms.collect::<Result<_, _>>()? })
    }
}

/// One robot's figures of a way in rooms of one kind. Shares of time and rates are means; figures that can disqualify a
/// way are those of the median room.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RoomFigures {
    /// Shares of the time by the state of the last belief.
    #[serde(flatten)]
    pub belief: BeliefShares,
    /// 95 % confidence interval of the mean share that is right.
    pub belief_right_95: [f64; 2],
    /// The least right share of any room.
    pub belief_right_worst: f64,
    /// Right echoes accepted per second.
    pub right_echoes_per_s: f64,
    /// 95 % confidence interval of this mean.
    pub right_echoes_per_s_95: [f64; 2],
    /// Share of wrong foreign sound among accepted readings.
    pub foreign_of_believed: f64,
    /// Largest share of foreign sound among the readings that one sensor believed.
    pub foreign_of_believed_worst: f64,
    /// Share of wrong own sound among accepted readings.
    pub own_wrong_of_believed: f64,
    /// Number of sensors that were right under 5 % of the times they fired.
    pub blind: f64,
    /// 99th percentile of the age of the last accepted reading, in milliseconds.
    pub age_p99_ms: f64,
}

/// A way with its figures.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedWay {
    /// The way.
    pub way: RoomWay,
    /// The figures in each group of rooms, in the order asked for; or the reason why the way cannot fire this ring.
    pub rooms: Result<Vec<RoomFigures>, String>,
    /// Least and largest number of blind sensors in 90 % of all rooms judged. Zeros if the way cannot fire the ring.
    pub blind_90: [f64; 2],
    /// 95 % confidence interval of [`echoes_against`](Self::echoes_against) the first way: from the differences among
    /// rooms of a kind. `None` if one of the two cannot fire the ring, or if no kind has two rooms.
    pub times_95: Option<[f64; 2]>,
}

/// Ways of firing judged in rooms.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The ways, in the order asked for.
    pub ways: Vec<JudgedWay>,
    /// The index of the recommended way, among those that a program can have; `None` if no such way can fire the ring.
    pub recommended: Option<usize>,
    /// True if the recommended way keeps the limits in each kind of room.
    pub keeps: bool,
}

impl Judgement {
    /// Returns the recommended way.
    pub fn best(&self) -> Option<&JudgedWay> {
        self.recommended.and_then(|index| self.ways.get(index))
    }

    /// Returns the judgement without some groups of rooms, given by index; `None` if no group is left out or none
    /// remains. [`JudgedWay::blind_90`] and [`JudgedWay::times_95`] still cover all rooms.
    pub fn without(&self, left_out: impl Fn(usize) -> bool, wrong: f64) -> Option<Self> {
        let mut ways = self.ways.clone();
        let mut fewer = false;
        for rooms in ways.iter_mut().filter_map(|way| way.rooms.as_mut().ok()) {
            let all = rooms.len();
            let mut index = 0..all;
            rooms.retain(|_| index.next().is_some_and(|index| !left_out(index)));
            if rooms.is_empty() {
                return None;
            }
            fewer |= rooms.len() < all;
        }
        let (recommended, keeps) = recommend(&ways, wrong);
        fewer.then_some(Self { ways, recommended, keeps })
    }
}

/// One room's figures.
#[derive(Clone, Copy, Debug)]
struct Run {
    belief: BeliefShares,
    right_echoes_per_s: f64,
    foreign: f64,
    own: f64,
    blind: f64,
    age_p99_ms: f64,
}

impl Run {
    fn of(readings: &Readings, robots: usize) -> Self {
        let of_one = robots.max(1) as f64;
        let summary = readings.summary();
        let Summary { belief, right_echoes_per_s, blind, age_ms, .. } = summary;
        let share = |of_all: f64| match summary.accepted {
            0 => 0.0,
            accepted => of_all * summary.readings as f64 / accepted as f64,
        };
        let foreign = share(summary.crosstalk_of_all);
        Self {
            belief,
            right_echoes_per_s: right_echoes_per_s / of_one,
            foreign,
            own: (share(summary.wrong_of_all) - foreign).max(0.0),
            blind: blind as f64 / of_one,
            age_p99_ms: age_ms.p99,
        }
    }
}

impl RoomFigures {
    fn of(runs: &[Run]) -> Option<Self> {
        let spread = |value: fn(&Run) -> f64| Spread::of(runs.iter().map(value));
        let (right, echoes) = (spread(|run| run.belief.right)?, spread(|run| run.right_echoes_per_s)?);
        let mean = |value: fn(&Run) -> f64| runs.iter().map(value).sum::<f64>() / runs.len() as f64;
        let median = |value: fn(&Run) -> f64| quantile(&mut runs.iter().map(value).collect::<Vec<_>>(), 0.5);
        Some(Self {
            belief: BeliefShares {
                right: right.mean,
                unknown: mean(|run| run.belief.unknown),
                phantom: mean(|run| run.belief.phantom),
                too_far: mean(|run| run.belief.too_far),
                faint: mean(|run| run.belief.faint),
            },
            belief_right_95: right.mean_95,
            belief_right_worst: runs.iter().map(|run| run.belief.right).fold(1.0, f64::min),
            right_echoes_per_s: echoes.mean,
            right_echoes_per_s_95: echoes.mean_95,
            foreign_of_believed: median(|run| run.foreign),
            foreign_of_believed_worst: runs.iter().map(|run| run.foreign).fold(0.0, f64::max),
            own_wrong_of_believed: median(|run| run.own),
            blind: median(|run| run.blind),
            age_p99_ms: median(|run| run.age_p99_ms),
        })
    }
}

/// Judges ways of firing in rooms, on all cores. The first way is one by one, with which the others are compared.
///
/// Several threads sometimes call `keep_going` with the finished share, 0 to 1; if it returns `false`, the judgement
/// stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no rooms or ways, for a room too small for the robot, and if it was stopped.
pub fn judge(
    ways: &[RoomWay],
    rooms: &[RoomGroup],
    asked: &RoomsOptions,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Judgement, ExperimentError> {
    if ways.is_empty() {
        return Err(ExperimentError::NoMethods);
    }
    if rooms.is_empty() || rooms.iter().any(|group| group.rooms.is_empty()) {
        return Err(ExperimentError::NoSeeds);
    }
    let places = rooms.iter().flat_map(|group| &group.rooms);
    let jobs: Vec<_> = places.flat_map(|room| (0..ways.len()).map(move |way| (room, way))).collect();
    let progress = Progress::new(jobs.len() as u64, keep_going);
    let runs = sweep(&jobs, |&(room, way)| {
        if !progress.go_on() {
            return Err(ExperimentError::Stopped);
        }
        let RoomWay { method, robot, options, .. } = &ways[way];
        let world = world_of(room, robot, asked)?;
        // All ways are simulated for the same time, counted in periods of the way.
        let seconds = if asked.speed_m_s > 0.0 { DRIVING_S } else { STANDING_S };
        let periods = (1e6 * seconds / f64::from(robot.period.as_micros())).ceil() as u32;
        let options = Options { periods, ..*options };
        let run = match simulate_while(&world, *method, &options, |_| progress.go_on()) {
            Ok(readings) => Ok(Run::of(&readings, world.robots().len())),
            Err(SimulationError::Stopped) => return Err(ExperimentError::Stopped),
            Err(error) => Err(error.to_string()),
        };
        progress.one_done();
        Ok(run)
    });
    let runs: Vec<Result<Run, String>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let of_way = |index| runs.iter().skip(index).step_by(ways.len()).cloned().collect::<Result<Vec<Run>, String>>();
    let base = of_way(0).ok();
    let sizes: Vec<usize> = rooms.iter().map(|group| group.rooms.len()).collect();
    let judged = |(index, way): (usize, &RoomWay)| {
        let of_way = of_way(index);
        let by_group = |mut of_way: &[Run]| {
            let mut figures = Vec::with_capacity(rooms.len());
            for group in rooms {
                let (runs, rest) = of_way.split_at_checked(group.rooms.len()).unwrap_or((of_way, &[]));
                figures.extend(RoomFigures::of(runs));
                of_way = rest;
            }
            figures
        };
        let blind_90 = of_way.as_ref().map_or([0.0; 2], |runs| blind_90(runs));
        let times_95 = of_way.as_ref().ok().zip(base.as_ref()).and_then(|(own, base)| times_95(own, base, &sizes));
        JudgedWay { way: way.clone(), rooms: of_way.map(|of_way| by_group(&of_way)), blind_90, times_95 }
    };
    let ways: Vec<_> = ways.iter().enumerate().map(judged).collect();
    let (recommended, keeps) = recommend(&ways, asked.wrong);
    Ok(Judgement { ways, recommended, keeps })
}

/// Returns the least and largest number of blind sensors in 90 % of rooms, rounded outwards.
fn blind_90(runs: &[Run]) -> [f64; 2] {
    let mut blind: Vec<f64> = runs.iter().map(|run| run.blind).collect();
    [libm::floor(quantile(&mut blind, 0.05)), libm::ceil(quantile(&mut blind, 0.95))]
}

/// Number added to right echoes a second before division, so that ways that hear none are equal.
const NO_ECHOES: f64 = 0.1;

/// Returns the 95 % interval of the ratio of right echoes, from its spread among rooms of a kind.
fn times_95(own: &[Run], base: &[Run], sizes: &[usize]) -> Option<[f64; 2]> {
    let (mut own, mut base) = (own, base);
    let (mut sum, mut variance, mut measured) = (0.0, 0.0, false);
    for &size in sizes {
        let ((own_here, own_rest), (base_here, base_rest)) =
            (own.split_at_checked(size)?, base.split_at_checked(size)?);
        (own, base) = (own_rest, base_rest);
        let rooms = size as f64;
        let echoes = |runs: &[Run]| runs.iter().map(|run| run.right_echoes_per_s).sum::<f64>() / rooms + NO_ECHOES;
        let (own_mean, base_mean) = (echoes(own_here), echoes(base_here));
        sum += libm::log(own_mean / base_mean);
        if size < 2 {
            continue;
        }
        measured = true;
        // To first order the logarithm moves by this with each room; its mean is 0.
        let moved = own_here.iter().zip(base_here).map(|(own, base)| {
            (own.right_echoes_per_s + NO_ECHOES) / own_mean - (base.right_echoes_per_s + NO_ECHOES) / base_mean
        });
        variance += moved.map(|moved| moved * moved).sum::<f64>() / (rooms * (rooms - 1.0));
    }
    let kinds = sizes.len() as f64;
    let reach = 1.96 * libm::sqrt(variance) / kinds;
    measured.then(|| [-reach, reach].map(|reach| libm::exp(sum / kinds + reach)))
}

/// Makes a room with the robot.
fn world_of(room: &RoomPlan, robot: &Robot, asked: &RoomsOptions) -> Result<World, ExperimentError> {
    let Condition { other_gain, flat } = asked.condition;
    let robot = if other_gain { with_other_gain(robot) } else { robot.clone() };
    let height = if flat { None } else { Some(Room::DEFAULT) };
    Ok(room.world(&robot, asked.speed_m_s)?.with_room(height)?.with_physics(Physics::DEFAULT)?)
}

/// Returns the robot with the other gain: stepped if it was constant, otherwise constant.
pub fn with_other_gain(robot: &Robot) -> Robot {
    let other = match robot.module_of(0).gain {
        Gain::Constant if robot.module_of(0).frequency_hz > 45_000 => GainProfile::Polaroid6500,
        Gain::Constant => GainProfile::Stepped,
        _ => GainProfile::Constant,
    };
    robot.clone().with_pattern(Some(other), None)
}

/// Allowed excess of own wrong echoes over those of one by one, as a share.
const OWN_WRONG_MORE: f64 = 0.01;
/// Difference of right belief below which two ways are equally good; more right echoes then decide.
const AS_GOOD: f64 = 0.01;
/// Ratio of right echoes below which one by one, which needs no library, is as good as another way.
const WORTH_A_LIBRARY: f64 = 1.2;

impl JudgedWay {
    /// Returns the share of time in which the belief is right, over all kinds of rooms.
    pub fn belief_right(&self) -> Option<f64> {
        let rooms = self.rooms.as_ref().ok()?;
        Some(rooms.iter().map(|figures| figures.belief.right).sum::<f64>() / rooms.len() as f64)
    }

    /// Returns the ratio of right echoes to those of another way, as the geometric mean over all kinds of rooms.
    pub fn echoes_against(&self, other: &Self) -> Option<f64> {
        let (Ok(own), Ok(others)) = (&self.rooms, &other.rooms) else { return None };
        let ratio = |(own, other): (&RoomFigures, &RoomFigures)| {
            libm::log((own.right_echoes_per_s + NO_ECHOES) / (other.right_echoes_per_s + NO_ECHOES))
        };
        let logs = own.iter().zip(others).map(ratio).sum::<f64>();
        Some(libm::exp(logs / own.len() as f64))
    }

    /// Returns the index of the first group of rooms in which the way is wrong too often, or leaves more sensors blind
    /// than one by one.
    pub fn fails_in(&self, one_by_one: &Self, wrong: f64) -> Option<usize> {
        let (Ok(own), Ok(base)) = (&self.rooms, &one_by_one.rooms) else { return None };
        let fails = |own: &RoomFigures, base: &RoomFigures| {
            own.foreign_of_believed > wrong
                || own.own_wrong_of_believed > base.own_wrong_of_believed + OWN_WRONG_MORE
                || own.blind > base.blind
        };
        own.iter().zip(base).position(|(own, base)| fails(own, base))
    }
}

/// Returns the index of the best way that a program can have and that keeps the limits, with true, or of the best of
/// all if none keeps them, with false. The best is right most of the time; among equals it has the most right echoes,
/// or is one by one if that has hardly fewer.
fn recommend(ways: &[JudgedWay], wrong: f64) -> (Option<usize>, bool) {
    let Some(base) = ways.first() else { return (None, false) };
    let best_of = |among: &dyn Fn(&JudgedWay) -> bool| {
        let fit: Vec<_> = ways.iter().enumerate().filter(|(_, way)| way.way.has_program() && among(way)).collect();
        let most = fit.iter().filter_map(|(_, way)| way.belief_right()).reduce(f64::max)?;
        let as_good = fit.iter().filter(|(_, way)| way.belief_right().is_some_and(|right| right >= most - AS_GOOD));
        let by_echoes: Vec<_> = as_good.map(|(index, way)| (*index, way.echoes_against(base).unwrap_or(0.0))).collect();
        let (index, times) = by_echoes.iter().copied().reduce(|one, next| if next.1 > one.1 { next } else { one })?;
        let one_by_one = by_echoes.iter().any(|&(index, _)| index == 0);
        Some(if one_by_one && times < WORTH_A_LIBRARY { 0 } else { index })
    };
    match best_of(&|way| way.rooms.is_ok() && way.fails_in(base, wrong).is_none()) {
        Some(index) => (Some(index), true),
        None => (best_of(&|way| way.rooms.is_ok()), false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::acoustics::Transducer;
    use crate::geometry::Pose;
    use crate::methods::Method;

    const USUAL: RoomFigures = RoomFigures {
        belief: BeliefShares { right: 0.9, unknown: 0.1, phantom: 0.0, too_far: 0.0, faint: 0.0 },
        belief_right_95: [0.9; 2],
        belief_right_worst: 0.9,
        right_echoes_per_s: 10.0,
        right_echoes_per_s_95: [10.0; 2],
        foreign_of_believed: 0.0,
        foreign_of_believed_worst: 0.0,
        own_wrong_of_believed: 0.0,
        blind: 0.0,
        age_p99_ms: 100.0,
    };

    const RUN: Run =
        Run { belief: USUAL.belief, right_echoes_per_s: 1.0, foreign: 0.0, own: 0.0, blind: 0.0, age_p99_ms: 1.0 };

    fn right(right: f64, echoes: f64) -> RoomFigures {
        RoomFigures { belief: BeliefShares { right, ..USUAL.belief }, right_echoes_per_s: echoes, ..USUAL }
    }

    fn judged(figures: &[Result<[RoomFigures; 2], &str>]) -> Vec<JudgedWay> {
        let robot = Robot::ring(Pose::identity(), 4, 1.57, 0.2, Transducer::HC_SR04);
        let way = RoomWay::all(&robot, None)[0].clone();
        let judged = figures
            .iter()
            .map(|rooms| (way.clone(), rooms.map(Vec::from).map_err(str::to_owned)))
            .map(|(way, rooms)| JudgedWay { way, rooms, blind_90: [0.0; 2], times_95: None });
        judged.collect()
    }

    fn chosen(figures: &[Result<[RoomFigures; 2], &str>]) -> (Option<usize>, bool) {
        recommend(&judged(figures), 0.03)
    }

    #[test]
    fn way_that_is_right_most_is_recommended_and_echoes_part_equals() {
        let base = Ok([USUAL; 2]);
        assert_eq!(chosen(&[base, Ok([right(0.95, 9.0); 2]), Ok([right(0.8, 99.0); 2])]), (Some(1), true));
        assert_eq!(chosen(&[base, Ok([right(0.95, 9.0); 2]), Ok([right(0.945, 20.0); 2])]), (Some(2), true));
        // A way with hardly more echoes than one by one is not worth a library.
        assert_eq!(chosen(&[base, Ok([right(0.905, 11.5); 2])]), (Some(0), true));
        assert_eq!(chosen(&[base, Ok([right(0.905, 12.5); 2])]), (Some(1), true));
        // A way without a program is not recommended.
        let mut ways = judged(&[base, Ok([right(0.99, 99.0); 2])]);
        ways[1].way.name = "arrays";
        ways[1].way.method = Method::Arrays;
        assert_eq!(recommend(&ways, 0.03), (Some(0), true));
        // A way that cannot fire the ring is passed over.
        assert_eq!(chosen(&[base, Err("too fast")]), (Some(0), true));
        assert_eq!(chosen(&[Err("too fast")]), (None, false));
    }

    #[test]
    fn limits_in_one_kind_of_room_are_enough_to_refuse_a_way() {
        let good = right(0.99, 50.0);
        let worse = [
            RoomFigures { foreign_of_believed: 0.04, ..good },
            RoomFigures { own_wrong_of_believed: 0.02, ..good },
            RoomFigures { blind: 1.0, ..good },
        ];
        for worse in worse {
            assert_eq!(chosen(&[Ok([USUAL; 2]), Ok([good, worse])]), (Some(0), true), "{worse:?}");
            // If all ways exceed the limits, the way that is right most is named, and marked as exceeding them.
            let base = RoomFigures { foreign_of_believed: 0.5, ..USUAL };
            assert_eq!(chosen(&[Ok([base; 2]), Ok([good, worse])]).0, Some(1), "{worse:?}");
        }
        let base = RoomFigures { foreign_of_believed: 0.5, ..USUAL };
        let worse = RoomFigures { foreign_of_believed: 0.04, ..good };
        assert_eq!(chosen(&[Ok([base; 2]), Ok([good, worse])]), (Some(1), false));
    }

    #[test]
    fn blind_sensors_of_the_worst_twentieth_of_rooms_do_not_count() {
        let run = |blind| Run { blind, ..RUN };
        let of =
            |many: usize| blind_90(&(0..40).map(|room| run(if room < many { 3.5 } else { 1.0 })).collect::<Vec<_>>());
        assert_eq!((of(0), of(2), of(3), of(40)), ([1.0, 1.0], [1.0, 1.0], [1.0, 4.0], [3.0, 4.0]));
    }

    // The factor is 2 in each room of one kind, and 1 or 4 in the rooms of the other kind.
    #[test]
    fn interval_of_a_factor_comes_from_rooms_that_differ_in_it() {
        let runs = |echoes: &[f64]| -> Vec<Run> {
            echoes.iter().map(|echoes| Run { right_echoes_per_s: echoes - NO_ECHOES, ..RUN }).collect()
        };
        let base = runs(&[1.0, 5.0, 2.0, 2.0]);
        let [low, high] = times_95(&runs(&[2.0, 10.0]), &base[..2], &[2]).unwrap();
        assert!((low - 2.0).abs() < 1e-9 && (high - 2.0).abs() < 1e-9, "{low} to {high}");
        let [low, high] = times_95(&runs(&[2.0, 10.0, 2.0, 8.0]), &base, &[2, 2]).unwrap();
        // The second kind's rooms lie 0.6 from their mean. So is its standard error; for both kinds it is half of that.
        assert!((high / low - libm::exp(2.0 * 1.96 * 0.3)).abs() < 1e-9, "{low} to {high}");
        assert!(((high * low).sqrt() - 5.0_f64.sqrt()).abs() < 1e-9, "{low} to {high}");
        assert_eq!(times_95(&runs(&[2.0]), &base[..1], &[1]), None);
    }

    // Judgement is the same on any number of threads and stops when asked.
    #[test]
    fn judgement_is_equal_on_any_number_of_threads() {
        let robot = Robot::ring(Pose::identity(), 4, 1.57, 0.2, Transducer::HC_SR04);
        let ways = RoomWay::all(&robot, None);
        let rooms = [RoomGroup::of_kind(RoomKind::Office, 3..5, 0.2), RoomGroup::of_kind(RoomKind::Meeting, 3..4, 0.2)];
        let asked = RoomsOptions::default();
        let once = judge(&ways, &rooms, &asked, &|_| true).unwrap();
        assert_eq!(once, judge(&ways, &rooms, &asked, &|_| true).unwrap());
        assert_eq!(once.ways[0].rooms.as_ref().unwrap().len(), 2);
        let alone = once.without(|index| index == 1, 0.03).unwrap();
        assert_eq!(alone.ways[0].rooms.as_ref().unwrap().len(), 1);
        assert_eq!(judge(&ways, &rooms, &asked, &|_| false), Err(ExperimentError::Stopped));
        assert_eq!(judge(&[], &rooms, &asked, &|_| true), Err(ExperimentError::NoMethods));
        assert_eq!(judge(&ways, &[], &asked, &|_| true), Err(ExperimentError::NoSeeds));
    }
}
