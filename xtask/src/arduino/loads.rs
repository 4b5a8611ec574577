//! Other work in a sketch's `loop()`: right and wrong readings of a flow ring, polled and by interrupt, in the alcove,
//! in a larger one, and with a separate wall for each module.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use super::build::{self, Board};
use super::world::{self, Room, UnderLoad};
use super::{ALL, TARGET, on_all_processors};
use crate::steps::output;
use crate::toolchain::program;

const SKETCH: &str = include_str!("loads/Loads.ino");
const NEWPING: &str = include_str!("loads/NewPing.ino");
/// The ring that `design` emits, with another number of modules.
const RING: &str = "rings/hc-sr04-8.toml";
const RINGS: [usize; 2] = [6, 8];
/// The file with all figures.
const FILE: &str = "tests/data/arduino-loads.csv";
const POLLED: &str = "polled";
const ALCOVE: &str = "alcove";
const OWN_WALLS: &str = "own walls";
/// Time for which each load runs, in seconds.
const SECONDS: u32 = 3;
/// Numbers of the loads that run in CI, with six modules in the alcove.
const CORNER: [usize; 3] = [1, 11, 18];

/// Longest time in milliseconds until a starving sketch reports that it is too slow.
const SAYS_SO_MS: u32 = 2_000;

/// Work of this many microseconds, begun this long after the previous start; in every turn of `loop()` if that is 0.
#[derive(Clone, Copy)]
pub(super) struct Load {
    pub(super) work_us: u32,
    pub(super) every_us: u32,
    baud: u32,
    /// True if the work masks interrupts; otherwise it may wait for `quietFor()` too.
    pub(super) masks: bool,
    pub(super) waits: bool,
    /// Least number of right readings a second of six polled modules in the alcove, for a table with edges stamped as
    /// seen.
    least: f64,
    /// Largest number of wrong readings a second: polled, and by interrupt.
    most: [f64; 2],
    /// The least share of accepted firings by interrupt, in percent, before walls of their own.
    pub(super) accepted: f64,
}

pub(super) const fn load(work_us: u32, every_us: u32, least: f64) -> Load {
    let accepted = if every_us == 0 && work_us > 0 { 0.0 } else { 85.0 };
    Load { work_us, every_us, baud: 115_200, masks: false, waits: false, least, most: [0.0; 2], accepted }
}

const fn masked(work_us: u32, waits: bool, most: [f64; 2], accepted: f64) -> Load {
    Load { masks: true, waits, most, accepted, ..load(work_us, 20_000, 0.0) }
}

pub(super) const KINDS: [Load; 23] = [
    load(0, 0, 64.9),
    load(1_000, 5_000, 43.2),
    load(1_600, 10_000, 41.2),
    load(3_000, 10_000, 37.1),
    load(5_000, 20_000, 29.3),
    load(6_000, 15_000, 21.1),
    load(8_000, 15_000, 3.1),
    load(6_000, 20_000, 0.0),
    load(6_000, 25_000, 0.0),
    load(6_000, 33_000, 0.0),
    load(3_000, 0, 0.0),
    load(5_000, 0, 0.0),
    load(10_000, 0, 0.0),
    load(20_000, 0, 0.0),
    load(100_000, 0, 0.0),
    load(5_000, 50_000, 58.4),
    load(25_000, 100_000, 47.9),
    masked(900, false, [0.0, 0.1], 80.0),
    masked(1_800, false, [0.0, 0.7], 70.0),
    masked(900, true, [0.0; 2], 85.0),
    masked(1_800, true, [0.0; 2], 85.0),
    Load { baud: 9_600, ..load(0, 0, 64.8) },
    Load { baud: 9_600, ..load(1_000, 5_000, 0.0) },
];

/// Draws a number below another one.
pub(super) fn up_to(state: &mut u64, most: u32) -> u32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*state >> 33) % u64::from(most)) as u32
}

/// Returns the sketch's simulated workload, its variables and its function, for use in other sketches.
pub(super) fn work() -> Option<(&'static str, &'static str)> {
    let (variables, rest) = SKETCH.split_once("struct {")?.1.split_once("void setup")?;
    Some((variables, rest.split_once("void doWork")?.1.split_once("void loop")?.0))
}

impl Load {
    pub(super) fn name(&self) -> String {
        let how = match (self.masks, self.waits) {
            (true, true) => " masked while quiet",
            (true, false) => " masked",
            _ if self.baud < 115_200 => " and Serial at 9600 baud",
            _ => "",
        };
        let ms = |us: u32| f64::from(us) / 1000.0;
        match self.every_us {
            _ if self.work_us == 0 => format!("none{how}"),
            0 => format!("delay({}){how}", ms(self.work_us)),
            every => format!("{} ms every {} ms{how}", ms(self.work_us), ms(every)),
        }
    }

