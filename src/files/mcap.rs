//! Simulated readings as an MCAP file, for Foxglove, Rerun and readers of ROS 2: ranges, poses, the scene, and each
//! reading's path.
//!
//! All messages are those of ROS 2, in CDR. Sensors and robots are counted from 1 in the names of topics and frames.

use std::path::Path;
use std::sync::Arc;

use eeruf_core::ReadingKind;
use eeruf_files::FileError;
use eeruf_logs::{LogReading, Marker, McapWriter, Placement, Shape, Transform};
use eeruf_sim::experiments::set_two::TrackPoint;
use eeruf_sim::{HeardPath, Moment, Point, Pose, Readings, Scene, SensorId, Simulation, Vector, World};

use super::error::InputError;
use super::firings::{CLOCK, firing};

/// The simulation begins at 2000-01-01: a stamp of zero would mean no time.
const START_NS: u64 = 946_684_800_000_000_000;
/// Seconds between two poses.
const POSES_S: f64 = 0.05;
/// Time for which a path is shown.
const SHOWN_NS: u64 = 120_000_000;

/// Time for which replaced scenes are kept, longer than sound travels.
const KEPT_S: f64 = 10.0;

/// A world with the places of its robots.
pub(crate) struct Stage<'a> {
    world: &'a World,
    /// Worlds with the later scenes, each with the time in seconds from which it holds, in order of time.
    changes: &'a [(Arc<World>, f64)],
    /// The place and velocity of a robot at a time in seconds, if they are known.
    moment: Box<dyn Fn(usize, f64) -> Option<Moment> + 'a>,
}

impl<'a> Stage<'a> {
    /// Makes a stage whose robots move as the world says.
    pub(crate) fn of(world: &'a World) -> Self {
        Self { world, changes: &[], moment: Box::new(|robot, time_s| planned(world, robot, time_s)) }
    }

    /// Makes a stage whose first robot was driven; its places are in order of time.
    pub(crate) fn driven(world: &'a World, track: &'a [TrackPoint]) -> Self {
        let moment = |robot, time_s| if robot == 0 { on_track(track, time_s) } else { planned(world, robot, time_s) };
        Self { world, changes: &[], moment: Box::new(moment) }
    }

    /// Makes a stage whose robots are steered, among scenes that change.
    fn under_way(simulation: &'a Simulation, changes: &'a [(Arc<World>, f64)]) -> Self {
        // Computed times may be off by a rounding error.
        let known = |time_s: f64| time_s.clamp(0.0, simulation.time_s());
        let moment = move |robot, time_s| simulation.moment_at(robot, known(time_s)).ok();
        Self { world: simulation.world(), changes, moment: Box::new(moment) }
    }

    /// Returns the scene for sound sent at this time.
    fn scene(&self, sent_s: f64) -> &Scene {
        let changed = self.changes.iter().rfind(|(_, since_s)| *since_s <= sent_s);
        changed.or_else(|| self.changes.first()).map_or(self.world, |(world, _)| &**world).scene()
    }

    fn pose(&self, robot: usize, time_s: f64) -> Option<Pose> {
        Some((self.moment)(robot, time_s)?.pose)
    }

    fn position(&self, id: SensorId, time_s: f64) -> Option<Point> {
        let robot = usize::from(id.robot);
        let mounted = self.world.robots().get(robot)?.sensors.get(usize::from(id.sensor))?;
        Some(Point::from((self.pose(robot, time_s)? * mounted).translation.vector))
    }
}

fn planned(world: &World, robot: usize, time_s: f64) -> Option<Moment> {
    let robot = world.robots().get(robot)?;
    Some(robot.motion.at(&robot.pose, time_s))
}

/// Returns the place between two given ones, or the last one.
fn on_track(track: &[TrackPoint], time_s: f64) -> Option<Moment> {
    let after = track.partition_point(|place| place.time_s <= time_s);
    let (before, after) = (track.get(after.saturating_sub(1))?, track.get(after));
    let Some(after) = after.filter(|after| after.time_s > before.time_s) else {
        let pose = Pose::new(Vector::new(before.x_m, before.y_m), before.heading_rad);
        return Some(Moment { pose, velocity: Vector::zeros(), turn_rad_s: 0.0 });
    };
    let lasts_s = after.time_s - before.time_s;
    let way = Vector::new(after.x_m - before.x_m, after.y_m - before.y_m);
    // The robot turns the shorter way round.
    let turn = after.heading_rad - before.heading_rad;
    let turn = turn.sin().atan2(turn.cos());
    let share = ((time_s - before.time_s) / lasts_s).clamp(0.0, 1.0);
    let place = Vector::new(before.x_m, before.y_m) + share * way;
    let pose = Pose::new(place, before.heading_rad + share * turn);
    Some(Moment { pose, velocity: way / lasts_s, turn_rad_s: turn / lasts_s })
}

