//! Checks the sketch that logs a real ring: `eeruf logs` reads its log as a ring's own, and it agrees with the
//! simulator in the same room.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;
use serde_json::Value;

use super::build::{self, Board};
use super::world::{Room, SCENE};
use super::{ALL, TARGET};
use crate::steps::output;
use crate::toolchain::program;

const MODULES: usize = 8;
/// Duration of each of the sketch's three ways of firing.
const SECONDS: u32 = 6;

pub(super) fn run(library: &Path) -> Result<()> {
    let text = fs::read_to_string(library.join("examples/RealLog/RealLog.ino"))?;
    let sketch = build::ours(library, Board::Uno, "RealLog", &text, &[&format!("-DSECONDS={SECONDS}")])?;
    let room = Room::alcove(format!("{TARGET}/alcove-of-log.txt"), MODULES)?;
    let said = room.text(&sketch.elf, 3 * SECONDS, &ALL[..MODULES].repeat(2), &[])?;
    let (_, rows) = said.split_once("sensor,").context("no header")?;
    let rows: String =
        rows.lines().take_while(|line| !line.starts_with("world")).map(|line| format!("{line}\n")).collect();
    let log = Path::new(TARGET).join("real-log.csv");
    fs::write(&log, format!("sensor,{rows}"))?;
    for method in ["sequential", "flow", "blocking"] {
        let mut reality = Command::new(program()?);
        reality.args(["lab", "reality", "--json", "--method", method]).arg(&log).arg(SCENE);
        let found: Value = serde_json::from_str(&output(&mut reality)?)?;
        let sensors = found["sensors"].as_array().context("no sensors")?;
        let like = sensors.iter().filter(|sensor| sensor["is_like"] == true).count();
        println!("{method}: {like} of {} sensors are as simulated", sensors.len());
        // This world loses no echoes, and the simulator loses some.
        ensure!(like + 2 >= MODULES, "{method}: {found:#}");
    }
    let logs = Command::new(program()?).args(["logs", "--json"]).arg(&log).output()?;
    let found: Value = serde_json::from_slice(&logs.stdout).context("eeruf logs")?;
    let sensors = found["sensors"].as_array().map_or(0, Vec::len);
    ensure!(sensors == MODULES, "eeruf logs: {sensors} sensors; expected {MODULES}: {found:#}");
    Ok(())
}
