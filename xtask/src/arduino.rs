//! The Arduino library in `c/arduino`: its tables from `design`, packed, its examples built with Debian's Arduino core
//! and run on a simulated Uno among simulated HC-SR04 modules.

mod build;
mod library;
mod newping;
mod own_walls;
mod pace;
mod survey;
mod tables;
mod world;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use build::Board;
pub(crate) use newping::newping;

use crate::c::need;
use crate::steps::{Steps, Trouble, run};

/// Where it is packed, built and run.
const TARGET: &str = "target/arduino";

/// Wiring of an example, and what it is measured by.
struct Example {
    name: &'static str,
    modules: usize,
    triggers: &'static [u8],
    echoes: &'static [u8],
    /// True if it is run where time is short.
    short: bool,
}

/// `examples/uno`, which is in Rust: wired as Ring8.
const IN_RUST: Example =
    Example { name: "examples/uno", modules: 8, triggers: ALL.split_at(8).0, echoes: ALL.split_at(8).1, short: true };

const ALL: [u8; 16] = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17];

const EXAMPLES: [Example; 9] = [
    Example { name: "Two", modules: 2, triggers: &[4, 5], echoes: &[2, 3], short: false },
    Example { name: "Ring8", modules: 8, triggers: ALL.split_at(8).0, echoes: ALL.split_at(8).1, short: false },
    Example {
        name: "Ring12OnePin",
        modules: 12,
        triggers: ALL.split_at(12).0,
        echoes: ALL.split_at(12).0,
        short: true,
    },
    Example { name: "Flow12", modules: 12, triggers: ALL.split_at(12).0, echoes: ALL.split_at(12).0, short: true },
    Example { name: "FromNewPing", modules: 3, triggers: &[4, 5, 6], echoes: &[4, 5, 6], short: true },
    Example { name: "States4", modules: 4, triggers: ALL.split_at(4).0, echoes: ALL.split_at(4).0, short: false },
    Example { name: "Hopping8", modules: 8, triggers: ALL.split_at(8).0, echoes: ALL.split_at(8).0, short: false },
    Example { name: "SerialRing8", modules: 8, triggers: ALL.split_at(8).0, echoes: ALL.split_at(8).1, short: true },
    Example { name: "Adaptive", modules: 8, triggers: ALL.split_at(8).0, echoes: ALL.split_at(8).0, short: false },
];

fn failed(what: &str) -> impl Fn(std::io::Error) -> Trouble + '_ {
    move |error| Trouble::Failed(format!("{what}: {error}"))
}

/// Parts to run.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Rewrite the tables instead of comparing them
    #[arg(long)]
    write: bool,
    /// Run two of the examples for 3 s instead of all for 20 s
    #[arg(long)]
    short: bool,
}

pub(crate) fn arduino(plan: &Plan, steps: &mut Steps) {
    steps.step("tables of the Arduino library", || tables::check(plan.write));
    steps.step("tables of the examples", crate::examples::tables);
    steps.step("Arduino library", || pack().and_then(|library| examples(&library, plan.short)));
    steps.step("pace of sketches", || pace::run(&Path::new(TARGET).join("libraries/Eeruf")));
    steps.step("ready tables before walls", || own_walls::run(&Path::new(TARGET).join("libraries/Eeruf"), plan.short));
}

/// The library as one installs it, its files and those of `c/`: packed as the `.zip` that the IDE takes, and unpacked
/// into a folder `libraries`, as the IDE does.
fn pack() -> Result<PathBuf, Trouble> {
    let target = Path::new(TARGET);
    let (library, libraries) = (target.join("Eeruf"), target.join("libraries"));
    for folder in [&library, &libraries] {
        if folder.exists() {
            fs::remove_dir_all(folder).map_err(failed("the packed library"))?;
        }
    }
    let source = library.join("src");
    fs::create_dir_all(&source).map_err(failed("the packed library"))?;
    fs::create_dir_all(&libraries).map_err(failed("the packed library"))?;
    for folder in ["src", "examples"] {
        run(Command::new("cp").args(["-r"]).arg(Path::new("c/arduino").join(folder)).arg(&library))?;
    }
    for file in ["library.properties", "keywords.txt", "library.json", "README.md"] {
        fs::copy(Path::new("c/arduino").join(file), library.join(file)).map_err(failed(file))?;
    }
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        fs::copy(file, library.join(file)).map_err(failed(file))?;
    }
    for file in ["eeruf.c", "eeruf.h", "eeruf_serial.h"] {
        fs::copy(Path::new("c").join(file), source.join(file)).map_err(failed(file))?;
    }
    let properties = fs::read_to_string(library.join("library.properties")).map_err(failed("library.properties"))?;
    let version = library::check(&properties).map_err(Trouble::Failed)?;
    let zip = format!("Eeruf-{version}.zip");
    let of_python = ["-m", "zipfile"];
    run(Command::new("python3").args(of_python).args(["-c", &zip, "Eeruf"]).current_dir(TARGET))?;
    run(Command::new("python3").args(of_python).args(["-e", &zip, "libraries"]).current_dir(TARGET))?;
    println!("{TARGET}/{zip}");
    Ok(libraries.join("Eeruf"))
}

fn examples(library: &Path, short: bool) -> Result<(), Trouble> {
    need("avr-g++", "gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    need("gcc", "gcc")?;
    let core = build::core(Board::Uno)?;
    let world = world::build()?;
    println!("| sketch | flash | data + bss | stack | firings/s | accepted/s | wrong of accepted |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for example in &EXAMPLES {
        let sketch = build::example(library, &core, example.name)?;
        if short && !example.short {
            continue;
        }
        let seconds = if short { 3 } else { 20 };
        let heard = world::run(&world, &sketch.elf, example, seconds, false)?;
        heard.is_plausible(example)?;
        println!("| {} | {} | {} | {} |", example.name, sketch.flash, sketch.ram, heard.row());
    }
    let elf = crate::examples::uno()?;
    let (flash, ram) = build::size(&elf)?;
    let heard = world::run(&world, &elf, &IN_RUST, if short { 3 } else { 20 }, false)?;
    heard.is_plausible(&IN_RUST)?;
    println!("| `{}`, in Rust | {flash} | {ram} | {} |", IN_RUST.name, heard.row());
    let sketch = build::example(library, &core, "Survey")?;
    newping::builds(library, &core)?;
    if short {
        return Ok(());
    }
    println!("| Survey | {} | {} | {} |", sketch.flash, sketch.ram, survey::run(&world, &sketch.elf)?);
    Ok(())
}
