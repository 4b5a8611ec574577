//! The times after which a ring's sensors hear each other and themselves in a scene, for `c/arduino/world/world.c`.
//!
//! ```text
//! cargo lab echo-times SCENE.toml [SENSORS]
//! ```
//!
//! One line for each audible path: emitter, receiver (from 0), time in microseconds. `SENSORS` sets the number of
//! sensors of the first robot's ring, evenly spaced.

use std::path::PathBuf;

use eeruf_sim::{CrosstalkMatrix, CrosstalkQuery, Limits, Tracer, World};

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let (file, sensors) = match arguments {
        [file] => (PathBuf::from(file), None),
        [file, sensors] => (PathBuf::from(file), Some(sensors.parse::<u32>()?)),
        _ => return Err("expected SCENE.toml [SENSORS]".into()),
    };
    let mut text = std::fs::read_to_string(&file)?;
    if let Some(sensors) = sensors {
        let ring = format!("ring = {{ sensors = {sensors}, spacing_deg = {}.0, radius_m = 0.20 }}", 360 / sensors);
        let lines = text.lines().map(|line| if line.starts_with("ring =") { &ring } else { line });
        text = lines.collect::<Vec<_>>().join("\n");
    }
    let world = World::from_text(&file, &text)?;
    let robot = world.robots().first().ok_or("a scene without a robot")?;
    let (scene, transducer) = (world.scene(), &robot.transducer);
    let sensors: Vec<_> = world.sensors(0, 0.0).collect();
    let floor = transducer.detection_floor(scene.air());
    let limits = Limits::order(world.max_order());
    let mut matrix = CrosstalkMatrix::new();
    matrix.compute(&mut Tracer::new(), &CrosstalkQuery::new(scene, &sensors, transducer, limits, floor))?;
    for path in matrix.paths() {
        let us = path.length_m / scene.air().speed_of_sound() * 1e6;
        println!("{} {} {us:.0}", path.emitter, path.receiver);
    }
    Ok(())
}
