//! Every ready table on a simulated board, each module before a wall of its own and nothing else to hear: what is not
//! accepted there is lost to lateness of the sketch, not to sound.

use std::collections::BTreeMap;
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use eeruf_core::{Micros, Requirements, Schedule};

use super::build::{self, Board, Source};
use super::{ALL, TARGET, failed, world};
use crate::c::need;
use crate::steps::{Trouble, output};

/// The sketch of all of them, with the pins and the table of its twelve modules exchanged.
const SKETCH: &str = "examples/Ring12OnePin/Ring12OnePin.ino";
const ON_UNO: [usize; 9] = [2, 3, 4, 5, 6, 8, 10, 12, 16];
/// All pins of a Mega whose changes interrupt: 18 by pin changes, 6 external ones.
const ON_MEGA: [u8; 24] =
    [10, 11, 12, 13, 50, 51, 52, 53, 14, 15, 62, 63, 64, 65, 66, 67, 68, 69, 2, 3, 18, 19, 20, 21];
/// The walls: all as far, so that modules that fire together have their echoes together, and scattered ones. Echo times
/// in microseconds.
const EQUAL_US: u32 = 12_000;
const SCATTERED_US: std::ops::Range<u32> = 1_500..23_000;
/// The least share of accepted firings, in percent: of each module, and of all together.
const LEAST: (u32, u32) = (85, 95);

pub(super) fn run(library: &Path, short: bool) -> Result<(), Trouble> {
    need("avr-g++", "gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    let world = world::build()?;
    let seconds = if short { 3 } else { 20 };
    println!("| modules | board | equal walls: accepted, worst module | scattered walls: accepted, worst module |");
    println!("|---:|---|---:|---:|");
    let boards = ON_UNO.map(|modules| (Board::Uno, modules)).into_iter().chain([(Board::Mega, ON_MEGA.len())]);
    for (board, modules) in boards {
        let pins = if board == Board::Uno { &ALL[..modules] } else { &ON_MEGA };
        let core = build::core(board)?;
        let text = fs::read_to_string(library.join(SKETCH)).map_err(failed(SKETCH))?;
        let name = format!("Ring{modules}BeforeWalls");
        let text = exchanged(&text, pins)?;
        let source = Source { name: &name, text: &text, board, ours: true, defines: &[] };
        let sketch = build::sketch(&source, &library.join("src"), &core)?;
        let mut row = format!("| {modules} | {} |", if board == Board::Uno { "Uno" } else { "Mega 2560" });
        for scattered in [false, true] {
            // Equal walls are the harder ones.
            if short && scattered {
                row += " not run |";
                continue;
            }
            let shares = accepted(&world, &sketch.elf, board, pins, seconds, scattered)?;
            let (all, (worst, module)) = shares;
            let _ = write!(row, " {all:.1} %, {worst:.1} % |");
            if worst < f64::from(LEAST.0) || all < f64::from(LEAST.1) {
                return Err(Trouble::Failed(format!(
                    "{name}: {all:.1} % of the firings before walls were accepted, {worst:.1} % of module {module}'s; \
                     expected at least {} and {} %",
                    LEAST.1, LEAST.0
                )));
            }
        }
        println!("{row}");
    }
    faults_are_no_free_space(library, &world)
}

/// Faults of one module's line: as `world.c` names them, and as the file does.
const FAULTS: [(&str, &str); 9] = [
    ("cut:3", "no power"),
    ("deaf:3", "cut wire"),
    ("glitch-high:3", "glitch high, cut wire"),
    ("glitch-low:3", "glitch low"),
    // Until it has been high for longer than any clone holds it, such a line still listens.
    (STUCK, "held for ever"),
    ("exchanged-4:3", "exchanged, 20 ms apart"),
    ("hold-66:3", "hold of 66 ms"),
    ("hold-130:3", "hold of 130 ms"),
    ("hold-200:3", "hold of 200 ms"),
];
const STUCK: &str = "stuck:3";
/// Those of a sketch to which each line's interrupt hands in the level that it sees, by the table of the file.
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
/// Pins of its triggers, then of its echoes.
const EDGE_PINS: [u8; 8] = [4, 5, 6, 7, 8, 2, 14, 3];
/// Echo times of the file's walls, in microseconds: those of the sensors that are well, and the near one.
const WALL_US: u32 = 5_830;
const NEAR_US: u32 = 500;
/// Distance of the walls, and how far a sketch may be off it.
const WALL_MM: u32 = 1000;
const OFF_MM: u32 = 10;
/// Surroundings of the module, as the file names them.
const PLACES: [&str; 2] = ["wall", "nothing"];
/// The faults of all languages, and the table of the outcomes, of which this column is compared.
const FILE: &str = "tests/data/line-faults.txt";
const LOG: &str = "docs/log/line-faults.md";
const COLUMN: &str = "Arduino";
/// Readings that a line may take to show its fault: the time that a clone holds it, in periods.
const UNTIL_STUCK: usize = 4;

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
    /// The state that the file has for a fault in this place. A clone before a wall is as one that is healthy.
    fn of(file: &str, fault: &str, place: &str) -> Result<Self, Trouble> {
        let names = if place == "wall" && fault.starts_with("hold of") { "healthy" } else { fault };
        let mut rows = rows(file).filter(|row| row.first() == Some(&names) && row.len() == 6);
        let row = rows.find(|row| [place, "either"].contains(&row[1]));
        match row.and_then(|row| row[4].split_whitespace().next()) {
            Some("obstacle") => Ok(Self::Wall),
            Some("clear") => Ok(Self::Clear),
            Some("unanswered" | "held") => Ok(Self::NoAnswer),
            Some("unknown") => Ok(Self::Unsure),
            _ => Err(Trouble::Failed(format!("{FILE} has no {names} before {place}"))),
        }
    }
}

