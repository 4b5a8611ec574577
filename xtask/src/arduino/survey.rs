//! Checks the sketch that surveys a ring: compares the findings of `eeruf survey` with the paths of sound in the
//! simulated world.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, Result, bail};
use fs_err as fs;
use serde_json::Value;

use super::TARGET;
use super::world::{KEPT, Room};
use crate::steps::output;

const MODULES: usize = 4;
const PINS: [u8; 2 * MODULES] = [2, 3, 4, 5, 2, 3, 4, 5];
/// Time that the sketch may take; it ends after 28 s.
const SECONDS: u32 = 29;
/// Travel time in microseconds below which pairs must be found; longer paths are seen at few leads.
const UNTIL_US: f64 = 15_000.0;
/// Tolerance in microseconds: the sketch looks at its lines every few microseconds.
const OFF_US: f64 = 30.0;

/// Runs the sketch, and returns the remaining columns of the table.
pub(super) fn run(elf: &Path) -> Result<String> {
    let said = Room::alcove(format!("{TARGET}/alcove-of-survey.txt"), 8)?.text(elf, SECONDS, &PINS, &[])?;
    let begins = said.find("# clock").context("no log")?;
    let ends = said.find("# over").with_context(|| format!("not over after {SECONDS} s"))?;
    let log = Path::new(TARGET).join("survey.csv");
    fs::write(&log, &said[begins..ends])?;
    let found = output(Command::new(crate::toolchain::program()?).args(["survey", "--json"]).arg(&log))?;
    let found: Value = serde_json::from_str(&found)?;
    let number = |path: &Value, name: &str| path[name].as_f64().unwrap_or(f64::NAN);
    let paths = found["paths"].as_array().map_or(&[][..], Vec::as_slice);
    let text = fs::read_to_string(KEPT)?;
    let ways: Vec<_> = text
        .lines()
        .filter_map(|line| {
            let numbers: Vec<f64> = line.split(' ').filter_map(|number| number.parse().ok()).collect();
            let [x, y, us] = numbers[..] else { return None };
            (x < MODULES as f64 && y < MODULES as f64).then_some((x, y, us))
        })
        .collect();
    let is_like = |path: &Value, &(x, y, us): &(f64, f64, f64)| {
        number(path, "sender") == x && number(path, "receiver") == y && (number(path, "travel_us") - us).abs() < OFF_US
    };
    if let Some(path) = paths.iter().find(|path| !ways.iter().any(|way| is_like(path, way))) {
        bail!("a path that no sound takes: {path}");
    }
    let near: Vec<_> = ways.iter().filter(|way| way.2 < UNTIL_US).collect();
    if let Some(way) = near.iter().find(|way| !paths.iter().any(|path| is_like(path, way))) {
        bail!("sound from module {} to {} in {} us was not found", way.0, way.1, way.2);
    }
    Ok(format!("- | - | {} of {} ways found | - |", near.len(), near.len()))
}
