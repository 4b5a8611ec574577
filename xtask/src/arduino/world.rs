//! The simulated world around a board, and a sketch's output in it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Error, Result, anyhow, ensure};
use eeruf_core::{ReadingKind, SpeedOfSound};
use eeruf_serial::{Decoder, FiringMessage, Message, Received};
use fs_err as fs;

use super::{Example, TARGET};
use crate::steps::{need, output, run, skip};

/// The scene of the examples, in which modules hear each other.
pub(super) const SCENE: &str = "scenes/alcove-hc-sr04.toml";
/// The paths of sound in it, for users without Rust.
pub(super) const KEPT: &str = "c/arduino/world/alcove.txt";
/// The program that [`build`] makes.
const WORLD: &str = "target/arduino/world";
/// Error in mm above which a reading is wrong: 0.3 ms of echo time.
const OFF_MM: u32 = 50;

/// Builds `c/arduino/world/world.c`, and checks the kept paths of sound.
pub(super) fn build() -> Result<()> {
    need("gcc --version", "apt install gcc")?;
    need("avr-g++ --version", "apt install gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    if !Path::new("/usr/include/simavr/sim_avr.h").exists() {
        return skip("no simavr; install libsimavr-dev libelf-dev".to_owned());
    }
    fs::create_dir_all(TARGET)?;
    run(Command::new("gcc")
        .args(["-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", "c/arduino/world/world.c", "-o", WORLD])
        .args(["-lsimavr", "-lelf"]))?;
    let is_kept = fs::read_to_string(KEPT)? == echo_times(8)?;
    ensure!(is_kept, "{KEPT} is not what `cargo lab echo-times {SCENE}` prints; rewrite it");
    Ok(())
}

/// The paths of sound in the scene, around its eight modules or around another number of them.
fn echo_times(modules: usize) -> Result<String> {
    let sensors = (modules != 8).then(|| modules.to_string());
    Ok(output(Command::new(crate::toolchain::lab()?).args(["echo-times", SCENE]).args(sensors))? + "\n")
}

/// A room of modules: the file with the paths of sound, and the distance that each module should measure.
pub(super) struct Room {
    file: PathBuf,
    own_mm: BTreeMap<usize, u32>,
}

impl Room {
    /// Makes a room, and its file, of paths of sound: lines of emitter, receiver and microseconds.
    pub(super) fn new(file: impl Into<PathBuf>, paths: &str) -> Result<Self> {
        let (file, mut own_mm) = (file.into(), BTreeMap::new());
        fs::write(&file, paths)?;
        for line in paths.lines() {
            let numbers: Vec<usize> = line.split(' ').filter_map(|number| number.parse().ok()).collect();
            if let [emitter, receiver, us] = numbers[..]
                && emitter == receiver
            {
                // 343.2 m/s, there and back.
                let mm = (us as u64 * 3432 / 20_000) as u32;
                let least = own_mm.entry(emitter).or_insert(mm);
                *least = mm.min(*least);
            }
        }
        Ok(Self { file, own_mm })
    }

    /// Makes a room in which each module faces a wall of its own at this echo time, or nothing.
    pub(super) fn walls(file: impl Into<PathBuf>, us: impl IntoIterator<Item = Option<u32>>) -> Result<Self> {
        let path = |(module, us): (usize, Option<u32>)| us.map(|us| format!("{module} {module} {us}\n"));
        Self::new(file, &us.into_iter().enumerate().filter_map(path).collect::<String>())
    }

    /// Makes the scene of the examples around its eight modules, of which a ring may have fewer, or around more.
    pub(super) fn alcove(file: impl Into<PathBuf>, modules: usize) -> Result<Self> {
        let paths = if modules > 8 { echo_times(modules) } else { Ok(fs::read_to_string(KEPT)?) };
        Self::new(file, &paths?)
    }

    /// Runs a sketch for some seconds of its own time among modules on these pins, triggers and then echoes; returns
    /// the bytes that it and the world print.
    pub(super) fn run(&self, elf: &Path, seconds: u32, pins: &[u8], options: &[&str]) -> Result<Vec<u8>> {
        let mut world = Command::new(WORLD);
        world.args(options).arg(elf).arg(seconds.to_string()).arg(&self.file).arg((pins.len() / 2).to_string());
        let ran = world.args(pins.iter().map(ToString::to_string)).output()?;
        ensure!(ran.status.success(), "the simulated world: {}", ran.status);
        Ok(ran.stdout)
    }