/// Lines of a sketch about one module: distances, clear, no answer, unsure, as [`Says`] has them.
fn said_of(said: &str, module: usize) -> [usize; 4] {
    let prefix = format!("{module} ");
    let mut counts = [0; 4];
    for rest in said.lines().filter_map(|line| line.trim().strip_prefix(&prefix)) {
        match rest {
            "clear" => counts[Says::Clear as usize] += 1,
            "does not answer" => counts[Says::NoAnswer as usize] += 1,
            "unsure" => counts[Says::Unsure as usize] += 1,
            distance if distance.parse::<u32>().is_ok() => counts[Says::Wall as usize] += 1,
            _ => {}
        }
    }
    counts
}

/// The words of a sketch about modules, one of which has a fault, each before a wall of its own at this echo time.
fn with_fault(
    world: &Path,
    elf: &Path,
    fault: &str,
    seconds: u32,
    walls: &[Option<u32>],
    pins: &[u8],
) -> Result<String, Trouble> {
    let ways = Path::new(TARGET).join("faults.txt");
    let way = |(module, us): (usize, &Option<u32>)| us.map(|us| format!("{module} {module} {us}\n"));
    fs::write(&ways, walls.iter().enumerate().filter_map(way).collect::<String>()).map_err(failed("target"))?;
    let mut run = Command::new(world);
    run.args(["--fault", fault]).arg(elf).arg(seconds.to_string()).arg(&ways).arg(walls.len().to_string());
    run.args(pins.iter().map(ToString::to_string));
    output(&mut run).ok_or_else(|| Trouble::Failed(format!("{}, {fault}, did not run", elf.display())))
}

/// The cells of a line.
fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}

/// A fault, its surroundings, and its readings: those that are right, all, and those without evidence.
type Outcome = (&'static str, &'static str, [usize; 3]);

/// The document whose table has these cells in the column, by fault and surroundings; rows of a fault that it has once
/// take the sum.
fn with_column(document: &str, said: &[Outcome]) -> Result<String, Trouble> {
    let head = document.lines().find(|line| line.starts_with("| fault")).map(cells).unwrap_or_default();
    let column = head.iter().position(|&name| name == COLUMN);
    let column = column.ok_or_else(|| Trouble::Failed(format!("{LOG} has no column {COLUMN}")))?;
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

/// Checks the words of sketches about a faulty module. The table of the log has what is said; `EERUF_WRITE` writes it.
fn faults_are_no_free_space(library: &Path, world: &Path) -> Result<(), Trouble> {
    let file = fs::read_to_string(FILE).map_err(failed(FILE))?;
    let document = fs::read_to_string(LOG).map_err(failed(LOG))?;
    println!("\n| fault | before | distances | clear | no answer | unsure | others' distances, least of each |");
    println!("|---|---|---:|---:|---:|---:|---:|");
    let mut outcomes = faults_of_ring8(library, world, &file)?;
    outcomes.extend(faults_of_edges(library, world, &file)?);
    latched_line_recovers(library, world)?;
    flow_says_states(library, world)?;
    let said = with_column(&document, &outcomes)?;
    if env::var_os("EERUF_WRITE").is_some() {
        fs::write(LOG, said).map_err(failed(LOG))
    } else if said == document {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("{LOG} is not what the sketches say; EERUF_WRITE=1 writes it")))
    }
}

