//! Finds what the experiments' methods are run with, and prints it as the source of `eeruf-sim` has it.
//!
//! `tune pilots FOLDER`: a pilot for each method of Set II; what was tried is kept in the folder, and not tried again.
//! `tune multi-echo`: what several echoes are compared by in Set I. `cargo xtask tune` runs both and puts what they
//! print into the source.

mod draw;
mod log;
mod multi_echo;
mod print;
mod score;
mod search;
#[cfg(test)]
mod tests;

use std::error::Error;
use std::path::Path;

use eeruf_sim::experiments::set_two::{Course, SetTwoOptions, steered_as};
use eeruf_sim::{Method, Physics, Robot, best_schedule_for};

use log::Log;
use score::ROUNDS;
use search::{Search, Tuned};

/// Budget of nodes for the search of the schedule of `eeruf_best`; it is proven shortest long before.
const BUDGET: u64 = 300_000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["pilots", folder] => print!("{}", pilots(Path::new(folder))?),
        ["multi-echo"] => println!("{}", multi_echo::line()?),
        _ => return Err("expected `pilots FOLDER` or `multi-echo`".into()),
    }
    Ok(())
}

fn pilots(folder: &Path) -> Result<String, Box<dyn Error>> {
    let options = SetTwoOptions { physics: Physics::PLAIN, ..SetTwoOptions::default() };
    let robot = Robot { t_delta: options.t_delta, ..Course::random(0).robot() };
    let options = SetTwoOptions { best: Some(best_schedule_for(&robot, BUDGET, |_| true)?), ..options };
    let mut log = Log::open(folder, &ROUNDS)?;
    let mut found: Vec<(Method, Tuned)> = Vec::new();
    // Those that are driven by default first, as they are what a search that is stopped early should have.
    let (first, others): (Vec<_>, Vec<_>) = Method::ALL
        .into_iter()
        .filter(|&of| steered_as(of) == of)
        .partition(|&of| options.methods.contains(&of.into()));
    for method in first.into_iter().chain(others) {
        let tuned = Search { rounds: &ROUNDS, options: &options, method }.run(&mut log)?;
        eprintln!("{}", print::row(method, &tuned));
        found.push((method, tuned));
    }
    found.sort_by_key(|(method, _)| *method);
    Ok(print::source(&ROUNDS, &found))
}
