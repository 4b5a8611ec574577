//! The channels of a world: every path from each emitter to each receiver that can be loud enough, computed once while
//! nothing moves, and for each firing anew otherwise.

mod hearing_range;
mod path_numbers;

use super::kinematics::Kinematics;
use super::receiver::{Hearing, NEVER};
use crate::{
    acoustics::{GainProfile, Transducer},
    geometry::{Pose, Vector},
    results::{HeardPath, SensorId},
    threads::Stop,
    tracing::{CriticalPath, CrosstalkMatrix, CrosstalkQuery, Limits, PathsError, Tracer, reception_along},
    world::{Robot, World, offset},
};
use hearing_range::HearingRange;
use path_numbers::PathNumbers;

/// One path from an emitter to a receiver, as the event loop needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    /// The receiver, counted over all robots.
    pub(crate) receiver: u32,
    /// The path's number, see [`Channels::paths`].
    pub(crate) path: u32,
    /// Travelling time in nanoseconds.
    pub(crate) delay: u64,
    /// Level above the detection floor, the receiver's gain left out.
    pub(crate) level_over_threshold_db: f32,
}

/// All channels of a world.
pub(crate) struct Channels<'w> {
    world: &'w World,
    /// For each sensor of the world, which one it is.
    ids: Vec<SensorId>,
    /// The first sensor of each robot.
    first: Vec<usize>,
    tracer: Tracer,
    matrix: CrosstalkMatrix,
    moves: bool,
    /// Of the kind of transducer asked for last.
    range: Option<HearingRange>,
    /// Whether it matters what a robot hears.
    listens: Vec<bool>,
    /// The channels from each emitter while nothing moves, with one more start at the end; else those of the last
    /// firing.
    channels: Vec<Channel>,
    starts: Vec<usize>,
    /// Every path met so far.
    paths: PathNumbers,
    // Kept between firings for their memory.
    poses: Vec<Pose>,
    velocities: Vec<Vector>,
    group: Vec<usize>,
}

impl<'w> Channels<'w> {
    pub(crate) fn new(world: &'w World, kinematics: &impl Kinematics, stop: Stop) -> Result<Self, PathsError> {
        let mut ids = Vec::new();
        let mut first = Vec::new();
        for (robot, ring) in world.robots().iter().enumerate() {
            first.push(ids.len());
            // At most 64 robots and 64 sensors.
            ids.extend((0..ring.sensors.len()).map(|sensor| SensorId { robot: robot as u16, sensor: sensor as u8 }));
        }
        let mut tracer = Tracer::new();
        tracer.stop = stop;
        let mut channels = Self {
            world,
            ids,
            first,
            tracer,
            matrix: CrosstalkMatrix::new(),
            moves: kinematics.moves(),
            range: None,
            listens: (0..world.robots().len()).map(|robot| kinematics.listens(robot)).collect(),
            channels: Vec::new(),
            starts: Vec::new(),
            paths: PathNumbers::default(),
            poses: Vec::new(),
            velocities: Vec::new(),
            group: Vec::new(),
        };
        if !channels.moves {
            channels.compute_all(kinematics)?;
        }
        Ok(channels)
    }

    /// Every sensor of the world.
    pub(crate) fn ids(&self) -> &[SensorId] {
        &self.ids
    }

    /// The number of a robot's first sensor.
    pub(crate) fn first_of(&self, robot: usize) -> usize {
        self.first[robot]
    }

    /// Makes sure that the channels from this emitter are those at a time, in true nanoseconds.
    pub(crate) fn prepare(&mut self, emitter: usize, now: u64, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        if self.moves { self.compute_from(emitter, now, kinematics) } else { Ok(()) }
    }

    /// The channels from an emitter that was prepared.
    pub(crate) fn from(&self, emitter: usize) -> &[Channel] {
        if self.moves { &self.channels } else { &self.channels[self.starts[emitter]..self.starts[emitter + 1]] }
    }

    /// The travelling time of what a prepared sensor reads alone: its own sound's first arrival that is loud enough; or
    /// [`NEVER`].
    pub(crate) fn reference(&self, sensor: usize, hearing: &Hearing) -> u64 {
        let own = self.from(sensor).iter().filter(|channel| channel.receiver as usize == sensor);
        let heard = own.filter(|channel| {
            (hearing.blanking..=hearing.window).contains(&channel.delay)
                && hearing.audible(channel.level_over_threshold_db, channel.delay)
        });
        heard.map(|channel| channel.delay).min().unwrap_or(NEVER)
    }

    /// Every path met so far, by its number.
    pub(crate) fn paths(&self) -> &[HeardPath] {
        self.paths.paths()
    }

    /// Whether paths are looked for at each firing.
    pub(crate) fn moves(&self) -> bool {
        self.moves
    }

    /// From now on something moves, though nothing did before.
    pub(crate) fn set_moving(&mut self) {
        self.moves = true;
    }

