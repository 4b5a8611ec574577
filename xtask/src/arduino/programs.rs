//! `cargo xtask programs`: what `eeruf design --program` writes, built as whoever asked for it would, and run to what
//! it accepts: on modules that are each before a wall of their own, and sketches also in an alcove where modules hear
//! each other.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use super::build::{self, Board};
use super::own_walls::{self, LEAST, enough};
use super::{Example, world};
use crate::steps::{edited, empty, output, run};
use crate::toolchain::program;

/// A program that is asked for: ring file, options, and whether it is one of the few that CI runs.
struct Asked(&'static str, &'static str, bool);

const CAR: &str = "tests/data/car-4.toml";
const MAVLINK: &str = "arduino --mavlink";
const EIGHT: &str = "rings/hc-sr04-8.toml";
const ASKED: [Asked; 17] = [
    Asked(CAR, "arduino", true),
    Asked(CAR, "arduino --way sequential", false),
    Asked(CAR, "arduino --way two-phases", false),
    Asked(CAR, MAVLINK, true),
    Asked("tests/programs/hc-sr04-2.toml", "arduino", false),
    Asked("tests/programs/hc-sr04-6.toml", "arduino", false),
    Asked(EIGHT, "arduino", false),
    Asked(EIGHT, "arduino --way groups", true),
    Asked("tests/programs/hc-sr04-12.toml", "arduino", false),
    Asked("tests/programs/hc-sr04-12.toml", "arduino --board mega", false),
    Asked(CAR, "c", false),
    Asked(EIGHT, "c --way groups", true),
    Asked("tests/programs/hc-sr04-12.toml", "c", false),
    Asked(CAR, "micropython", true),
    Asked(EIGHT, "micropython --way sequential", false),
    Asked(CAR, "rust", true),
    Asked(EIGHT, "rust --way groups", false),
];
/// Folder of the harnesses.
const WALLS: &str = "tests/programs";

/// Runs all programs, or a few of them for a few seconds.
pub(crate) fn programs(short: bool) -> Result<()> {
    let folder = PathBuf::from("target/programs");
    empty(&folder)?;
    println!(
        "| ring | program | accepted before walls, worst module | in the alcove: stack, firings/s, accepted/s, wrong |"
    );
    println!("|---|---|---:|---:|");
    for (number, Asked(ring, options, in_ci)) in ASKED.iter().enumerate() {
        if short && !in_ci {
            continue;
        }
        let out = folder.join(format!("ring_{number}"));
        let words = format!("{options} --places 1");
        let mut design = Command::new(program()?);
        design.args(["design", ring, "--program"]).args(words.split(' ')).arg("--out").arg(&out);
        output(&mut design).with_context(|| format!("{ring}: {options}"))?;
        let row = match options.split(' ').next() {
            Some("arduino") => sketch(&out, options, if short { 3 } else { 20 }),
            Some("c") => counted(&c(&out)?),
            Some("micropython") => {
                counted(&output(Command::new("python3").arg(format!("{WALLS}/walls.py")).arg(&out))?)
            }
            _ => counted(&rust(&out)?),
        };
        println!("| {ring} | {options} | {} |", row.with_context(|| format!("{ring}: {options}"))?);
    }
    Ok(())
}

/// A row of a harness that says how many readings there were, how many accepted, how many of them wrong.
fn counted(said: &str) -> Result<String> {
    let numbers = |line: &str| line.split(' ').map(|word| word.parse::<u32>().ok()).collect::<Option<Vec<_>>>();
    let counts = said.lines().filter_map(numbers).find(|counts| counts.len() == 3).unwrap_or_default();
    let [readings, accepted, wrong] = counts[..] else { anyhow::bail!("expected three counts, not: {said}") };
    let share = 100.0 * f64::from(accepted) / f64::from(readings.max(1));
    ensure!(
        share >= LEAST.1 && readings > 100 && wrong == 0,
        "{accepted} of {readings} readings accepted, {wrong} of them wrong; expected {} % and none",
        LEAST.1
    );
    Ok(format!("{share:.1} % | not run"))
}

