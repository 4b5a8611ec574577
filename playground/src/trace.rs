//! Every critical path of a ring, with its corners for drawing.

use eeruf_sim::{CrosstalkMatrix, CrosstalkQuery, Limits, Point, Pose, Tracer, World};
use serde::Serialize;

/// The scene and the paths of sound. Metres and radians; sensors from 0.
#[derive(Serialize)]
pub(crate) struct Traced {
    /// Position and heading of each sensor.
    sensors: Vec<[f64; 3]>,
    body_radius_m: f64,
    sound_m_s: f64,
    period_us: u32,
    window_us: u32,
    paths: Vec<TracedPath>,
}

#[derive(Serialize)]
struct TracedPath {
    emitter: u32,
    /// The receiver; equal to the emitter for a sensor's own echo.
    receiver: u32,
    order: u32,
    length_m: f64,
    /// Level above the threshold of hearing.
    level_db: f64,
    corners: Vec<[f64; 2]>,
}

/// Traces the first robot's ring.
pub(crate) fn trace(world: &World) -> Result<Traced, String> {
    let robot = world.robots().first().ok_or("no robot; expected one")?;
    let (scene, transducer) = (world.scene(), &robot.transducer);
    let ring: Vec<Pose> = world.sensors(0, 0.0).collect();
    let floor = transducer.detection_floor(scene.air());
    let limits = Limits::order(world.max_order());
    let mut matrix = CrosstalkMatrix::new();
    matrix
        .compute(&mut Tracer::new(), &CrosstalkQuery::new(scene, &ring, transducer, limits, floor))
        .map_err(|error| error.to_string())?;
    let position = |sensor: u32| Some(Point::from(ring.get(sensor as usize)?.translation.vector));
    let paths = matrix.paths().iter().filter_map(|path| {
        let ends = (position(path.emitter)?, position(path.receiver)?);
        let corners = scene.bounce_points(ends.0, ends.1, matrix.bounces(path))?;
        Some(TracedPath {
            emitter: path.emitter,
            receiver: path.receiver,
            order: path.order,
            length_m: path.length_m,
            level_db: transducer.level_db(path.amplitude, path.length_m, scene.air()),
            corners: pairs(&corners),
        })
    });
    Ok(Traced {
        paths: paths.collect(),
        sensors: ring.iter().map(|pose| [pose.translation.x, pose.translation.y, pose.rotation.angle()]).collect(),
        body_radius_m: robot.radius_m(),
        sound_m_s: scene.air().speed_of_sound(),
        period_us: robot.period.as_micros(),
        window_us: robot.window.as_micros(),
    })
}

/// Converts points to JSON.
pub(crate) fn pairs(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(|point| [point.x, point.y]).collect()
}
