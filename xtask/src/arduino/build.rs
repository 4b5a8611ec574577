//! Sketches, compiled as the Arduino IDE does for an Uno or a Mega.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use anyhow::{Result, bail};
use fs_err as fs;

use super::TARGET;
use crate::steps::{command, output, run, skip};

/// Debian's `arduino-core-avr`.
const CORE: &str = "/usr/share/arduino/hardware/arduino/avr/cores/arduino";
const VARIANTS: &str = "/usr/share/arduino/hardware/arduino/avr/variants";

/// The options of the core's platform.txt, and those that its sources need with this compiler.
const COMMON: &str = "-c -g -Os -ffunction-sections -fdata-sections -flto -DF_CPU=16000000L -DARDUINO=10819 \
                      -DARDUINO_ARCH_AVR -DDECIMAL_DIG=10";
const C: &str = "avr-gcc -std=gnu11 -fno-fat-lto-objects";
const CXX: &str = "avr-g++ -std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics";

/// The board that a sketch is built for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Board {
    Uno,
    Mega,
}

impl Board {
    /// The names of the controller, of the folder with the board's pins, and of the board in the core.
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

fn compile(board: Board, source: &Path, object: &Path, more: &[&str]) -> Result<()> {
    let [controller, variant, name] = board.names();
    let is_c = source.extension().is_some_and(|extension| extension == "c");
    let compiler = if is_c { C } else { CXX };
    run(command(&format!("{compiler} {COMMON} {controller} {name}"))
        .args(more)
        .args(["-I", CORE, "-I"])
        .arg(Path::new(VARIANTS).join(variant))
        .arg("-o")
        .arg(object)
        .arg(source))
}

/// The files of a folder that a compiler takes.
fn sources(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut sources = vec![];
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "c" || extension == "cpp") {
            sources.push(path);
        }
    }
    sources.sort();
    Ok(sources)
}

fn object(folder: &Path, source: &Path) -> PathBuf {
    folder.join(source.file_name().unwrap_or_default()).with_added_extension("o")
}

/// Builds the core as an archive, once.
fn core(board: Board) -> Result<PathBuf> {
    if !Path::new(CORE).exists() {
        return skip(format!("no {CORE}; install arduino-core-avr"));
    }
    static BUILDS: Mutex<()> = Mutex::new(());
    let _alone = BUILDS.lock();
    let folder = Path::new(TARGET).join(format!("core-{}", board.names()[1]));
    fs::create_dir_all(&folder)?;
    let archive = folder.join("core.a");
    if archive.exists() {
        return Ok(archive);
    }
    let mut objects = vec![];
    for source in sources(Path::new(CORE))? {
        let object = object(&folder, &source);
        compile(board, &source, &object, &["-w"])?;
        objects.push(object);
    }
    run(Command::new("avr-gcc-ar").arg("rcs").arg(&archive).args(objects))?;
    Ok(archive)
}

/// Builds an example of the packed library.
pub(super) fn example(library: &Path, name: &str) -> Result<Sketch> {
    let text = fs::read_to_string(library.join(format!("examples/{name}/{name}.ino")))?;
    ours(library, Board::Uno, name, &text, &[])
}

/// Builds a sketch from this text, with the packed library and all warnings.
pub(super) fn ours(library: &Path, board: Board, name: &str, text: &str, defines: &[&str]) -> Result<Sketch> {
    sketch(&library.join("src"), board, name, text, &[&["-Wall", "-Wextra", "-Werror"], defines].concat())
}

/// Builds a sketch with the sources of a library.
pub(super) fn sketch(library: &Path, board: Board, name: &str, text: &str, options: &[&str]) -> Result<Sketch> {
    let core = core(board)?;
    let folder = Path::new(TARGET).join(name);
    fs::create_dir_all(&folder)?;
    let include = library.to_string_lossy();
    // As the IDE: a sketch is C++ that includes Arduino.h.
    let cpp = folder.join(format!("{name}.cpp"));
    fs::write(&cpp, format!("#include <Arduino.h>\n{text}"))?;
    let mut objects = vec![];
    for source in sources(library)?.into_iter().chain([cpp]) {
        let object = object(&folder, &source);
        compile(board, &source, &object, &[options, &["-I", &include]].concat())?;
        objects.push(object);
    }
    let elf = folder.join(format!("{name}.elf"));
    run(Command::new("avr-gcc")
        .args(["-w", "-Os", "-g", "-flto", "-fuse-linker-plugin", "-Wl,--gc-sections", board.names()[0], "-o"])
        .arg(&elf)
        .args(objects)
        .arg(&core)
        .arg("-lm"))?;
    let (flash, ram) = size(&elf)?;
    Ok(Sketch { elf, flash, ram })
}

/// Returns the bytes of flash, and of data and bss.
pub(super) fn size(elf: &Path) -> Result<(u64, u64)> {
    let size = output(Command::new("avr-size").arg(elf))?;
    let numbers: Vec<u64> =
        size.lines().nth(1).into_iter().flat_map(str::split_whitespace).filter_map(|n| n.parse().ok()).collect();
    let [text, data, bss, ..] = numbers[..] else { bail!("avr-size said: {size}") };
    Ok((text + data, data + bss))
}
