//! Logs with and without faults, and what `diagnose` says of each.

use std::error::Error;

use eeruf_core::{Micros, Phase};
use eeruf_logs::{Fault as Found, FiringLog, Settings, diagnose, timing};
use eeruf_sim::experiments::rooms::RoomKind::{Aisle, Clutter, Corridor, Garage, Hall, Office};
use eeruf_sim::experiments::rooms::{RoomKind, RoomPlan};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{
    AnySchedule, Fault, FaultKind, Method, Motion, Options, Physics, Random, Vector, World, simulate, table_i_d_for,
};

use super::oracle::{paths_tell, scene_tells};
use super::truth::{SENSORS, Truth};

/// Rooms with one robot in them.
const ROOMS: [RoomKind; 6] = [Corridor, Office, Hall, Clutter, Garage, Aisle];
/// A robot stands for a minute, backs out of an alcove for 20 s, and drives through a room for 8 s.
const PERIODS: u32 = 1000;
const ALCOVE_PERIODS: u32 = 333;
const ROOM_PERIODS: u32 = 133;
const SPEED_M_S: f64 = 0.5;
/// Delay of a late trigger.
const LATE_US: u32 = 1000;
/// Seeds of whole rings at the same place, from here on.
const TWIN: u64 = 1 << 40;
/// Drift of a clock.
const DRIFT_PPM: f64 = 20.0;

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    Alcove,
    Room,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Robots {
    Stand,
    Drive,
    /// The ring knows how.
    DriveByOdometry,
}

/// A thing that goes wrong, or not.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Broken {
    /// The echo line is cut.
    Deaf,
    /// Share of echoes that are lost.
    Loses(f64),
    /// Share of readings that are changed.
    Noise(f64),
    EchoWires,
    LateTrigger,
    /// The ring fires by another table than the schedule that it is held against.
    OtherTable,
    ClockDrift,
    /// Nothing is broken.
    Nothing,
    /// Nothing is broken, and people walk by.
    People,
}

/// Outcome of one log.
#[derive(Clone, Copy)]
pub(crate) struct Outcome {
    pub(crate) is_named: bool,
    pub(crate) blames: bool,
    /// True if it is not named, and `diagnose` says that the log cannot tell: a sensor hears nothing, or misses echoes
    /// at random, and may be healthy. In a healthy log that holds of any sensor.
    pub(crate) is_open: bool,
    /// Verdicts of the readers of `oracle.rs`: of the one who knows the scene, and the one who knows the paths.
    pub(crate) told: [bool; 2],
}

impl Broken {
    pub(crate) const ALL: [Self; 13] = [
        Self::Deaf,
        Self::Loses(0.5),
        Self::Loses(0.9),
        Self::Loses(0.97),
        Self::Noise(0.1),
        Self::Noise(0.2),
        Self::Noise(0.4),
        Self::EchoWires,
        Self::LateTrigger,
        Self::OtherTable,
        Self::ClockDrift,
        Self::Nothing,
        Self::People,
    ];

    pub(crate) fn name(self) -> String {
        match self {
            Self::Deaf => "deaf".to_owned(),
            Self::Loses(share) => format!("loses {:.0} % of echoes", 100.0 * share),
            Self::Noise(share) => format!("noise changes {:.0} % of readings", 100.0 * share),
            Self::EchoWires => "echo wires exchanged".to_owned(),
            Self::LateTrigger => "trigger 1 ms late".to_owned(),
            Self::OtherTable => "another table, `--schedule`".to_owned(),
            Self::ClockDrift => "clock 20 ppm fast, `--schedule`".to_owned(),
            Self::Nothing => "none: false alarms".to_owned(),
            Self::People => "none, people walk by: false alarms".to_owned(),
        }
    }

    /// Returns true if it shows in readings, and not in a schedule or in people.
    pub(crate) fn shows_in_readings(self) -> bool {
        !matches!(self, Self::OtherTable | Self::ClockDrift | Self::People)
    }

    pub(crate) fn is_healthy(self) -> bool {
        matches!(self, Self::Nothing | Self::People)
    }

    /// Returns true if a ring that fires by this method can have it: what a schedule shows takes a fixed one.
    pub(crate) fn applies(self, method: Method) -> bool {
        !matches!(self, Self::OtherTable | Self::ClockDrift) || method == Method::Eeruf
    }

