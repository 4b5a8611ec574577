//! NewPing beside eeruf: the same rings on a simulated Uno, among the same simulated modules, in the same room.
//!
//! By hand: NewPing is not free to be kept here, so that a folder with its sources is asked for.

use std::fs;
use std::path::{Path, PathBuf};

use super::build::{self, Board, Source};
use super::{ALL, Example, failed, pack, world};
use crate::c::need;
use crate::steps::{Steps, Trouble};

/// For how long each row runs, in seconds.
const SECONDS: u32 = 20;

/// Figures that are compared.
struct Row {
    name: &'static str,
    sketch: &'static str,
    text: &'static str,
    defines: &'static [&'static str],
}

const NEWPING: &str = include_str!("newping/NewPing.ino");
const EERUF: &str = include_str!("newping/Eeruf.ino");
const ROWS: [Row; 4] = [
    Row { name: "NewPing, one module every 33 ms", sketch: "NewPing", text: NEWPING, defines: &[] },
    Row {
        name: "eeruf's rate, constant waits, every echo",
        sketch: "Constant",
        text: EERUF,
        defines: &["-DCONSTANT=1", "-DEVERY=1", "-DEERUF_FIRINGS=1"],
    },
    Row {
        name: "eeruf's rate, constant waits, two agree",
        sketch: "ConstantCompared",
        text: EERUF,
        defines: &["-DCONSTANT=1", "-DEVERY=0", "-DEERUF_FIRINGS=1"],
    },
    Row { name: "eeruf", sketch: "Eeruf", text: EERUF, defines: &["-DCONSTANT=0", "-DEVERY=0"] },
];

/// Compares with the NewPing in this folder.
pub(crate) fn newping(folder: &Path, steps: &mut Steps) {
    steps.step("NewPing beside eeruf", || compare(folder));
}

/// Where NewPing's sources are, and their version.
fn sources(folder: &Path) -> Result<(PathBuf, String), Trouble> {
    let folder = [folder.to_owned(), folder.join("src")]
        .into_iter()
        .find(|folder| folder.join("NewPing.h").exists() && folder.join("NewPing.cpp").exists())
        .ok_or_else(|| Trouble::Failed(format!("{}: no NewPing.h and NewPing.cpp in it", folder.display())))?;
    let header = fs::read_to_string(folder.join("NewPing.h")).map_err(failed("NewPing.h"))?;
    let version = header
        .split_once("NewPing Library - v")
        .and_then(|(_, rest)| rest.split_whitespace().next())
        .ok_or_else(|| Trouble::Failed("NewPing.h does not say its version as expected".to_owned()))?;
    Ok((folder, version.to_owned()))
}

fn compare(folder: &Path) -> Result<(), Trouble> {
    let (newping, version) = sources(folder)?;
    need("avr-g++", "gcc-avr avr-libc binutils-avr arduino-core-avr")?;
    let (library, core, world) = (pack()?, build::core(Board::Uno)?, world::build()?);
    println!("NewPing {version}, {SECONDS} s each");
    println!(
        "| ring | method | flash | data + bss | stack | in interrupts | firings/s | readings/s | right/s | wrong \
         | own by another way | own from before | foreign |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for modules in [8, 12] {
        for row in &ROWS {
            let library = if row.is_ours() { library.join("src") } else { newping.clone() };
            let sketch = row.build(modules, &library, &core)?;
            let (pins, _) = ALL.split_at(modules);
            let example = Example { name: row.name, modules, triggers: pins, echoes: pins, short: false };
            let heard = world::run(&world, &sketch.elf, &example, SECONDS, true)?;
            println!(
                "| {modules} | {} | {} | {} | {} |",
                row.name,
                sketch.flash,
                sketch.ram,
                heard.row_beside_newping()
            );
        }
    }
    Ok(())
}

/// Builds the sketches that need no NewPing, so that CI knows that they can be built.
pub(super) fn builds(library: &Path, core: &Path) -> Result<(), Trouble> {
    ROWS.iter().filter(|row| row.is_ours()).try_for_each(|row| row.build(8, &library.join("src"), core).map(drop))
}

impl Row {
    fn is_ours(&self) -> bool {
        self.text == EERUF
    }

    fn build(&self, modules: usize, library: &Path, core: &Path) -> Result<build::Sketch, Trouble> {
        let name = format!("{}{modules}", self.sketch);
        let modules = format!("-DMODULES={modules}");
        let defines: Vec<&str> = self.defines.iter().copied().chain([&*modules]).collect();
        // Code of others is compiled without our warnings.
        let ours = self.is_ours();
        let source = Source { name: &name, text: self.text, board: Board::Uno, ours, defines: &defines };
        build::sketch(&source, library, core)
    }
}
