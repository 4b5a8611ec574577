//! `cargo xtask programs`: builds the output of `eeruf design --program` like a user, and runs it: on modules that each
//! face a wall of their own, and sketches also in an alcove where modules hear each other. `--combinations`
//! draws way, language, number of modules, and other work of the loop.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, Error, Result, ensure};
use fs_err as fs;

use super::build::{self, Board};
use super::loads::{self, Load};
use super::on_all_processors;
use super::world::{self, Room};
use crate::steps::{Skipped, edited, empty, output, run};
use crate::toolchain::program;

/// Combinations to draw.
#[derive(clap::Args, Default)]
pub(crate) struct Drawn {
    /// Run this many programs whose way, language, number of modules and other work are drawn, instead of those of the
    /// table in docs/log/arduino.md; by default none
    #[arg(long, value_name = "N", default_value_t = 0)]
    combinations: usize,
    /// The seed of the draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Run instead six modules beside each other work of tests/data/arduino-loads.csv on an Uno, a Mega and an emulated
    /// M0
    #[arg(long)]
    loads: bool,
}

/// A requested program: ring file or number of modules, options, and the other work of its loop.
struct Asked {
    ring: String,
    options: String,
    load: Option<Load>,
}

const CAR: &str = "tests/data/car-4.toml";
/// A ring whose file names no module, and which listens only as far as its ranges.
const CAR_12: &str = "rings/car-12.toml";
const MAVLINK: &str = "arduino --mavlink";
/// A crate whose edges a timer's capture registers stamp.
const CAPTURED: &str = "rust --way flow captured";
/// Programs for the car alone.
const OF_CAR: [&str; 2] = [MAVLINK, "rust --way two-phases"];
const RINGS: [&str; 9] = [
    CAR,
    "2",
    "6",
    "rings/hc-sr04-8.toml",
    "12",
    "rings/magni-5.toml",
    "rings/nao-2.toml",
    "rings/pmb2-3.toml",
    CAR_12,
];
const LANGUAGES: [&str; 4] = ["arduino", "c", "rust", "micropython"];
const WAYS: [&str; 4] = ["flow", "sequential", "groups", "two-phases"];
/// Combinations that run in CI.
const CORNER: usize = 5;
/// Folder of the harnesses.
const WALLS: &str = "tests/programs";
/// A sketch's line that looks for a reading, after which it is counted.
const READ: &str = "  if (!sonar.read() || Serial.availableForWrite() < 14) return;\n";
const COUNTED: &str = "  if (!sonar.read()) return;
  if (sonar.accepted()) {
    GPIOR1 = sonar.millimetres() >> 8;
    GPIOR2 = sonar.millimetres();
    GPIOR0 = sonar.sensor() + 1;
  }
  if (Serial.availableForWrite() < 14) return;
";

/// Shares of accepted firings, over all modules and for the worst one, and shares of wrong readings among them, with
/// walls and in the alcove, all in percent; `says_so` is true if the program reports that it is too slow.
#[derive(Default)]
struct Figures {
    accepted: f64,
    worst: f64,
    wrong: f64,
    in_alcove: Option<(u32, f64)>,
    says_so: bool,
}

/// Runs all programs, or a few of them for a few seconds, or drawn combinations.
pub(crate) fn programs(drawn: &Drawn, short: bool) -> Result<()> {
    let folder = Path::new("target/programs");
    empty(folder)?;
    world::build()?;
    let program = program()?;
    let mut state = drawn.seed;
    let mut asked = vec![];
    let rings = if drawn.combinations > 0 || drawn.loads { 0 } else { [RINGS.len(), 1][usize::from(short)] };
    for load in loads::KINDS.into_iter().filter(|_| drawn.loads) {
        // The crate has no call that waits until it is quiet.
        let programs = ["arduino --way flow", "arduino --way flow --board mega", CAPTURED];
        let programs = programs.into_iter().filter(|program| *program != CAPTURED || !load.waits);
        asked.extend(programs.map(|options| Asked::new("6", options, Some(load))));
    }
    // Groups of three: a late trigger loses a module.
    asked.extend((rings > 0).then(|| Asked::new("12", "arduino --way groups", None)));
    for ring in &RINGS[..rings] {
        // Its sensors have limits of their own, which MicroPython's ring has not.
        let languages = &LANGUAGES[..if *ring == CAR_12 { 3 } else { 4 }];
        let programs = languages.iter().chain(OF_CAR.iter().filter(|_| *ring == CAR));
        asked.extend(programs.map(|options| Asked::new(ring, options, None)));
    }
    let count = if short { CORNER } else { drawn.combinations };
    asked.extend((0..count).map(|_| Asked::drawn(&mut state)));
    println!("| ring | program | other work | accepted | worst module | wrong | in the alcove: stack, wrong |");
    println!("|---|---|---|---:|---:|---:|---:|");
    let failed = on_all_processors(&asked, |number, asked| {
        let row = asked.row(&folder.join(format!("ring_{number}")), short, &program);
        row.map(|row| println!("| {} | {row} |", asked.name())).map_err(|error| error.context(asked.name()))
    });
    let (skipped, broken): (Vec<Error>, Vec<Error>) =
        failed.into_iter().filter_map(Result::err).partition(Error::is::<Skipped>);
    let broken: Vec<_> = broken.iter().map(|error| format!("{error:#}")).collect();
    ensure!(broken.is_empty(), "{}", broken.join("\n"));
    skipped.into_iter().next().map_or(Ok(()), Err)
}