    /// From now on sound travels in the scene of another world, whose sensors are the same. Paths keep their numbers.
    pub(crate) fn change_scene(&mut self, world: &'w World, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        self.world = world;
        self.channels.clear();
        self.starts.clear();
        if self.moves { Ok(()) } else { self.compute_all(kinematics) }
    }

    fn robot_of(&self, sensor: usize) -> &'w Robot {
        &self.world.robots()[usize::from(self.ids[sensor].robot)]
    }

    fn compute_all(&mut self, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        self.set_poses(0, kinematics);
        let mut by_emitter: Vec<Vec<Channel>> = vec![Vec::new(); self.ids.len()];
        for (robot, ring) in self.world.robots().iter().enumerate() {
            // Once for each kind of transducer.
            if self.world.robots()[..robot].iter().any(|before| before.transducer == ring.transducer) {
                continue;
            }
            let range = self.trace(&ring.transducer, None)?;
            let matrix = core::mem::take(&mut self.matrix);
            for path in matrix.paths() {
                let emitter = self.group[path.emitter as usize];
                if let Some(channel) = self.channel(emitter, &matrix, path, &range) {
                    by_emitter[emitter].push(channel);
                }
            }
            self.matrix = matrix;
        }
        for channels in by_emitter {
            self.starts.push(self.channels.len());
            self.channels.extend(channels);
        }
        self.starts.push(self.channels.len());
        Ok(())
    }

    fn compute_from(&mut self, emitter: usize, now: u64, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        self.set_poses(now, kinematics);
        let transducer = &self.robot_of(emitter).transducer;
        self.channels.clear();
        let range = self.trace(transducer, Some(emitter))?;
        let matrix = core::mem::take(&mut self.matrix);
        for path in matrix.paths() {
            if let Some(channel) = self.channel(emitter, &matrix, path, &range) {
                self.channels.push(channel);
            }
        }
        self.matrix = matrix;
        Ok(())
    }

    /// Where all sensors are, and how fast they go.
    fn set_poses(&mut self, now: u64, kinematics: &impl Kinematics) {
        self.poses.clear();
        self.velocities.clear();
        for (index, robot) in self.world.robots().iter().enumerate() {
            let moment = kinematics.moment(index, now);
            for sensor in &robot.sensors {
                self.poses.push(moment.pose * sensor);
                self.velocities.push(moment.velocity_at(moment.pose.rotation * offset(sensor)));
            }
        }
    }

    /// Fills the matrix for all sensors of one kind that matter, or from one emitter to them. Paths that only the
    /// strongest fading lifts over the detection floor are in it too.
    fn trace(&mut self, transducer: &Transducer, emitter: Option<usize>) -> Result<HearingRange, PathsError> {
        let concerned = |&sensor: &usize| {
            let hears = emitter.is_none() || self.listens[usize::from(self.ids[sensor].robot)];
            hears && self.robot_of(sensor).transducer == *transducer
        };
        self.group = (0..self.ids.len()).filter(concerned).collect();
        let poses: Vec<_> = self.group.iter().map(|&sensor| self.poses[sensor]).collect();
        let scene = self.world.scene();
        let range = match self.range {
            Some(range) if range.transducer == *transducer => range,
            _ => *self.range.insert(HearingRange::new(transducer, self.world)),
        };
        let limits = Limits { max_order: self.world.max_order(), max_length_m: range.longest_m };
        self.tracer.pole_order = self.world.pole_order();
        // The receiver's gain depends on when the receiver fired, so it cannot be applied here.
        let flat = Transducer { gain: GainProfile::Constant, ..*transducer };
        let query = CrosstalkQuery { scene, sensors: &poses, transducer: &flat, limits, floor: range.faintest };
        match emitter {
            Some(emitter) => self.matrix.compute_from(&self.poses[emitter], &mut self.tracer, &query)?,
            None => self.matrix.compute(&mut self.tracer, &query)?,
        }
        Ok(range)
    }

    fn channel(
        &mut self,
        emitter: usize,
        matrix: &CrosstalkMatrix,
        path: &CriticalPath,
        range: &HearingRange,
    ) -> Option<Channel> {
        let receiver = self.group[path.receiver as usize];
        let velocity = self.velocities[receiver];
        let c = self.world.scene().air().speed_of_sound();
        let met = reception_along(path.length_m, path.arrival_rad, velocity, c)?;
        let level_over_threshold_db = 20.0 * libm::log10(path.amplitude / range.floor);
        let ends = [self.ids[emitter], self.ids[receiver]];
        let path = self.paths.number(ends, path, matrix.bounces(path));
        Some(Channel {
            receiver: receiver as u32,
            path,
            delay: (met.time_s * 1e9).round() as u64,
            level_over_threshold_db: level_over_threshold_db as f32,
        })
    }
}
