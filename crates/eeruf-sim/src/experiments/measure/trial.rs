//! Trials: a robot in a room under a condition, the thing that appears before it, and the readings of a way of firing.

use std::sync::Arc;

use serde::Serialize;

use super::heard::Heard;
use super::things::{Draws, Thing};
use super::ways::RoomWay;
use crate::{
    acoustics::Physics,
    experiments::error::ExperimentError,
    experiments::rooms::{RoomKind, RoomPlan},
    geometry::Pose,
    methods::Method,
    results::Readings,
    scene::{Room, Scene, SceneError},
    simulation::{Options, SharedPaths, Simulation},
    threads::Stop,
    world::{Random, Robot, World, WorldError},
};

/// The version of the set of trials. A trial is fixed by version and number.
pub const VERSION: u32 = 1;
/// Limits of the uniform instant at which a thing appears, in seconds. On average a trial measures false stops for 10
/// s.
const APPEARS_S: [f64; 2] = [5.0, 15.0];
/// The time in seconds after which a thing counts as never seen.
pub const NEVER_S: f64 = 5.0;
/// The longest duration of a trial, in seconds.
const LONGEST_S: f64 = APPEARS_S[1] + NEVER_S;
/// The random key of trials, next to the keys of the kinds of rooms.
const THING: u64 = 200;
/// Distance in metres and turn in degrees after which paths of a moving robot are searched for again.
const STEP_M: f64 = 0.06;
const STEP_DEG: f64 = 6.0;
/// Times after the thing's appearance, in seconds, at which the trial ends if the thing has been seen.
const LOOKS_S: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 3.5];
/// Interval between checks for contact, in seconds.
const LOOK_S: f64 = 0.01;

/// A robot's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Moving {
    /// The robot stands still.
    Standing,
    /// The robot drives back and forth along its free way.
    Driving,
    /// The robot turns on the spot.
    Turning,
}

/// A condition under which ways are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Condition {
    /// The robot's motion.
    pub moving: Moving,
    /// True with another robot of the same make close by, which has its own clock.
    pub others: bool,
}

impl Condition {
    /// All six conditions, alone first.
    pub const ALL: [Self; 6] = [
        Self { moving: Moving::Standing, others: false },
        Self { moving: Moving::Driving, others: false },
        Self { moving: Moving::Turning, others: false },
        Self { moving: Moving::Standing, others: true },
        Self { moving: Moving::Driving, others: true },
        Self { moving: Moving::Turning, others: true },
    ];

    /// Returns the name in tables and in JSON.
    pub const fn as_str(self) -> &'static str {
        match (self.moving, self.others) {
            (Moving::Standing, false) => "standing",
            (Moving::Driving, false) => "driving",
            (Moving::Turning, false) => "turning",
            (Moving::Standing, true) => "standing_others",
            (Moving::Driving, true) => "driving_others",
            (Moving::Turning, true) => "turning_others",
        }
    }

    /// Returns the rooms of the condition: `places` rooms of each of the seven kinds without another robot, or seven
    /// times as many of the kind with one.
    pub fn rooms(self, first: u64, places: u64) -> Vec<(RoomKind, u64)> {
        let alone = RoomKind::ALL.into_iter().filter(|&kind| kind != RoomKind::Meeting);
        match self.others {
            false => alone.flat_map(|kind| (first..first + places).map(move |number| (kind, number))).collect(),
            true => (first..first + 7 * places).map(|number| (RoomKind::Meeting, number)).collect(),
        }
    }
}

/// The speeds of a robot that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Driving, in m/s.
    pub speed_m_s: f64,
    /// Turning, in rad/s.
    pub turn_rad_s: f64,
}

/// A trial, the same for every way of firing.
#[derive(Debug)]
pub(super) struct Trial {
    pub(super) plan: RoomPlan,
    pub(super) thing: Option<Thing>,
    pub(super) draws: Draws,
    /// Time when the thing appears.
    pub(super) appears_s: f64,
    /// Time when the trial ends: before the robot touches the thing, or after the time for seeing it.
    pub(super) ends_s: f64,
    /// The robot's speeds, of which at most one is not 0.
    pub(super) speeds: Speeds,
    pub(super) c: f64,
    /// Paths of a moving robot before and after the thing appears.
    shared: Option<[Arc<SharedPaths>; 2]>,
}

