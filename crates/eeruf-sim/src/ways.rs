//! Every way from each emitter of a world to each receiver that can be loud enough: computed once while nothing moves, and
//! for each firing anew otherwise.

use core::hash::{Hash, Hasher};
use std::collections::HashMap;
use std::hash::DefaultHasher;

use crate::{
    crosstalk::{CriticalPath, CrosstalkMatrix},
    detector::{Hearing, NEVER},
    error::PathsError,
    guide::Guide,
    moving::reception_along,
    noise::FARTHEST,
    paths::{Bounce, Limits, Tracer},
    plane::{Pose, Vector},
    readings::{HeardPath, SensorId},
    robot::{Robot, offset},
    transducer::{GainProfile, Transducer},
    world::World,
};

/// One way from an emitter to a receiver.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// The receiver, counted over all robots.
    pub(crate) receiver: u32,
    /// The path, in [`Ways::paths`].
    pub(crate) path: u32,
    /// Travelling time in nanoseconds.
    pub(crate) delay: u64,
    /// Level above the detection floor, the receiver's gain left out.
    pub(crate) margin_db: f32,
}

/// All ways in a world.
pub(crate) struct Ways<'w> {
    world: &'w World,
    /// For each sensor of the world, which one it is.
    ids: Vec<SensorId>,
    /// The first sensor of each robot.
    first: Vec<usize>,
    tracer: Tracer,
    matrix: CrosstalkMatrix,
    moves: bool,
    /// Of the kind of transducer asked for last.
    hears: Option<Audible>,
    /// Whether it matters what a robot hears.
    listens: Vec<bool>,
    /// The ways from each emitter while nothing moves, with one more start at the end; else those of the last firing.
    ways: Vec<Way>,
    starts: Vec<usize>,
    /// Every path met so far.
    pub(crate) paths: Vec<HeardPath>,
    numbers: HashMap<u64, u32>,
    // Kept between firings for their memory.
    poses: Vec<Pose>,
    velocities: Vec<Vector>,
    group: Vec<usize>,
}

impl<'w> Ways<'w> {
    pub(crate) fn new(world: &'w World, guide: &impl Guide) -> Result<Self, PathsError> {
        let mut ids = Vec::new();
        let mut first = Vec::new();
        for (robot, crew) in world.robots().iter().enumerate() {
            first.push(ids.len());
            // At most 64 robots and 64 sensors.
            ids.extend((0..crew.sensors.len()).map(|sensor| SensorId { robot: robot as u16, sensor: sensor as u8 }));
        }
        let mut ways = Self {
            world,
            ids,
            first,
            tracer: Tracer::new(),
            matrix: CrosstalkMatrix::new(),
            moves: guide.moves(),
            hears: None,
            listens: (0..world.robots().len()).map(|robot| guide.listens(robot)).collect(),
            ways: Vec::new(),
            starts: Vec::new(),
            paths: Vec::new(),
            numbers: HashMap::new(),
            poses: Vec::new(),
            velocities: Vec::new(),
            group: Vec::new(),
        };
        if !ways.moves {
            ways.compute_all(guide)?;
        }
        Ok(ways)
    }

    /// Every sensor of the world.
    pub(crate) fn ids(&self) -> &[SensorId] {
        &self.ids
    }

    /// The number of a robot's first sensor.
    pub(crate) fn first_of(&self, robot: usize) -> usize {
        self.first[robot]
    }

    /// Makes sure that the ways from this emitter are those at a time, in true nanoseconds.
    pub(crate) fn prepare(&mut self, emitter: usize, now: u64, guide: &impl Guide) -> Result<(), PathsError> {
        if self.moves { self.compute_from(emitter, now, guide) } else { Ok(()) }
    }

    /// The ways from an emitter that was prepared.
    pub(crate) fn from(&self, emitter: usize) -> &[Way] {
        if self.moves { &self.ways } else { &self.ways[self.starts[emitter]..self.starts[emitter + 1]] }
    }

    /// The travelling time of what a prepared sensor reads alone: its own sound's first arrival that is loud enough; or
    /// [`NEVER`].
    pub(crate) fn reference(&self, sensor: usize, hearing: &Hearing) -> u64 {
        let own = self.from(sensor).iter().filter(|way| way.receiver as usize == sensor);
        let heard = own.filter(|way| {
            (hearing.blanking..=hearing.window).contains(&way.delay) && hearing.audible(way.margin_db, way.delay)
        });
        heard.map(|way| way.delay).min().unwrap_or(NEVER)
    }

