//! The Arduino library in `c/arduino`: its tables from `design`, packed, its examples built with Debian's Arduino core
//! and run on a simulated Uno among simulated HC-SR04 modules.

mod build;
mod line_faults;
mod loads;
mod pace;
mod programs;
mod real_log;
mod survey;
mod tables;
mod world;

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use anyhow::{Context as _, Result};
use fs_err as fs;

pub(crate) use self::programs::{Drawn, programs};
use crate::steps::{Steps, command, empty, run};

/// Folder in which the library is packed, built and run.
const TARGET: &str = "target/arduino";

/// Wiring of an example: a trigger and an echo pin for each module. `short` is true if it runs in the short test.
struct Example {
    name: &'static str,
    triggers: &'static [u8],
    echoes: &'static [u8],
    short: bool,
}

impl Example {
    const fn new(name: &'static str, triggers: &'static [u8], echoes: &'static [u8], short: bool) -> Self {
        Self { name, triggers, echoes, short }
    }

    const fn modules(&self) -> usize {
        self.triggers.len()
    }

    fn pins(&self) -> Vec<u8> {
        [self.triggers, self.echoes].concat()
    }
}

const ALL: [u8; 16] = [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17];

const EXAMPLES: [Example; 6] = [
    Example::new("Ring8", ALL.split_at(8).0, ALL.split_at(8).1, false),
    Example::new("Flow12", ALL.split_at(12).0, ALL.split_at(12).0, true),
    Example::new("Strip", ALL.split_at(6).0, ALL.split_at(6).0, false),
    Example::new("FromNewPing", &[4, 5, 6], &[4, 5, 6], true),
    Example::new("States4", ALL.split_at(4).0, ALL.split_at(4).0, false),
    Example::new("SerialRing8", ALL.split_at(8).0, ALL.split_at(8).1, true),
];

/// Parts to run.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Rewrite the tables instead of comparing them
    #[arg(long)]
    write: bool,
    /// Run two of the examples for 3 s instead of all for 20 s
    #[arg(long)]
    short: bool,
    /// Run instead rings whose sketches have other work, and write tests/data/arduino-loads.csv
    #[arg(long)]
    loads: bool,
    /// With --loads: NewPing beside them, from a folder with its sources
    #[arg(long, value_name = "DIR", requires = "loads")]
    newping: Option<PathBuf>,
}

pub(crate) fn arduino(plan: &Plan, steps: &mut Steps) {
    if !plan.loads {
        steps.step("tables of the Arduino library", || tables::check(plan.write));
    }
    let Some(library) = steps.step("Arduino library", pack) else { return };
    if !plan.loads {
        steps.step("Arduino library for its other cores", || cores(&library));
    }
    if steps.step("simulated world", world::build).is_none() {
        return;
    }
    if plan.loads {
        steps.step("other work in loop()", || loads::run(&library, plan.newping.as_deref(), true));
        return;
    }
    steps.step("examples of the Arduino library", || examples(&library, plan.short));
    steps.step("pace of sketches", || pace::run(&library));
    steps.step("programs of `eeruf design`, a corner", || programs(&Drawn::default(), true));
    steps.step("log of a real ring", || real_log::run(&library));
    steps.step("sketches with a faulty module", || line_faults::run(&library));
    steps.step("other work in loop(), a corner", || loads::run(&library, None, false));
}

/// Runs a function on each item, on all processors; returns its answers in the order of the items.
fn on_all_processors<T: Sync, R: Send>(items: &[T], run: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    let (next, workers) = (AtomicUsize::new(0), thread::available_parallelism().map_or(1, usize::from));
    let taken = || Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|number| Some((number, items.get(number)?)));
    let work = || std::iter::from_fn(taken).map(|(number, item)| (number, run(number, item))).collect::<Vec<_>>();
    let mut done: Vec<_> = thread::scope(|scope| {
        let started: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        started.into_iter().flat_map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, answer)| answer).collect()
}

/// Packs the library, with its own files and those of `c/`, as the `.zip` that the IDE installs, and unpacks it into a
/// folder `libraries`, as the IDE does.
pub(crate) fn pack() -> Result<PathBuf> {
    let target = Path::new(TARGET);
    let (library, libraries) = (target.join("Eeruf"), target.join("libraries"));
    empty(&library)?;
    empty(&libraries)?;
    // Its sources of the C library are links.
    let copy = |to: &Path, from: &[&str]| run(Command::new("cp").arg("-rL").args(from).arg(to));
    copy(&library, &["c/arduino/src", "c/arduino/examples", "LICENSE-MIT", "LICENSE-APACHE"])?;
    let about = ["library.properties", "keywords.txt", "library.json", "README.md"];
    copy(&library, &about.map(|file| format!("c/arduino/{file}")).each_ref().map(String::as_str))?;
    let properties = fs::read_to_string(library.join("library.properties"))?;
    let version = properties.lines().find_map(|line| line.strip_prefix("version="));
    let zip = format!("Eeruf-{}.zip", version.context("library.properties: no version")?);
    for arguments in [["-c", &zip, "Eeruf"], ["-e", &zip, "libraries"]] {
        run(Command::new("python3").args(["-m", "zipfile"]).args(arguments).current_dir(TARGET))?;
    }
    println!("{TARGET}/{zip}");
    Ok(libraries.join("Eeruf"))
}

/// Compiles library and sketches against the declarations of the supported cores in `tests/arduino`.
fn cores(library: &Path) -> Result<()> {
    let properties = fs::read_to_string(library.join("library.properties"))?;
    let cores = properties.lines().find_map(|line| line.strip_prefix("architectures=")).context("no architectures")?;
    let sketches = ["FromNewPing", "States4", "Flow12", "Strip", "SerialRing8"];
    let sketches = sketches.map(|name| library.join(format!("examples/{name}/{name}.ino")));
    let sources = [&[library.join("src/EerufArduino.cpp")], &sketches[..]].concat();
    // The real core of AVRs compiles all of them.
    for core in cores.split(',').filter(|&core| core != "avr") {
        for source in &sources {
            let mut check =
                command("g++ -std=c++11 -fsyntax-only -Wall -Wextra -Werror -I tests/arduino -include Arduino.h");
            check.arg(format!("-DARDUINO_ARCH_{}", core.to_uppercase())).arg("-I").arg(library.join("src"));
            run(check.args(["-x", "c++"]).arg(source))?;
        }
    }
    println!("{cores}");
    Ok(())
}

fn examples(library: &Path, short: bool) -> Result<()> {
    let seconds = if short { 3 } else { 20 };
    println!("| sketch | flash | data + bss | stack | firings/s | accepted/s | wrong of accepted |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    for example in &EXAMPLES {
        let sketch = build::example(library, example.name)?;
        if example.short || !short {
            let room = world::Room::alcove(format!("{TARGET}/{}.alcove", example.name), example.modules())?;
            let heard = room.heard(&sketch.elf, seconds, &example.pins(), &[]).context(example.name)?;
            heard.is_plausible(example)?;
            println!("| {} | {} | {} | {} |", example.name, sketch.flash, sketch.ram, heard.row());
        }
    }
    let sketch = build::example(library, "Survey")?;
    if !short {
        println!("| Survey | {} | {} | {} |", sketch.flash, sketch.ram, survey::run(&sketch.elf)?);
    }
    Ok(())
}