/// Ring8 with a faulty module before a wall and before nothing; its others read their walls.
fn faults_of_ring8(library: &Path, world: &Path, file: &str) -> Result<Vec<Outcome>, Trouble> {
    const FAULTY: usize = 3;
    let sketch = build::example(library, &build::core(Board::Uno)?, "Ring8")?;
    let mut outcomes = vec![];
    for (fault, name) in FAULTS {
        for place in PLACES {
            let expected = Says::of(file, name, place)?;
            let wall = |module| (module != FAULTY || place == "wall").then_some(EQUAL_US + 500 * module as u32);
            let walls: Vec<_> = (1..=8).map(wall).collect();
            let said = with_fault(world, &sketch.elf, fault, 3, &walls, &ALL)?;
            // The wires of the one after it are exchanged with its own.
            let exchanged = fault.starts_with("exchanged");
            let others = (1..=8).filter(|&module| module != FAULTY && !(exchanged && module == FAULTY + 1));
            let least = others.map(|module| said_of(&said, module)[Says::Wall as usize]).min().unwrap_or(0);
            let found = said_of(&said, FAULTY);
            print_row(name, place, found, least);
            // Until the health of a line shows its fault, the sketch is unsure.
            let [distances, clear, silent, unsure] = found;
            let (right, all) = (found[expected as usize], distances + clear + silent);
            // While a line that is stuck may listen, its silence has evidence.
            let lies = if expected == Says::Clear || fault == STUCK { 0 } else { clear };
            outcomes.push((name, place, [right, all, lies]));
            let fine =
                if fault == STUCK { right > 20 && right + clear == all && clear < UNTIL_STUCK } else { right == all };
            if !fine || least < 27 || all < 23 || unsure > UNTIL_STUCK {
                return Err(unexpected(name, place, expected));
            }
        }
    }
    Ok(outcomes)
}

/// The sketch of `c/arduino/world` with the faults that interrupts by level can have; its readings after the second.
fn faults_of_edges(library: &Path, world: &Path, file: &str) -> Result<Vec<Outcome>, Trouble> {
    const FAULTY: usize = 2;
    let text = fs::read_to_string(EDGE_SKETCH).map_err(failed(EDGE_SKETCH))?;
    let text = format!("{}\n{text}", table_of(file)?);
    let core = build::core(Board::Uno)?;
    let sketch = |name, defines| {
        let source = Source { name, text: &text, board: Board::Uno, ours: true, defines };
        build::sketch(&source, &library.join("src"), &core)
    };
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
            let said = with_fault(world, &sketch.elf, fault, 5, &walls, &EDGE_PINS)?;
            let [least, other] = [1, 3].map(|module| said_of(&said, module)[Says::Wall as usize]);
            let least = least.min(other);
            let after = after_the_second(&said, FAULTY);
            let found = said_of(&after, FAULTY);
            let is_wrong = |line: &str| {
                let mm = line.trim().strip_prefix(&format!("{FAULTY} ")).and_then(|rest| rest.parse().ok());
                mm.is_some_and(|mm: u32| mm.abs_diff(WALL_MM) > OFF_MM)
            };
            print_row(name, place, found, least);
            let (right, all) = (found[expected as usize], found.iter().sum());
            let lies = if expected == Says::Clear { 0 } else { found[Says::Clear as usize] };
            outcomes.push((name, place, [right, all, lies]));
            if right != all || all < 45 || least < 47 || after.lines().any(is_wrong) {
                return Err(unexpected(name, place, expected));
            }
        }
    }
    Ok(outcomes)
}

