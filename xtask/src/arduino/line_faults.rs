//! Sketches on a simulated Uno with a faulty module: its line never counts as free space, and the others keep measuring
//! their walls.

use std::env;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow, ensure};
use eeruf_core::{Micros, Requirements, Schedule};
use eeruf_files::emit::Emit as _;
use fs_err as fs;

use super::build::{self, Board};
use super::world::Room;
use super::{ALL, TARGET};
use crate::measured::cells;
use crate::steps::edited;

/// Echo time of a wall, in microseconds.
const EQUAL_US: u32 = 12_000;
/// Faults of one module's line, by their names in `world.c` and in the file.
const FAULTS: [(&str, &str); 9] = [
    ("cut:3", "no power"),
    ("deaf:3", "cut wire"),
    ("glitch-high:3", "glitch high, cut wire"),
    ("glitch-low:3", "glitch low"),
    ("stuck:3", "held for ever"),
    ("exchanged-4:3", "exchanged, 20 ms apart"),
    ("hold-66:3", "hold of 66 ms"),
    ("hold-130:3", "hold of 130 ms"),
    ("hold-200:3", "hold of 200 ms"),
];
/// The faults of a sketch whose interrupts pass on the level that they see, with their names in the file.
const EDGE_FAULTS: [(&str, &str, &[&str]); 6] = [
    ("hold-38:2", "healthy", &PLACES),
    ("lost-rise:2", "lost rising edge", &PLACES),
    ("lost-fall:2", "lost falling edge", &PLACES),
    ("spike:2", "glitch high", &PLACES),
    ("hold-38:2", FORGOTTEN, &PLACES),
    ("exchanged-4:2", "exchanged, 1 ms apart", &["wall", "near wall", "nothing"]),
];
const FORGOTTEN: &str = "forgotten call";
const EDGE_SKETCH: &str = "c/arduino/world/edges.ino";
/// Pins of the sketch's triggers, then of its echoes.
const EDGE_PINS: [u8; 8] = [4, 5, 6, 7, 8, 2, 14, 3];
/// Echo times of the file's walls, in microseconds: those of the healthy sensors, and the near one.
const WALL_US: u32 = 5_830;
const NEAR_US: u32 = 500;
/// Distance of the walls, and the tolerance of a sketch.
const WALL_MM: u32 = 1000;
const OFF_MM: u32 = 10;
/// Surroundings of the module, as the file names them.
const PLACES: [&str; 2] = ["wall", "nothing"];
/// The file with the faults of all languages, and the table of outcomes, one column of which is compared.
const FILE: &str = "tests/data/line-faults.txt";
const OUTCOMES: &str = "tests/data/line-fault-outcomes.txt";
/// Number of readings within which a line must show its state: twice the time for which a clone holds it, in periods.
const UNTIL_STUCK: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Says {
    Wall,
    Clear,
    NoAnswer,
    Unsure,
}

/// Rows of the file's table, without its comments.
fn rows(file: &str) -> impl Iterator<Item = Vec<&str>> {
    file.lines().filter(|line| !line.starts_with('#')).map(cells)
}

impl Says {
    /// Returns the file's state for a fault in this place. A clone in front of a wall counts as healthy.
    fn of(file: &str, fault: &str, place: &str) -> Result<Self> {
        let names = if place == "wall" && fault.starts_with("hold of") { "healthy" } else { fault };
        let mut rows = rows(file).filter(|row| row.first() == Some(&names) && row.len() == 6);
        let row = rows.find(|row| [place, "either"].contains(&row[1]));
        match row.and_then(|row| row[4].split_whitespace().next()) {
            Some("obstacle") => Ok(Self::Wall),
            Some("clear") => Ok(Self::Clear),
            Some("unanswered" | "held") => Ok(Self::NoAnswer),
            Some("unknown") => Ok(Self::Unsure),
            _ => Err(anyhow!("{FILE} has no {names} before {place}")),
        }
    }
}