    /// Returns the figures of a ring that break a promise.
    fn broken(&self, heard: &UnderLoad, polled: bool, compared: bool, own_walls: bool) -> Vec<String> {
        let UnderLoad { right, wrong, accepted_percent, starved, slow_ms, .. } = *heard;
        let most = self.most[usize::from(!polled)];
        let least = if polled && compared { self.least } else { 0.0 };
        let least_percent = if own_walls && !polled { self.accepted } else { 0.0 };
        let says_so = slow_ms.is_some_and(|ms| ms <= SAYS_SO_MS);
        let name = format!("{}, {}", self.name(), if polled { "polled" } else { "by interrupt" });
        [
            (wrong <= most, format!("{wrong:.1} wrong a second; expected at most {most}")),
            (right >= least, format!("{right:.1} right a second; expected at least {least}")),
            (
                accepted_percent >= least_percent,
                format!("{accepted_percent:.1} % accepted; expected at least {least_percent}"),
            ),
            (starved == 0 || says_so, format!("{starved} modules starve; said so: {slow_ms:?} ms")),
        ]
        .into_iter()
        .filter_map(|(holds, what)| (!holds).then(|| format!("{name}: {what}")))
        .collect()
    }

    /// The bytes that the sketch reads.
    pub(super) fn eeprom(&self) -> String {
        let numbers = [self.work_us, self.every_us, self.baud].map(u32::to_le_bytes).concat();
        let bytes = numbers.into_iter().chain([self.masks.into(), self.waits.into()]);
        bytes.fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        })
    }
}

/// The rooms by their names: the alcove; separate walls at 0.4 to 3.4 m, spaced by the golden section so that no two
/// are alike; and the alcove 1.6 times as large, where a module's sound is still heard after 10 ms, for eight modules.
fn rooms() -> Result<[(&'static str, Room); 3]> {
    let alcove = fs::read_to_string(world::KEPT)?;
    let own = (0..8).map(|module| Some(2_300 + module * 618 % 1000 * 175 / 10));
    let larger = |line: &str| {
        let (who, us) = line.rsplit_once(' ')?;
        Some(format!("{who} {}\n", us.parse::<u32>().ok()? * 8 / 5))
    };
    let large: String = alcove.lines().filter_map(larger).collect();
    let file = |name: &str| Path::new(TARGET).join(name);
    Ok([
        (ALCOVE, Room::alcove(file("alcove.txt"), 8)?),
        (OWN_WALLS, Room::walls(file("own-walls.txt"), own)?),
        ("large alcove", Room::new(file("large-alcove.txt"), &large)?),
    ])
}

/// Returns the folder of NewPing's sources, and their version. The licence of NewPing does not allow it here.
fn newping(folder: &Path) -> Result<(PathBuf, String)> {
    let folders = [folder.to_owned(), folder.join("src")];
    let found = folders.into_iter().find(|folder| folder.join("NewPing.h").exists());
    let found = found.with_context(|| format!("{}: no NewPing.h in it", folder.display()))?;
    let header = fs::read_to_string(found.join("NewPing.h"))?;
    let version = header.split_once("NewPing Library - v").and_then(|(_, rest)| rest.split_whitespace().next());
    let version = version.context("NewPing.h does not say its version as expected")?.to_owned();
    Ok((found, version))
}

/// Makes the sketch for this many modules from the output of `design`.
fn sketch(library: &Path, modules: usize, polled: bool) -> Result<build::Sketch> {
    let name = format!("Loads{modules}{}", if polled { "Polled" } else { "" });
    let folder = Path::new(TARGET).join(&name);
    fs::create_dir_all(&folder)?;
    let ring = folder.join("ring.toml");
    fs::write(&ring, fs::read_to_string(RING)?.replace("sensors = 8", &format!("sensors = {modules}")))?;
    let emitted =
        output(Command::new(program()?).arg("design").arg(ring).args(["--way", "flow", "--emit", "arduino"]))?;
    ensure!(emitted.contains("EerufFlowConfig RING"), "{RING}: not by flow:\n{emitted}");
    fs::write(folder.join("ring.h"), emitted)?;
    build::ours(
        library,
        Board::Uno,
        &name,
        SKETCH,
        &[&format!("-DMODULES={modules}"), &format!("-DPOLLED={}", u8::from(polled))],
    )
}

/// A sketch of this many modules: NewPing's, by its name, or ours.
struct Ring {
    modules: usize,
    elf: PathBuf,
    edges: &'static str,
    newping: Option<String>,
}

/// A run of a sketch in a room, ours with other work.
struct Run<'a> {
    ring: &'a Ring,
    room: &'a (&'static str, Room),
    load: Option<&'a Load>,
}