/// Checks Ring8 with a module that hears nothing in the first second and then holds its line until it is pulled low:
/// without `recover()` it never answers, with it the module measures its wall.
fn latched_line_recovers(library: &Path, world: &Path) -> Result<(), Trouble> {
    const FAULTY: usize = 3;
    const BEGIN: &str = "if (!eerufInterrupts(sonar))";
    let name = "examples/Ring8/Ring8.ino";
    let text = fs::read_to_string(library.join(name)).map_err(failed(name))?;
    let recovers = text.replace(BEGIN, &format!("sonar.recover();\n  {BEGIN}"));
    if recovers == text {
        return Err(Trouble::Failed(format!("{name} has no {BEGIN}")));
    }
    let core = build::core(Board::Uno)?;
    let walls: Vec<_> = (1..=8).map(|module| Some(EQUAL_US + 500 * module)).collect();
    let mut found = [[0; 4]; 2];
    let (mut flash, mut is_wrong) = ([0; 2], false);
    for (((name, text), found), flash) in
        [("Ring8Stuck", &text), ("Ring8Recovers", &recovers)].into_iter().zip(&mut found).zip(&mut flash)
    {
        let source = Source { name, text, board: Board::Uno, ours: true, defines: &[] };
        let sketch = build::sketch(&source, &library.join("src"), &core)?;
        let said = with_fault(world, &sketch.elf, &format!("latched:{FAULTY}"), 4, &walls, &ALL)?;
        (*found, *flash) = (said_of(&said, FAULTY), sketch.flash);
        // Once it measures its wall again, nothing is free.
        let of_module = said.lines().filter_map(|line| line.trim().strip_prefix(&format!("{FAULTY} ")));
        let since = of_module.skip_while(|rest| rest.parse::<u32>().is_err());
        is_wrong |= since.into_iter().any(|rest| rest == "clear");
        print_row(name, "latched line, wall", *found, said_of(&said, 1)[Says::Wall as usize]);
    }
    println!("flash of Ring8: {} B, with recover() {} B", flash[0], flash[1]);
    let [[never, held, ..], [walls, clear, silent, _]] = found;
    // Each hold of 250 ms in the first second is three readings.
    let is_stuck = never == 0 && held < UNTIL_STUCK;
    if is_wrong || !is_stuck || walls < 40 || clear > 3 * UNTIL_STUCK || silent == 0 {
        return Err(Trouble::Failed(format!("a latched line without and with recover(): {found:?}")));
    }
    Ok(())
}

/// Checks States4 with a flow ring in place of its table: a module before nothing is clear, one without power does not
/// answer, and the others keep saying their walls.
fn flow_says_states(library: &Path, world: &Path) -> Result<(), Trouble> {
    const SHOWN: usize = 3;
    let name = "examples/States4/States4.ino";
    let mut text = fs::read_to_string(library.join(name)).map_err(failed(name))?;
    for (of_table, of_flow) in [
        ("EerufTables.h", "EerufFlow.h"),
        ("EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS)", "EerufFlow<4> sonar(PINS)"),
        ("  if (sonar.tooSlow()) Serial.println(F(\"loop() is too slow: modules fire late\"));\n", ""),
        ("has not answered for ms: ", "does not answer\\n"),
    ] {
        let replaced = text.replace(of_table, of_flow);
        if replaced == text {
            return Err(Trouble::Failed(format!("{name} has no {of_table}")));
        }
        text = replaced;
    }
    let source = Source { name: "FlowStates4", text: &text, board: Board::Uno, ours: true, defines: &[] };
    let sketch = build::sketch(&source, &library.join("src"), &build::core(Board::Uno)?)?;
    println!("flash of States4 with a flow ring: {} B", sketch.flash);
    let pins = [&ALL[..4], &ALL[..4]].concat();
    let walls = [Some(EQUAL_US), Some(EQUAL_US + 500), None, Some(EQUAL_US + 1000)];
    for (fault, expected) in [("hold-38:3", Says::Clear), ("cut:3", Says::NoAnswer)] {
        let said = with_fault(world, &sketch.elf, fault, 4, &walls, &pins)?;
        let found = said_of(&said, SHOWN);
        let least = [1, 2, 4].map(|module| said_of(&said, module)[Says::Wall as usize]).into_iter().min();
        print_row("flow, States4", fault, found, least.unwrap_or(0));
        // Twenty times a second each; readings take the first few cycles.
        let (right, all): (usize, usize) = (found[expected as usize], found.iter().sum());
        if least < Some(50) || right < 50 || right + found[Says::Unsure as usize] != all {
            return Err(Trouble::Failed(format!("{fault}: a flow ring's state() says {found:?}")));
        }
    }
    Ok(())
}

/// The lines of a sketch without the first two of a module.
fn after_the_second(said: &str, module: usize) -> String {
    let prefix = format!("{module} ");
    let mut left = 2;
    let is_kept = |line: &&str| {
        let is_first = left > 0 && line.trim().starts_with(&prefix);
        left -= u32::from(is_first);
        !is_first
    };
    said.lines().filter(is_kept).map(|line| format!("{line}\n")).collect()
}

fn print_row(name: &str, place: &str, found: [usize; 4], least: usize) {
    let [distances, clear, silent, unsure] = found;
    println!("| {name} | {place} | {distances} | {clear} | {silent} | {unsure} | {least} |");
}

