//! Writes a world file.

use eeruf_core::{Micros, SensorLimits};
use eeruf_modules::{KEYS, Module, Value as Figure, find};
use toml::{Table, Value};

use super::fault::fault_table;
use super::schedule_file::ScheduleFile;
use crate::{
    acoustics::{Physics, Transducer},
    geometry::Pose,
    scene::{Body, Faces, Material, Room, Scene},
    world::{fault::Fault, motion::Motion, noise::Noise, robot::Robot},
};

/// Writes the world file of a scene with these robots, noise, physics, order, seed and faults: reading it again gives
/// the same, bit for bit, with the schedules in it. Only the last bit of a heading may move, and only the first time;
/// see [`heading_rad`].
pub fn world_file(
    scene: &Scene,
    robots: &[Robot],
    noise: &Noise,
    physics: &Physics,
    max_order: u32,
    seed: u64,
    faults: &[Fault],
) -> String {
    let mut file = Table::new();
    // TOML's whole numbers end at 2^63.
    let seed = i64::try_from(seed).map_or_else(|_| Value::from(seed.to_string()), Value::from);
    file.insert("seed".to_owned(), seed);
    set(&mut file, "max_order", i64::from(max_order));
    let (mut air, sound) = (Table::new(), scene.air());
    set(&mut air, "temperature_c", sound.temperature_c);
    set(&mut air, "humidity_percent", sound.humidity_percent);
    set(&mut air, "pressure_kpa", sound.pressure_kpa);
    set(&mut file, "air", air);
    let mut loud = Table::new();
    set(&mut loud, "fading_db_rms", noise.fading_db_rms);
    set(&mut loud, "jitter_us_rms", noise.jitter_us_rms);
    set(&mut loud, "bursts_per_s", noise.bursts_per_s);
    set(&mut loud, "burst_db", noise.burst_db);
    set(&mut file, "noise", loud);
    match physics.name() {
        Some(name) => set(&mut file, "physics", name),
        None => {
            let mut effects = Table::new();
            set(&mut effects, "shadows", physics.shadows);
            set(&mut effects, "edges", physics.edges);
            set(&mut effects, "narrow_panels", physics.narrow_panels);
            set(&mut effects, "range_walk", physics.range_walk);
            set(&mut effects, "interference", physics.interference);
            set(&mut effects, "fading_time_s", physics.fading_time_s);
            set(&mut file, "physics", effects);
        }
    }
    match scene.room() {
        None => set(&mut file, "height", "flat"),
        Some(room) if *room == Room::DEFAULT => set(&mut file, "height", "room"),
        Some(room) => {
            let mut height = Table::new();
            set(&mut height, "ceiling_m", room.ceiling_m);
            for (name, material) in [("floor", &room.floor), ("ceiling", &room.ceiling)] {
                let mut table = Table::new();
                surface(&mut table, material);
                set(&mut height, name, table);
            }
            set(&mut file, "height", height);
        }
    }
    let walls = scene.walls().iter().map(|wall| {
        let mut table = Table::new();
        set(&mut table, "points_m", vec![vec![wall.from.x, wall.from.y], vec![wall.to.x, wall.to.y]]);
        let faces = match wall.faces {
            Faces::Left => None,
            Faces::Both => Some("both"),
            Faces::Open => Some("open"),
        };
        if let Some(faces) = faces {
            set(&mut table, "faces", faces);
        }
        surface(&mut table, &wall.material);
        Value::Table(table)
    });
    list(&mut file, "wall", walls.collect());
    let poles = scene.poles().iter().map(|pole| {
        let mut table = Table::new();
        set(&mut table, "at_m", vec![pole.centre.x, pole.centre.y]);
        set(&mut table, "radius_m", pole.radius_m);
        surface(&mut table, &pole.material);
        Value::Table(table)
    });
    list(&mut file, "pole", poles.collect());
    list(&mut file, "robot", robots.iter().map(|robot| Value::Table(robot_table(robot))).collect());
    list(&mut file, "fault", faults.iter().map(|fault| Value::Table(fault_table(fault))).collect());
    file.to_string()
}

fn list(table: &mut Table, key: &str, entries: Vec<Value>) {
    if !entries.is_empty() {
        set(table, key, entries);
    }
}

fn surface(table: &mut Table, material: &Material) {
    set(table, "reflection", material.reflection);
    set(table, "roughness_m", material.roughness_m);
}

fn pose_table(pose: &Pose) -> Table {
    let mut table = Table::new();
    set(&mut table, "x_m", pose.translation.x);
    set(&mut table, "y_m", pose.translation.y);
    set(&mut table, "heading_rad", heading_rad(pose));
    table
}

/// An angle whose pose is this one, bit for bit where there is one near by: sine and cosine are what a pose holds, and
/// of those there are more than of angles. Where there is none, as after several turns, it is one whose pose differs in
/// the last bits, and whose own heading is that angle again.
pub fn heading_rad(pose: &Pose) -> f64 {
    let angle = pose.rotation.angle();
    exact_angle(pose).or_else(|| exact_angle(&Pose::rotation(angle))).unwrap_or(angle)
}

/// An angle whose sine and cosine are those of this pose.
fn exact_angle(pose: &Pose) -> Option<f64> {
    let angle = pose.rotation.angle();
    // What was given may have been up to a turn more or less.
    for turned in [0.0, core::f64::consts::TAU, -core::f64::consts::TAU] {
        let (mut above, mut below) = (angle + turned, angle + turned);
        for _ in 0..8 {
            for candidate in [above, below] {
                if Pose::rotation(candidate).rotation == pose.rotation {
                    return Some(candidate);
                }
            }
            (above, below) = (above.next_up(), below.next_down());
        }
    }
    None
}

