//! Sketches, compiled as the Arduino IDE does for an Uno or a Mega.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{TARGET, failed};
use crate::steps::{Trouble, output, run};

/// Debian's `arduino-core-avr`.
const CORE: &str = "/usr/share/arduino/hardware/arduino/avr/cores/arduino";
const VARIANTS: &str = "/usr/share/arduino/hardware/arduino/avr/variants";

/// The options of the core's platform.txt, and what its sources want of this compiler.
const COMMON: [&str; 10] = [
    "-c",
    "-g",
    "-Os",
    "-ffunction-sections",
    "-fdata-sections",
    "-flto",
    "-DF_CPU=16000000L",
    "-DARDUINO=10819",
    "-DARDUINO_ARCH_AVR",
    "-DDECIMAL_DIG=10",
];
const C: [&str; 2] = ["-std=gnu11", "-fno-fat-lto-objects"];
const CXX: [&str; 4] = ["-std=gnu++11", "-fpermissive", "-fno-exceptions", "-fno-threadsafe-statics"];

/// The board that a sketch is built for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Board {
    Uno,
    Mega,
}

impl Board {
    /// The name of the controller, of the folder with the board's pins, and what the core calls it.
    const fn names(self) -> [&'static str; 3] {
        match self {
            Self::Uno => ["-mmcu=atmega328p", "standard", "-DARDUINO_AVR_UNO"],
            Self::Mega => ["-mmcu=atmega2560", "mega", "-DARDUINO_AVR_MEGA2560"],
        }
    }
}

pub(super) struct Sketch {
    pub(super) elf: PathBuf,
    pub(super) flash: u64,
    pub(super) ram: u64,
}

fn compile(board: Board, source: &Path, object: &Path, more: &[&str]) -> Result<(), Trouble> {
    let [controller, variant, name] = board.names();
    let is_c = source.extension().is_some_and(|extension| extension == "c");
    let (compiler, language) = if is_c { ("avr-gcc", &C[..]) } else { ("avr-g++", &CXX[..]) };
    run(Command::new(compiler)
        .args(COMMON)
        .args(language)
        .args([controller, name])
        .args(more)
        .args(["-I", CORE, "-I"])
        .arg(Path::new(VARIANTS).join(variant))
        .arg("-o")
        .arg(object)
        .arg(source))
}

/// The files of a folder that a compiler takes.
fn sources(folder: &Path) -> Result<Vec<PathBuf>, Trouble> {
    let mut sources = vec![];
    for entry in fs::read_dir(folder).map_err(failed(&folder.display().to_string()))? {
        let path = entry.map_err(failed("a folder"))?.path();
        if path.extension().is_some_and(|extension| extension == "c" || extension == "cpp") {
            sources.push(path);
        }
    }
    sources.sort();
    Ok(sources)
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The core as an archive, built once.
pub(super) fn core(board: Board) -> Result<PathBuf, Trouble> {
    if !Path::new(CORE).exists() {
        return Err(Trouble::Skipped(format!("no {CORE}; install arduino-core-avr")));
    }
    let folder = Path::new(TARGET).join(format!("core-{}", board.names()[1]));
    fs::create_dir_all(&folder).map_err(failed("target"))?;
    let archive = folder.join("core.a");
    if archive.exists() {
        return Ok(archive);
    }
    let mut objects = vec![];
    for source in sources(Path::new(CORE))? {
        let object = folder.join(name(&source) + ".o");
        compile(board, &source, &object, &["-w"])?;
        objects.push(object);
    }
    run(Command::new("avr-gcc-ar").arg("rcs").arg(&archive).args(objects))?;
    Ok(archive)
}

/// An example of the packed library.
pub(super) fn example(library: &Path, core: &Path, name: &str) -> Result<Sketch, Trouble> {
    let ino = library.join("examples").join(name).join(format!("{name}.ino"));
    let text = fs::read_to_string(&ino).map_err(failed(&ino.display().to_string()))?;
    sketch(&Source { name, text: &text, board: Board::Uno, ours: true, defines: &[] }, &library.join("src"), core)
}

/// A sketch and how it is built.
pub(super) struct Source<'a> {
    pub(super) name: &'a str,
    pub(super) text: &'a str,
    pub(super) board: Board,
    /// True for our own code, which is compiled with all warnings.
    pub(super) ours: bool,
    pub(super) defines: &'a [&'a str],
}

/// A sketch with the sources of a library.
pub(super) fn sketch(source: &Source<'_>, library: &Path, core: &Path) -> Result<Sketch, Trouble> {
    let &Source { name: example, text, board, ours, defines } = source;
    let folder = Path::new(TARGET).join(example);
    fs::create_dir_all(&folder).map_err(failed("target"))?;
    let include = library.to_string_lossy();
    let warnings: &[&str] = if ours { &["-Wall", "-Wextra", "-Werror"] } else { &["-w"] };
    // As the IDE: a sketch is C++ that includes Arduino.h.
    let cpp = folder.join(format!("{example}.cpp"));
    fs::write(&cpp, format!("#include <Arduino.h>\n{text}")).map_err(failed("target"))?;
    let mut objects = vec![];
    for source in sources(library)?.into_iter().chain([cpp]) {
        let object = folder.join(name(&source) + ".o");
        compile(board, &source, &object, &[warnings, defines, &["-I", &include]].concat())?;
        objects.push(object);
    }
    let elf = folder.join(format!("{example}.elf"));
    run(Command::new("avr-gcc")
        .args(["-w", "-Os", "-g", "-flto", "-fuse-linker-plugin", "-Wl,--gc-sections", board.names()[0], "-o"])
        .arg(&elf)
        .args(objects)
        .arg(core)
        .arg("-lm"))?;
    let (flash, ram) = size(&elf)?;
    Ok(Sketch { elf, flash, ram })
}

/// Bytes of flash, and of data and bss.
pub(super) fn size(elf: &Path) -> Result<(u64, u64), Trouble> {
    let size = output(Command::new("avr-size").arg(elf)).ok_or_else(|| Trouble::Failed("avr-size".to_owned()))?;
    let numbers: Vec<u64> =
        size.lines().nth(1).into_iter().flat_map(str::split_whitespace).filter_map(|n| n.parse().ok()).collect();
    match numbers[..] {
        [text, data, bss, ..] => Ok((text + data, data + bss)),
        _ => Err(Trouble::Failed(format!("avr-size said: {size}"))),
    }
}
