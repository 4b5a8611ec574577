//! Every ring file, emitted for C and for Arduino, as a table and as recommended: built, and started on its modules.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{Scratch, eeruf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The ring files for `design`, not the tables of the paper.
pub(crate) fn rings() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(Path::new(ROOT).join("rings")).unwrap();
    let files = folder.map(|entry| entry.unwrap().path());
    files.filter(|file| !file.file_stem().unwrap().to_str().unwrap().starts_with("table-")).collect()
}

/// Builds and runs a program of `emitted/` with a table, or with the setup of a flow ring, whose constants have these
/// names; returns its output, which is the error if it fails.
pub(crate) fn run_c(source: &str, table: &str, [schedule, settings]: [&str; 2]) -> Result<String, String> {
    let (folder, header) = Scratch::new("ring.h", table);
    // Arduino's class is not what is tried, but the table and the library below it.
    std::fs::write(folder.path().join("EerufArduino.h"), "#include \"eeruf.h\"\n").unwrap();
    let program = folder.path().join("start");
    let mut gcc = Command::new("gcc");
    gcc.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused", "-Ic"]).arg("-I").arg(folder.path());
    let kind = if flows(table) { "FLOW" } else { "SCHEDULE" };
    gcc.arg(format!("-D{kind}={schedule}")).arg(format!("-DTABLE=\"{}\"", header.display()));
    for (name, constant) in [("SETTINGS", settings), ("CONFIG", "EERUF_RING_CONFIG")] {
        if table.contains(constant) {
            gcc.arg(format!("-D{name}={constant}"));
        }
    }
    gcc.arg(format!("tests/claims/emitted/{source}.c")).args(["c/eeruf.c", "-o"]).arg(&program).current_dir(ROOT);
    let built = gcc.output().expect("gcc runs");
    if !built.status.success() {
        return Err(String::from_utf8_lossy(&built.stderr).into_owned());
    }
    let ran = Command::new(program).output().expect("it was built");
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    if ran.status.success() { Ok(said) } else { Err(said) }
}

/// Runs `start.c`; `Err` with what it says if the ring does not start.
fn start(table: &str, schedule: &str, settings: &str) -> Result<(), String> {
    run_c("start", table, [schedule, settings]).map(drop)
}

fn flows(emitted: &str) -> bool {
    emitted.contains("EerufFlowConfig")
}

/// Forms in which a ring file is emitted: form, name of the constant, name of the modules' settings.
pub(crate) const FORMS: [[&str; 3]; 2] =
    [["c", "eeruf_schedule", "EERUF_MODULES"], ["arduino", "RING", "RING_MODULES"]];

#[test]
fn ways_are_emitted_start_and_fire() {
    let (mut flow, mut with_modules) = (0, 0);
    for ring in rings() {
        let ring = ring.to_str().unwrap();
        let [form, schedule, settings] = FORMS[usize::from(ring.ends_with("hc-sr04-8.toml"))];
        let asked = ["design", ring, "--way", "flow"];
        let emitted = eeruf(&[&asked[..], &["--emit", form]].concat());
        assert_eq!(emitted.code, Some(0), "{ring}: {}", emitted.err);
        if form == "arduino" {
            // `emitted.rs` compiles that file.
            let rust = eeruf(&[&asked[..], &["--emit", "rust"]].concat()).out;
            assert_eq!(rust, include_str!("emitted/flow_8.rs"), "eeruf design {ring} --way flow --emit rust");
        }
        let schedule = if flows(&emitted.out) && form == "c" { "eeruf_flow_config" } else { schedule };
        flow += u32::from(flows(&emitted.out));
        with_modules += u32::from(flows(&emitted.out) && emitted.out.contains(settings));
        start(&emitted.out, schedule, settings).unwrap_or_else(|why| panic!("{ring}: {form}: {why}"));
    }
    assert!(flow >= 4 && with_modules >= 1, "{flow} flow, {with_modules} of them with HC-SR04 modules");
}

#[test]
fn every_emitted_table_starts_and_fires() {
    let mut with_modules = 0;
    let rings = rings();
    assert!(rings.len() >= 6, "{rings:?}");
    for ring in rings {
        for [form, schedule, settings] in FORMS {
            let emitted = eeruf(&["design", ring.to_str().unwrap(), "--no-atlas", "--period-only", "--emit", form]);
            assert_eq!(emitted.code, Some(0), "{}: {}", ring.display(), emitted.err);
            with_modules += u32::from(emitted.out.contains(settings));
            start(&emitted.out, schedule, settings).unwrap_or_else(|why| panic!("{}: {form}: {why}", ring.display()));
        }
    }
    assert_eq!(with_modules, 12, "six ring files name one kind of module");
}

#[test]
fn table_for_sooner_triggers_needs_its_own_settings() {
    let ring = "rings/hc-sr04-8-two-multiplexers.toml";
    let emitted = eeruf(&["design", ring, "--no-atlas", "--period-only", "--emit", "c"]).out;
    // It has 40 ms from the ring file; the data sheet advises 60 ms.
    start(&emitted, "eeruf_schedule", "EERUF_MODULES").unwrap();
    let usual = format!("{emitted}\n#define USUAL EERUF_HC_SR04\n");
    assert_eq!(start(&usual, "eeruf_schedule", "USUAL"), Err("modules: status -21\n".to_owned()));
}