/// A preset by name, or a table of all figures.
fn module_value(module: &Module) -> Value {
    if find(module.name) == Some(module) {
        return Value::from(module.name);
    }
    let mut table = Table::new();
    set(&mut table, "like", module.name);
    for key in &KEYS {
        match key.of(module) {
            Figure::Number(number) if key.is_whole() => set(&mut table, key.name, number as i64),
            Figure::Number(number) => set(&mut table, key.name, number),
            Figure::Word(word) => set(&mut table, key.name, word),
        }
    }
    Value::Table(table)
}

fn robot_table(robot: &Robot) -> Table {
    let mut table = Table::new();
    set(&mut table, "pose", pose_table(&robot.pose));
    let sensors: Vec<Value> = robot.sensors.iter().map(|sensor| Value::Table(pose_table(sensor))).collect();
    set(&mut table, "sensors", sensors);
    if robot.modules.is_empty() {
        let Transducer { gain, beam, .. } = robot.transducer;
        let module = robot.module_of(0);
        // A preset but for these two, which have keys of their own.
        let preset = find(module.name).filter(|preset| Module { gain, beam, ..**preset } == module);
        set(&mut table, "module", preset.map_or_else(|| module_value(&module), |preset| Value::from(preset.name)));
        set(&mut table, "gain", gain.name());
        set(&mut table, "beam", beam.name());
    } else {
        set(&mut table, "module", robot.modules.iter().map(module_value).collect::<Vec<_>>());
    }
    if let Some(coupling_db) = robot.coupling_db {
        set(&mut table, "coupling_db", coupling_db);
    }
    if !robot.heights_m.is_empty() {
        set(&mut table, "height_m", robot.heights_m.clone());
    }
    if let Some(body) = &robot.body {
        let mut outline = Table::new();
        match body {
            Body::Disc(radius_m) => set(&mut outline, "radius_m", *radius_m),
            Body::Box(length_m, width_m) => set(&mut outline, "box_m", vec![*length_m, *width_m]),
            Body::Polygon(polygon) => {
                let corners: Vec<_> = polygon.corners().iter().map(|corner| vec![corner.x, corner.y]).collect();
                set(&mut outline, "corners_m", corners);
            }
        }
        set(&mut table, "body", outline);
    }
    let mut motion = Table::new();
    match &robot.motion {
        Motion::Still => {}
        Motion::Constant { velocity, turn_rad_s } => {
            set(&mut motion, "velocity_m_s", vec![velocity.x, velocity.y]);
            set(&mut motion, "turn_rad_s", *turn_rad_s);
        }
        Motion::Waypoints { points, speed_m_s } => {
            set(&mut motion, "waypoints_m", points.iter().map(|at| vec![at.x, at.y]).collect::<Vec<_>>());
            set(&mut motion, "speed_m_s", *speed_m_s);
        }
    }
    if !motion.is_empty() {
        set(&mut table, "motion", motion);
    }
    let mut clock = Table::new();
    set(&mut clock, "offset_us", i64::from(robot.clock.offset_us));
    set(&mut clock, "drift_ppm", robot.clock.drift_ppm);
    set(&mut table, "clock", clock);
    if robot.others {
        set(&mut table, "others", true);
    }
    if let Some(schedule) =
        robot.schedule.as_ref().and_then(|schedule| Table::try_from(ScheduleFile::from(schedule)).ok())
    {
        set(&mut table, "schedule", schedule);
    }
    let times: [(&str, Micros); 7] = [
        ("start_us", robot.start),
        ("period_us", robot.period),
        ("t_delta_us", robot.t_delta),
        ("window_us", robot.window),
        ("blanking_us", robot.blanking),
        ("min_refire_us", robot.min_refire),
        ("audible_us", robot.audible),
    ];
    for (key, time) in times {
        set(&mut table, key, i64::from(time.as_micros()));
    }
    if let Some(change) = robot.path_change {
        set(&mut table, "path_change_us", i64::from(change.as_micros()));
    }
    if !robot.blankings.is_empty() {
        let each = robot.blankings.iter().map(|blanking| i64::from(blanking.as_micros()));
        set(&mut table, "blanking_us", each.collect::<Vec<_>>());
    }
    if !robot.limits.is_empty() {
        let list = |of: fn(&SensorLimits) -> Micros| {
            robot.limits.iter().map(|limits| i64::from(of(limits).as_micros())).collect::<Vec<_>>()
        };
        set(&mut table, "t_delta_us", list(|limits| limits.t_delta));
        set(&mut table, "window_us", list(|limits| limits.window));
    }
    if !robot.together.is_empty() {
        let members = |set: &u64| (0..64_i64).filter(|sensor| set >> sensor & 1 == 1).collect::<Vec<_>>();
        set(&mut table, "together", robot.together.iter().map(members).collect::<Vec<_>>());
    }
    for (key, number) in [("neighbours", robot.neighbours), ("consecutive", robot.consecutive)] {
        set(&mut table, key, i64::from(number));
    }
    set(&mut table, "odometry", robot.odometry);
    let firing = robot.firing.to_table();
    if !firing.is_empty() {
        set(&mut table, "firing", firing);
    }
    table
}

/// Sets a value under a key.
pub(super) fn set(table: &mut Table, key: &str, value: impl Into<Value>) {
    table.insert(key.to_owned(), value.into());
}
