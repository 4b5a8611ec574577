//! `eeruf paths`: every critical path of a ring, the ways along which one sensor hears another.

use std::path::PathBuf;

use comfy_table::{CellAlignment, Table, presets};
use eeruf_sim::{CrosstalkMatrix, CrosstalkQuery, Limits, MAX_ORDER, Tracer, World};
use serde::Serialize;

use crate::Answer;
use crate::fooled::{by_way_of, wall_numbers};
use crate::input::{InputError, to_json};
use crate::study::read_world;

/// List every critical path of the first robot's ring: along which ways each sensor hears which other.
///
/// A path counts if its sound is loud enough to be heard. Sensors are printed from 1; walls and poles from 0, as in files.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The scene
    #[arg(value_name = "SCENE.toml")]
    file: PathBuf,
    /// The most bounces, if not the scene's max_order
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_ORDER)))]
    order: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let world = read_world(&args.file)?;
    let max_order = args.order.unwrap_or(world.max_order());
    let bad = |error| InputError::new(&args.file, None, error);
    let paths = critical_paths(&world, max_order).map_err(|error| bad(error.to_string()))?;
    if args.json {
        println!("{}", to_json(&paths));
    } else {
        println!(
            "{}: {} critical paths of up to {max_order} bounces; levels in dB above what is just heard",
            args.file.display(),
            paths.order.len()
        );
        println!("{}", paths.table());
    }
    Ok(Answer::Yes)
}

/// Arrays of equal length, by emitter, receiver and length, named as in Python; sensors and walls from 0.
#[derive(Default, Serialize)]
struct PathsJson {
    emitter: Vec<u32>,
    receiver: Vec<u32>,
    length_m: Vec<f64>,
    order: Vec<u32>,
    departure_rad: Vec<f64>,
    arrival_rad: Vec<f64>,
    /// Relative to 1 m on axis, both sensors' patterns included.
    amplitude: Vec<f64>,
    /// Above what is just heard.
    level_db: Vec<f64>,
    /// Pole p stands as -1 - p.
    walls: Vec<Vec<i64>>,
    #[serde(skip)]
    by_way_of: Vec<String>,
}

fn critical_paths(world: &World, max_order: u32) -> Result<PathsJson, eeruf_sim::PathsError> {
    let mut out = PathsJson::default();
    let Some(robot) = world.robots().first() else { return Ok(out) };
    let (scene, transducer) = (world.scene(), &robot.transducer);
    let ring: Vec<_> = world.sensors(0, 0.0).collect();
    let floor = transducer.detection_floor(scene.air());
    let mut matrix = CrosstalkMatrix::new();
    let query = CrosstalkQuery { scene, sensors: &ring, transducer, limits: Limits::order(max_order), floor };
    matrix.compute(&mut Tracer::new(), &query)?;
    for path in matrix.paths().iter().filter(|path| path.emitter != path.receiver) {
        let received = transducer.received(path.amplitude, path.length_m, scene.air());
        out.emitter.push(path.emitter);
        out.receiver.push(path.receiver);
        out.length_m.push(path.length_m);
        out.order.push(path.order);
        out.departure_rad.push(path.departure_rad);
        out.arrival_rad.push(path.arrival_rad);
        out.amplitude.push(path.amplitude);
        out.level_db.push(20.0 * (received / floor).log10());
        let bounces = matrix.bounces(path);
        out.walls.push(wall_numbers(bounces));
        out.by_way_of.push(by_way_of(bounces));
    }
    Ok(out)
}

impl PathsJson {
    fn table(&self) -> Table {
        let mut table = Table::new();
        table.load_style(presets::ASCII_MARKDOWN);
        table.set_header(["emitter", "receiver", "order", "length m", "level dB", "by way of"]);
        for k in 0..self.order.len() {
            table.add_row([
                (self.emitter[k] + 1).to_string(),
                (self.receiver[k] + 1).to_string(),
                self.order[k].to_string(),
                format!("{:.3}", self.length_m[k]),
                format!("{:.1}", self.level_db[k]),
                self.by_way_of[k].clone(),
            ]);
        }
        for column in table.column_iter_mut().take(5) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        table
    }
}
