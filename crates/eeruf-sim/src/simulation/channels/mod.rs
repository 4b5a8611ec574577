//! The channels of a world: every path from each emitter to each receiver that can be loud enough. They are computed
//! once while nothing moves, and otherwise again for each firing.

mod bodies;
mod hearing_range;
mod path_numbers;
mod shared;

use std::sync::Arc;

use super::kinematics::Kinematics;
use super::receiver::{Envelope, Hearing, NEVER, Wave};
use crate::{
    acoustics::{GainProfile, Transducer},
    geometry::{Pose, Vector},
    results::{HeardPath, SensorId},
    scene::{Bounce, Scene},
    threads::Stop,
    tracing::{
        CriticalPath, CrosstalkMatrix, CrosstalkQuery, Limits, Matters, Moved, PathsError, Tracer, reception_at,
    },
    world::{Robot, World, offset},
};
pub(super) use bodies::Bodies;
use hearing_range::HearingRange;
use path_numbers::PathNumbers;
pub(crate) use shared::SharedPaths;
use shared::Snapshot;

/// One path from an emitter to a receiver, as the event loop needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Channel {
    /// The index of the receiver, counted over all robots.
    pub(crate) receiver: u32,
    /// The path's number, see [`Channels::paths`].
    pub(crate) path: u32,
    /// The key that depends only on the path's ends and bounces.
    pub(crate) key: u64,
    /// Travelling time in nanoseconds.
    pub(crate) delay: u64,
    /// Phase of the carrier when the sound begins to arrive, as a share of a turn.
    pub(crate) turn: f32,
    /// Level above the detection floor, without the receiver's gain.
    pub(crate) level_over_threshold_db: f32,
}

impl Channel {
    /// Returns the sound of this channel with its onset and level, and with the receiver's burst length.
    pub(crate) fn wave(&self, onset: u64, level_over_threshold_db: f32, burst: u64) -> Wave {
        let Self { receiver, path, turn, .. } = *self;
        Wave { receiver: receiver as usize, onset, burst, turn, path, level_over_threshold_db }
    }
}

/// Returns true if sound that reaches a sensor at a time, give or take a slack, may matter; both in true nanoseconds.
pub(crate) type Arrives<'a> = &'a dyn Fn(usize, u64, u64) -> bool;

/// Phase of sound that an edge returns towards its source, as a share of a turn: the phase of Keller's coefficient,
/// `-exp(-j pi / 4)`.
const EDGE_TURN: f64 = 0.375;

/// All channels of a world.
#[derive(Clone)]
pub(crate) struct Channels {
    /// The current world; earlier worlds differed only in their scenes.
    world: Arc<World>,
    /// Identity of each sensor of the world.
    ids: Vec<SensorId>,
    /// The first sensor of each robot.
    first: Vec<usize>,
    tracer: Tracer,
    matrix: CrosstalkMatrix,
    moves: bool,
    /// Hearing ranges for each pair of kinds of transducers that hear each other.
    ranges: Vec<HearingRange>,
    bodies: Bodies,
    /// For each robot, true if its hearing matters.
    listens: Vec<bool>,
    /// The channels from each emitter while nothing moves, with one more start at the end; otherwise the channels of
    /// the last firing.
    channels: Vec<Channel>,
    starts: Vec<usize>,
    /// Every path met so far.
    paths: PathNumbers,
    /// Paths of this scene that other simulations have found, if they are shared.
    shared: Option<Arc<SharedPaths>>,
    // These are kept between firings for their memory.
    poses: Vec<Pose>,
    velocities: Vec<Vector>,
    robots: Vec<Pose>,
    bounces: Vec<Bounce>,
}

