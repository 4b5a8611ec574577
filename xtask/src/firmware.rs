//! `cargo xtask firmware`: builds the firmware for four boards, runs it in QEMU, and measures it.
//!
//! Every figure is an exact count that repeats: instructions under `-icount`, bytes of sections, stack sizes that the
//! compiler wrote down. The budgets of a Cortex-M0 with twelve sensors are checked.

mod in_the_loop;
mod rings;
mod stack;
mod tables;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::measured;
use crate::steps::{Trouble, output, run, run_component};
use crate::toolchain::cargo_for_target;

struct Board {
    name: &'static str,
    target: &'static str,
    qemu: &'static str,
    machine: &'static [&'static str],
}

const BOARDS: [Board; 4] = [
    Board { name: "microbit", target: "thumbv6m-none-eabi", qemu: "qemu-system-arm", machine: &["-M", "microbit"] },
    Board { name: "lm3s6965", target: "thumbv7m-none-eabi", qemu: "qemu-system-arm", machine: &["-M", "lm3s6965evb"] },
    Board { name: "an386", target: "thumbv7em-none-eabihf", qemu: "qemu-system-arm", machine: &["-M", "mps2-an386"] },
    Board {
        name: "rv_virt",
        target: "riscv32imac-unknown-none-elf",
        qemu: "qemu-system-riscv32",
        machine: &["-M", "virt", "-bios", "none"],
    },
];

/// Parts to build, run and measure.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Put the tables into the document instead of comparing them
    #[arg(long)]
    write: bool,
    /// Only on this board, and without the simulated world
    #[arg(long, value_name = "NAME", conflicts_with = "write", value_parser = BOARDS.map(|board| board.name))]
    board: Option<String>,
}

impl Plan {
    /// Returns true if it is for all boards; then the programs are linted, too.
    pub(crate) fn is_whole(&self) -> bool {
        self.board.is_none()
    }
}

/// Builds, runs and measures everything, or what there is for one board; prints the tables of
/// `docs/log/firmware.md`, and compares them with what stands there or writes them.
pub(crate) fn firmware(plan: &Plan) -> Result<(), Trouble> {
    let (tables, over) = tables::measure(plan.board.as_deref())?;
    for (name, table) in &tables {
        println!("\n{name}:\n\n{table}");
    }
    if !over.is_empty() {
        return Err(Trouble::Failed(over.join("; ")));
    }
    if plan.write { measured::write(&tables) } else { measured::check(&tables, plan.board.as_deref()) }
}

/// Formatting, and Clippy for all but RTIC's program, which is of another target.
pub(crate) fn lint() -> Result<(), Trouble> {
    run_component("rustfmt", &["fmt", "--all", "--check", "--manifest-path", "firmware/Cargo.toml"])?;
    let [microbit, ..] = &BOARDS;
    let debian = cargo(microbit)?.get_program() == "/usr/bin/cargo";
    if debian && !Path::new("/usr/bin/cargo-clippy").exists() {
        return Err(Trouble::Skipped(format!(
            "no Clippy beside Debian's compiler; try: apt install rust-web-clippy (or rustup target add {})",
            microbit.target
        )));
    }
    let strict = ["clippy", "--quiet", "--release", "--locked", "--workspace", "--exclude", "eeruf-rtic"];
    run(cargo(microbit)?.args(strict).args(["--target", microbit.target, "--", "--deny", "warnings"]))
}

/// `cargo` for a board, in the firmware's own workspace. Where stacks are read, the compiler writes down each frame,
/// beside the program, by an unstable option.
fn cargo(board: &Board) -> Result<Command, Trouble> {
    let mut cargo = cargo_for_target(board.target)?;
    cargo.current_dir("firmware");
    if stack::is_read_on(board) {
        cargo.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Clink-arg=-Tlink.x -Zemit-stack-sizes");
    }
    Ok(cargo)
}

fn build(board: &Board, what: &[&str]) -> Result<(), Trouble> {
    run(cargo(board)?.args(["build", "--quiet", "--release", "--locked", "--target", board.target]).args(what))
}

fn on_target_tests(board: &Board) -> Result<(), Trouble> {
    let target = ["test", "--quiet", "--release", "--locked", "--target", board.target];
    run(cargo(board)?.args(target).args(["--package", "eeruf-on-target", "--test", "corpus"]))
}

fn image(board: &Board, name: &str) -> Result<PathBuf, Trouble> {
    let cargo = cargo(board)?;
    let target_dir = cargo.get_envs().find(|(key, _)| *key == "CARGO_TARGET_DIR").and_then(|(_, value)| value);
    let target_dir = target_dir.map_or(PathBuf::from("target"), PathBuf::from);
    Ok(Path::new("firmware").join(target_dir).join(board.target).join("release").join(name))
}

/// Runs an image, with `2^shift` ns an instruction; what it says, if it leaves with 0 within five minutes.
fn run_image(board: &Board, name: &str, shift: u32) -> Result<String, Trouble> {
    qemu(board, &image(board, name)?, shift)
}

/// The command that runs an image on a board, with `2^shift` ns an instruction.
fn emulator(board: &Board, image: &Path, shift: u32) -> Command {
    let mut qemu = Command::new(board.qemu);
    qemu.args(board.machine)
        .args(["-nographic", "-monitor", "none", "-serial", "none", "-icount", &format!("shift={shift},sleep=off")])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(image);
    qemu
}