/// Writes all runs into one file, each under the name of its method.
pub(crate) fn write_mcap(file: &Path, stage: &Stage<'_>, runs: &[Readings]) -> Result<(), InputError> {
    let mut out = McapWriter::create(file)?;
    // A robot that was driven may have arrived before the time was over.
    let fired_s = |run: &Readings| run.fired_s.iter().copied().fold(0.0, f64::max);
    let end_s = runs.iter().map(fired_s).fold(0.0, f64::max);
    scene(&mut out, stage.world.scene(), 0.0)?;
    let steps = (end_s / POSES_S).ceil() as u64;
    for step in 0..=steps {
        poses(&mut out, stage, step as f64 * POSES_S)?;
    }
    for run in runs {
        readings(&mut out, stage, run)?;
    }
    Ok(out.finish()?)
}

/// An MCAP file of a [`Simulation`], written while it runs, with the contents of `eeruf study --mcap`: ranges, accepted
/// readings, poses, the scene and its changes, each reading's path and each firing; `docs/how-to/logs.md` lists the
/// topics.
///
/// ```
/// use eeruf_sim::*;
/// use std::sync::Arc;
/// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
/// let wall = Wall::new(2.0, -5.0, 2.0, 5.0).with_faces(Faces::Both);
/// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
/// let mut simulation = Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default())?;
/// let file = std::env::temp_dir().join("eeruf-recording-example.mcap");
/// let mut recording = eeruf::Recording::create(&file, &simulation)?;
/// for step in 0..20 {
///     simulation.set_velocity(0, 0.02 * f64::from(step), 0.1)?;
///     let readings = simulation.step(0.06, |_| true)?;
///     recording.add(&simulation, &readings)?;
/// }
/// recording.finish()?;
/// # std::fs::remove_file(&file)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Recording {
    out: McapWriter,
    /// Time of the next poses, counted in steps.
    next: u64,
    /// The latest scenes, each in its world, and the time from which each holds, in seconds.
    scenes: Vec<(Arc<World>, f64)>,
}

impl Recording {
    /// Creates the file, and writes the scene.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(file: &Path, simulation: &Simulation) -> Result<Self, FileError> {
        let mut out = McapWriter::create(file)?;
        let (world, since_s) = simulation.world_now();
        scene(&mut out, world.scene(), simulation.time_s())?;
        let next = (simulation.time_s() / POSES_S).ceil() as u64;
        Ok(Self { out, next, scenes: vec![(Arc::clone(world), since_s)] })
    }

    /// Adds the readings of a step, the robots' poses since the previous step, and the scene if it has changed.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, simulation: &Simulation, read: &Readings) -> Result<(), FileError> {
        let (world, since_s) = simulation.world_now();
        if !self.scenes.last().is_some_and(|(known, _)| Arc::ptr_eq(known, world)) {
            scene(&mut self.out, world.scene(), since_s)?;
            self.scenes.push((Arc::clone(world), since_s));
        }
        let stage = Stage::under_way(simulation, &self.scenes);
        while self.next as f64 * POSES_S <= simulation.time_s() {
            poses(&mut self.out, &stage, self.next as f64 * POSES_S)?;
            self.next += 1;
        }
        readings(&mut self.out, &stage, read)?;
        drop(stage);
        let kept_s = simulation.time_s() - KEPT_S;
        let gone = self.scenes.iter().skip(1).take_while(|(_, since_s)| *since_s < kept_s).count();
        self.scenes.drain(..gone);
        Ok(())
    }

    /// Writes the rest and the index. A dropped recording does so too, but cannot report a failure.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), FileError> {
        self.out.finish()
    }
}

fn at_ns(time_s: f64) -> u64 {
    START_NS + (1e9 * time_s.max(0.0)).round() as u64
}

fn sensor_frame(id: SensorId) -> String {
    format!("robot_{}/sonar_{}", id.robot + 1, id.sensor + 1)
}

fn placement(pose: &Pose) -> Placement {
    Placement::planar(pose.translation.x, pose.translation.y, pose.rotation.angle())
}

fn marker(namespace: &str, id: usize, shape: Shape, colour: [f32; 4], lifetime_ns: u64) -> Marker {
    let (frame, namespace) = ("world".to_owned(), namespace.to_owned());
    Marker { frame, namespace, id: id as i32, shape, colour, lifetime_ns }
}

/// Writes walls and poles, in place of earlier ones.
fn scene(out: &mut McapWriter, scene: &Scene, time_s: f64) -> Result<(), FileError> {
    const COLOUR: [f32; 4] = [0.2, 0.2, 0.25, 1.0];
    let walls = scene.walls().iter().flat_map(|wall| [wall.from, wall.to]);
    let walls = Shape::Lines(walls.map(|end| [end.x, end.y, 0.0]).collect(), 0.02);
    let mut markers = vec![marker("", 0, Shape::Clear, COLOUR, 0), marker("walls", 0, walls, COLOUR, 0)];
    for (number, pole) in scene.poles().iter().enumerate() {
        let place = Placement::planar(pole.centre.x, pole.centre.y, 0.0);
        let shape = Shape::Cylinder(place, 2.0 * pole.radius_m, 0.5);
        markers.push(marker("poles", number, shape, COLOUR, 0));
    }
    out.markers("/scene", at_ns(time_s), &markers)
}