    /// Returns true if the log counts: the healthy ring shows that the fault is there to be seen.
    fn counts(self, truth: &Truth, [sensor, other]: [usize; 2]) -> bool {
        match self {
            Self::Deaf => truth.would_hear(sensor),
            Self::Loses(_) => truth.is_loud(sensor),
            Self::Noise(share) => truth.noise_that_changes(sensor, share).is_some(),
            Self::EchoWires => truth.heard_others(sensor) && truth.heard_others(other),
            Self::LateTrigger => truth.heard_both_ways(sensor),
            Self::OtherTable | Self::ClockDrift | Self::Nothing | Self::People => true,
        }
    }

    /// The faults of the simulator.
    fn faults(self, truth: &Truth, [sensor, other]: [usize; 2], world: &World, seconds: f64) -> Vec<Fault> {
        let of = |kind: FaultKind| vec![Fault::new(kind).of_sensors(&[sensor as u8])];
        match self {
            Self::Deaf => of(FaultKind::Cut),
            Self::Loses(share) => of(FaultKind::Lost { share }),
            Self::Noise(share) => {
                let per_s = truth.noise_that_changes(sensor, share).unwrap_or(0.0);
                of(FaultKind::Noise { per_s })
            }
            Self::EchoWires => vec![Fault::new(FaultKind::EchoWires).of_sensors(&[sensor as u8, other as u8])],
            Self::LateTrigger => of(FaultKind::LateTrigger { us: LATE_US }),
            Self::OtherTable => {
                other_table(world).map(|schedule| Fault::new(FaultKind::OtherTable { schedule })).into_iter().collect()
            }
            Self::ClockDrift => vec![Fault::new(FaultKind::ClockDrift { ppm: DRIFT_PPM })],
            Self::Nothing => vec![],
            Self::People => people(world, seconds),
        }
    }

    /// Returns true if a finding is this fault of these sensors.
    fn is(self, found: &Found, [sensor, other]: [usize; 2]) -> bool {
        let pair = |of: (u8, u8)| [[sensor, other], [other, sensor]].contains(&[of.0.into(), of.1.into()]);
        match (self, found) {
            (Self::Deaf | Self::Loses(_), &Found::Deaf { sensor: of, .. })
            | (Self::Loses(_), &Found::Losing { sensor: of, .. })
            | (Self::LateTrigger, &Found::Late { sensor: of, .. })
            | (Self::Noise(_), &Found::Chattering { sensor: of, .. }) => usize::from(of) == sensor,
            (Self::EchoWires, &(Found::Swapped { sensors, .. } | Found::Exchanged { sensors, .. })) => pair(sensors),
            _ => false,
        }
    }
}

/// The table of the robot with its sensors in reverse order.
fn other_table(world: &World) -> Option<Box<AnySchedule>> {
    let schedule = schedule_of(world)?;
    let row = |phase| -> Option<Vec<Micros>> { (0..SENSORS).rev().map(|x| schedule.t_fire(phase, x)).collect() };
    let [a, b] = [row(Phase::A)?, row(Phase::B)?];
    AnySchedule::from_slices(schedule.period(), &[Micros::ZERO; SENSORS], [&a, &b]).ok().map(Box::new)
}

fn schedule_of(world: &World) -> Option<AnySchedule> {
    let robot = &world.robots()[0];
    table_i_d_for(SENSORS, robot.period, robot.neighbours).ok()
}

/// Two legs that cross before the robot, again and again.
fn people(world: &World, seconds: f64) -> Vec<Fault> {
    let robot = &world.robots()[0];
    let mut faults = vec![];
    let mut from_s = 1.0;
    while from_s + 2.0 < seconds {
        let pose = robot.motion.at(&robot.pose, from_s).pose;
        for (ahead_m, radius_m) in [(0.62, 0.05), (0.72, 0.06)] {
            let place = |aside: f64| {
                let at = pose * eeruf_sim::Point::new(ahead_m, aside);
                [at.x, at.y]
            };
            let kind = FaultKind::Leg { radius_m, from_m: place(-0.5), to_m: place(0.5) };
            faults.push(Fault::new(kind).between(from_s, from_s + 2.0));
        }
        from_s += 6.0;
    }
    faults
}