impl Asked {
    fn new(ring: &str, options: &str, load: Option<Load>) -> Self {
        Self { ring: ring.to_owned(), options: options.to_owned(), load }
    }

    /// Draws a valid combination.
    fn drawn(state: &mut u64) -> Self {
        loop {
            let mut up_to = |most: usize| loads::up_to(state, most as u32) as usize;
            let (modules, way, language) = (2 + up_to(23), WAYS[up_to(4)], LANGUAGES[up_to(4)]);
            let kinds = loads::KINDS.len();
            let number = up_to(kinds + 1);
            let load = if number < kinds { loads::KINDS[number] } else { loads::load(20_000, 500_000, 0.0) };
            let polled = up_to(4) == 0;
            let (sketch, python) = (language == "arduino", language == "micropython");
            // A Pico has pins for 13, and the emulated board twelve fake modules.
            let most = if python { 13 } else { [24, 12][usize::from(language == "rust")] };
            let is_unknown = python && ["groups", "two-phases"].contains(&way) || load.masks && !sketch;
            if modules > most || is_unknown || way == "groups" && modules % 4 != 0 {
                continue;
            }
            let board = if sketch && modules > 16 { " --board mega" } else { "" };
            let edges = if sketch && polled { " polled" } else { "" };
            let options = format!("{language} --way {way}{board}{edges}");
            return Self::new(&modules.to_string(), &options, Some(load));
        }
    }

    /// The first columns of its row.
    fn name(&self) -> String {
        let work = self.load.as_ref().map_or_else(|| "-".to_owned(), Load::name);
        format!("{} | {} | {work}", self.ring, self.options)
    }

    /// Runs a program, and returns the columns of its figures, if they are good enough.
    fn row(&self, out: &Path, short: bool, program: &Path) -> Result<String> {
        let seconds = if short { 3 } else { 5 };
        let mut text = match self.ring.parse::<usize>() {
            Ok(modules) => format!("sensors = {modules}\nlayout = \"ring\"\nspeed_m_s = 0.5\n"),
            Err(_) => fs::read_to_string(&self.ring)?,
        };
        if !text.contains("\nmodule = ") {
            text = format!("module = \"hc-sr04\"\n{text}");
        }
        let ring = out.with_extension("toml");
        fs::write(&ring, text)?;
        let words =
            format!("{} --places 1 --budget 20000", self.options.replace(" polled", "").replace(" captured", ""));
        let mut design = Command::new(program);
        output(design.arg("design").arg(ring).arg("--program").args(words.split(' ')).arg("--out").arg(out))?;
        let polled = self.options.ends_with("polled") || self.options.starts_with("micropython");
        let figures = match self.options.split(' ').next() {
            Some("arduino") if self.options == MAVLINK => return obstacles(out, seconds),
            Some("arduino") => self.sketch(out, seconds)?,
            Some("micropython") => self.counted(Command::new("python3").arg(format!("{WALLS}/walls.py")).arg(out))?,
            Some("c") => self.counted(&mut c(out)?)?,
            _ => self.counted(&mut rust(out, self)?)?,
        };
        let Figures { accepted, worst, wrong, in_alcove, says_so } = figures;
        let (least, least_of_worst) = match self.load {
            None => (95.0, 85.0),
            Some(_) if polled || self.options.contains("two-phases") || says_so => (0.0, 0.0),
            Some(load) => (load.accepted.max(70.0), 70.0),
        };
        // In the alcove, sensors of a group hear each other, so groups are not recommended there.
        let foreign = in_alcove.filter(|_| !self.options.contains("groups")).map_or(0.0, |(_, foreign)| foreign);
        let mut row =
            format!("{accepted:.1} % | {worst:.1} %{} | {wrong:.1} %", if says_so { ", says so" } else { "" });
        row += &in_alcove.map_or(" | not run".to_owned(), |(stack, wrong)| format!(" | {stack}, {wrong:.1} %"));
        ensure!(
            accepted >= least && worst >= least_of_worst && wrong == 0.0 && foreign <= 1.0,
            "{row}; expected {least} % accepted, {least_of_worst} % of the worst module, and 1 % wrong in the alcove"
        );
        // Except for tables, a late poll costs only time. If a table is polled, modules that fire at once wait for each
        // other's line to rise.
        let may_say_so = |load: Load| load.work_us > 0 || polled && self.options.contains("two-phases");
        ensure!(
            !says_so || self.load.is_some_and(may_say_so),
            "{row}; expected that it does not say that it is too slow"
        );
        Ok(row)
    }