    /// Runs a sketch, and returns its lines.
    pub(super) fn text(&self, elf: &Path, seconds: u32, pins: &[u8], options: &[&str]) -> Result<String> {
        Ok(String::from_utf8_lossy(&self.run(elf, seconds, pins, options)?).replace('\r', ""))
    }

    /// Runs a sketch, and returns the figures of its readings.
    pub(super) fn heard(&self, elf: &Path, seconds: u32, pins: &[u8], options: &[&str]) -> Result<Heard> {
        let said = self.run(elf, seconds, pins, options)?;
        let mut heard = Heard { seconds, ..Heard::of(&String::from_utf8_lossy(&said), &self.own_mm) };
        heard.frames(&said, &self.own_mm).map_err(Error::msg)?;
        Ok(heard)
    }
}

/// Figures of a run.
#[derive(Default)]
pub(super) struct Heard {
    seconds: u32,
    firings: Vec<u32>,
    ignored: u32,
    pub(super) stack: u32,
    accepted: u32,
    by_module: BTreeMap<usize, u32>,
    wrong: u32,
    /// Wrong readings that were a module's own echo on another path, measured correctly.
    own_later: u32,
    right_by_module: BTreeMap<usize, u32>,
    /// Time of the sketch's first message that it is too slow, in milliseconds.
    slow_ms: Option<u32>,
    pub(super) says_so: bool,
}

/// Figures of a sketch with other work: right readings, wrong ones, and correctly measured own later echoes, each per
/// second; the share of accepted firings; the right readings of the worst module; the modules with fewer than one in
/// two seconds; and the time in milliseconds of the first report that the loop is too slow.
pub(super) struct UnderLoad {
    pub(super) right: f64,
    pub(super) wrong: f64,
    pub(super) wrong_percent: f64,
    pub(super) own_later: f64,
    pub(super) accepted_percent: f64,
    pub(super) worst: f64,
    pub(super) starved: usize,
    pub(super) slow_ms: Option<u32>,
}

