//! The ready tables: results of `eeruf design` for rings of HC-SR04 modules.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use super::TARGET;
use crate::steps::output;

const FILE: &str = "c/arduino/src/EerufTables.h";

/// Modules in a ring.
const MODULES: [u32; 3] = [4, 8, 12];

/// The ring file of this many modules. Lines that are sampled in `loop()` are up to 0.2 ms late.
fn ring(modules: u32) -> String {
    format!(
        "sensors = {modules}\nlayout = \"ring\"\nneighbours = 4\nmax_range_m = 4.0\ncrosstalk_range_m = 2.5\n\
         jitter_us = 200\nspeed_m_s = 0.5\ntick_us = 500\nretrigger_us = 60000\n"
    )
}

/// Compares the tables with what `eeruf design` says, or writes them.
pub(super) fn check(write: bool) -> Result<()> {
    let mut text = String::from(
        "// Ready tables for rings of 4, 8 and 12 HC-SR04 modules: no shorter period lets each module rest for 60 ms\n\
         // and keeps four adjacent ones 14.569 ms apart, so that sound from up to 2.5 m has died. Unused\n\
         // tables take no room.\n\
         // Written by `cargo xtask arduino --write` from what `eeruf design` finds; for your own ring:\n\
         //   eeruf design RING.toml --period-only --emit arduino > ring.h\n\
         #pragma once\n#include <EerufArduino.h>\n",
    );
    fs::create_dir_all(TARGET)?;
    let program = crate::toolchain::program()?;
    for modules in MODULES {
        let file = Path::new(TARGET).join(format!("ring-{modules}.toml"));
        fs::write(&file, ring(modules))?;
        let design = ["design", "--period-only", "--emit", "arduino"];
        let tab = output(Command::new(&program).args(design).arg(&file))?;
        let constant = tab.replace("#pragma once\n#include <EerufArduino.h>\n", "");
        let name = format!("EERUF_HC_SR04_{modules}");
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
