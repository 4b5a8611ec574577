//! Effect of `narrow_panels`: the loudness of panels straight ahead, and the changes in the first alcoves of Set I.
//!
//! `cargo lab narrow-panels`

use std::collections::BTreeMap;

use eeruf_sim::experiments::FIRST;
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

const WIDTHS_MM: [f64; 6] = [1.0, 10.0, 20.0, 50.0, 83.0, 100.0];
const ALCOVES: u64 = 3;
const WITHOUT: Physics = Physics { narrow_panels: false, ..Physics::DEFAULT };

pub(crate) fn main(_: &[String]) -> crate::Answer {
    let widths = WIDTHS_MM.map(|width_mm| format!(" {width_mm} mm |")).concat();
    println!("| width |{widths}\n|---|{}", "---:|".repeat(WIDTHS_MM.len()));
    for distance_m in [1.0, 3.0] {
        let mut cells = String::new();
        for width_mm in WIDTHS_MM {
            cells += &format!(" {:.1} |", straight_ahead_db(distance_m, 1e-3 * width_mm)?);
        }
        println!("| at {distance_m} m |{cells}");
    }
    println!("\n| alcove | paths | louder | fainter | no more | new | EERUF: wrong % | good lost % |");
    println!("|---|{}", "---:|".repeat(7));
    for number in FIRST..FIRST + ALCOVES {
        let world = |physics| Alcove::random(number).world()?.with_seed(number).with_physics(physics);
        let worlds = [world(WITHOUT)?, world(Physics::DEFAULT)?];
        let (off, on) = (heard(&worlds[0])?, heard(&worlds[1])?);
        let changes_db = off.iter().filter_map(|(path, was)| on.get(path).map(|is| 20.0 * libm::log10(is / was)));
        let changes_db: Vec<_> = changes_db.collect();
        let count = |is: fn(&&f64) -> bool| changes_db.iter().filter(is).count();
        let (louder, fainter) = (count(|change_db| **change_db > 1.0), count(|change_db| **change_db < -1.0));
        let (gone, new) = (off.len() - changes_db.len(), on.len() - changes_db.len());
        let mut cells = format!("{} | {louder} | {fainter} | {gone} | {new}", off.len());
        let run = |world| simulate(world, Method::Eeruf, &Options::periods(1000)).map(|readings| readings.summary());
        let (off, on) = (run(&worlds[0])?, run(&worlds[1])?);
        let lost = |summary: &Summary| summary.good_lost.unwrap_or(0.0);
        for (off, on) in [(off.wrong_of_all, on.wrong_of_all), (lost(&off), lost(&on))] {
            cells += &format!(" | {:.1}, {:.1}", 100.0 * off, 100.0 * on);
        }
        println!("| {number} | {cells} |");
    }
    Ok(())
}

/// Returns the reflection of a panel relative to a wall, in dB.
fn straight_ahead_db(distance_m: f64, width_m: f64) -> Result<f64, Box<dyn std::error::Error>> {
    let amplitude = |half_m: f64, narrow_panels| -> Result<f64, Box<dyn std::error::Error>> {
        let panel = Wall::new(distance_m, half_m, distance_m, -half_m).with_faces(Faces::Both);
        let scene = Scene::new(vec![panel], vec![], Air::default())?;
        let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
        tracer.narrow_panels = narrow_panels;
        let here = Point::origin();
        tracer.trace(&scene, here, &[here], Limits::order(1), &mut paths)?;
        Ok(paths.amplitude[0])
    };
    Ok(20.0 * libm::log10(amplitude(0.5 * width_m, true)? / amplitude(0.5 * width_m, false)?))
}

/// Key of a path: its emitter, its receiver and its bounces.
type Key = (u32, u32, Vec<Bounce>);

/// Returns all audible paths and their levels.
fn heard(world: &World) -> Result<BTreeMap<Key, f64>, PathsError> {
    let robot = &world.robots()[0];
    let (scene, transducer) = (world.scene(), &robot.transducer);
    let sensors: Vec<_> = world.sensors(0, 0.0).collect();
    let (floor, limits) = (transducer.detection_floor(scene.air()), Limits::order(world.max_order()));
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    tracer.follow(&world.physics());
    matrix.compute(&mut tracer, &CrosstalkQuery::new(scene, &sensors, transducer, limits, floor))?;
    let key = |path: &CriticalPath| (path.emitter, path.receiver, matrix.bounces(path).to_vec());
    Ok(matrix.paths().iter().map(|path| (key(path), path.amplitude)).collect())
}
