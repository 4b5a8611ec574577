//! `cargo xtask firmware`: builds the firmware for four boards, runs it in QEMU, and measures it.
//!
//! Every figure is an exact count that repeats: instructions under `-icount`, bytes of sections, stack sizes that the
//! compiler wrote down. The budgets of a Cortex-M0 with twelve sensors are checked.

mod stack;
mod tables;

use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::measured;
use crate::steps::{Steps, need, output, run, run_component, skip};
use crate::toolchain::{cargo_for_target, is_debian, target_folder};

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
    /// Put the tables into the file instead of comparing them
    #[arg(long)]
    write: bool,
    /// Only on this board, and without the example of the C library
    #[arg(long, value_name = "NAME", conflicts_with = "write", value_parser = BOARDS.map(|board| board.name))]
    board: Option<String>,
}

/// Builds, runs and measures everything, or only one board; prints the tables of `tests/data/boards.txt`, and compares
/// them with the file or writes it. For all boards it also lints the programs.
pub(crate) fn run_all(plan: &Plan, steps: &mut Steps) {
    if plan.board.is_none() {
        steps.step("lint of the firmware", lint);
    }
    steps.step("firmware on emulated boards", || {
        let (tables, over) = tables::measure(plan.board.as_deref())?;
        for (name, table) in &tables {
            println!("\n{name}:\n\n{table}");
        }
        ensure!(over.is_empty(), "{}", over.join("; "));
        if plan.write { measured::write(&tables) } else { measured::check(&tables, plan.board.as_deref()) }
    });
}

/// Checks formatting, and runs Clippy for all but RTIC's program, which has another target.
fn lint() -> Result<()> {
    run_component("rustfmt", "fmt --all --check --manifest-path firmware/Cargo.toml")?;
    let [microbit, ..] = &BOARDS;
    if is_debian(&cargo(microbit)?) && !Path::new("/usr/bin/cargo-clippy").exists() {
        return skip(format!(
            "no Clippy beside Debian's compiler; try: apt install rust-web-clippy (or rustup target add {})",
            microbit.target
        ));
    }
    let strict = ["clippy", "--quiet", "--release", "--locked", "--workspace", "--exclude", "eeruf-rtic"];
    run(cargo(microbit)?.args(strict).args(["--target", microbit.target, "--", "--deny", "warnings"]))
}

/// `cargo` for a board, in the firmware's own workspace; for stacks, an unstable option adds the size of each frame.
fn cargo(board: &Board) -> Result<Command> {
    let mut cargo = cargo_for_target(board.target)?;
    cargo.current_dir("firmware");
    if stack::is_read_on(board) {
        cargo.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Clink-arg=-Tlink.x -Zemit-stack-sizes");
    }
    Ok(cargo)
}

fn build(board: &Board, what: &[&str]) -> Result<()> {
    run(cargo(board)?.args(["build", "--quiet", "--release", "--locked", "--target", board.target]).args(what))
}

fn on_target_tests(board: &Board) -> Result<()> {
    let target = ["test", "--quiet", "--release", "--locked", "--target", board.target];
    run(cargo(board)?.args(target).args(["--package", "eeruf-on-target", "--test", "corpus"]))
}

fn image(board: &Board, name: &str) -> Result<PathBuf> {
    let cargo = cargo(board)?;
    Ok(Path::new("firmware").join(target_folder(&cargo)).join(board.target).join("release").join(name))
}

/// Runs an image, with `2^shift` ns per instruction. Returns its output if it exits with 0 within five minutes.
fn run_image(board: &Board, name: &str, shift: u32) -> Result<String> {
    qemu(board, &image(board, name)?, shift)
}

/// Returns the command that runs an image on a board, with `2^shift` ns per instruction.
fn emulator(board: &Board, image: &Path, shift: u32) -> Command {
    let mut qemu = Command::new(board.qemu);
    qemu.args(board.machine)
        .args(["-nographic", "-monitor", "none", "-serial", "none", "-icount", &format!("shift={shift},sleep=off")])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(image);
    qemu
}

