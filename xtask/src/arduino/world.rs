//! The simulated world around an Uno, and a sketch's output in it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Error, Result, anyhow, bail, ensure};
use eeruf_core::{ReadingKind, SpeedOfSound};
use eeruf_serial::{Decoder, FiringMessage, Message, Received};
use fs_err as fs;

use super::{Example, TARGET};
use crate::steps::{need, output, run, skip};

/// The room of the examples, in which modules hear each other.
pub(super) const SCENE: &str = "scenes/alcove-hc-sr04.toml";
/// The paths as a file, for users without Rust.
pub(super) const KEPT: &str = "c/arduino/world/alcove.txt";
/// Error in mm above which a reading is wrong: 0.3 ms of echo time.
const OFF_MM: u32 = 50;

/// Figures of a run.
#[derive(Default)]
pub(super) struct Heard {
    seconds: u32,
    firings: Vec<u32>,
    ignored: u32,
    pub(super) stack: u32,
    /// The share of the time spent in interrupts, in millionths.
    interrupts: u32,
    accepted: u32,
    by_module: BTreeMap<usize, u32>,
    wrong: u32,
    /// Wrong readings that were a module's own echo on another path, measured correctly.
    own_later: u32,
    right_by_module: BTreeMap<usize, u32>,
    /// Time of the sketch's first message that it is too slow, in milliseconds.
    slow_ms: Option<u32>,
    /// Wrong readings by cause: a module's own sound on another path, its own of an earlier firing, another's.
    by_cause: [u32; 3],
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

const CAUSES: [&str; 3] = ["own", "earlier", "foreign"];

/// Builds `c/arduino/world/world.c`.
pub(super) fn build() -> Result<PathBuf> {
    need("gcc --version", "apt install gcc")?;
    need("avr-g++ --version", "apt install gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    if !Path::new("/usr/include/simavr/sim_avr.h").exists() {
        return skip("no simavr; install libsimavr-dev libelf-dev".to_owned());
    }
    fs::create_dir_all(TARGET)?;
    let world = Path::new(TARGET).join("world");
    run(Command::new("gcc")
        .args(["-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", "c/arduino/world/world.c", "-o"])
        .arg(&world)
        .args(["-lsimavr", "-lelf"]))?;
    Ok(world)
}

/// Writes the paths of sound among the scene's eight modules, or among more of them all around, to a file; also returns
/// the distance that each module should measure.
pub(super) fn echo_times(modules: usize) -> Result<(PathBuf, BTreeMap<usize, u32>)> {
    let sensors = (modules > 8).then(|| modules.to_string());
    let times = output(Command::new(crate::toolchain::lab()?).args(["echo-times", SCENE]).args(&sensors))? + "\n";
    if sensors.is_none() && fs::read_to_string(KEPT)? != times {
        bail!("{KEPT} is not what `cargo lab echo-times {SCENE}` prints; rewrite it");
    }
    let own_mm = own_walls(&times);
    let file = Path::new(TARGET).join(format!("echo-times-{modules}.txt"));
    fs::write(&file, times)?;
    Ok((file, own_mm))
}

/// Returns the distance that each module should measure, from the paths of sound.
pub(super) fn own_walls(times: &str) -> BTreeMap<usize, u32> {
    let mut own_mm = BTreeMap::new();
    for line in times.lines() {
        let numbers: Vec<usize> = line.split(' ').filter_map(|number| number.parse().ok()).collect();
        let [emitter, receiver, us] = numbers[..] else { continue };
        if emitter == receiver {
            // 343.2 m/s, there and back.
            let mm = (us as u64 * 3432 / 20_000) as u32;
            let least = own_mm.entry(emitter).or_insert(mm);
            *least = mm.min(*least);
        }
    }
    own_mm
}

/// The command that runs a sketch for some seconds of its own time among modules on these pins (triggers, then echoes),
/// with the paths of sound in a file.
pub(super) fn command(world: &Path, options: &[&str], elf: &Path, seconds: u32, ways: &Path, pins: &[u8]) -> Command {
    let mut command = Command::new(world);
    command.args(options).arg(elf).arg(seconds.to_string()).arg(ways).arg((pins.len() / 2).to_string());
    command.args(pins.iter().map(ToString::to_string));
    command
}

/// The output of a sketch whose modules each face a wall at this echo time, or nothing.
pub(super) fn before_walls(
    world: &Path,
    elf: &Path,
    options: &[&str],
    seconds: u32,
    walls: &[Option<u32>],
    pins: &[u8],
) -> Result<String> {
    let way = |(module, us): (usize, &Option<u32>)| us.map(|us| format!("{module} {module} {us}\n"));
    let ways = Path::new(TARGET).join("walls.txt");
    fs::write(&ways, walls.iter().enumerate().filter_map(way).collect::<String>())?;
    output(&mut command(world, options, elf, seconds, &ways, pins))
}

/// Runs a sketch for some seconds of its own time. With `causes` the world prints why each pulse ended; not possible
/// with a sketch that sends frames.
pub(super) fn hear(world: &Path, elf: &Path, example: &Example, seconds: u32, causes: bool) -> Result<Heard> {
    let (times, own_mm) = echo_times(example.modules())?;
    let options: &[&str] = if causes { &["--pulses"] } else { &[] };
    hear_by(&mut command(world, options, elf, seconds, &times, &example.pins()), seconds, &own_mm)
        .with_context(|| example.name)
}

/// Runs a sketch by a command of [`command`], where each module should measure these distances.
pub(super) fn hear_by(command: &mut Command, seconds: u32, own_mm: &BTreeMap<usize, u32>) -> Result<Heard> {
    let ran = command.output()?;
    ensure!(ran.status.success(), "the simulated world: {}", ran.status);
    let mut heard = Heard::of(&String::from_utf8_lossy(&ran.stdout), own_mm);
    heard.seconds = seconds;
    heard.frames(&ran.stdout, own_mm).map_err(Error::msg)?;
    Ok(heard)
}

impl Heard {
    /// The figures in the output of a sketch and of the world, with the distance that each module should measure.
    pub(super) fn of(said: &str, own_mm: &BTreeMap<usize, u32>) -> Self {
        let mut heard = Self::default();
        // The cause that ended each module's last pulse, and its width as a distance; a sketch prints the reading
        // before the module fires again.
        let mut causes: BTreeMap<usize, (usize, u32)> = BTreeMap::new();
        for line in said.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let numbers = || words.iter().skip(2).filter_map(|word| word.parse().ok());
            match words[..] {
                ["world", "firings", ..] => heard.firings = numbers().collect(),
                ["world", "ignored", ..] => heard.ignored = numbers().sum(),
                ["world", "stack", ..] => heard.stack = numbers().sum(),
                ["world", "interrupts", ..] => heard.interrupts = numbers().sum(),
                ["world", "pulse", module, cause, us] => {
                    let cause = CAUSES.iter().position(|known| *known == cause);
                    if let (Ok(module), Some(cause), Ok(us)) = (module.parse(), cause, us.parse::<u32>()) {
                        causes.insert(module, (cause, us * 1716 / 10_000));
                    }
                }
                ["slow", ms] => heard.slow_ms = heard.slow_ms.or(ms.parse().ok()),
                [module, distance] | [module, distance, "cm"] => {
                    let (Ok(module), Ok(distance)) = (module.parse::<usize>(), distance.parse::<u32>()) else {
                        continue;
                    };
                    let mm = if words.len() == 3 { 10 * distance } else { distance };
                    let cause = causes.get(&module).copied();
                    heard.accept(own_mm, module.wrapping_sub(1), mm, cause);
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

    /// Counts a reading of a module, from 0: its width as a distance, and the cause of its end, if known.
    fn accept(&mut self, own_mm: &BTreeMap<usize, u32>, module: usize, mm: u32, cause: Option<(usize, u32)>) {
        self.accepted += 1;
        *self.by_module.entry(module).or_default() += 1;
        if own_mm.get(&module).is_some_and(|own| own.abs_diff(mm) <= OFF_MM) {
            *self.right_by_module.entry(module).or_default() += 1;
            return;
        }
        self.wrong += 1;
        let Some((cause, width_mm)) = cause else { return };
        if let Some(count) = self.by_cause.get_mut(cause) {
            *count += 1;
        }
        self.own_later += u32::from(CAUSES[cause] == "own" && width_mm.abs_diff(mm) <= OFF_MM);
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

    /// The columns of the table beside NewPing.
    pub(super) fn row_beside_newping(&self) -> String {
        let per_second = |count: u32| format!("{:.1}", f64::from(count) / f64::from(self.seconds));
        let share = |count: u32| format!("{:.1} %", 100.0 * f64::from(count) / f64::from(self.accepted.max(1)));
        let mut columns = vec![self.stack.to_string(), format!("{:.1} %", f64::from(self.interrupts) / 1e4)];
        columns.extend([self.firings.iter().sum(), self.accepted, self.accepted - self.wrong].map(per_second));
        columns.push(share(self.wrong));
        columns.extend(self.by_cause.map(share));
        columns.join(" | ")
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
