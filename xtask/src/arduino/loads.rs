//! Other work in a sketch's `loop()`: right and wrong readings of a flow ring, polled and by interrupt, in the alcove,
//! in a larger one, and with a separate wall for each module.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use anyhow::{Result, anyhow, ensure};
use fs_err as fs;

use super::build::{self, Board};
use super::world::{self, UnderLoad};
use super::{ALL, TARGET, newping};
use crate::steps::output;
use crate::toolchain::program;

const SKETCH: &str = include_str!("loads/Loads.ino");
/// The ring that `design` emits, with another number of modules.
const RING: &str = "rings/hc-sr04-8.toml";
const RINGS: [usize; 2] = [6, 8];
/// The file with all figures.
const FILE: &str = "tests/data/arduino-loads.csv";
const POLLED: &str = "polled";
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

/// Positions of the modules.
struct Place {
    name: &'static str,
    ways: PathBuf,
    own_mm: BTreeMap<usize, u32>,
}

/// The alcove; separate walls at 0.4 to 3.4 m, spaced by the golden section so that no two are alike; and the alcove
/// 1.6 times as large, where a module's sound is still heard after 10 ms, for eight modules.
fn places() -> Result<[Place; 3]> {
    let alcove = fs::read_to_string(world::KEPT)?;
    let own = (0..8).map(|module| format!("{module} {module} {}\n", 2_300 + module * 618 % 1000 * 175 / 10)).collect();
    let larger = |line: &str| {
        let (who, us) = line.rsplit_once(' ')?;
        Some(format!("{who} {}\n", us.parse::<u32>().ok()? * 8 / 5))
    };
    let large = alcove.lines().filter_map(larger).collect();
    let place = |name: &'static str, ways: String| {
        let file = Path::new(TARGET).join(format!("{}.txt", name.replace(' ', "-")));
        fs::write(&file, &ways)?;
        anyhow::Ok(Place { name, own_mm: world::own_walls(&ways), ways: file })
    };
    Ok([place("alcove", alcove)?, place(OWN_WALLS, own)?, place("large alcove", large)?])
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

/// A run of a sketch, with the way it gets its edges and its other work.
struct Run<'a> {
    elf: &'a Path,
    edges: &'static str,
    work: String,
    load: Option<&'a Load>,
}

/// A ring in a place.
struct Ring<'a> {
    modules: usize,
    place: &'a Place,
    is_compared: bool,
    runs: Vec<Run<'a>>,
}

impl Ring<'_> {
    /// Returns the rows of all runs of the load, and the broken promises.
    fn rows(&self, world: &Path, seconds: u32) -> Result<(String, Vec<String>)> {
        let (mut rows, mut broken) = (String::new(), vec![]);
        let (modules, place) = (self.modules, self.place.name);
        for Run { elf, edges, work, load } in &self.runs {
            let eeprom = load.map(Load::eeprom).unwrap_or_default();
            let options = ["--pulses", "--eeprom", &eeprom];
            let pins = ALL[..modules].repeat(2);
            let mut command = world::command(world, &options, elf, seconds, &self.place.ways, &pins);
            let heard = world::hear_by(&mut command, seconds, &self.place.own_mm)?.under_load();
            let UnderLoad { right, wrong, wrong_percent, own_later, accepted_percent, worst, starved, slow_ms } = heard;
            let said = slow_ms.map_or(String::new(), |ms| ms.to_string());
            // NewPing does not compare readings.
            let accepted = load.map_or(String::new(), |_| format!("{accepted_percent:.1}"));
            let per_second = format!("{right:.1},{wrong:.1},{wrong_percent:.1},{own_later:.1}");
            let figures = format!("{per_second},{accepted},{worst:.1},{starved},{said}");
            let row = format!("{modules},{place},{edges},{work},{figures}");
            println!("{row}");
            rows += &(row + "\n");
            let of = |load: &Load| load.broken(&heard, *edges == POLLED, self.is_compared, place == OWN_WALLS);
            let named = |what| format!("{modules} modules, {place}, {what}");
            broken.extend(load.iter().copied().flat_map(of).map(named));
        }
        Ok((rows, broken))
    }
}

/// Runs all loads and writes their figures, or runs a few of them for CI.
pub(super) fn run(library: &Path, newping: Option<&Path>, all: bool) -> Result<()> {
    let world = world::build()?;
    let mut sketches = vec![];
    for modules in RINGS {
        let mut of_ring = vec![];
        for wait_ms in newping.iter().flat_map(|_| [0, 5, 10, 29]) {
            let (sources, version) = newping::sources(newping.unwrap_or(library))?;
            let defines = ["-w", &format!("-DMODULES={modules}"), &format!("-DWAIT_MS={wait_ms}")];
            let name = format!("NewPing{modules}Waits{wait_ms}");
            let sketch = build::sketch(&sources, Board::Uno, &name, newping::NEWPING, &defines)?;
            of_ring.push((sketch.elf, "waits", format!("NewPing {version} every {wait_ms} ms")));
        }
        for edges in [POLLED, "interrupts"].into_iter().filter(|_| all || modules == RINGS[0]) {
            of_ring.push((sketch(library, modules, edges == POLLED)?.elf, edges, String::new()));
        }
        sketches.push((modules, of_ring));
    }
    let places = places()?;
    let mut rings = vec![];
    for (modules, of_ring) in &sketches {
        let in_place = |number: usize| if all { number < RINGS.len() || *modules > RINGS[0] } else { number == 0 };
        for (number, place) in places.iter().enumerate().filter(|(number, _)| in_place(*number)) {
            let is_compared = *modules == RINGS[0] && number == 0;
            let mut runs = vec![];
            for (elf, edges, work) in of_ring {
                if !work.is_empty() {
                    runs.push(Run { elf, edges, work: work.clone(), load: None });
                    continue;
                }
                let chosen = KINDS.iter().enumerate().filter(|(number, _)| all || CORNER.contains(number));
                runs.extend(chosen.map(|(_, load)| Run { elf, edges, work: load.name(), load: Some(load) }));
            }
            rings.push(Ring { modules: *modules, place, is_compared, runs });
        }
    }
    let mut table = "modules,place,edges,work,right_per_s,wrong_per_s,wrong_percent,own_later_per_s,accepted_percent,\
         worst_right_per_s,starved,said_ms\n"
        .to_owned();
    print!("{table}");
    let world = &world;
    let done = thread::scope(|scope| {
        let started: Vec<_> = rings.iter().map(|ring| scope.spawn(move || ring.rows(world, SECONDS))).collect();
        started.into_iter().map(|one| one.join().map_err(|_| anyhow!("a thread failed"))?).collect::<Result<Vec<_>>>()
    })?;
    let mut broken = vec![];
    for (rows, of_ring) in done {
        table += &rows;
        broken.extend(of_ring);
    }
    if all {
        fs::write(FILE, table)?;
    }
    ensure!(broken.is_empty(), "{}", broken.join("\n"));
    Ok(())
}
