//! Simulated readings as an MCAP file, for Foxglove, Rerun and whatever reads ROS 2: ranges, poses, the scene, and
//! along which path each reading came.
//!
//! Ranges are `sensor_msgs/msg/Range` in CDR; poses, scene and paths are Foxglove's own messages in JSON. Sensors and
//! robots are counted from 1 in the names of topics and frames.

use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_logs::{McapWriter, Reading};
use eeruf_sim::experiments::set_two::Place;
use eeruf_sim::{HeardPath, Point, Pose, Readings, SensorId, Vector, World};
use serde_json::{Value, json};

use super::error::InputError;
use super::firings::{CLOCK, firing};

/// The simulation begins at 2000-01-01: a stamp of zero means that there is none.
const START_NS: u64 = 946_684_800_000_000_000;
/// From pose to pose.
const POSES_S: f64 = 0.05;
/// A path is shown for so long.
const SHOWN_NS: u64 = 120_000_000;

/// A world and where its robots are.
pub(crate) struct Stage<'a> {
    world: &'a World,
    /// Where the first robot was, if it did not move as the world says.
    track: &'a [Place],
}

impl<'a> Stage<'a> {
    /// Robots move as the world says.
    pub(crate) fn of(world: &'a World) -> Self {
        Self { world, track: &[] }
    }

    /// The first robot was driven; its places are in order of time.
    pub(crate) fn driven(world: &'a World, track: &'a [Place]) -> Self {
        Self { world, track }
    }

    fn pose(&self, robot: usize, time_s: f64) -> Pose {
        let after = self.track.partition_point(|place| place.time_s <= time_s);
        let (before, after) = (self.track.get(after.saturating_sub(1)), self.track.get(after));
        match (robot, before, after) {
            (0, Some(before), Some(after)) if after.time_s > before.time_s => {
                let share = ((time_s - before.time_s) / (after.time_s - before.time_s)).clamp(0.0, 1.0);
                let between = |from: f64, to: f64| from + share * (to - from);
                // The shorter way round.
                let turn = (after.heading_rad - before.heading_rad)
                    .sin()
                    .atan2((after.heading_rad - before.heading_rad).cos());
                let place = Vector::new(between(before.x_m, after.x_m), between(before.y_m, after.y_m));
                Pose::new(place, before.heading_rad + share * turn)
            }
            (0, Some(last), _) => Pose::new(Vector::new(last.x_m, last.y_m), last.heading_rad),
            _ => self.world.robots().get(robot).map_or_else(Pose::identity, |of| of.motion.at(&of.pose, time_s).pose),
        }
    }

    fn position(&self, id: SensorId, time_s: f64) -> Option<Point> {
        let robot = usize::from(id.robot);
        let mounted = self.world.robots().get(robot)?.sensors.get(usize::from(id.sensor))?;
        Some(Point::from((self.pose(robot, time_s) * mounted).translation.vector))
    }
}

/// Writes all runs into one file, each under the name of its method.
pub(crate) fn write_mcap(file: &Path, stage: &Stage<'_>, runs: &[Readings]) -> Result<(), InputError> {
    let mut out = McapWriter::create(file)?;
    // A robot that was driven may have arrived before the time was over.
    let fired_s = |run: &Readings| run.fired_s.iter().copied().fold(0.0, f64::max);
    let end_s = runs.iter().map(fired_s).fold(0.0, f64::max);
    out.json("/scene", "foxglove.SceneUpdate", START_NS, &scene(stage.world).to_string())?;
    let steps = (end_s / POSES_S).ceil() as u64;
    for step in 0..=steps {
        poses(&mut out, stage, step as f64 * POSES_S)?;
    }
    for run in runs {
        readings(&mut out, stage, run)?;
    }
    Ok(out.finish()?)
}

fn at_ns(time_s: f64) -> u64 {
    START_NS + (1e9 * time_s.max(0.0)).round() as u64
}

fn stamp(at_ns: u64) -> Value {
    json!({"sec": at_ns / 1_000_000_000, "nsec": at_ns % 1_000_000_000})
}

fn sensor_frame(id: SensorId) -> String {
    format!("robot_{}/sonar_{}", id.robot + 1, id.sensor + 1)
}

fn point(at: &Point) -> Value {
    json!({"x": at.x, "y": at.y, "z": 0.0})
}

/// Half the angle makes the quaternion.
fn turned(pose: &Pose) -> Value {
    let (z, w) = (0.5 * pose.rotation.angle()).sin_cos();
    json!({"x": 0.0, "y": 0.0, "z": z, "w": w})
}

/// A line strip, as Foxglove has it.
fn line(points: &[Value], colour: [f64; 4], thickness: f64) -> Value {
    let [r, g, b, a] = colour;
    json!({
        "type": 0, "thickness": thickness, "scale_invariant": true, "points": points, "colors": [], "indices": [],
        "pose": {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}},
        "color": {"r": r, "g": g, "b": b, "a": a},
    })
}

/// An entity in the world's frame; a lifetime of zero is for ever.
fn entity(id: &str, at_ns: u64, lifetime_ns: u64, lines: &[Value], cylinders: &[Value]) -> Value {
    json!({
        "timestamp": stamp(at_ns), "frame_id": "world", "id": id, "lifetime": stamp(lifetime_ns),
        "frame_locked": false, "metadata": [], "arrows": [], "cubes": [], "spheres": [], "triangles": [],
        "texts": [], "models": [], "lines": lines, "cylinders": cylinders,
    })
}