impl Heard {
    /// Counts the readings in the output of a sketch and of the world: those that the world has read from the board's
    /// registers, if there are any, else those that the sketch prints.
    fn of(said: &str, own_mm: &BTreeMap<usize, u32>) -> Self {
        let by_world = said.contains("world read ");
        let mut heard = Self { says_so: said.contains("too slow"), ..Self::default() };
        // The width of each module's last pulse, as a distance, if its own sound ended it; a sketch prints the reading
        // before the module fires again.
        let mut own_pulses = BTreeMap::new();
        for line in said.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let numbers = || words.iter().skip(2).filter_map(|word| word.parse().ok());
            match words[..] {
                ["world", "firings", ..] => heard.firings = numbers().collect(),
                ["world", "ignored", ..] => heard.ignored = numbers().sum(),
                ["world", "stack", ..] => heard.stack = numbers().sum(),
                ["world", "pulse", module, cause, us] => {
                    let us = us.parse::<u32>().ok().filter(|_| cause == "own");
                    own_pulses.insert(module, us.map(|us| us * 1716 / 10_000));
                }
                ["slow", ms] => heard.slow_ms = heard.slow_ms.or(ms.parse().ok()),
                ["world", "read", module, distance] | [module, distance] | [module, distance, "cm"]
                    if by_world == (words.len() == 4) =>
                {
                    if let (Ok(number), Ok(distance)) = (module.parse::<usize>(), distance.parse::<u32>()) {
                        let mm = if words.len() == 3 { 10 * distance } else { distance };
                        heard.accept(own_mm, number.wrapping_sub(1), mm, own_pulses.get(module).copied().flatten());
                    }
                }
                _ => {}
            }
        }
        heard
    }

    /// The shares of accepted firings in percent: of all, and of the worst module, which is counted from 1. The first
    /// firing of each module is not compared.
    pub(super) fn shares(&self) -> (f64, (f64, usize)) {
        let share = |accepted: u32, compared: u32| 100.0 * f64::from(accepted) / f64::from(compared.max(1));
        let of = |module: usize| self.by_module.get(&module).copied().unwrap_or(0);
        let compared = self.firings.iter().map(|fired| fired.saturating_sub(1));
        let shares = compared.clone().enumerate().map(|(module, compared)| (share(of(module), compared), module + 1));
        let worst = shares.min_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or((0.0, 0));
        (share(self.accepted, compared.sum()), worst)
    }

    /// Counts a reading of a module, from 0, and the width as a distance of its pulse if its own sound ended it.
    fn accept(&mut self, own_mm: &BTreeMap<usize, u32>, module: usize, mm: u32, own_pulse_mm: Option<u32>) {
        self.accepted += 1;
        *self.by_module.entry(module).or_default() += 1;
        if own_mm.get(&module).is_some_and(|own| own.abs_diff(mm) <= OFF_MM) {
            *self.right_by_module.entry(module).or_default() += 1;
            return;
        }
        self.wrong += 1;
        self.own_later += u32::from(own_pulse_mm.is_some_and(|width_mm| width_mm.abs_diff(mm) <= OFF_MM));
    }

    /// The figures of a sketch with other work. An own later echo that was measured correctly is not wrong.
    pub(super) fn under_load(&self) -> UnderLoad {
        let per_second = |count: u32| f64::from(count) / f64::from(self.seconds);
        let wrong = self.wrong - self.own_later;
        let right_of = |module: usize| self.right_by_module.get(&module).copied().unwrap_or(0);
        let rights = || (0..self.firings.len()).map(right_of);
        UnderLoad {
            right: per_second(rights().sum()),
            wrong: per_second(wrong),
            wrong_percent: 100.0 * f64::from(wrong) / f64::from(self.accepted.max(1)),
            own_later: per_second(self.own_later),
            accepted_percent: self.shares().0,
            worst: per_second(rights().min().unwrap_or(0)),
            starved: rights().filter(|right| 2 * right < self.seconds).count(),
            slow_ms: self.slow_ms,
        }
    }

    /// Reads the frames of a sketch, none of which may be damaged or missing; other sketches send none. The simulator's
    /// own output comes before them.
    fn frames(&mut self, mut line: &[u8], own_mm: &BTreeMap<usize, u32>) -> Result<(), String> {
        while line.starts_with(b"Loaded ") {
            line = line.iter().position(|&byte| byte == b'\n').map_or(&[], |end| &line[end + 1..]);
        }
        let mut decoder = Decoder::default();
        for (frame, awaited) in line.iter().filter_map(|&byte| decoder.push(byte)).zip(0_u16..) {
            let Received { sequence, message, .. } = frame.map_err(|error| error.to_string())?;
            if sequence != awaited {
                return Err(format!("frame {awaited} is missing"));
            }
            if let Message::Firing(FiringMessage {
                sensor, kind: ReadingKind::Accepted, t_echo: Some(t_echo), ..
            }) = message
            {
                self.accept(own_mm, sensor.into(), SpeedOfSound::at_celsius_tenths(200).distance_mm(t_echo), None);
            }
        }
        Ok(())
    }

    /// The share of accepted readings that are wrong, in percent.
    pub(super) fn wrong_percent(&self) -> f64 {
        100.0 * f64::from(self.wrong) / f64::from(self.accepted.max(1))
    }

    /// The columns of the table.
    pub(super) fn row(&self) -> String {
        let per_second = |count: u32| f64::from(count) / f64::from(self.seconds);
        let wrong = self.wrong_percent();
        let firings = per_second(self.firings.iter().sum());
        format!("{} | {firings:.1} | {:.1} | {wrong:.1} %", self.stack, per_second(self.accepted))
    }

    /// Returns true if the sketch did its job.
    pub(super) fn is_plausible(&self, example: &Example) -> Result<()> {
        let least = self.firings.iter().min().copied().unwrap_or(0);
        let most = self.firings.iter().max().copied().unwrap_or(0);
        // 8 periods of the slowest table a second, each module once in each, and some 5 cycles of flow.
        let evenly = 10 * least + 20 >= 7 * most && least >= 5 * self.seconds;
        let all_fire = self.firings.len() == example.modules() && evenly;
        let is_right = 100 * self.wrong <= self.accepted;
        if all_fire && is_right && self.ignored == 0 && self.accepted > 2 * self.seconds {
            return Ok(());
        }
        Err(anyhow!(
            "{}: firings {:?}, {} triggers ignored, {} readings accepted in {} s, {} of them wrong",
            example.name,
            self.firings,
            self.ignored,
            self.accepted,
            self.seconds,
            self.wrong
        ))
    }
}