impl Channels {
    pub(crate) fn new(world: &Arc<World>, kinematics: &impl Kinematics, stop: Stop) -> Result<Self, PathsError> {
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
            world: Arc::clone(world),
            ids,
            first,
            tracer,
            matrix: CrosstalkMatrix::new(),
            moves: kinematics.moves(),
            ranges: Vec::new(),
            bodies: Bodies::new(world),
            listens: (0..world.robots().len()).map(|robot| kinematics.listens(robot)).collect(),
            channels: Vec::new(),
            starts: Vec::new(),
            paths: PathNumbers::default(),
            shared: None,
            poses: Vec::new(),
            velocities: Vec::new(),
            robots: Vec::new(),
            bounces: Vec::new(),
        };
        if !channels.moves {
            channels.compute_all(kinematics)?;
        }
        Ok(channels)
    }

    /// Copies the channels, with a separate switch to stop them.
    pub(crate) fn copy(&self, stop: Stop) -> Self {
        let mut copy = self.clone();
        copy.tracer.stop = stop;
        copy
    }

    /// Identities of all sensors of the world.
    pub(crate) fn ids(&self) -> &[SensorId] {
        &self.ids
    }

    /// Returns the index of a robot's first sensor.
    pub(crate) fn first_of(&self, robot: usize) -> usize {
        self.first[robot]
    }

    /// Updates the channels from this emitter to a time, in true nanoseconds. Channels that are computed now and do not
    /// matter are left out.
    pub(crate) fn prepare(
        &mut self,
        emitter: usize,
        now: u64,
        kinematics: &impl Kinematics,
        matters: Option<Arrives<'_>>,
    ) -> Result<(), PathsError> {
        if self.moves { self.compute_from(emitter, now, kinematics, matters) } else { Ok(()) }
    }

    /// Returns the channels from an emitter that was prepared.
    pub(crate) fn from(&self, emitter: usize) -> &[Channel] {
        if self.moves { &self.channels } else { &self.channels[self.starts[emitter]..self.starts[emitter + 1]] }
    }

    /// Returns the travelling time that a prepared sensor would read alone: the first arrival of its own sound that is
    /// loud enough, or [`NEVER`].
    pub(crate) fn reference(&self, sensor: usize, hearing: &Hearing) -> u64 {
        let own = self.from(sensor).iter().filter(|channel| channel.receiver as usize == sensor);
        if self.world.physics().interference {
            let mut sum = Envelope::default();
            let burst = hearing.rise_ns.ceil() as u64;
            own.for_each(|channel| sum.push(channel.wave(channel.delay, channel.level_over_threshold_db, burst)));
            let mut earliest = NEVER;
            sum.rises(0, |_, arrival| {
                let heard = hearing.late(&arrival, 0).map(|late| arrival.onset + late);
                let heard = heard.filter(|heard| (hearing.blanking..=hearing.window).contains(heard));
                earliest = earliest.min(heard.unwrap_or(NEVER));
            });
            return earliest;
        }
        let heard = own.filter_map(|channel| {
            let late = hearing.lateness(channel.level_over_threshold_db, channel.delay)?;
            Some(channel.delay + late).filter(|heard| (hearing.blanking..=hearing.window).contains(heard))
        });
        heard.min().unwrap_or(NEVER)
    }

    /// Shares the paths of the current scene with other simulations until the scene changes.
    pub(crate) fn share(&mut self, shared: Arc<SharedPaths>) {
        self.shared = Some(shared);
    }

    /// Returns every path met so far, by its number.
    pub(crate) fn paths(&self) -> &[HeardPath] {
        self.paths.paths()
    }

    /// Returns true if paths are computed for each firing.
    pub(crate) fn moves(&self) -> bool {
        self.moves
    }

    /// Declares that something moves from now on.
    pub(crate) fn set_moving(&mut self) {
        self.moves = true;
    }

    /// Changes to the scene of another world with the same sensors. Paths keep their numbers. If no paths can be found,
    /// nothing changes.
    pub(crate) fn change_scene(&mut self, world: Arc<World>, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        let before = core::mem::replace(&mut self.world, world);
        self.shared = None;
        let changed = self.begin_anew(kinematics);
        if changed.is_err() {
            self.world = before;
            if self.begin_anew(kinematics).is_err() {
                // The search was stopped: paths are searched for when a sensor fires.
                self.moves = true;
            }
        }
        changed
    }

    fn begin_anew(&mut self, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        self.ranges.clear();
        self.bodies = Bodies::new(&self.world);
        self.channels.clear();
        self.starts.clear();
        if self.moves { Ok(()) } else { self.compute_all(kinematics) }
    }

    fn robot_of(&self, sensor: usize) -> &Robot {
        &self.world.robots()[usize::from(self.ids[sensor].robot)]
    }

    fn transducer_of(&self, sensor: usize) -> Transducer {
        self.robot_of(sensor).transducer_of(usize::from(self.ids[sensor].sensor))
    }

    fn compute_all(&mut self, kinematics: &impl Kinematics) -> Result<(), PathsError> {
        self.set_poses(0, kinematics);
        let mut by_emitter: Vec<Vec<Channel>> = vec![Vec::new(); self.ids.len()];
        let everyone: Vec<usize> = (0..self.ids.len()).collect();
        for senders in self.alike(&everyone) {
            self.trace(&senders, &everyone, None, |emitter, channel| by_emitter[emitter].push(channel))?;
        }
        for channels in by_emitter {
            self.starts.push(self.channels.len());
            self.channels.extend(channels);
        }
        self.starts.push(self.channels.len());
        Ok(())
    }

    fn compute_from(
        &mut self,
        emitter: usize,
        now: u64,
        kinematics: &impl Kinematics,
        matters: Option<Arrives<'_>>,
    ) -> Result<(), PathsError> {
        self.set_poses(now, kinematics);
        let listening: Vec<usize> =
            (0..self.ids.len()).filter(|&sensor| self.listens[usize::from(self.ids[sensor].robot)]).collect();
        let mut channels = core::mem::take(&mut self.channels);
        channels.clear();
        let matters = matters.map(|matters| (now, matters));
        let found = |_, channel| channels.push(channel);
        let traced = match self.shared.clone() {
            Some(shared) => self.trace_shared(&shared, (now, kinematics), emitter, &listening, matters, found),
            None => self.trace(&[emitter], &listening, matters, found),
        };
        self.channels = channels;
        traced
    }

    /// Finds the channels from an emitter like [`trace`](Self::trace), but along the paths at the nearest instant for
    /// which paths are shared.
    fn trace_shared(
        &mut self,
        shared: &SharedPaths,
        (now, kinematics): (u64, &impl Kinematics),
        emitter: usize,
        receivers: &[usize],
        matters: Option<(u64, Arrives<'_>)>,
        mut found: impl FnMut(usize, Channel),
    ) -> Result<(), PathsError> {
        let at = shared.instant(now);
        self.set_poses(at, kinematics);
        // Shared paths are used only if they were found for the same positions at that instant.
        let known = shared.get(at, emitter).filter(|known| known.poses == self.poses);
        let known = match known {
            Some(known) => Ok(known),
            None => self.snapshot(emitter, receivers).map(|found| shared.put(at, emitter, found)),
        };
        self.set_poses(now, kinematics);
        // The robot's position at that instant may be in a wall.
        let Ok(Snapshot { poses, groups }) = known.as_deref() else {
            return self.trace(&[emitter], receivers, matters, found);
        };
        for (listeners, matrix) in groups {
            self.hand_out(&[emitter], listeners, matrix, Some(poses), matters, &mut found);
        }
        Ok(())
    }

    /// Finds the paths from an emitter to all receivers that hear it, at their current positions.
    fn snapshot(&mut self, emitter: usize, receivers: &[usize]) -> Result<Snapshot, PathsError> {
        let mut snapshot = Snapshot { poses: self.poses.clone(), groups: vec![] };
        for listeners in self.hearing(emitter, receivers) {
            self.search(&[emitter], &listeners, None)?;
            snapshot.groups.push((listeners, self.matrix.clone()));
        }
        Ok(snapshot)
    }

    /// Groups sensors of one kind; sensors of robots with a body or with a mounting that carries sound, also by robot.
    fn alike(&self, sensors: &[usize]) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let same = |a: usize, b: usize| {
            self.transducer_of(a) == self.transducer_of(b)
                && self.embodied(a) == self.embodied(b)
                && self.coupled(a) == self.coupled(b)
        };
        for &sensor in sensors {
            match groups.iter_mut().find(|group| same(group[0], sensor)) {
                Some(group) => group.push(sensor),
                None => groups.push(vec![sensor]),
            }
        }
        groups
    }

    /// Returns the sensor's robot, if it has a body.
    fn embodied(&self, sensor: usize) -> Option<usize> {
        self.robot_of(sensor).body.map(|_| usize::from(self.ids[sensor].robot))
    }

    /// Returns the sensor's robot, if its mounting carries sound from sensor to sensor.
    fn coupled(&self, sensor: usize) -> Option<usize> {
        self.robot_of(sensor).coupling_db.map(|_| usize::from(self.ids[sensor].robot))
    }

    /// Sets the poses and speeds of all sensors.
    fn set_poses(&mut self, now: u64, kinematics: &impl Kinematics) {
        self.poses.clear();
        self.velocities.clear();
        self.robots.clear();
        for (index, robot) in self.world.robots().iter().enumerate() {
            let moment = kinematics.moment(index, now);
            self.robots.push(moment.pose);
            for sensor in &robot.sensors {
                self.poses.push(moment.pose * sensor);
                self.velocities.push(moment.velocity_at(moment.pose.rotation * offset(sensor)));
            }
        }
    }

    /// Finds the channels from a group of emitters to all of these receivers that hear them, including paths that only
    /// the strongest fading raises above the detection floor.
    fn trace(
        &mut self,
        emitters: &[usize],
        receivers: &[usize],
        matters: Option<(u64, Arrives<'_>)>,
        mut found: impl FnMut(usize, Channel),
    ) -> Result<(), PathsError> {
        let Some(&first) = emitters.first() else { return Ok(()) };
        for listeners in self.hearing(first, receivers) {
            self.search(emitters, &listeners, matters)?;
            let matrix = core::mem::take(&mut self.matrix);
            self.hand_out(emitters, &listeners, &matrix, None, None, &mut found);
            self.matrix = matrix;
        }
        Ok(())
    }

    /// Groups the receivers that hear an emitter by kind.
    fn hearing(&self, emitter: usize, receivers: &[usize]) -> Vec<Vec<usize>> {
        let sending = self.transducer_of(emitter);
        let hears = |&sensor: &usize| self.transducer_of(sensor).hears(&sending);
        self.alike(&receivers.iter().copied().filter(hears).collect::<Vec<_>>())
    }

    /// Searches for the paths from emitters of one kind to listeners of one kind, into `self.matrix`.
    fn search(
        &mut self,
        emitters: &[usize],
        listeners: &[usize],
        matters: Option<(u64, Arrives<'_>)>,
    ) -> Result<(), PathsError> {
        let (Some(&first), Some(&hears)) = (emitters.first(), listeners.first()) else { return Ok(()) };
        let (world, sending) = (&*Arc::clone(&self.world), &self.transducer_of(first));
        let transducer = &self.transducer_of(hears);
        let (sources, sensors) = (self.poses_of(emitters), self.poses_of(listeners));
        let range = self.range(sending, transducer);
        let mut furnished = None;
        if self.bodies.any() {
            let without = [self.embodied(first), self.embodied(hears)];
            let both = [&sources[..], &sensors].concat();
            furnished = self.bodies.scene(world, &self.robots, &both, without)?;
        }
        let scene = furnished.as_ref().map_or(world.scene(), |furnished| &furnished.scene);
        let limits = Limits { max_order: world.max_order(), max_length_m: range.longest_m };
        self.tracer.pole_order = world.pole_order();
        self.tracer.follow(&world.physics());
        // Bodies shade under any physics.
        self.tracer.pole_shadows |= furnished.is_some();
        // The receiver's gain depends on when the receiver fired, so it cannot be applied here.
        let flat = Transducer { gain: GainProfile::Constant, ..*transducer };
        let query = CrosstalkQuery::new(scene, &sensors, &flat, limits, range.faintest);
        let heights_m = [emitters, listeners].map(|sensors| self.heights_of(scene, sensors));
        let coupling = self.coupling(first, hears);
        let query = CrosstalkQuery { coupling, heights_m: heights_m.each_ref().map(Vec::as_slice), ..query };
        let by_length = matters.map(|matters| self.by_length(listeners, matters));
        let by_length = by_length.as_ref().map(|by_length| by_length as Matters<'_>);
        self.matrix.compute_what_matters(&sources, sending, &mut self.tracer, &query, by_length)?;
        if let Some(furnished) = &furnished {
            furnished.number(self.matrix.bounces_mut());
        }
        Ok(())
    }

    /// Returns a function that is true if sound matters to one of the listeners after a path of a given length.
    fn by_length<'a>(
        &self,
        listeners: &[usize],
        (now, arrives): (u64, Arrives<'a>),
    ) -> impl Fn(usize, f64) -> bool + 'a {
        let c = self.world.scene().air().speed_of_sound();
        // A moving receiver is reached earlier or later by at most this share of the time.
        let slack_of = |&sensor: &usize| {
            let speed = self.velocities[sensor].norm();
            (sensor, speed / (c - speed))
        };
        let slacks: Vec<(usize, f64)> = listeners.iter().map(slack_of).collect();
        move |listener, length_m| {
            let Some(&(sensor, slack)) = slacks.get(listener) else { return true };
            let time_s = length_m / c;
            let slack_s = time_s * slack;
            !(slack_s >= 0.0) || arrives(sensor, now + (time_s * 1e9) as u64, (slack_s * 1e9) as u64 + 2)
        }
    }

    /// Returns the amplitude that the mounting carries from one sensor to another.
    fn coupling(&self, emitter: usize, receiver: usize) -> f64 {
        let on_one = self.coupled(emitter).filter(|&robot| self.coupled(receiver) == Some(robot));
        on_one.map_or(0.0, |robot| self.world.robots()[robot].coupling())
    }

    /// Appends the channels of the paths that matter; paths found for other positions of the sensors are adapted to the
    /// present ones.
    fn hand_out(
        &mut self,
        emitters: &[usize],
        listeners: &[usize],
        matrix: &CrosstalkMatrix,
        found_at: Option<&[Pose]>,
        matters: Option<(u64, Arrives<'_>)>,
        found: &mut impl FnMut(usize, Channel),
    ) {
        let (Some(&first), Some(&hears)) = (emitters.first(), listeners.first()) else { return };
        let [sending, hearing] = [first, hears].map(|sensor| self.transducer_of(sensor));
        let range = self.range(&sending, &hearing);
        let by_length = matters.map(|matters| self.by_length(listeners, matters));
        let moved = found_at.filter(|found_at| **found_at != *self.poses).map(|found_at| {
            let air = self.world.scene().air();
            let arriving = Transducer { frequency_hz: sending.frequency_hz, ..hearing }.piston(air);
            let coupling = self.coupling(first, hears);
            (found_at, Moved { patterns: [sending.piston(air), arriving], coupling })
        });
        for path in matrix.paths() {
            let ends = [emitters[path.emitter as usize], listeners[path.receiver as usize]];
            let mut path = *path;
            if let Some((found_at, moved)) = &moved {
                path = moved.carried(&path, ends.map(|end| [&found_at[end], &self.poses[end]]));
            }
            if found_at.is_some()
                && (by_length.as_ref().is_some_and(|by_length| !by_length(path.receiver as usize, path.length_m))
                    || path.amplitude < range.faintest)
            {
                continue;
            }
            self.bounces.clear();
            self.bounces.extend_from_slice(matrix.bounces(&path));
            if let Some(channel) = self.channel(ends, &path, &range) {
                found(ends[0], channel);
            }
        }
    }

    /// Returns the heights of sensors; empty in a flat scene.
    fn heights_of(&self, scene: &Scene, sensors: &[usize]) -> Vec<f64> {
        let height_m = |&sensor: &usize| self.robot_of(sensor).height_m(usize::from(self.ids[sensor].sensor));
        if scene.room().is_some() { sensors.iter().map(height_m).collect() } else { Vec::new() }
    }

    fn poses_of(&self, sensors: &[usize]) -> Vec<Pose> {
        sensors.iter().map(|&sensor| self.poses[sensor]).collect()
    }

    fn range(&mut self, sending: &Transducer, hearing: &Transducer) -> HearingRange {
        match self.ranges.iter().find(|range| range.is_of(sending, hearing)) {
            Some(range) => *range,
            None => {
                let range = HearingRange::new(sending, hearing, &self.world);
                self.ranges.push(range);
                range
            }
        }
    }

    /// Makes the channel of a path whose bounces are in `self.bounces`.
    fn channel(&mut self, ends: [usize; 2], path: &CriticalPath, range: &HearingRange) -> Option<Channel> {
        let receiver = ends[1];
        let velocity = self.velocities[receiver];
        let c = self.world.scene().air().speed_of_sound();
        let met = reception_at(path.length_m, [path.arrival_rad, path.elevations_rad[1]], velocity, c)?;
        let level_over_threshold_db = 20.0 * libm::log10(path.amplitude / range.floor);
        // Walls, poles, floor and ceiling are hard and keep the phase.
        let bent = self.bounces.iter().filter(|bounce| matches!(bounce, Bounce::Edge(_))).count();
        let turns = bent as f64 * EDGE_TURN - met.time_s * range.frequency_hz();
        let path = self.paths.number(ends.map(|end| self.ids[end]), path, &self.bounces);
        Some(Channel {
            receiver: receiver as u32,
            path,
            key: self.paths.key(path),
            delay: (met.time_s * 1e9).round() as u64,
            turn: (turns - turns.floor()) as f32,
            level_over_threshold_db: level_over_threshold_db as f32,
        })
    }
}
