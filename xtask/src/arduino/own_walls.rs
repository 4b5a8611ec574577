//! Every ready table on a simulated Uno, each module before a wall of its own and nothing else to hear: readings not
//! accepted there are lost to the sketch's lateness, not to sound.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Result, ensure};
use fs_err as fs;

use super::ALL;
use super::build::{self, Board};
use super::world::{self, Heard};
use crate::steps::edited;

/// The sketch of all of them, with a table in place of flow, and the pins of its twelve modules exchanged.
const SKETCH: &str = "examples/Flow12/Flow12.ino";
const MODULES: [usize; 3] = [4, 8, 12];
/// The walls: all as far, so that modules that fire together have their echoes together, and scattered ones. Echo times
/// in microseconds.
pub(super) const EQUAL_US: u32 = 12_000;
const SCATTERED_US: std::ops::Range<u32> = 1_500..23_000;
/// The least share of accepted firings, in percent: of each module, and of all together.
pub(super) const LEAST: (f64, f64) = (85.0, 95.0);
pub(super) fn run(library: &Path, short: bool) -> Result<()> {
    let world = world::build()?;
    let seconds = if short { 3 } else { 20 };
    println!("| modules | equal walls: accepted, worst module | scattered walls: accepted, worst module |");
    println!("|---:|---:|---:|");
    for modules in MODULES {
        let pins = &ALL[..modules];
        let text = fs::read_to_string(library.join(SKETCH))?;
        let name = format!("Ring{modules}BeforeWalls");
        let text = exchanged(&text, pins)?;
        let sketch = build::ours(library, Board::Uno, &name, &text, &[])?;
        let mut row = format!("| {modules} |");
        for scattered in [false, true] {
            // Equal walls are the harder ones.
            if short && scattered {
                row += " not run |";
                continue;
            }
            let shares = accepted(&world, &sketch.elf, Board::Uno, [pins, pins], seconds, scattered)?;
            let (all, worst) = enough(&name, shares, LEAST)?;
            let _ = write!(row, " {all:.1} %, {worst:.1} % |");
        }
        println!("{row}");
    }
    Ok(())
}

/// Returns the shares of all firings and of the worst module's, if they are large enough.
pub(super) fn enough(name: &str, (all, (worst, module)): (f64, (f64, usize)), least: (f64, f64)) -> Result<(f64, f64)> {
    ensure!(
        worst >= least.0 && all >= least.1,
        "{name}: {all:.1} % of the firings before walls were accepted, {worst:.1} % of module {module}'s; \
         expected at least {} and {} %",
        least.1,
        least.0
    );
    Ok((all, worst))
}

/// Returns the sketch for as many modules as there are pins.
fn exchanged(text: &str, pins: &[u8]) -> Result<String> {
    let list =
        |pins: &[u8]| format!("PINS[] = {{{}}}", pins.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "));
    let count = pins.len();
    let sonar = format!("EerufSonar<{count}> sonar(EERUF_HC_SR04_{count}, PINS)");
    let by_table = [("EerufFlow.h", "EerufTables.h"), ("EerufFlow<12> sonar(PINS)", &*sonar)];
    edited(text, &[&[(&*list(&ALL[..12]), &*list(pins))], &by_table[..]].concat())
}

/// The shares of accepted firings in percent: of all, and of the worst module, which is counted from 1.
pub(super) fn accepted(
    world: &Path,
    elf: &Path,
    board: Board,
    [triggers, echoes]: [&[u8]; 2],
    seconds: u32,
    scattered: bool,
) -> Result<(f64, (f64, usize))> {
    let span = SCATTERED_US.end - SCATTERED_US.start;
    let walls: Vec<_> = (0..triggers.len() as u32)
        // By the golden section, so that no two are alike.
        .map(|module| SCATTERED_US.start + (module * 618 % 1000) * span / 1000)
        .map(|us| Some(if scattered { us } else { EQUAL_US }))
        .collect();
    let options: &[&str] = if board == Board::Mega { &["--mega"] } else { &[] };
    let said = world::before_walls(world, elf, options, seconds, &walls, &[triggers, echoes].concat())?;
    Ok(Heard::of(&said, &BTreeMap::new()).shares())
}