impl Trial {
    /// The trial of a room for a robot under a condition; the key is its kind's.
    pub(super) fn new(
        (key, plan): (u64, RoomPlan),
        robot: &Robot,
        condition: Condition,
        asked: Speeds,
    ) -> Result<Self, ExperimentError> {
        let speeds = match condition.moving {
            Moving::Standing => Speeds { speed_m_s: 0.0, turn_rad_s: 0.0 },
            // Each leg of its way lasts at least a second.
            Moving::Driving if plan.turns() => Speeds { speed_m_s: asked.speed_m_s.min(plan.way_m()), turn_rad_s: 0.0 },
            // The alcove's robot does not come back.
            Moving::Driving => Speeds { speed_m_s: asked.speed_m_s.min(plan.way_m() / LONGEST_S), turn_rad_s: 0.0 },
            Moving::Turning => Speeds { speed_m_s: 0.0, ..asked },
        };
        let mut random = Random::new(plan.number).of(THING + key).of(condition.moving as u64);
        let appears_s = random.between(APPEARS_S[0], APPEARS_S[1]);
        let world = plan.moving(robot, speeds.speed_m_s, speeds.turn_rad_s)?;
        Ok(Self::drawn(plan, &world, speeds, appears_s, random))
    }

    /// Makes a trial of the first robot of a scene, standing or moving as in the scene.
    pub(super) fn in_scene(world: &World, number: u64) -> Option<Self> {
        let (robot, scene) = (world.robots().first()?, world.scene());
        let plan = RoomPlan::own(number, scene.walls().to_vec(), scene.poles().to_vec(), robot.pose, 0.0);
        let mut random = Random::new(number).of(THING);
        let appears_s = random.between(APPEARS_S[0], APPEARS_S[1]);
        let moment = robot.motion.at(&robot.pose, appears_s);
        let speeds = Speeds { speed_m_s: moment.velocity.norm(), turn_rad_s: moment.turn_rad_s };
        Some(Self::drawn(plan, world, speeds, appears_s, random))
    }

    fn drawn(plan: RoomPlan, world: &World, speeds: Speeds, appears_s: f64, random: Random) -> Self {
        let c = world.scene().air().speed_of_sound();
        let moves = speeds.speed_m_s > 0.0 || speeds.turn_rad_s != 0.0;
        let step_s = (STEP_M / speeds.speed_m_s).min(STEP_DEG.to_radians() / speeds.turn_rad_s.abs());
        let shared = moves.then(|| [(); 2].map(|()| Arc::new(SharedPaths::new(step_s))));
        let (draws, ends_s) = (Draws::default(), appears_s + NEVER_S);
        let mut trial = Self { plan, thing: None, draws, appears_s, ends_s, speeds, c, shared };
        let pose = trial.pose(world, appears_s);
        let drawn = Thing::draw(random, &trial.plan, world, &pose, &mut trial.draws);
        let Some(thing) = drawn else { return trial };
        let looks = (1..=(NEVER_S / LOOK_S) as u32).map(|look| appears_s + LOOK_S * f64::from(look));
        let touches = |at: &f64| thing.touches(&world.robots()[0], &trial.pose(world, *at));
        let contact = looks.into_iter().find(touches).filter(|_| moves);
        trial.ends_s = contact.map_or(trial.ends_s, |contact| contact - LOOK_S);
        trial.thing = Some(thing);
        trial
    }

    /// Returns the duration of a leg of the robot's way, in seconds, if it drives back and forth.
    fn leg_s(&self) -> Option<f64> {
        let is_asked = self.speeds.speed_m_s > 0.0 && self.plan.turns();
        is_asked.then(|| self.plan.way_m() / self.speeds.speed_m_s)
    }

    /// Returns the robot's pose at a time.
    fn pose(&self, world: &World, at_s: f64) -> Pose {
        let robot = &world.robots()[0];
        let straight = |at_s| robot.motion.at(&robot.pose, at_s).pose;
        let Some(leg_s) = self.leg_s() else { return straight(at_s) };
        let in_turn_s = at_s % (2.0 * leg_s);
        straight(in_turn_s.min(2.0 * leg_s - in_turn_s))
    }

