//! The sketch that surveys a ring: what `eeruf survey` makes of its log, held against the ways that sound takes in the
//! simulated world.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{TARGET, failed};
use crate::steps::{Trouble, output};

const MODULES: usize = 4;
/// The sketch is through after 28 s.
const SECONDS: &str = "29";
/// Modules that hear each other within this time, in microseconds, must be found; what takes longer is seen at few
/// leads.
const UNTIL_US: f64 = 15_000.0;
/// The sketch looks at its lines every few microseconds.
const OFF_US: f64 = 30.0;

/// Runs it, and gives the columns of the table that are left.
pub(super) fn run(world: &Path, elf: &Path) -> Result<String, Trouble> {
    let wrong = |what: String| Trouble::Failed(format!("Survey: {what}"));
    let pins = ["2", "3", "4", "5"];
    let ways = super::world::KEPT;
    let said = Command::new(world).arg(elf).args([SECONDS, ways, &MODULES.to_string()]).args(pins).args(pins).output();
    let said = String::from_utf8_lossy(&said.map_err(failed("the simulated world"))?.stdout).replace('\r', "");
    let begins = said.find("# clock").ok_or_else(|| wrong("no log".to_owned()))?;
    let ends = said.find("# over").ok_or_else(|| wrong(format!("not over after {SECONDS} s")))?;
    let log = Path::new(TARGET).join("survey.csv");
    fs::write(&log, &said[begins..ends]).map_err(failed("target"))?;
    let found = output(Command::new(crate::program::program()?).args(["survey", "--json"]).arg(&log));
    let found: Value = serde_json::from_str(&found.ok_or_else(|| wrong("eeruf survey failed".to_owned()))?)
        .map_err(|error| wrong(error.to_string()))?;
    let number = |path: &Value, name: &str| path[name].as_f64().unwrap_or(f64::NAN);
    let paths = found["paths"].as_array().map_or(&[][..], Vec::as_slice);
    let text = fs::read_to_string(ways).map_err(failed(ways))?;
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
        return Err(wrong(format!("a path that no sound takes: {path}")));
    }
    let near: Vec<_> = ways.iter().filter(|way| way.2 < UNTIL_US).collect();
    if let Some(way) = near.iter().find(|way| !paths.iter().any(|path| is_like(path, way))) {
        return Err(wrong(format!("sound from module {} to {} in {} us was not found", way.0, way.1, way.2)));
    }
    Ok(format!("- | - | {} of {} ways found | - |", near.len(), near.len()))
}
