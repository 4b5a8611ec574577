//! NewPing beside eeruf: the same rings on a simulated Uno, among the same simulated modules, in the same room.
//!
//! This is run by hand: the licence of NewPing does not allow it here, so the user names a folder with its sources.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use fs_err as fs;

use super::build::{self, Board};
use super::{Example, pack, world};

/// Time for which each row runs, in seconds.
const SECONDS: u32 = 20;

/// Figures that are compared.
struct Row {
    name: &'static str,
    sketch: &'static str,
    text: &'static str,
    defines: &'static [&'static str],
}

pub(super) const NEWPING: &str = include_str!("newping/NewPing.ino");
const EERUF: &str = include_str!("newping/Eeruf.ino");
const ROWS: [Row; 4] = [
    Row { name: "NewPing, one module every 33 ms", sketch: "NewPing", text: NEWPING, defines: &[] },
    Row {
        name: "eeruf's rate, constant waits, every echo",
        sketch: "Constant",
        text: EERUF,
        defines: &["-DCONSTANT=1", "-DEVERY=1", "-DEERUF_AGREEMENT_ALONE"],
    },
    Row {
        name: "eeruf's rate, constant waits, two agree",
        sketch: "ConstantCompared",
        text: EERUF,
        defines: &["-DCONSTANT=1", "-DEVERY=0", "-DEERUF_AGREEMENT_ALONE"],
    },
    Row { name: "eeruf", sketch: "Eeruf", text: EERUF, defines: &["-DCONSTANT=0", "-DEVERY=0"] },
];

/// Returns the folder of NewPing's sources, and their version.
pub(super) fn sources(folder: &Path) -> Result<(PathBuf, String)> {
    let folder = [folder.to_owned(), folder.join("src")]
        .into_iter()
        .find(|folder| folder.join("NewPing.h").exists() && folder.join("NewPing.cpp").exists())
        .with_context(|| format!("{}: no NewPing.h and NewPing.cpp in it", folder.display()))?;
    let header = fs::read_to_string(folder.join("NewPing.h"))?;
    let version = header
        .split_once("NewPing Library - v")
        .and_then(|(_, rest)| rest.split_whitespace().next())
        .context("NewPing.h does not say its version as expected")?;
    Ok((folder, version.to_owned()))
}

/// Compares with the NewPing in this folder.
pub(crate) fn newping(folder: &Path) -> Result<()> {
    let (newping, version) = sources(folder)?;
    let (library, world) = (pack()?, world::build()?);
    println!("NewPing {version}, {SECONDS} s each");
    println!(
        "| ring | method | flash | data + bss | stack | in interrupts | firings/s | readings/s | right/s | wrong \
         | own by another way | own from before | foreign |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for modules in [8, 12] {
        for row in &ROWS {
            let sketch = row.build(modules, if row.is_ours() { &library } else { &newping })?;
            let example = Example::one_pin(row.name, modules, false);
            let heard = world::hear(&world, &sketch.elf, &example, SECONDS, true)?;
            let heard = heard.row_beside_newping();
            println!("| {modules} | {} | {} | {} | {heard} |", row.name, sketch.flash, sketch.ram);
        }
    }
    Ok(())
}

/// Builds the sketches that need no NewPing, so that CI knows that they can be built.
pub(super) fn builds(library: &Path) -> Result<()> {
    ROWS.iter().filter(|row| row.is_ours()).try_for_each(|row| row.build(8, library).map(drop))
}

impl Row {
    fn is_ours(&self) -> bool {
        self.text == EERUF
    }

    fn build(&self, modules: usize, library: &Path) -> Result<build::Sketch> {
        let name = format!("{}{modules}", self.sketch);
        let modules = format!("-DMODULES={modules}");
        let defines = [self.defines, &[&*modules]].concat();
        if self.is_ours() {
            return build::ours(library, Board::Uno, &name, self.text, &defines);
        }
        // Code of others is compiled without our warnings.
        build::sketch(library, Board::Uno, &name, self.text, &[&["-w"], &defines[..]].concat())
    }
}