fn qemu(board: &Board, image: &Path, shift: u32) -> Result<String> {
    let what = format!("{} on {}", image.display(), board.name);
    need(&format!("{} --version", board.qemu), "apt install qemu-system-arm qemu-system-misc")?;
    let emulator = emulator(board, image, shift);
    let mut command = Command::new("timeout");
    let output = command.arg("300").arg(emulator.get_program()).args(emulator.get_args()).output()?;
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    // QEMU complains of a timer that is not yet set; that is harmless.
    let said: String =
        said.lines().filter(|line| !line.contains("Timer with period zero")).map(|line| format!("{line}\n")).collect();
    ensure!(output.status.success(), "{what}: {}\n{said}", output.status);
    Ok(said)
}

fn expect(board: &Board, name: &str, shift: u32, what: &str) -> Result<()> {
    let said = run_image(board, name, shift)?;
    print!("{said}");
    ensure!(said.contains(what), "{name} on {}: expected {what}", board.name);
    Ok(())
}

/// Builds the example of the C library, on the host and on a Cortex-M3.
fn c_example(board: &Board) -> Result<()> {
    let folder = Path::new("firmware/target/c");
    fs::create_dir_all(folder)?;
    let design = ["design", "rings/hc-sr04-8.toml", "--period-only", "--emit", "c"];
    fs::write(folder.join("ring.h"), output(Command::new(crate::toolchain::program()?).args(design))? + "\n")?;
    let strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-Ic", "-Ifirmware/target/c"];
    let sources = ["c/examples/ring.c", "c/eeruf.c", "-o"];
    let host = folder.join("ring");
    run(Command::new("gcc").args(strict).args(sources).arg(&host))?;
    run(&mut Command::new(host))?;
    let out = folder.join("ring-m3.elf");
    run(Command::new("arm-none-eabi-gcc")
        .args(["-mcpu=cortex-m3", "-mthumb", "-Os", "-ffunction-sections"])
        .args(strict)
        .args(sources)
        .arg(&out)
        .args(["--specs=rdimon.specs", "-T", "c/examples/lm3s6965.ld", "-Wl,--gc-sections"]))?;
    let said = qemu(board, &out, 6)?;
    print!("{said}");
    ensure!(said.contains("c: accepted 792, at 2059 mm"), "the C example said: {said}");
    Ok(())
}

/// The command for a program on the emulated Cortex-M0, built in this folder from its manifest and its source.
pub(crate) fn on_m0(folder: &Path, name: &str, manifest: &str, main: &str) -> Result<Command> {
    let [microbit, ..] = &BOARDS;
    fs::create_dir_all(folder.join("src"))?;
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::write(folder.join("src/main.rs"), main)?;
    let (mut cargo, target) = (cargo_for_target(microbit.target)?, absolute("target/programs-m0")?);
    cargo.current_dir(folder).env("CARGO_TARGET_DIR", &target).env("RUSTFLAGS", "-Clink-arg=-Tlink.x");
    run(cargo.args(["build", "--quiet", "--release", "--target", microbit.target]))?;
    Ok(emulator(microbit, &target.join(microbit.target).join("release").join(name), 6))
}

/// Flash and RAM of an image: loaded sections, and sections without contents except the stack.
fn sections(board: &Board, name: &str) -> Result<(u64, u64)> {
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

/// Runs one of Debian's LLVM tools, whose names contain the version.
fn llvm(tool: &str, args: &[&str], image: &Path) -> Result<String> {
    let mut names = [format!("llvm-{tool}-22"), format!("llvm-{tool}")].into_iter();
    match names.find(|name| output(Command::new(name).arg("--version")).is_ok()) {
        Some(name) => output(Command::new(name).args(args).arg(image)),
        None => skip(format!("no llvm-{tool}; install llvm-22")),
    }
}