/// A robot in a place.
pub(crate) fn world(number: u64, place: Place, robots: Robots, physics: Physics) -> Result<World, Box<dyn Error>> {
    let alcove = Alcove::random(number);
    let mut robot = alcove.robot();
    robot.odometry = robots == Robots::DriveByOdometry;
    let world = match place {
        Place::Alcove => {
            if robots != Robots::Stand {
                let turn_rad_s = if number.is_multiple_of(2) { 0.04 } else { -0.04 };
                robot.motion = Motion::Constant { velocity: Vector::new(0.0, -0.015), turn_rad_s };
            }
            World::new(alcove.scene()?, vec![robot], eeruf_sim::Noise::default())?.with_seed(number)
        }
        Place::Room => {
            let kind = ROOMS[(number % ROOMS.len() as u64) as usize];
            let speed_m_s = if robots == Robots::Stand { 0.0 } else { SPEED_M_S };
            RoomPlan::random(kind, number, robot.radius_m()).world(&robot, speed_m_s)?
        }
    };
    Ok(world.with_physics(physics)?)
}

/// A log with its fault.
pub(crate) struct Case {
    pub(crate) broken: Broken,
    pub(crate) log: FiringLog,
    pub(crate) world: World,
    /// The sensor that has the fault, and the other one of a pair.
    pub(crate) sensors: [usize; 2],
    told: [bool; 2],
}

/// The log of each of these faults in one place; none where it does not count.
pub(crate) fn cases(
    number: u64,
    place: Place,
    robots: Robots,
    method: Method,
    physics: Physics,
    rows: &[Broken],
) -> Result<Vec<Option<Case>>, Box<dyn Error>> {
    let periods = match (place, robots) {
        (_, Robots::Stand) => PERIODS,
        (Place::Alcove, _) => ALCOVE_PERIODS,
        (Place::Room, _) => ROOM_PERIODS,
    };
    let options = Options { seed: Some(number), ..Options::periods(periods) };
    let healthy = simulate(&world(number, place, robots, physics)?, method, &options)?;
    let truth = Truth::of(&world(number, place, robots, physics)?, &healthy)?;
    let mut random = Random::new(number).of(47);
    let sensor = (random.bits() % SENSORS as u64) as usize;
    let other = (sensor + 1 + (random.bits() % (SENSORS as u64 - 1)) as usize) % SENSORS;
    let sensors = [sensor, other];
    let case = |broken: Broken| {
        let base = world(number, place, robots, physics)?;
        let faults = broken.faults(&truth, sensors, &base, healthy.duration_s);
        // Where people have no room to walk, nobody does.
        let Some(world) = base.with_faults(faults).ok().filter(|_| broken.counts(&truth, sensors)) else {
            return Ok(None);
        };
        let Ok(readings) = simulate(&world, method, &options) else { return Ok(None) };
        let mut told = [false; 2];
        if broken.shows_in_readings() {
            let whole = || self::world(number, place, robots, physics);
            let of = if broken == Broken::EchoWires { &sensors[..] } else { &sensors[..1] };
            told = [scene_tells(whole, &readings, of, TWIN + number)?, paths_tell(&world, &readings, of)];
        }
        Ok(Some(Case { broken, log: eeruf::firing_log(&readings), world, sensors, told }))
    };
    rows.iter().copied().map(case).collect()
}

impl Case {
    /// Verdict of `diagnose`.
    pub(crate) fn outcome(&self) -> Outcome {
        Outcome { told: self.told, ..outcome(self.broken, &self.log, &self.world, self.sensors) }
    }
}

/// Verdict of `diagnose` on a log.
fn outcome(broken: Broken, log: &FiringLog, world: &World, sensors: [usize; 2]) -> Outcome {
    let diagnosis = diagnose(log, &Settings::default());
    let open = [diagnosis.silent(), diagnosis.missing()].concat();
    let found = diagnosis.faults;
    let is_named = match (broken, schedule_of(world)) {
        (Broken::Nothing | Broken::People, _) => !found.is_empty(),
        (Broken::OtherTable | Broken::ClockDrift, Some(schedule)) => {
            let fires_at = |sensor: u8, phase: u8| {
                schedule.t_fire(Phase(phase), sensor.into()).filter(|_| phase < 2).map(Micros::as_micros)
            };
            let held = timing(log, schedule.period().as_micros(), fires_at);
            match (broken, held) {
                (Broken::OtherTable, held) => held.is_err(),
                // The drift that is printed, with its interval.
                (_, Ok(held)) => held.drift_ppm.abs() > 1.96 * held.drift_error_ppm + 10.0,
                (_, Err(_)) => false,
            }
        }
        _ => found.iter().any(|found| broken.is(found, sensors)),
    };
    let blames = !broken.is_healthy() && found.iter().any(|found| !broken.is(found, sensors));
    let is_open = !is_named && open.iter().any(|&of| broken.is_healthy() || sensors[0] == usize::from(of));
    Outcome { is_named, blames, is_open, told: [false; 2] }
}
