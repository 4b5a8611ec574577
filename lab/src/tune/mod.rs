//! Search for settings of the experiments' methods: a pilot for each method of Set II, and the comparison of several
//! echoes in Set I. The results go into the source of `eeruf-sim`, or with `--check` are compared with it (an hour).
//!
//! ```text
//! cargo lab tune [--check]
//! ```
//!
//! Results are kept in `target/tune` and not computed again, even after a stop; delete that folder after changing the
//! simulator. With other physics, other constants come out.

mod draw;
mod log;
mod multi_echo;
mod print;
mod score;
mod search;
#[cfg(test)]
mod tests;

use std::error::Error;
use std::fs;
use std::path::Path;

use eeruf_sim::experiments::set_two::{Course, SetTwoOptions, steered_as};
use eeruf_sim::{Method, Physics, Robot, best_schedule_for};

use self::log::Log;
use score::ROUNDS;
use search::{Search, Tuned};

/// Node budget for the search of `eeruf_best`'s schedule, which is proven shortest long before that.
const BUDGET: u64 = 300_000;

const FOLDER: &str = "target/tune";
const PILOTS: &str = "crates/eeruf-sim/src/experiments/set_two/own_pilots.rs";
const MULTI_ECHO: &str = "crates/eeruf-sim/src/experiments/set_one/multi_echo.rs";
/// Beginning of the line that holds the result for several echoes.
const LINE: &str = "    pub const TUNED: Self = ";

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let check = match arguments {
        [] => false,
        [word] if word == "--check" => true,
        _ => return Err("expected --check or nothing".into()),
    };
    put(MULTI_ECHO, &with_line(&fs::read_to_string(MULTI_ECHO)?, &multi_echo::line()?), check)?;
    put(PILOTS, &pilots(Path::new(FOLDER))?, check)
}

/// Returns the text with the constant's line replaced.
fn with_line(text: &str, line: &str) -> String {
    let lines = text.lines().map(|old| if old.starts_with(LINE) { line } else { old });
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// Writes a source file, or compares it.
fn put(path: &str, text: &str, check: bool) -> crate::Answer {
    if fs::read_to_string(path)? == text {
        println!("{path} is what was found");
    } else if check {
        return Err(format!("{path} is not what was found:\n{text}").into());
    } else {
        fs::write(path, text)?;
        println!("{path} is written");
    }
    Ok(())
}

fn pilots(folder: &Path) -> Result<String, Box<dyn Error>> {
    let options = SetTwoOptions { physics: Physics::PLAIN, ..SetTwoOptions::default() };
    let robot = Robot { t_delta: options.t_delta, ..Course::random(0).robot() };
    let options = SetTwoOptions { best: Some(best_schedule_for(&robot, BUDGET, |_| true)?), ..options };
    let mut log = Log::open(folder, &ROUNDS)?;
    let mut found: Vec<(Method, Tuned)> = Vec::new();
    // Methods driven by default come first: a search that is stopped early should have their pilots.
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