fn scene(world: &World) -> Value {
    let scene = world.scene();
    let wall = |wall: &eeruf_sim::Wall| line(&[point(&wall.from), point(&wall.to)], [0.2, 0.2, 0.25, 1.0], 3.0);
    let walls: Vec<_> = scene.walls().iter().map(wall).collect();
    let pole = |pole: &eeruf_sim::Pole| {
        json!({
            "pose": {"position": point(&pole.centre), "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}},
            "size": {"x": 2.0 * pole.radius_m, "y": 2.0 * pole.radius_m, "z": 0.5},
            "bottom_scale": 1.0, "top_scale": 1.0, "color": {"r": 0.2, "g": 0.2, "b": 0.25, "a": 1.0},
        })
    };
    let poles: Vec<_> = scene.poles().iter().map(pole).collect();
    json!({"deletions": [], "entities": [entity("scene", START_NS, 0, &walls, &poles)]})
}

/// Where robots and sensors are at a moment: transforms, and each robot's pose, which is its odometry without error.
fn poses(out: &mut McapWriter, stage: &Stage<'_>, time_s: f64) -> Result<(), InputError> {
    let now = at_ns(time_s);
    let transform = |parent: &str, child: &str, pose: &Pose| {
        json!({
            "timestamp": stamp(now), "parent_frame_id": parent, "child_frame_id": child,
            "translation": {"x": pose.translation.x, "y": pose.translation.y, "z": 0.0}, "rotation": turned(pose),
        })
    };
    let mut transforms = Vec::new();
    for (number, robot) in stage.world.robots().iter().enumerate() {
        let name = format!("robot_{}", number + 1);
        let pose = stage.pose(number, time_s);
        transforms.push(transform("world", &name, &pose));
        for (sensor, mounted) in robot.sensors.iter().enumerate() {
            let id = SensorId { robot: number as u16, sensor: sensor as u8 };
            transforms.push(transform(&name, &sensor_frame(id), mounted));
        }
        let place = json!({"x": pose.translation.x, "y": pose.translation.y, "z": 0.0});
        let message = json!({
            "timestamp": stamp(now), "frame_id": "world", "pose": {"position": place, "orientation": turned(&pose)},
        });
        out.json(&format!("/{name}/pose"), "foxglove.PoseInFrame", now, &message.to_string())?;
    }
    let message = json!({"transforms": transforms}).to_string();
    Ok(out.json("/tf", "foxglove.FrameTransforms", now, &message)?)
}

/// Each reading as a range, what the method accepts beside it, its path, and the firings of the first robot as
/// `diagnose` reads them.
fn readings(out: &mut McapWriter, stage: &Stage<'_>, run: &Readings) -> Result<(), InputError> {
    let world = stage.world;
    let c = world.scene().air().speed_of_sound();
    let mut order: Vec<_> = (0..run.len()).collect();
    order.sort_by(|&a, &b| run.fired_s[a].total_cmp(&run.fired_s[b]));
    for k in order {
        let id = run.id(k);
        let robot = &world.robots()[usize::from(id.robot)];
        let metres = |us: f64| if us.is_nan() { f64::INFINITY } else { 0.5e-6 * us * c };
        let reading = Reading {
            sensor: usize::from(id.sensor),
            at_ns: at_ns(run.fired_s[k]),
            radiation: 0,
            field_of_view_rad: 0.26,
            min_range_m: metres(f64::from(robot.blanking.as_micros())),
            max_range_m: metres(f64::from(robot.window.as_micros())),
            range_m: metres(run.earliest_us[k]),
            variance: Some(0.0),
        };
        let (frame, topic) = (sensor_frame(id), format!("/{}/{}", run.method, sensor_frame(id)));
        out.range(&topic, &frame, &reading)?;
        if id.robot == 0 {
            out.firing(&format!("/{}/firings", run.method), CLOCK, reading.at_ns, &firing(run, k))?;
        }
        if run.is_accepted(k) {
            let range_m = if run.kind[k] == ReadingKind::Clear { f64::INFINITY } else { metres(run.t_echo_us[k]) };
            out.range(&format!("{topic}/accepted"), &frame, &Reading { range_m, ..reading })?;
        }
        if let Some(points) = run.path_of(k).and_then(|path| corners(stage, path, run.emitted_s[k], c)) {
            let is_own = run.path_of(k).is_some_and(|path| path.emitter == path.receiver);
            // Its own echo in green, another's sound in red where it is believed, else in yellow.
            let colour = match (is_own, run.is_accepted(k)) {
                (true, _) => [0.30, 0.62, 0.44, 0.6],
                (false, true) => [0.82, 0.29, 0.36, 1.0],
                (false, false) => [0.93, 0.78, 0.42, 0.8],
            };
            let points: Vec<_> = points.iter().map(point).collect();
            let entity = entity(&frame, reading.at_ns, SHOWN_NS, &[line(&points, colour, 1.5)], &[]);
            let message = json!({"deletions": [], "entities": [entity]}).to_string();
            out.json(&format!("/{}/paths", run.method), "foxglove.SceneUpdate", reading.at_ns, &message)?;
        }
    }
    Ok(())
}

/// Where the path of a reading ran.
fn corners(stage: &Stage<'_>, path: &HeardPath, sent_s: f64, c: f64) -> Option<Vec<Point>> {
    let (from, to) =
        (stage.position(path.emitter, sent_s)?, stage.position(path.receiver, sent_s + path.length_m / c)?);
    stage.world.scene().bounce_points(from, to, &path.bounces)
}