/// A sketch's output about its modules.
struct Said(String);

impl Said {
    /// Runs a sketch among modules that each face a wall at this echo time, or nothing; one of them has a fault.
    fn of(elf: &Path, fault: &str, seconds: u32, walls: &[Option<u32>], pins: &[u8]) -> Result<Self> {
        let room = Room::walls(format!("{TARGET}/walls-of-faults.txt"), walls.iter().copied())?;
        Ok(Self(room.text(elf, seconds, pins, &["--fault", fault]).with_context(|| fault.to_owned())?))
    }

    /// Returns the words about one module, reading by reading.
    fn words(&self, module: usize) -> Vec<&str> {
        let prefix = format!("{module} ");
        self.0.lines().filter_map(|line| line.trim().strip_prefix(&prefix)).collect()
    }

    /// Returns the smallest number of distances for one of these modules.
    fn least_distances(&self, modules: impl IntoIterator<Item = usize>) -> usize {
        let distances = |module| counts(&self.words(module))[Says::Wall as usize];
        modules.into_iter().map(distances).min().unwrap_or(0)
    }
}

/// The numbers of readings in the order of [`Says`]: distances, clear, no answer, unsure.
fn counts(words: &[&str]) -> [usize; 4] {
    let mut counts = [0; 4];
    for words in words {
        match *words {
            "clear" => counts[Says::Clear as usize] += 1,
            "does not answer" | "unanswered" => counts[Says::NoAnswer as usize] += 1,
            "unsure" | "unknown" => counts[Says::Unsure as usize] += 1,
            distance if distance.parse::<u32>().is_ok() => counts[Says::Wall as usize] += 1,
            _ => {}
        }
    }
    counts
}

/// A fault, its surroundings, and its numbers of readings: right ones, all, and those without evidence.
type Outcome = (&'static str, &'static str, [usize; 3]);

