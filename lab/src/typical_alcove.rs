//! The typical alcove of Set I, and the rank of the alcove of `scenes/alcove.toml` among them.
//!
//! The typical alcove is the one of 200, from number 20,000 on, whose ranks in four figures (wrong under constant lags;
//! wrong, lost and starved under EERUF) are in sum nearest to the middle. `scenes/typical-alcove.toml` holds it.
//!
//! `cargo lab typical-alcove [SCENE.toml]`: also writes it as a scene.

use std::path::Path;

use eeruf_sim::experiments::FIRST;
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Method, Options, SimulationError, World, simulate, sweep, world_file};

const ALCOVES: u64 = 200;
const NAMES: [&str; 4] = ["conventional: wrong %", "eeruf: wrong %", "eeruf: good lost %", "eeruf: starved"];

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let numbers: Vec<u64> = (FIRST..FIRST + ALCOVES).collect();
    let each = sweep(&numbers, |&number| figures(&world(number)));
    let each = each.into_iter().collect::<Result<Vec<_>, _>>()?;
    let off = |of: &[f64; 4]| (0..4).map(|figure| (rank(&each, figure, of[figure]) - 0.5).abs()).sum::<f64>();
    let nearest = each.iter().enumerate().min_by(|(_, a), (_, b)| off(a).total_cmp(&off(b)));
    let (place, typical) = nearest.ok_or("no alcoves")?;
    let shown = figures(&World::from_toml(Path::new("scenes/alcove.toml"))?)?;
    println!("Of {ALCOVES} alcoves from {FIRST} on, number {} is the typical one.\n", numbers[place]);
    println!("| | {} | less wrong and lost together |", NAMES.join(" | "));
    println!("|---|{}", "---:|".repeat(5));
    for (name, of) in [("typical alcove", typical), ("scenes/alcove.toml", &shown)] {
        let cells: Vec<_> = (0..4).map(|figure| cell(&each, figure, of[figure])).collect();
        let better = each.iter().filter(|other| other[1] + other[2] < of[1] + of[2]).count();
        println!("| {name} | {} | {better} of {ALCOVES} |", cells.join(" | "));
    }
    if let Some(file) = arguments.first() {
        let world = world(numbers[place]);
        let text = world_file(
            world.scene(),
            world.robots(),
            &world.noise(),
            &world.physics(),
            world.max_order(),
            world.seed(),
            world.faults(),
        );
        std::fs::write(file, format!("# The typical alcove of Set I, number {}.\n{text}", numbers[place]))?;
    }
    Ok(())
}

/// Makes an alcove of Set I.
fn world(number: u64) -> World {
    Alcove::random(number).world().expect("every random alcove has room").with_seed(number)
}

/// Returns the four figures, shares as fractions of 1.
fn figures(world: &World) -> Result<[f64; 4], SimulationError> {
    let of = |method| Ok::<_, SimulationError>(simulate(world, method, &Options::periods(1000))?.summary());
    let (conventional, eeruf) = (of(Method::Conventional)?, of(Method::Eeruf)?);
    let lost = eeruf.good_lost.unwrap_or(0.0);
    Ok([conventional.wrong_of_all, eeruf.wrong_of_all, lost, eeruf.starved as f64])
}

/// Returns the share of alcoves with a smaller figure; equal figures count half.
fn rank(each: &[[f64; 4]], figure: usize, value: f64) -> f64 {
    let count = |is: fn(&f64, &f64) -> bool| each.iter().filter(|of| is(&of[figure], &value)).count() as f64;
    (count(|a, b| a < b) + 0.5 * count(|a, b| a == b)) / each.len() as f64
}

/// Formats a figure, with the percentage of alcoves below it in brackets.
fn cell(each: &[[f64; 4]], figure: usize, value: f64) -> String {
    let rank = 100.0 * rank(each, figure, value);
    if figure == 3 { format!("{value} ({rank:.0} %)") } else { format!("{:.1} ({rank:.0} %)", 100.0 * value) }
}