impl Run<'_> {
    /// Returns the row of the table, and the broken promises.
    fn row(&self) -> Result<(String, Vec<String>)> {
        let (Ring { modules, elf, edges, newping }, (place, room)) = (self.ring, self.room);
        let eeprom = self.load.map(Load::eeprom).unwrap_or_default();
        let options = ["--pulses", "--eeprom", &eeprom];
        let heard = room.heard(elf, SECONDS, &ALL[..*modules].repeat(2), &options)?.under_load();
        let UnderLoad { right, wrong, wrong_percent, own_later, accepted_percent, worst, starved, slow_ms } = heard;
        let said = slow_ms.map_or(String::new(), |ms| ms.to_string());
        let work = newping.clone().or(self.load.map(Load::name)).unwrap_or_default();
        // NewPing does not compare readings.
        let accepted = self.load.map_or(String::new(), |_| format!("{accepted_percent:.1}"));
        let per_second = format!("{right:.1},{wrong:.1},{wrong_percent:.1},{own_later:.1}");
        let figures = format!("{per_second},{accepted},{worst:.1},{starved},{said}");
        let row = format!("{modules},{place},{edges},{work},{figures}\n");
        print!("{row}");
        let is_compared = *modules == RINGS[0] && *place == ALCOVE;
        let of = |load: &Load| load.broken(&heard, *edges == POLLED, is_compared, *place == OWN_WALLS);
        let named = |what| format!("{modules} modules, {place}, {what}");
        Ok((row, self.load.into_iter().flat_map(of).map(named).collect()))
    }
}

/// Builds the sketches of all rings: NewPing's, if a folder has its sources, and ours.
fn rings(library: &Path, newping_in: Option<&Path>, all: bool) -> Result<Vec<Ring>> {
    let mut rings = vec![];
    for modules in RINGS.into_iter().filter(|&modules| all || modules == RINGS[0]) {
        for (folder, wait_ms) in newping_in.into_iter().flat_map(|folder| [0, 5, 10, 29].map(|ms| (folder, ms))) {
            let (sources, version) = newping(folder)?;
            let defines = ["-w", &format!("-DMODULES={modules}"), &format!("-DWAIT_MS={wait_ms}")];
            let name = format!("NewPing{modules}Waits{wait_ms}");
            let elf = build::sketch(&sources, Board::Uno, &name, NEWPING, &defines)?.elf;
            let newping = Some(format!("NewPing {version} every {wait_ms} ms"));
            rings.push(Ring { modules, elf, edges: "waits", newping });
        }
        for edges in [POLLED, "interrupts"] {
            let elf = sketch(library, modules, edges == POLLED)?.elf;
            rings.push(Ring { modules, elf, edges, newping: None });
        }
    }
    Ok(rings)
}

/// Runs all loads and writes their figures, or runs a few of them for CI.
pub(super) fn run(library: &Path, newping_in: Option<&Path>, all: bool) -> Result<()> {
    let (rings, rooms) = (rings(library, newping_in, all)?, rooms()?);
    let chosen: Vec<&Load> =
        KINDS.iter().enumerate().filter(|(number, _)| all || CORNER.contains(number)).map(|(_, load)| load).collect();
    let mut runs = vec![];
    for modules in RINGS {
        let most = if all { [2, 3][usize::from(modules > RINGS[0])] } else { 1 };
        for room in &rooms[..most] {
            for ring in rings.iter().filter(|ring| ring.modules == modules) {
                let loads =
                    if ring.newping.is_some() { vec![None] } else { chosen.iter().copied().map(Some).collect() };
                runs.extend(loads.into_iter().map(|load| Run { ring, room, load }));
            }
        }
    }
    let mut table = "modules,place,edges,work,right_per_s,wrong_per_s,wrong_percent,own_later_per_s,accepted_percent,\
         worst_right_per_s,starved,said_ms\n"
        .to_owned();
    print!("{table}");
    let mut broken = vec![];
    for done in on_all_processors(&runs, |_, run| run.row()) {
        let (row, of_run) = done?;
        table += &row;
        broken.extend(of_run);
    }
    if all {
        fs::write(FILE, table)?;
    }
    ensure!(broken.is_empty(), "{}", broken.join("\n"));
    Ok(())
}