/// A sketch: built as the IDE does, from its folder alone; one of eight that fires as recommended also in the alcove.
fn sketch(folder: &Path, options: &str, seconds: u32) -> Result<String> {
    let world = world::build()?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let text = fs::read_to_string(folder.join(format!("{name}.ino")))?;
    let board = if options.contains("mega") { Board::Mega } else { Board::Uno };
    let include = folder.to_string_lossy();
    let warnings = ["-Wall", "-Wextra", "-Werror", "-I", &*include];
    let built = build::sketch(&folder.join("src/eeruf"), board, &name, &text, &warnings)?;
    let pins = ["TRIGGERS", "ECHOES"].map(|list| pins(&text, list).or_else(|| pins(&text, "PINS")).unwrap_or_default());
    if options == MAVLINK {
        return Ok(format!("{}, {}", built.flash, obstacles(&world, &built.elf, &pins.concat(), seconds)?));
    }
    let shares = own_walls::accepted(&world, &built.elf, board, pins.each_ref().map(|pins| &pins[..]), seconds, true)?;
    let (all, worst) = enough(&name, shares, LEAST)?;
    let mut row = format!("{all:.1} %, {worst:.1} % | ");
    if options == "arduino" && pins[0].len() == 8 {
        let [triggers, echoes] = pins.map(|pins| &*pins.leak());
        let example = Example::new("the program", triggers, echoes, true);
        let heard = world::hear(&world, &built.elf, &example, seconds, false)?;
        heard.is_plausible(&example)?;
        row += &heard.row();
    } else {
        row += "not run";
    }
    Ok(row)
}

/// The rate of `OBSTACLE_DISTANCE` of a car's sketch, whose last must show the wall of each module.
fn obstacles(world: &Path, elf: &Path, pins: &[u8], seconds: u32) -> Result<String> {
    // Ahead, left, right, behind, at 1 to 4 m: the sector that looks there, of 5 degrees clockwise from -20 on.
    let ways = Path::new("target/programs/walls.txt");
    fs::write(ways, "0 0 5828\n1 1 11655\n2 2 17483\n3 3 23310\n")?;
    let sectors = [4, 58, 22, 40];
    let ran = world::command(world, &[], elf, seconds, ways, pins).output()?;
    let frames: Vec<_> = (0..ran.stdout.len()).filter_map(|at| sectors_in(&ran.stdout[at..])).collect();
    let last = frames.last().context("no OBSTACLE_DISTANCE")?;
    for (sector, metres) in sectors.into_iter().zip([100, 200, 300, 400]) {
        ensure!(last[sector].abs_diff(metres) <= 1, "sector {sector}: {} cm; expected {metres}", last[sector]);
    }
    let rate = frames.len() as u32 / seconds;
    ensure!(rate >= 4, "{rate} OBSTACLE_DISTANCE a second; expected 4");
    Ok(format!("{rate} OBSTACLE_DISTANCE a second"))
}

/// The distances of an `OBSTACLE_DISTANCE` that these bytes begin with, if it is whole.
fn sectors_in(bytes: &[u8]) -> Option<Vec<u16>> {
    let [0xFD, length, ..] = *bytes else { return None };
    let frame = bytes.get(1..12 + usize::from(length))?;
    let (content, sum) = frame.split_at(frame.len() - 2);
    // CRC-16/MCRF4XX, over a byte of the message's own, too.
    let crc = content.iter().chain(&[23]).fold(0xFFFF_u16, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0x8408 } else { 0 })
    });
    let is_whole = content.get(6..9) == Some(&[74, 1, 0]) && crc.to_le_bytes() == sum;
    let distances = content.get(17..17 + 2 * 72).filter(|_| is_whole)?;
    Some(distances.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect())
}

/// Returns the numbers of a list of pins in a sketch.
fn pins(text: &str, list: &str) -> Option<Vec<u8>> {
    let (_, rest) = text.split_once(&format!(" {list}[] = {{"))?;
    let (inside, _) = rest.split_once('}')?;
    inside.split(", ").map(|pin| pin.parse().ok()).collect()
}

fn c(folder: &Path) -> Result<String> {
    let program = folder.join("walls");
    let sources = ["sonar.c", "eeruf.c"].map(|file| folder.join(file));
    run(Command::new("gcc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
        .arg(folder)
        .arg(format!("{WALLS}/walls.c"))
        .args(sources)
        .arg("-o")
        .arg(&program))?;
    output(&mut Command::new(program))
}

/// A crate, with the crates of this checkout for those of the repository that it names.
fn rust(folder: &Path) -> Result<String> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let (root, manifest) = (std::env::current_dir()?, folder.join("Cargo.toml"));
    let here = |name| format!("{name} = {{ path = \"{}\"", root.join("crates").join(name).display());
    let there = |name| format!(r#"{name} = {{ git = "https://github.com/eeruf/eeruf""#);
    let [core, driver] = ["eeruf-core", "eeruf-hc-sr04"];
    let text = fs::read_to_string(&manifest)?;
    fs::write(&manifest, edited(&text, &[(&there(core), &here(core)), (&there(driver), &here(driver))])?)?;
    fs::create_dir_all(folder.join("tests"))?;
    let harness = fs::read_to_string(format!("{WALLS}/walls.rs"))?.replace("NAME", &name);
    fs::write(folder.join("tests/walls.rs"), harness)?;
    let mut cargo = Command::new("cargo");
    cargo.current_dir(folder).env("CARGO_TARGET_DIR", root.join("target/programs-rust"));
    output(cargo.args(["test", "--quiet", "--test", "walls", "--", "--nocapture"]))
}