fn unexpected(name: &str, place: &str, expected: Says) -> Trouble {
    Trouble::Failed(format!("{name} before {place}: expected {expected:?} of the faulty module"))
}

/// The file's schedule, as a table for a sketch.
fn table_of(file: &str) -> Result<String, Trouble> {
    let wrong = || Trouble::Failed(format!("{FILE}: expected a schedule of 4 sensors in 2 phases"));
    let row = rows(file).find(|row| row.first() == Some(&"schedule")).ok_or_else(wrong)?;
    let &[_, period, a, b] = &row[..] else { return Err(wrong()) };
    let times = |words: &str| {
        let times: Option<Vec<_>> = words.split_whitespace().map(|us| us.parse().ok().map(Micros::new)).collect();
        times.and_then(|times| <[Micros; 4]>::try_from(times).ok()).ok_or_else(wrong)
    };
    let period = Micros::new(period.parse().map_err(|_| wrong())?);
    let requirements = Requirements::new(Micros::new(240));
    let schedule = Schedule::<4>::from_firing(period, [times(a)?, times(b)?]).map_err(|_| wrong())?;
    // It stands in the sketch itself.
    Ok(schedule.to_arduino(&requirements, "LINE_FAULTS").to_string().replace("#pragma once\n", ""))
}

/// The sketch for as many modules as there are pins.
fn exchanged(text: &str, pins: &[u8]) -> Result<String, Trouble> {
    let (before, rest) = text.split_once("PINS[] = {").ok_or_else(|| changed("PINS"))?;
    let (_, after) = rest.split_once('}').ok_or_else(|| changed("PINS"))?;
    let pins_text: Vec<_> = pins.iter().map(ToString::to_string).collect();
    let (twelve, table) = ("EerufSonar<12>", "EERUF_HC_SR04_12");
    if !after.contains(twelve) || !after.contains(table) {
        return Err(changed(table));
    }
    let count = pins.len();
    let after = after.replace(twelve, &format!("EerufSonar<{count}>"));
    let after = after.replace(table, &format!("EERUF_HC_SR04_{count}"));
    Ok(format!("{before}PINS[] = {{{}}}{after}", pins_text.join(", ")))
}

fn changed(what: &str) -> Trouble {
    Trouble::Failed(format!("{SKETCH} has no {what} as expected"))
}

/// The shares of accepted firings in percent: of all, and of the worst module, which is counted from 1.
fn accepted(
    world: &Path,
    elf: &Path,
    board: Board,
    pins: &[u8],
    seconds: u32,
    scattered: bool,
) -> Result<(f64, (f64, usize)), Trouble> {
    let span = SCATTERED_US.end - SCATTERED_US.start;
    let walls = (0..pins.len() as u32).map(|module| {
        // By the golden section, so that no two are alike.
        let us = SCATTERED_US.start + (module * 618 % 1000) * span / 1000;
        format!("{module} {module} {}\n", if scattered { us } else { EQUAL_US })
    });
    let ways = Path::new(TARGET).join("walls.txt");
    fs::write(&ways, walls.collect::<String>()).map_err(failed("target"))?;
    let names = pins.iter().chain(pins).map(ToString::to_string);
    let said = output(
        Command::new(world)
            .args((board == Board::Mega).then_some("--mega"))
            .arg(elf)
            .arg(seconds.to_string())
            .arg(&ways)
            .arg(pins.len().to_string())
            .args(names),
    )
    .ok_or_else(|| Trouble::Failed(format!("{} did not run", elf.display())))?;
    let (mut counts, mut firings) = (BTreeMap::<usize, u32>::new(), Vec::<u32>::new());
    for line in said.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["world", "firings", ..] => firings = words.iter().skip(2).filter_map(|word| word.parse().ok()).collect(),
            [module, distance] if distance.parse::<u32>().is_ok() => {
                if let Ok(module) = module.parse() {
                    *counts.entry(module).or_default() += 1;
                }
            }
            _ => {}
        }
    }
    // The first firing of each is compared with nothing.
    let share = |accepted: u32, fired: u32| 100.0 * f64::from(accepted) / f64::from(fired.saturating_sub(1).max(1));
    let of = |module: usize| counts.get(&module).copied().unwrap_or(0);
    let worst = (1..=pins.len())
        .map(|module| (share(of(module), firings.get(module - 1).copied().unwrap_or(0)), module))
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .unwrap_or((0.0, 0));
    let total = share(counts.values().sum(), firings.iter().map(|fired| fired.saturating_sub(1)).sum::<u32>() + 1);
    Ok((total, worst))
}
