//! The ready tables: what `eeruf design` finds for rings of HC-SR04 modules.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use super::{TARGET, failed};
use crate::steps::{Trouble, output};

const FILE: &str = "c/arduino/src/EerufTables.h";

/// Modules, by how much longer they rest, and what that is called.
const TABLES: [(u32, u32, &str); 12] = [
    (2, 60_000, ""),
    (3, 60_000, ""),
    (4, 60_000, ""),
    (5, 60_000, ""),
    (6, 60_000, ""),
    (8, 60_000, ""),
    (8, 90_000, "_SLOWER"),
    (8, 120_000, "_SLOWEST"),
    (10, 60_000, ""),
    (12, 60_000, ""),
    (16, 60_000, ""),
    (24, 60_000, ""),
];

/// A board fires a module in 0.1 ms. For this many modules firings that coincide are moved apart by that: one by one
/// they come late by more than the table has to spare.
const MANY: u32 = 24;
const HANDLING: &str = "handling_us = 110\n";

/// The ring file of this many modules. Lines that are sampled in `loop()` are up to 0.2 ms late.
fn ring(modules: u32, retrigger_us: u32) -> String {
    let neighbours = modules.min(4);
    let handling = if modules >= MANY { HANDLING } else { "" };
    format!(
        "sensors = {modules}\nlayout = \"ring\"\nneighbours = {neighbours}\nmax_range_m = 4.0\n\
         crosstalk_range_m = 2.5\njitter_us = 200\nspeed_m_s = 0.5\ntick_us = 500\n\
         retrigger_us = {retrigger_us}\n{handling}"
    )
}

/// Compares the tables with what `eeruf design` says, or writes them.
pub(super) fn check(write: bool) -> Result<(), Trouble> {
    let mut text = String::from(
        "// Ready tables for rings of 2, 3, 4, 5, 6, 8, 10, 12, 16 and 24 HC-SR04 modules: no shorter period lets\n\
         // each module rest for 60 ms and keeps four adjacent ones 14.569 ms apart, so that sound from up to 2.5 m\n\
         // has died. The slower ones are for EerufAdaptation. Those that a sketch does not name take no room.\n\
         // Written by `cargo xtask arduino --write` from what `eeruf design` finds; for your own ring:\n\
         //   eeruf design RING.toml --period-only --emit arduino > ring.h\n\
         #pragma once\n#include <EerufArduino.h>\n",
    );
    fs::create_dir_all(TARGET).map_err(failed("target"))?;
    let program = crate::program::program()?;
    for (modules, retrigger_us, suffix) in TABLES {
        let file = Path::new(TARGET).join(format!("ring-{modules}{suffix}.toml"));
        fs::write(&file, ring(modules, retrigger_us)).map_err(failed("target"))?;
        let design = ["design", "--period-only", "--emit", "arduino"];
        let tab = output(Command::new(&program).args(design).arg(&file))
            .ok_or_else(|| Trouble::Failed(format!("eeruf design {} failed", file.display())))?;
        let constant = tab.replace("#pragma once\n#include <EerufArduino.h>\n", "");
        let name = format!("EERUF_HC_SR04_{modules}{suffix}");
        let constant = constant.replace("RING_", &format!("{name}_"));
        let constant = constant.replace("EerufSchedule RING ", &format!("EerufSchedule {name} "));
        let _ = writeln!(text, "\n{constant}");
    }
    let text = text.replace("\n\nstatic", "\nstatic").trim_end().to_owned() + "\n";
    if write {
        return fs::write(FILE, text).map_err(failed(FILE));
    }
    let stands = fs::read_to_string(FILE).map_err(failed(FILE))?;
    if stands == text {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("{FILE} is not what `eeruf design` says; run cargo xtask arduino --write")))
    }
}