    fn robot_of(&self, sensor: usize) -> &'w Robot {
        &self.world.robots()[usize::from(self.ids[sensor].robot)]
    }

    fn compute_all(&mut self, guide: &impl Guide) -> Result<(), PathsError> {
        self.place(0, guide);
        let mut by_emitter: Vec<Vec<Way>> = vec![Vec::new(); self.ids.len()];
        for (robot, crew) in self.world.robots().iter().enumerate() {
            // Once for each kind of transducer.
            if self.world.robots()[..robot].iter().any(|before| before.transducer == crew.transducer) {
                continue;
            }
            let audible = self.trace(&crew.transducer, None)?;
            let matrix = core::mem::take(&mut self.matrix);
            for path in matrix.paths() {
                let emitter = self.group[path.emitter as usize];
                if let Some(way) = self.way(emitter, &matrix, path, &audible) {
                    by_emitter[emitter].push(way);
                }
            }
            self.matrix = matrix;
        }
        for ways in by_emitter {
            self.starts.push(self.ways.len());
            self.ways.extend(ways);
        }
        self.starts.push(self.ways.len());
        Ok(())
    }

    fn compute_from(&mut self, emitter: usize, now: u64, guide: &impl Guide) -> Result<(), PathsError> {
        self.place(now, guide);
        let transducer = &self.robot_of(emitter).transducer;
        self.ways.clear();
        let audible = self.trace(transducer, Some(emitter))?;
        let matrix = core::mem::take(&mut self.matrix);
        for path in matrix.paths() {
            if let Some(way) = self.way(emitter, &matrix, path, &audible) {
                self.ways.push(way);
            }
        }
        self.matrix = matrix;
        Ok(())
    }

    /// Where all sensors are, and how fast they go.
    fn place(&mut self, now: u64, guide: &impl Guide) {
        self.poses.clear();
        self.velocities.clear();
        for (index, robot) in self.world.robots().iter().enumerate() {
            let moment = guide.moment(index, now);
            for sensor in &robot.sensors {
                self.poses.push(moment.pose * sensor);
                self.velocities.push(moment.velocity_at(moment.pose.rotation * offset(sensor)));
            }
        }
    }

    /// Fills the matrix for all sensors of one kind that matter, or from one emitter to them. Paths that only the strongest
    /// fading lifts over the detection floor are in it too.
    fn trace(&mut self, transducer: &Transducer, emitter: Option<usize>) -> Result<Audible, PathsError> {
        let concerned = |&sensor: &usize| {
            let hears = emitter.is_none() || self.listens[usize::from(self.ids[sensor].robot)];
            hears && self.robot_of(sensor).transducer == *transducer
        };
        self.group = (0..self.ids.len()).filter(concerned).collect();
        let poses: Vec<_> = self.group.iter().map(|&sensor| self.poses[sensor]).collect();
        let scene = self.world.scene();
        let audible = match self.hears {
            Some(audible) if audible.transducer == *transducer => audible,
            _ => *self.hears.insert(Audible::new(transducer, self.world)),
        };
        let limits = Limits { max_order: self.world.max_order(), max_length_m: audible.longest_m };
        self.tracer.pole_order = self.world.pole_order();
        // The receiver's gain depends on when the receiver fired, so it cannot be applied here.
        let flat = Transducer { gain: GainProfile::Constant, ..*transducer };
        let (tracer, floor) = (&mut self.tracer, audible.faintest);
        match emitter {
            Some(emitter) => {
                let emitter = &self.poses[emitter];
                self.matrix.compute_from(emitter, tracer, scene, &poses, &flat, limits, floor)?;
            }
            None => self.matrix.compute(tracer, scene, &poses, &flat, limits, floor)?,
        }
        Ok(audible)
    }

    fn way(&mut self, emitter: usize, matrix: &CrosstalkMatrix, path: &CriticalPath, audible: &Audible) -> Option<Way> {
        let receiver = self.group[path.receiver as usize];
        let velocity = self.velocities[receiver];
        let c = self.world.scene().air().speed_of_sound();
        let met = reception_along(path.length_m, path.arrival_rad, velocity, c)?;
        let margin_db = 20.0 * libm::log10(path.amplitude / audible.floor);
        let path = self.number(emitter, receiver, path, matrix.bounces(path));
        Some(Way {
            receiver: receiver as u32,
            path,
            delay: (met.time_s * 1e9).round() as u64,
            margin_db: margin_db as f32,
        })
    }

    /// The number of a path, a new one if it was never met.
    fn number(&mut self, emitter: usize, receiver: usize, path: &CriticalPath, bounces: &[Bounce]) -> u32 {
        let (emitter, receiver) = (self.ids[emitter], self.ids[receiver]);
        let mut hasher = DefaultHasher::new();
        (emitter, receiver, bounces).hash(&mut hasher);
        let mut key = hasher.finish();
        while let Some(&number) = self.numbers.get(&key) {
            let known = &self.paths[number as usize];
            if known.emitter == emitter && known.receiver == receiver && *known.bounces == *bounces {
                // One emitter has one image in a sequence of walls, so this is the same path, if need be from elsewhere.
                return number;
            }
            key = key.wrapping_add(1);
        }
        let number = self.paths.len() as u32;
        self.numbers.insert(key, number);
        self.paths.push(HeardPath {
            emitter,
            receiver,
            order: path.order,
            length_m: path.length_m,
            departure_rad: path.departure_rad,
            arrival_rad: path.arrival_rad,
            bounces: bounces.into(),
        });
        number
    }
}

/// What a kind of transducer hears in this world.
#[derive(Clone, Copy, Debug)]
struct Audible {
    transducer: Transducer,
    /// The amplitude that is just heard.
    floor: f64,
    /// The same if the strongest fading lifts it.
    faintest: f64,
    /// The longest path that is heard then, in metres.
    longest_m: f64,
}

impl Audible {
    fn new(transducer: &Transducer, world: &World) -> Self {
        let air = world.scene().air();
        let floor = transducer.detection_floor(air);
        let faintest = floor / 10f64.powf(world.noise().fading_db_rms * f64::from(FARTHEST) / 20.0);
        Self { transducer: *transducer, floor, faintest, longest_m: loudest_m(transducer, air, faintest) }
    }
}

/// The longest path that sound could be heard after, in metres: a millimetre more than where it has fallen to `floor` without
/// any loss but spreading and the air's.
fn loudest_m(transducer: &Transducer, air: crate::air::Air, floor: f64) -> f64 {
    let loss_db_per_m = air.absorption_db_per_m(transducer.frequency_hz);
    let (mut near, mut far) = (0.0, 1.0 / floor);
    while far - near > 1e-3 {
        let middle = 0.5 * (near + far);
        let heard = 10f64.powf(-loss_db_per_m * middle / 20.0) / middle >= floor;
        *(if heard { &mut near } else { &mut far }) = middle;
    }
    far + 1e-3
}
