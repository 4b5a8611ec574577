//! Every ready table on a simulated board, each module before a wall of its own and nothing else to hear: what is not
//! accepted there is lost to lateness of the sketch, not to sound.

use std::collections::BTreeMap;
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

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
    ("cut", "no power"),
    ("deaf", "cut wire"),
    ("glitch-high", "glitch high, cut wire"),
    ("glitch-low", "glitch low"),
    // Until it has been high for longer than any clone holds it, such a line still listens.
    ("stuck", "held for ever"),
    ("exchanged", "exchanged, 20 ms apart"),
    ("hold-66", "hold of 66 ms"),
    ("hold-130", "hold of 130 ms"),
    ("hold-200", "hold of 200 ms"),
];
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
}

impl Says {
    /// The state that the file has for a fault in this place. A clone before a wall is as one that is healthy.
    fn of(file: &str, fault: &str, place: &str) -> Result<Self, Trouble> {
        let names = if place == "wall" && fault.starts_with("hold of") { "healthy" } else { fault };
        let rows = file.lines().filter(|line| !line.starts_with('#')).map(|line| cells(line));
        let mut rows = rows.filter(|row| row.first() == Some(&names) && row.len() == 6);
        let row = rows.find(|row| [place, "either"].contains(&row[1]));
        match row.and_then(|row| row[4].split_whitespace().next()) {
            Some("obstacle") => Ok(Self::Wall),
            Some("clear") => Ok(Self::Clear),
            Some("unanswered" | "held") => Ok(Self::NoAnswer),
            _ => Err(Trouble::Failed(format!("{FILE} has no {names} before {place}"))),
        }
    }
}

/// The cells of a line.
fn cells(line: &str) -> Vec<&str> {
    line.trim_matches('|').split('|').map(str::trim).collect()
}

/// The document whose table has these cells in the column, by fault and surroundings; rows of a fault that it has once
/// take the sum.
fn with_column(document: &str, said: &[(&str, &str, [usize; 3])]) -> Result<String, Trouble> {
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

/// Checks the words of Ring8 about a faulty module, before a wall and before nothing; its others read their walls. The
/// table of the log has what is said; `EERUF_WRITE` writes it.
fn faults_are_no_free_space(library: &Path, world: &Path) -> Result<(), Trouble> {
    const FAULTY: usize = 3;
    let sketch = build::example(library, &build::core(Board::Uno)?, "Ring8")?;
    let (triggers, echoes) = ALL.split_at(8);
    println!(
        "\n| fault of module {FAULTY} | before | distances | clear | no answer | others' distances, least of each |"
    );
    println!("|---|---|---:|---:|---:|---:|");
    let (file, document) =
        (fs::read_to_string(FILE).map_err(failed(FILE))?, fs::read_to_string(LOG).map_err(failed(LOG))?);
    let mut outcomes = vec![];
    for (fault, name) in FAULTS {
        for place in PLACES {
            let expected = Says::of(&file, name, place)?;
            let ways = Path::new(TARGET).join("faults.txt");
            let walls = (1..=8).filter(|&module| module != FAULTY || place == "wall");
            let walls = walls.map(|module| format!("{0} {0} {1}\n", module - 1, EQUAL_US + 500 * module as u32));
            fs::write(&ways, walls.collect::<String>()).map_err(failed("target"))?;
            let pins = triggers.iter().chain(echoes).map(ToString::to_string);
            let mut run = Command::new(world);
            run.arg("--fault")
                .arg(format!("{fault}:{FAULTY}"))
                .arg(&sketch.elf)
                .arg("3")
                .arg(&ways)
                .arg("8")
                .args(pins);
            let said = output(&mut run).ok_or_else(|| Trouble::Failed(format!("Ring8, {fault}, did not run")))?;
            let count = |module: usize, what: &dyn Fn(&str) -> bool| {
                let rest = |line: &str| line.trim().strip_prefix(&format!("{module} ")).is_some_and(what);
                said.lines().filter(|line| rest(line)).count()
            };
            let distances = |module| count(module, &|rest| rest.parse::<u32>().is_ok());
            let clear = count(FAULTY, &|rest| rest == "clear");
            let silent = count(FAULTY, &|rest| rest == "does not answer");
            // The wires of the one after it are exchanged with its own.
            let others = (1..=8).filter(|&module| module != FAULTY && (fault != "exchanged" || module != FAULTY + 1));
            let least = others.map(distances).min().unwrap_or(0);
            println!("| {name} | {place} | {} | {clear} | {silent} | {least} |", distances(FAULTY));
            let found = [distances(FAULTY), clear, silent];
            // While a line that is stuck may listen, its silence has evidence.
            let lies = if expected == Says::Clear || fault == "stuck" { 0 } else { clear };
            outcomes.push((name, place, [found[expected as usize], found.iter().sum(), lies]));
            let fine = match expected {
                Says::Wall => found[0] > 26 && found[1..] == [0, 0],
                Says::Clear => found[1] > 26 && found[0] + found[2] == 0,
                Says::NoAnswer if fault == "stuck" => found[2] > 20 && found[1] < UNTIL_STUCK && found[0] == 0,
                Says::NoAnswer => found[2] > 22 && found[..2] == [0, 0],
            };
            if !fine || least < 27 {
                return Err(Trouble::Failed(format!(
                    "{name} before {place}: expected {expected:?} of module {FAULTY}"
                )));
            }
        }
    }
    let said = with_column(&document, &outcomes)?;
    if env::var_os("EERUF_WRITE").is_some() {
        fs::write(LOG, said).map_err(failed(LOG))
    } else if said == document {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("{LOG} is not what Ring8 says; EERUF_WRITE=1 writes it")))
    }
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
