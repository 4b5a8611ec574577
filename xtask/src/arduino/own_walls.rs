//! Every ready table on a simulated board, each module before a wall of its own and nothing else to hear: what is not
//! accepted there is lost to lateness of the sketch, not to sound.

use std::collections::BTreeMap;
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
    a_cut_wire_is_no_free_space(library, &world)
}

/// Of Ring8 one module is not connected, and one has nothing before it: the sketch says so of each.
fn a_cut_wire_is_no_free_space(library: &Path, world: &Path) -> Result<(), Trouble> {
    const CUT: usize = 3;
    const FREE: usize = 5;
    let sketch = build::example(library, &build::core(Board::Uno)?, "Ring8")?;
    let ways = Path::new(TARGET).join("cut.txt");
    let walls = (0..8).filter(|&module| module + 1 != FREE).map(|module| format!("{module} {module} {EQUAL_US}\n"));
    fs::write(&ways, walls.collect::<String>()).map_err(failed("target"))?;
    let (triggers, echoes) = ALL.split_at(8);
    let pins = triggers.iter().chain(echoes).map(ToString::to_string);
    let said = output(
        Command::new(world).args(["--cut", &CUT.to_string()]).arg(&sketch.elf).arg("3").arg(&ways).arg("8").args(pins),
    )
    .ok_or_else(|| Trouble::Failed("Ring8 with a cut wire did not run".to_owned()))?;
    let count = |line: &str| said.lines().filter(|said| said.trim() == line).count();
    let clear = [CUT, FREE].map(|module| count(&format!("{module} clear")));
    let silent = count(&format!("{CUT} does not answer"));
    println!(
        "module {CUT}, cut: {silent} times no answer, {} clear; module {FREE}, free: {} clear",
        clear[0], clear[1]
    );
    if clear[0] == 0 && silent > 30 && clear[1] > 30 {
        return Ok(());
    }
    Err(Trouble::Failed("a cut wire reads as free space, or free space does not".to_owned()))
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
