//! The ready tables: what `eeruf design` finds for rings of HC-SR04 modules.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use super::TARGET;
use crate::steps::output;

const FILE: &str = "c/arduino/src/EerufTables.h";

/// Modules in a ring.
const MODULES: [u32; 10] = [2, 3, 4, 5, 6, 8, 10, 12, 16, 24];
/// Rest of a module, and the name of its table; of the slower ones there is one of [`SLOWER`] modules each.
const RESTS: [(u32, &str); 3] = [(60_000, ""), (90_000, "_SLOWER"), (120_000, "_SLOWEST")];
const SLOWER: u32 = 8;

/// The ring file of this many modules. Lines that are sampled in `loop()` are up to 0.2 ms late. A board fires a module
/// in 0.1 ms: for 24 modules firings that coincide are moved apart by half as much again, since one by one they come
/// late by more than the table has to spare, and a slow loop still finds its walls.
fn ring(modules: u32, retrigger_us: u32) -> String {
    let neighbours = modules.min(4);
    let handling = if modules >= 24 { "handling_us = 150\n" } else { "" };
    format!(
        "sensors = {modules}\nlayout = \"ring\"\nneighbours = {neighbours}\nmax_range_m = 4.0\n\
         crosstalk_range_m = 2.5\njitter_us = 200\nspeed_m_s = 0.5\ntick_us = 500\n\
         retrigger_us = {retrigger_us}\n{handling}"
    )
}

/// Compares the tables with what `eeruf design` says, or writes them.
pub(super) fn check(write: bool) -> Result<()> {
    let mut text = String::from(
        "// Ready tables for rings of 2, 3, 4, 5, 6, 8, 10, 12, 16 and 24 HC-SR04 modules: no shorter period lets\n\
         // each module rest for 60 ms and keeps four adjacent ones 14.569 ms apart, so that sound from up to 2.5 m\n\
         // has died. The slower ones are for EerufAdaptation. Those that a sketch does not name take no room.\n\
         // Written by `cargo xtask arduino --write` from what `eeruf design` finds; for your own ring:\n\
         //   eeruf design RING.toml --period-only --emit arduino > ring.h\n\
         #pragma once\n#include <EerufArduino.h>\n",
    );
    fs::create_dir_all(TARGET)?;
    let program = crate::toolchain::program()?;
    let rests = |modules| if modules == SLOWER { &RESTS[..] } else { &RESTS[..1] };
    let rings = MODULES.iter().flat_map(|&modules| rests(modules).iter().map(move |rest| (modules, rest)));
    for (modules, (retrigger_us, suffix)) in rings {
        let file = Path::new(TARGET).join(format!("ring-{modules}{suffix}.toml"));
        fs::write(&file, ring(modules, *retrigger_us))?;
        let design = ["design", "--period-only", "--emit", "arduino"];
        let tab = output(Command::new(&program).args(design).arg(&file))?;
        let constant = tab.replace("#pragma once\n#include <EerufArduino.h>\n", "");
        let name = format!("EERUF_HC_SR04_{modules}{suffix}");
        let constant = constant.replace("RING_", &format!("{name}_"));
        let constant = constant.replace("EerufSchedule RING ", &format!("EerufSchedule {name} "));
        let _ = writeln!(text, "\n{constant}");
    }
    let text = text.replace("\n\nstatic", "\nstatic").trim_end().to_owned() + "\n";
    if write {
        return Ok(fs::write(FILE, text)?);
    }
    ensure!(
        fs::read_to_string(FILE)? == text,
        "{FILE} is not what `eeruf design` says; run cargo xtask arduino --write"
    );
    Ok(())
}