    /// The work of the loop, its interval, and the distance between walls in microseconds: a fast robot, or one whose
    /// file gives ranges, listens only briefly.
    fn work(&self) -> [String; 3] {
        let [work, every] = self.load.map_or([0; 2], |load| [load.work_us, load.every_us]);
        // A PMB-2 sees 1 m.
        let of_file = if self.ring.contains("pmb2") { 4 } else { 9 };
        [work, every, if self.ring.parse::<u8>().is_ok() { 20 } else { of_file }].map(|us| us.to_string())
    }

    /// Figures of a harness that prints, for each module, its readings, those accepted and those wrong. It takes the
    /// load from the environment.
    fn counted(&self, harness: &mut Command) -> Result<Figures> {
        let ran = harness.env("LOAD", self.work().join(" ")).output()?;
        // The emulated board writes to standard error.
        let said = [ran.stdout, ran.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        ensure!(ran.status.success(), "{}: {said}", ran.status);
        let numbers = |line: &str| line.split(' ').map(|word| word.parse::<f64>().ok()).collect::<Option<Vec<_>>>();
        let counts: Vec<[f64; 3]> = said.lines().filter_map(|line| numbers(line)?.try_into().ok()).collect();
        let [readings, accepted, wrong] =
            counts.iter().fold([0.0; 3], |sum, of| std::array::from_fn(|n| sum[n] + of[n]));
        ensure!(readings > 5.0 * counts.len() as f64, "{readings} readings of {} modules:\n{said}", counts.len());
        let worst = counts.iter().map(|[readings, accepted, _]| 100.0 * accepted / readings.max(1.0)).reduce(f64::min);
        Ok(Figures {
            accepted: (100.0 * accepted / readings).min(100.0),
            worst: worst.context("no modules")?.min(100.0),
            wrong: 100.0 * wrong / accepted.max(1.0),
            says_so: said.contains("too slow"),
            ..Figures::default()
        })
    }

    /// Returns figures of a sketch, built as the IDE does, from its folder alone. With twelve modules or fewer it also
    /// runs in the alcove.
    fn sketch(&self, folder: &Path, seconds: u32) -> Result<Figures> {
        let mut text = sketch_in(folder)?;
        let mut eeprom = String::new();
        if let Some(load) = &self.load {
            let (work, does) = loads::work().context("the sketch of loads has other lines")?;
            let setup =
                format!("struct {{{work}void doWork{does}void setup() {{\n  eeprom_read_block(&work, 0, sizeof work);");
            text = edited(
                &text,
                &[
                    ("void setup() {", &setup),
                    ("Serial.begin(115200)", "Serial.begin(work.baud)"),
                    ("void loop() {", "void loop() {\n  doWork();"),
                    (READ, COUNTED),
                ],
            )?;
            let polled = if self.options.ends_with("polled") { "#define EERUF_POLLED\n" } else { "" };
            text = format!("{polled}#include <avr/eeprom.h>\n{text}");
            eeprom = load.eeprom();
        }
        let is_mega = self.options.contains("mega");
        let (elf, pins) = built(folder, if is_mega { Board::Mega } else { Board::Uno }, &text)?;
        let options = [&["--mega"][usize::from(!is_mega)..], &["--eeprom", &eeprom]].concat();
        let modules = pins.len() / 2;
        // By the golden section, so that no two are alike.
        let span: usize = self.work()[2].parse()?;
        let walls = (0..modules).map(|x| Some((1_500 + x * 618 % 1000 * span) as u32));
        let heard = Room::walls(folder.join("walls.txt"), walls)?.heard(&elf, seconds, &pins, &options)?;
        // If every echo is believed, so is the first, which the shares leave out.
        let (accepted, (worst, _)) = heard.shares();
        let mut in_alcove = None;
        if modules <= 12 {
            let heard = Room::alcove(folder.join("alcove.txt"), modules)?.heard(&elf, seconds, &pins, &options)?;
            in_alcove = Some((heard.stack, heard.wrong_percent()));
        }
        let (wrong, says_so) = (heard.wrong_percent(), heard.says_so);
        Ok(Figures { accepted: accepted.min(100.0), worst: worst.min(100.0), wrong, in_alcove, says_so })
    }
}

fn sketch_in(folder: &Path) -> Result<String> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    Ok(fs::read_to_string(folder.join(format!("{name}.ino")))?)
}