/// Writes the poses of robots and sensors at a moment: transforms, and each robot's odometry, without error.
fn poses(out: &mut McapWriter, stage: &Stage<'_>, time_s: f64) -> Result<(), FileError> {
    let now = at_ns(time_s);
    let transform = |parent: &str, child: &str, pose: &Pose| Transform {
        parent: parent.to_owned(),
        child: child.to_owned(),
        placement: placement(pose),
    };
    let mut transforms = Vec::new();
    for (number, robot) in stage.world.robots().iter().enumerate() {
        let name = format!("robot_{}", number + 1);
        let Some(Moment { pose, velocity, turn_rad_s }) = (stage.moment)(number, time_s) else { continue };
        let of = transform("world", &name, &pose);
        let ahead = pose.rotation.inverse() * velocity;
        out.odometry(&format!("/{name}/odom"), now, &of, [ahead.x, ahead.y, 0.0], [0.0, 0.0, turn_rad_s])?;
        transforms.push(of);
        for (sensor, mounted) in robot.sensors.iter().enumerate() {
            let id = SensorId { robot: number as u16, sensor: sensor as u8 };
            transforms.push(transform(&name, &sensor_frame(id), mounted));
        }
    }
    out.transforms("/tf", now, &transforms)
}

/// Writes each reading as a range, its accepted range, its path, and the firings of the first robot as `diagnose` reads
/// them.
fn readings(out: &mut McapWriter, stage: &Stage<'_>, run: &Readings) -> Result<(), FileError> {
    let world = stage.world;
    let mut order: Vec<_> = (0..run.len()).collect();
    order.sort_by(|&a, &b| run.fired_s[a].total_cmp(&run.fired_s[b]));
    for k in order {
        let id = run.id(k);
        let robot = &world.robots()[usize::from(id.robot)];
        let c = stage.scene(run.fired_s[k]).air().speed_of_sound();
        let metres = |us: f64| if us.is_nan() { f64::INFINITY } else { 0.5e-6 * us * c };
        let fired_ns = at_ns(run.fired_s[k]);
        let reading = LogReading {
            sensor: usize::from(id.sensor),
            at_ns: Some(fired_ns),
            radiation: 0,
            field_of_view_rad: 0.26,
            min_range_m: metres(f64::from(robot.blanking_of(usize::from(id.sensor)).as_micros())),
            max_range_m: metres(f64::from(robot.window.as_micros())),
            range_m: metres(run.earliest_us[k]),
            variance: Some(0.0),
        };
        let (frame, topic) = (sensor_frame(id), format!("/{}/{}", run.method, sensor_frame(id)));
        out.range(&topic, &frame, &reading)?;
        if id.robot == 0 {
            out.firing(&format!("/{}/firings", run.method), CLOCK, fired_ns, &firing(run, k))?;
        }
        if run.is_accepted(k) {
            let range_m = if run.kind[k] == ReadingKind::Clear { f64::INFINITY } else { metres(run.t_echo_us[k]) };
            out.range(&format!("{topic}/accepted"), &frame, &LogReading { range_m, ..reading })?;
        }
        if let Some(points) = run.path_of(k).and_then(|path| corners(stage, path, run.emitted_s[k])) {
            let is_own = run.path_of(k).is_some_and(|path| path.emitter == path.receiver);
            // The sensor's own echo is green; another's sound is red if it is believed, else yellow.
            let colour = match (is_own, run.is_accepted(k)) {
                (true, _) => [0.30, 0.62, 0.44, 0.6],
                (false, true) => [0.82, 0.29, 0.36, 1.0],
                (false, false) => [0.93, 0.78, 0.42, 0.8],
            };
            let points = points.iter().map(|point| [point.x, point.y, 0.0]).collect();
            let drawn = marker(&frame, 0, Shape::Strip(points, 0.01), colour, SHOWN_NS);
            out.markers(&format!("/{}/paths", run.method), fired_ns, &[drawn])?;
        }
    }
    Ok(())
}

/// Returns the corners of the path of a reading.
fn corners(stage: &Stage<'_>, path: &HeardPath, sent_s: f64) -> Option<Vec<Point>> {
    let scene = stage.scene(sent_s);
    let heard_s = sent_s + path.length_m / scene.air().speed_of_sound();
    scene.bounce_points(stage.position(path.emitter, sent_s)?, stage.position(path.receiver, heard_s)?, &path.bounces)
}