    /// Returns the lifetime of a belief: until the robot has moved by 0.15 m or turned by 10 degrees, at most 2 s.
    pub(super) fn life_s(&self) -> f64 {
        let Speeds { speed_m_s, turn_rad_s } = self.speeds;
        (0.15 / speed_m_s).min(10f64.to_radians() / turn_rad_s.abs()).min(2.0)
    }

    /// Simulates a way of firing and returns the first robot's readings in the order in which they were complete. If
    /// `until_seen`, the readings end when all settings have seen the thing.
    pub(super) fn heard(
        &self,
        way: &RoomWay,
        until_seen: bool,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<Heard>, ExperimentError> {
        let Speeds { speed_m_s, turn_rad_s } = self.speeds;
        let world = self.plan.moving(&way.robot, speed_m_s, turn_rad_s)?.with_room(Some(Room::DEFAULT))?;
        let world = Arc::new(world.with_physics(Physics::DEFAULT)?);
        let (how, shared) = ((way.method, &way.options), self.shared.as_ref());
        self.heard_in(&world, how, |thing, _| thing.scene(&self.plan), (until_seen, shared), keep_going)
    }

    /// Simulates a method in the caller's scene and returns the readings.
    pub(super) fn heard_in_scene(
        &self,
        world: &World,
        method: Method,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<Heard>, ExperimentError> {
        let options = Options { seed: Some(self.plan.number), ..Options::default() };
        self.heard_in(&Arc::new(world.clone()), (method, &options), Thing::added_to, (true, None), keep_going)
    }

    fn heard_in(
        &self,
        world: &Arc<World>,
        (method, options): (Method, &Options),
        with: impl Fn(&Thing, &Scene) -> Result<Scene, SceneError>,
        (until_seen, shared): (bool, Option<&[Arc<SharedPaths>; 2]>),
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<Heard>, ExperimentError> {
        let (speed_m_s, robot) = (self.speeds.speed_m_s, &world.robots()[0]);
        let mut simulation = Simulation::new(Arc::clone(world), method, options, Stop::default())?;
        if let Some([before, _]) = shared {
            simulation.share(Arc::clone(before));
        }
        let legs = self.leg_s().map_or(0, |leg_s| (self.ends_s / leg_s) as u32);
        let turns = (1..=legs).map(|leg| (self.leg_s().unwrap_or_default() * f64::from(leg), Event::Turns(leg)));
        let looks = LOOKS_S.map(|late_s| (self.appears_s + late_s, Event::Looks)).into_iter();
        let looks = looks.filter(|(at_s, _)| until_seen && *at_s < self.ends_s);
        let ends = [(self.appears_s, Event::Appears), (self.ends_s, Event::Ends)];
        let mut events: Vec<_> = turns.chain(looks).chain(ends).collect();
        events.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut heard: Vec<Heard> = vec![];
        for (at_s, event) in events {
            let part: Readings = simulation.step((at_s - simulation.time_s()).max(0.0), |_| keep_going())?;
            heard.extend(Heard::all(&part, robot.window));
            match (event, &self.thing) {
                (Event::Turns(leg), _) if leg % 2 == 1 => simulation.set_velocity(0, -speed_m_s, 0.0)?,
                (Event::Turns(_), _) => simulation.set_velocity(0, speed_m_s, 0.0)?,
                (Event::Appears, Some(thing)) => {
                    simulation.change_scene(with(thing, world.scene()).map_err(WorldError::from)?)?;
                    if let Some([_, after]) = shared {
                        simulation.share(Arc::clone(after));
                    }
                }
                (Event::Looks, _) if self.is_seen(robot, sorted(&mut heard), at_s) => break,
                (Event::Ends, _) => break,
                (Event::Appears, None) if until_seen => break,
                (Event::Looks | Event::Appears, _) => {}
            }
        }
        sorted(&mut heard);
        Ok(heard)
    }
}

/// An event of a trial.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// The robot is at the end of this leg of its way.
    Turns(u32),
    /// The thing appears.
    Appears,
    /// The trial ends if the thing is seen.
    Looks,
    /// The trial ends.
    Ends,
}

/// Sorts readings by the time when they were complete.
fn sorted(heard: &mut [Heard]) -> &[Heard] {
    heard.sort_by(|one, other| one.ready_s.total_cmp(&other.ready_s));
    heard
}