/// Returns the document with these cells in the column, by fault and surroundings; a row for several of them has the
/// sum.
fn with_column(document: &str, said: &[Outcome]) -> Result<String> {
    let head = document.lines().find(|line| line.starts_with("| fault")).map(cells).unwrap_or_default();
    let column =
        head.iter().position(|&name| name == "Arduino").with_context(|| format!("{OUTCOMES} has no column Arduino"))?;
    let mut text = String::new();
    for line in document.lines() {
        let mut row = cells(line);
        let of_row = said.iter().filter(|(fault, place, _)| {
            line.starts_with('|') && row.len() > column && row[0] == *fault && [*place, "either"].contains(&row[1])
        });
        let sum = of_row.map(|&(.., counts)| counts).reduce(|a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
        let Some([right, all, lies]) = sum else {
            text += line;
            text.push('\n');
            continue;
        };
        let cell = format!("{right} of {all}, {lies}");
        row[column] = &cell;
        _ = writeln!(text, "| {} |", row.join(" | "));
    }
    Ok(text)
}

/// Checks the output of sketches with a faulty module against the table; `EERUF_WRITE` writes the table.
pub(super) fn run(library: &Path) -> Result<()> {
    let file = fs::read_to_string(FILE)?;
    let document = fs::read_to_string(OUTCOMES)?;
    let mut outcomes = faults_of_ring8(library, &file)?;
    outcomes.extend(faults_of_edges(library, &file)?);
    latched_line_recovers(library)?;
    flow_says_states(library)?;
    let said = with_column(&document, &outcomes)?;
    if env::var_os("EERUF_WRITE").is_some() {
        fs::write(OUTCOMES, &said)?;
    }
    ensure!(fs::read_to_string(OUTCOMES)? == said, "{OUTCOMES} is not what the sketches say; EERUF_WRITE=1 writes it");
    Ok(())
}

/// Runs Ring8 with a faulty module that faces a wall, or nothing; the others must read their walls.
fn faults_of_ring8(library: &Path, file: &str) -> Result<Vec<Outcome>> {
    const FAULTY: usize = 3;
    let sketch = build::example(library, "Ring8")?;
    let mut outcomes = vec![];
    for (fault, name) in FAULTS {
        for place in PLACES {
            let expected = Says::of(file, name, place)?;
            let wall = |module| (module != FAULTY || place == "wall").then_some(EQUAL_US + 500 * module as u32);
            let walls: Vec<_> = (1..=8).map(wall).collect();
            let said = Said::of(&sketch.elf, fault, 3, &walls, &ALL)?;
            // The wires of this module and the next one are exchanged.
            let exchanged = fault.starts_with("exchanged");
            let others = (1..=8).filter(|&module| module != FAULTY && !(exchanged && module == FAULTY + 1));
            let least = said.least_distances(others);
            let found = counts(&said.words(FAULTY));
            // Until the health of a line shows its fault, the sketch is unsure.
            let [distances, clear, silent, unsure] = found;
            let (right, all) = (found[expected as usize], distances + clear + silent);
            let lies = if expected == Says::Clear { 0 } else { clear };
            outcomes.push((name, place, [right, all, lies]));
            let fine = right == all && least >= 27 && all >= 20 && unsure <= UNTIL_STUCK;
            ensure!(fine, "{name} before {place}: {found:?}, expected {expected:?}; of the others {least}");
        }
    }
    Ok(outcomes)
}

/// Runs the sketch of `c/arduino/world` with the faults that interrupts by level can have; returns its readings after
/// the second.
fn faults_of_edges(library: &Path, file: &str) -> Result<Vec<Outcome>> {
    const FAULTY: usize = 2;
    let text = fs::read_to_string(EDGE_SKETCH)?;
    let text = format!("#define EERUF_POLLED\n{}\n{text}", table_of(file)?);
    let sketch = |name, defines| build::ours(library, Board::Uno, name, &text, defines);
    let (whole, forgetful) = (sketch("edges", &[])?, sketch("edgesForgotten", &["-DFORGOTTEN"])?);
    let mut outcomes = vec![];
    for (fault, name, places) in EDGE_FAULTS {
        let sketch = if name == FORGOTTEN { &forgetful } else { &whole };
        for &place in places {
            let expected = Says::of(file, name, place)?;
            let faulty = match place {
                "wall" => Some(WALL_US),
                "near wall" => Some(NEAR_US),
                _ => None,
            };
            let exchanged = fault.starts_with("exchanged");
            let walls = [Some(WALL_US), faulty, Some(WALL_US), Some(WALL_US).filter(|_| !exchanged)];
            let said = Said::of(&sketch.elf, fault, 5, &walls, &EDGE_PINS)?;
            let least = said.least_distances([1, 3]);
            let words = said.words(FAULTY);
            let after = words.get(2..).unwrap_or_default();
            let found = counts(after);
            let mut distances = after.iter().filter_map(|words| words.parse::<u32>().ok());
            let is_near = distances.all(|mm| mm.abs_diff(WALL_MM) <= OFF_MM);
            let (right, all) = (found[expected as usize], found.iter().sum());
            let lies = if expected == Says::Clear { 0 } else { found[Says::Clear as usize] };
            outcomes.push((name, place, [right, all, lies]));
            let fine = is_near && right == all && all >= 45 && least >= 47;
            ensure!(fine, "{name} before {place}: {found:?}, expected {expected:?}; of the others {least}");
        }
    }
    Ok(outcomes)
}

/// Checks Ring8 with a module that hears nothing in the first second and then holds its line until it is pulled low:
/// without `recover()` it never answers, with it the module measures its wall.
fn latched_line_recovers(library: &Path) -> Result<()> {
    const FAULTY: usize = 3;
    const BEGIN: &str = "if (!sonar.begin())";
    let name = "examples/Ring8/Ring8.ino";
    let text = fs::read_to_string(library.join(name))?;
    let recovers = edited(&text, &[(BEGIN, &format!("sonar.recover();\n  {BEGIN}"))])?;
    let walls: Vec<_> = (1..=8).map(|module| Some(EQUAL_US + 500 * module)).collect();
    let heard = |name: &str, text: &str| {
        let sketch = build::ours(library, Board::Uno, name, text, &[])?;
        println!("flash of {name}: {} B", sketch.flash);
        Said::of(&sketch.elf, &format!("latched:{FAULTY}"), 4, &walls, &ALL)
    };
    let (without, with) = (heard("Ring8Stuck", &text)?, heard("Ring8Recovers", &recovers)?);
    let words = with.words(FAULTY);
    let ([never, held, ..], [walls, clear, silent, _]) = (counts(&without.words(FAULTY)), counts(&words));
    // Each hold of 250 ms in the first second is three readings.
    let recovers = walls >= 40 && clear <= 3 * UNTIL_STUCK && silent > 0;
    // Once it measures its wall again, nothing is free.
    let is_free = words.iter().skip_while(|rest| rest.parse::<u32>().is_err()).any(|rest| *rest == "clear");
    ensure!(never + held == 0, "latched line without recover(): {never} distances, {held} clear");
    ensure!(recovers && !is_free, "latched line with recover(): {walls} distances, {clear} clear, {silent} silent");
    Ok(())
}

/// Checks States4 with a flow ring in place of its table: a module that faces nothing is clear, one without power does
/// not answer, and the others keep reporting their walls.
fn flow_says_states(library: &Path) -> Result<()> {
    const SHOWN: usize = 3;
    let name = "examples/States4/States4.ino";
    let of_flow = [
        ("EerufTables.h", "EerufFlow.h"),
        ("EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS)", "EerufFlow<4> sonar(PINS)"),
        ("has not answered for ms: ", "does not answer\\n"),
    ];
    let text = edited(&fs::read_to_string(library.join(name))?, &of_flow)?;
    let sketch = build::ours(library, Board::Uno, "FlowStates4", &text, &[])?;
    println!("flash of States4 with a flow ring: {} B", sketch.flash);
    let pins = [&ALL[..4], &ALL[..4]].concat();
    let walls = [Some(EQUAL_US), Some(EQUAL_US + 500), None, Some(EQUAL_US + 1000)];
    for (fault, expected) in [("hold-38:3", Says::Clear), ("cut:3", Says::NoAnswer)] {
        let said = Said::of(&sketch.elf, fault, 4, &walls, &pins)?;
        let (found, least) = (counts(&said.words(SHOWN)), said.least_distances([1, 2, 4]));
        // Twenty times a second each; readings take the first few cycles.
        let (right, all): (usize, usize) = (found[expected as usize], found.iter().sum());
        let fine = least >= 50 && right >= 50 && right + found[Says::Unsure as usize] == all;
        ensure!(fine, "{fault}: a flow ring's state() says {found:?}; of the others {least}");
    }
    Ok(())
}

/// The file's schedule, as a table for a sketch.
fn table_of(file: &str) -> Result<String> {
    let wrong = || anyhow!("{FILE}: expected a schedule of 4 sensors in 2 phases");
    let row = rows(file).find(|row| row.first() == Some(&"schedule")).ok_or_else(wrong)?;
    let &[_, period, a, b] = &row[..] else { return Err(wrong()) };
    let times = |words: &str| {
        let times: Option<Vec<_>> = words.split_whitespace().map(|us| us.parse().ok().map(Micros::new)).collect();
        times.and_then(|times| <[Micros; 4]>::try_from(times).ok()).ok_or_else(wrong)
    };
    let period = Micros::new(period.parse().map_err(|_| wrong())?);
    let requirements = Requirements::new(Micros::new(240));
    let schedule = Schedule::<4>::from_firing(period, [times(a)?, times(b)?]).map_err(|_| wrong())?;
    // The table becomes part of the sketch itself.
    Ok(schedule.to_arduino(&requirements, "LINE_FAULTS").replace("#pragma once\n", ""))
}