/// Builds a sketch as the IDE does, from its folder alone: the program, and its pins, triggers and then echoes.
fn built(folder: &Path, board: Board, text: &str) -> Result<(std::path::PathBuf, Vec<u8>)> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let warnings = ["-Wall", "-Wextra", "-Werror", "-I", &*folder.to_string_lossy()];
    let elf = build::sketch(&folder.join("src/eeruf"), board, &name, text, &warnings)?.elf;
    let pins = ["TRIGGERS", "ECHOES"].map(|list| pins(text, list).or_else(|| pins(text, "PINS")).unwrap_or_default());
    Ok((elf, pins.concat()))
}

/// The rate of `OBSTACLE_DISTANCE` messages of a car's sketch, whose later half must show the wall of each module.
fn obstacles(folder: &Path, seconds: u32) -> Result<String> {
    let (elf, pins) = built(folder, Board::Uno, &sketch_in(folder)?)?;
    // Ahead, left, right, behind, at 1 to 3.9 m: the sector that looks there, of 5 degrees clockwise from -20 on.
    let room = Room::walls(folder.join("walls.txt"), [5_828, 11_655, 17_483, 22_727].map(Some))?;
    let sectors = [4, 58, 22, 40];
    let said = room.run(&elf, seconds, &pins, &[])?;
    let frames: Vec<_> = (0..said.len()).filter_map(|at| sectors_in(&said[at..])).collect();
    ensure!(!frames.is_empty(), "no OBSTACLE_DISTANCE");
    for frame in &frames[frames.len() / 2..] {
        for (sector, cm) in sectors.into_iter().zip([100, 200, 300, 390]) {
            ensure!(frame[sector].abs_diff(cm) <= 1, "sector {sector}: {} cm; expected {cm}", frame[sector]);
        }
    }
    let rate = frames.len() as u32 / seconds;
    ensure!(rate >= 4, "{rate} OBSTACLE_DISTANCE a second; expected 4");
    Ok(format!("{rate} OBSTACLE_DISTANCE a second | - | - | -"))
}

/// The distances of an `OBSTACLE_DISTANCE` message at the start of these bytes, if it is whole.
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

fn c(folder: &Path) -> Result<Command> {
    let program = folder.join("walls");
    let sources = ["sonar.c", "eeruf.c"].map(|file| folder.join(file));
    run(Command::new("gcc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-I"])
        .arg(folder)
        .arg(format!("{WALLS}/walls.c"))
        .args(sources)
        .arg("-o")
        .arg(&program))?;
    Ok(Command::new(program))
}

/// Builds a crate for an emulated Cortex-M0, with this checkout's crates in place of the repository that it names.
fn rust(folder: &Path, asked: &Asked) -> Result<Command> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let (root, manifest) = (std::env::current_dir()?, folder.join("Cargo.toml"));
    let mut text = fs::read_to_string(&manifest)?;
    for name in ["eeruf-core", "eeruf-hc-sr04"] {
        let here = format!("{name} = {{ path = \"{}\"", root.join("crates").join(name).display());
        text = edited(&text, &[(&format!(r#"{name} = {{ git = "https://github.com/eeruf/eeruf""#), &here)])?;
    }
    fs::write(&manifest, text)?;
    let root = root.to_string_lossy();
    let edge = if asked.options == CAPTURED { "captured()" } else { "edge()" };
    let ([work, every, span], masked) = (&asked.work(), asked.load.is_some_and(|load| load.masks).to_string());
    let mut values = vec![("NAME", &*name), ("ROOT", &root), ("WORK", work), ("EVERY", every), ("SPAN", span)];
    values.extend([("edge()", edge), ("MASKED", &masked)]);
    if !fs::read_to_string(folder.join("src/lib.rs"))?.contains("seed: u32") {
        // A table has no dice, and needs no speed.
        values.extend([("7, now", "now"), ("    ring.moving(0, 0, now);\n", "")]);
    }
    let harness = |file: &str| {
        let text = fs::read_to_string(Path::new(WALLS).join(file))?;
        anyhow::Ok(values.iter().fold(text, |text, (name, value)| text.replace(name, value)))
    };
    crate::firmware::on_m0(&folder.join("m0"), &format!("m0-{name}"), &harness("m0.toml")?, &harness("m0.rs")?)
}