/// The command that runs the ring that speaks over the board's serial line, as a JSON list; `SERIAL` in it stands for
/// the line.
pub(crate) fn serial_board() -> Result<String, Trouble> {
    let [_, lm3s6965, ..] = &BOARDS;
    if output(Command::new(lm3s6965.qemu).arg("--version")).is_none() {
        return Err(Trouble::Skipped(format!("no {}; install qemu-system-arm", lm3s6965.qemu)));
    }
    build(lm3s6965, &["--package", "eeruf-hil-board", "--features", "serial", "--bin", "eeruf-serial-board"])?;
    let image = std::path::absolute(image(lm3s6965, "eeruf-serial-board")?);
    let image = image.map_err(|error| Trouble::Failed(error.to_string()))?;
    let image = image.to_str().ok_or_else(|| Trouble::Failed("the path of the clone is no text".to_owned()))?;
    let line = ["-nographic", "-monitor", "none", "-serial", "SERIAL", "-icount", "shift=6,sleep=off"];
    let rest = ["-semihosting-config", "enable=on,target=native", "-kernel", image];
    let command = [&[lm3s6965.qemu][..], lm3s6965.machine, &line, &rest].concat();
    Ok(format!("[{}]", command.iter().map(|part| format!("{part:?}")).collect::<Vec<_>>().join(",")))
}

fn qemu(board: &Board, image: &Path, shift: u32) -> Result<String, Trouble> {
    let what = format!("{} on {}", image.display(), board.name);
    let mut command = emulator(board, image, shift);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| {
        Trouble::Skipped(format!("{}: {error}; install qemu-system-arm and qemu-system-misc", board.qemu))
    })?;
    let deadline = Instant::now() + Duration::from_secs(300);
    loop {
        match child.try_wait() {
            Ok(None) if Instant::now() > deadline => {
                // It may have ended meanwhile.
                let _ = child.kill();
                return Err(Trouble::Failed(format!("{what}: not finished after five minutes")));
            }
            Ok(None) => std::thread::sleep(Duration::from_millis(10)),
            Ok(Some(_)) => break,
            Err(error) => return Err(Trouble::Failed(format!("{what}: {error}"))),
        }
    }
    let output = child.wait_with_output().map_err(|error| Trouble::Failed(format!("{what}: {error}")))?;
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    // QEMU complains of a timer that is not yet set; that is harmless.
    let said: String =
        said.lines().filter(|line| !line.contains("Timer with period zero")).map(|line| format!("{line}\n")).collect();
    if output.status.success() { Ok(said) } else { Err(Trouble::Failed(format!("{what}: {}\n{said}", output.status))) }
}

fn expect(board: &Board, name: &str, shift: u32, what: &str) -> Result<(), Trouble> {
    let said = run_image(board, name, shift)?;
    print!("{said}");
    if said.contains(what) {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("{name} on {}: expected {what}", board.name)))
    }
}

/// The example of the C library, on the host and on a Cortex-M3.
fn c_example(board: &Board) -> Result<(), Trouble> {
    let folder = Path::new("firmware/target/c");
    std::fs::create_dir_all(folder).map_err(|error| Trouble::Failed(error.to_string()))?;
    let design = ["design", "rings/hc-sr04-8.toml", "--period-only", "--emit", "c"];
    let table = output(Command::new(crate::program::program()?).args(design))
        .ok_or_else(|| Trouble::Failed("eeruf design rings/hc-sr04-8.toml failed".to_owned()))?;
    std::fs::write(folder.join("ring.h"), table + "\n").map_err(|error| Trouble::Failed(error.to_string()))?;
    let strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-Ic", "-Ifirmware/target/c"];
    let sources = ["c/examples/ring.c", "c/eeruf.c", "-o"];
    let host = folder.join("ring");
    run(Command::new("gcc").args(strict).args(sources).arg(&host))?;
    run(&mut Command::new(host))?;
    let out = folder.join("ring-m3.elf");
    run(Command::new("arm-none-eabi-gcc")
        .args(["-mcpu=cortex-m3", "-mthumb", "-Os", "-ffunction-sections"])
        .args(strict)
        .arg("c/examples/lm3s6965.c")
        .args(sources)
        .arg(&out)
        .args(["-nostartfiles", "--specs=rdimon.specs", "-T", "c/examples/lm3s6965.ld", "-Wl,--gc-sections"]))?;
    let said = qemu(board, &out, 6)?;
    print!("{said}");
    if said.contains("c: accepted 792, at 2059 mm") {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("the C example said: {said}")))
    }
}

/// Flash and RAM of an image: the sections that are loaded, and those that are not but for the stack.
fn sections(board: &Board, name: &str) -> Result<(u64, u64), Trouble> {
    let image = image(board, name)?;
    let listing = llvm("size", &["-A"], &image)?;
    let (mut flash, mut ram) = (0, 0);
    for line in listing.lines() {
        let [section, bytes, _] = line.split_whitespace().collect::<Vec<_>>()[..] else { continue };
        let Ok(bytes) = bytes.parse::<u64>() else { continue };
        match section {
            ".vector_table" | ".init" | ".init.rust" | ".text" | ".text.dummy" | ".rodata" | ".trap" | ".init.trap" => {
                flash += bytes;
            }
            ".data" => {
                flash += bytes;
                ram += bytes;
            }
            ".bss" | ".uninit" => ram += bytes,
            _ => {}
        }
    }
    Ok((flash, ram))
}

/// Debian's LLVM tools have their version in the name.
fn llvm(tool: &str, args: &[&str], image: &Path) -> Result<String, Trouble> {
    for name in [format!("llvm-{tool}-22"), format!("llvm-{tool}")] {
        if let Some(text) = output(Command::new(name).args(args).arg(image)) {
            return Ok(text);
        }
    }
    Err(Trouble::Skipped(format!("no llvm-{tool}; install llvm-22")))
}
