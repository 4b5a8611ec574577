//! `cargo xtask firmware`: builds the firmware for four boards, runs it in QEMU, and measures it.
//!
//! Every figure is an exact count that repeats: instructions under `-icount`, bytes of sections, stack sizes that the
//! compiler wrote down. The budgets of a Cortex-M0 with twelve sensors are checked.

use std::collections::{BTreeMap, BTreeSet};
use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::measured::{self, Tables};
use crate::steps::{Trouble, output, run};
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

/// What a ring of twelve may cost on the Cortex-M0: (name in the measured lines, most instructions).
const INSTRUCTIONS: [(&str, u32); 5] = [("idle_poll", 44), ("fire", 95), ("echo", 67), ("stamp", 60), ("reading", 423)];
/// The program on the host that puts the boards into a simulated world, and the boards' side of it.
const HARNESS: &str = "eeruf-hil";
const BOARD_PROGRAM: &str = "eeruf-hil-board";
/// The same with a ring that hops in time.
const HOPPING_PROGRAM: &str = "eeruf-hil-hopping";
/// What a hopping ring of twelve costs there, as `docs/hopping.md` has it: it may not grow unnoticed.
const HOPPING: [(&str, u32); 6] =
    [("idle_poll", 62), ("fire", 255), ("echo", 77), ("reading", 1452), ("period_ended", 3108), ("new_lags", 18_444)];
const HOPPING_FLASH: u64 = 8088;
const HOPPING_RAM: u64 = 1036;
/// What a poll of it takes of the stack there.
const HOPPING_STACK: u64 = 404;
/// Compilers differ: only more than the budget and this part of it fails.
const LEEWAY: f64 = 0.05;
const FLASH: u64 = 4332;
const RAM: u64 = 12 * 18 + 80;
const STACK: u64 = 256;

/// Builds, runs and measures everything; prints the tables of `docs/firmware.md`, and compares them with what stands
/// there or writes them.
pub(crate) fn firmware(write: bool) -> Result<(), Trouble> {
    let (tables, over) = measure_all()?;
    for (name, table) in &tables {
        println!("\n{name}:\n\n{table}");
    }
    if !over.is_empty() {
        return Err(Trouble::Failed(over.join("; ")));
    }
    if write { measured::write(&tables) } else { measured::check(&tables) }
}

/// Formatting, and Clippy for all but RTIC's program, which is of another target.
pub(crate) fn lint() -> Result<(), Trouble> {
    run(Command::new("cargo").current_dir("firmware").args(["fmt", "--all", "--check"]))?;
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

/// The tables, and which budgets are exceeded.
fn measure_all() -> Result<(Tables, Vec<String>), Trouble> {
    let mut tables = Tables::new();
    let mut instructions = Vec::new();
    let mut sizes = Vec::new();
    let mut lateness = Vec::new();
    for board in &BOARDS {
        build(board, &["--workspace", "--exclude", "eeruf-rtic", "--exclude", "eeruf-embassy"])?;
        expect(board, "eeruf-ring", 6, "accepted 1089")?;
        on_target_tests(board)?;
        let said = format!("{}{}", run_image(board, "instructions", 10)?, run_image(board, "instructions-alone", 10)?);
        instructions.push((board, said));
        sizes.push((board, [8, 12, 24].map(|k| sections(board, &format!("size-{k}"))), sections(board, "size-bare")));
        for shift in [6, 9] {
            lateness.push((board, shift, run_image(board, "lateness", shift)?));
        }
    }
    let [microbit, lm3s6965, ..] = &BOARDS;
    build(lm3s6965, &["--package", "eeruf-rtic", "--package", "eeruf-embassy"])?;
    build(microbit, &["--package", "eeruf-embassy"])?;
    expect(lm3s6965, "eeruf-rtic", 6, "accepted 1188")?;
    expect(lm3s6965, "eeruf-embassy", 6, "accepted 1188")?;
    expect(microbit, "eeruf-embassy", 6, "accepted 1188")?;
    c_example(lm3s6965)?;
    let (in_the_loop, hopping_in_the_loop) =
        (in_the_loop(BOARD_PROGRAM, &[])?, in_the_loop(HOPPING_PROGRAM, &["--hopping"])?);

    let mut text = "| board | compiler |\n|---|---|\n".to_owned();
    for board in &BOARDS {
        text += &format!("| {} | {} |\n", board.name, compiler(board)?);
    }
    tables.insert(measured::COMPILERS, text);
    let mut over = Vec::new();
    let mut text = "| board | call | fewest instructions | most |\n|---|---|---:|---:|\n".to_owned();
    for (board, said) in &instructions {
        for line in said.lines() {
            let [name, fewest, most] = line.split(' ').collect::<Vec<_>>()[..] else { continue };
            text += &format!("| {} | {name} | {fewest} | {most} |\n", board.name);
            let most: u32 = most.parse().map_err(|_| Trouble::Failed(format!("{}: {line}", board.name)))?;
            for (budgeted, budget) in INSTRUCTIONS {
                if board.name == "microbit" && name == budgeted && f64::from(most) > f64::from(budget) * (1.0 + LEEWAY)
                {
                    over.push(format!("{name}: {most} instructions; the budget is {budget}"));
                }
            }
        }
    }
    tables.insert("instructions", text);
    over.extend(hopping(&mut tables)?);
    let mut text = "| board | sensors | flash (text) | data + bss |\n|---|---:|---:|---:|\n".to_owned();
    for (board, with, bare) in sizes {
        let bare = bare?;
        for (k, with) in [8, 12, 24].into_iter().zip(with) {
            let with = with?;
            let (flash, ram) = (with.0 - bare.0, with.1 - bare.1);
            text += &format!("| {} | {k} | {flash} | {ram} |\n", board.name);
            if board.name == "microbit" && k == 12 && (flash > FLASH || ram > RAM) {
                over.push(format!("{flash} bytes of flash and {ram} of RAM; the budget is {FLASH} and {RAM}"));
            }
        }
    }
    tables.insert("size", text);
    let mut text = "| board | function | worst stack, bytes |\n|---|---|---:|\n".to_owned();
    for board in [microbit, lm3s6965] {
        for (function, bytes) in stack(board, "size-12")? {
            text += &format!("| {} | `{function}` | {bytes} |\n", board.name);
            if board.name == "microbit" && bytes > STACK {
                over.push(format!("{function}: {bytes} bytes of stack; the budget is {STACK}"));
            }
        }
    }
    tables.insert("stack", text);
    let mut text = "| board | ns per instruction | lateness under echo load |\n|---|---:|---|\n".to_owned();
    for (board, shift, said) in lateness {
        text += &format!("| {} | {} | {} |\n", board.name, 1 << shift, said.trim());
    }
    tables.insert("lateness", text);
    let search = run_image(lm3s6965, "search", 6)?;
    tables.insert("search", format!("| board | search |\n|---|---|\n| {} | {} |\n", lm3s6965.name, search.trim()));
    tables.insert("in a simulated world", in_the_loop);
    tables.insert("hopping in a simulated world", hopping_in_the_loop);
    Ok((tables, over))
}

/// What a hopping ring of twelve costs on each board, and what of it is more than it should be.
fn hopping(tables: &mut Tables) -> Result<Vec<String>, Trouble> {
    let exceeds = |value: u64, budget: u64| value as f64 > budget as f64 * (1.0 + LEEWAY);
    let mut over = Vec::new();
    let mut sizes =
        "| board | flash (text) | data + bss | stack of a poll | of `new` |\n|---|---:|---:|---:|---:|\n".to_owned();
    let mut calls = "| board | call | fewest instructions | most |\n|---|---|---:|---:|\n".to_owned();
    for board in &BOARDS {
        let (with, bare) = (sections(board, "size-hopping-12")?, sections(board, "size-bare")?);
        let (flash, ram) = (with.0 - bare.0, with.1 - bare.1);
        // As of the ring of two phases, whose table it stands beside.
        let measured = ["microbit", "lm3s6965"].contains(&board.name);
        let stack = if measured { stack(board, "size-hopping-12")? } else { Vec::new() };
        let worst = |name: &str| stack.iter().find(|(function, _)| function == name).map(|(_, bytes)| *bytes);
        let [poll, new] =
            ["ring_poll", "ring_new"].map(|name| worst(name).map_or("-".to_owned(), |bytes| bytes.to_string()));
        sizes += &format!("| {} | {flash} | {ram} | {poll} | {new} |\n", board.name);
        let said = run_image(board, "hopping-instructions", 10)?;
        for line in said.lines() {
            if let [name, fewest, most] = line.split(' ').collect::<Vec<_>>()[..] {
                calls += &format!("| {} | {name} | {fewest} | {most} |\n", board.name);
            }
        }
        if board.name != "microbit" {
            continue;
        }
        for (name, budget) in HOPPING {
            let line = said.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
            let most = line.and_then(|line| line.split(' ').nth(1)?.parse::<u32>().ok());
            let most =
                most.ok_or_else(|| Trouble::Failed(format!("{}: hopping-instructions said {said}", board.name)))?;
            if exceeds(most.into(), budget.into()) {
                over.push(format!("hopping, {name}: {most} instructions; the budget is {budget}"));
            }
        }
        if exceeds(flash, HOPPING_FLASH) || exceeds(ram, HOPPING_RAM) {
            let budget = format!("{HOPPING_FLASH} and {HOPPING_RAM}");
            over.push(format!("hopping: {flash} bytes of flash and {ram} of RAM; the budget is {budget}"));
        }
        if let Some(bytes) = worst("ring_poll").filter(|&bytes| exceeds(bytes, HOPPING_STACK)) {
            over.push(format!("hopping, a poll: {bytes} bytes of stack; the budget is {HOPPING_STACK}"));
        }
    }
    tables.insert("hopping size", sizes);
    tables.insert("hopping instructions", calls);
    Ok(over)
}

/// The compiler that a board's figures are of, as "rustc 1.95".
fn compiler(board: &Board) -> Result<String, Trouble> {
    let debian = cargo(board)?.get_program() == "/usr/bin/cargo";
    let rustc = if debian { "/usr/bin/rustc" } else { "rustc" };
    let said = output(Command::new(rustc).arg("--version")).unwrap_or_default();
    let version = said.strip_prefix("rustc ").and_then(|rest| rest.split('.').nth(1).map(|minor| (rest, minor)));
    let (rest, minor) = version.ok_or_else(|| Trouble::Failed(format!("{rustc} --version says {said}")))?;
    let major = rest.split('.').next().unwrap_or_default();
    Ok(format!("rustc {major}.{minor}"))
}

/// `cargo` for a board, in the firmware's own workspace.
fn cargo(board: &Board) -> Result<Command, Trouble> {
    let mut cargo = cargo_for_target(board.target)?;
    cargo.current_dir("firmware");
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

/// The boards' rings in the simulated world, in lock step with the host's; the tables that come of it.
fn in_the_loop(program: &str, arguments: &[&str]) -> Result<String, Trouble> {
    crate::program::build(&["--bin", HARNESS])?;
    let mut harness = Command::new(format!("target/debug/{HARNESS}{EXE_SUFFIX}"));
    harness.arg("scenes/alcove-hc-sr04.toml").args(arguments);
    for board in &BOARDS {
        let qemu = emulator(board, &image(board, program)?, 6);
        harness.args(["--board", board.name]).arg(qemu.get_program()).args(qemu.get_args());
    }
    let what = |why: &dyn std::fmt::Display| Trouble::Failed(format!("hardware in the loop: {why}"));
    let said = harness.stderr(Stdio::inherit()).output().map_err(|error| what(&error))?;
    let tables = String::from_utf8_lossy(&said.stdout).into_owned();
    if said.status.success() { Ok(tables) } else { Err(what(&said.status)) }
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
    let design = ["design", "rings/hc-sr04-8.toml", "--emit", "c"];
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

/// The worst stack of each public function of the ring in an image, over all calls it can lead to: the compiler writes
/// the size of each frame, the disassembly says who calls whom.
fn stack(board: &Board, name: &str) -> Result<Vec<(String, u64)>, Trouble> {
    let mut cargo = cargo(board)?;
    let target_dir = cargo.get_envs().find(|(key, _)| *key == "CARGO_TARGET_DIR").and_then(|(_, value)| value);
    let target_dir = target_dir.map_or(PathBuf::from("target"), PathBuf::from).join("stack");
    cargo.args(["build", "--quiet", "--release", "--locked", "--target", board.target]);
    cargo.args(["--package", "eeruf-measure", "--bin", name]);
    // An unstable option of the compiler.
    cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_TARGET_DIR", &target_dir);
    run(cargo.env("RUSTFLAGS", "-Clink-arg=-Tlink.x -Zemit-stack-sizes"))?;
    let image = Path::new("firmware").join(target_dir).join(board.target).join("release").join(name);

    let mut frames = BTreeMap::new();
    for line in llvm("readelf", &["--stack-sizes"], &image)?.lines() {
        if let Some((bytes, names)) = line.trim().split_once(char::is_whitespace)
            && let Ok(bytes) = bytes.parse::<u64>()
        {
            frames.extend(names.trim().split(", ").map(|name| (name.to_owned(), bytes)));
        }
    }
    let mut calls: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut caller = String::new();
    for line in llvm("objdump", &["-d", "--no-show-raw-insn"], &image)?.lines() {
        if let Some(name) = line.strip_suffix(">:").and_then(|line| line.split_once('<')) {
            name.1.clone_into(&mut caller);
            continue;
        }
        // A branch within a function has an offset; to another one it is a call.
        let Some((_, callee)) = line.rsplit_once('<') else { continue };
        let callee = callee.split_once('>').map_or(callee, |(callee, _)| callee);
        if !callee.contains('+') && callee != caller {
            calls.entry(caller.clone()).or_default().insert(callee.to_owned());
        }
    }
    let public: Vec<String> =
        frames.keys().filter(|name| name.starts_with("ring_") && *name != "ring_program").cloned().collect();
    Ok(public.into_iter().map(|name| (name.clone(), worst(&name, &frames, &calls, 0))).collect())
}

/// The calls are a tree: core has no recursion. A path deeper than any there is would be one, and counts as endless.
fn worst(name: &str, frames: &BTreeMap<String, u64>, calls: &BTreeMap<String, BTreeSet<String>>, depth: u32) -> u64 {
    if depth > 64 {
        return u64::MAX / 2;
    }
    let below = calls.get(name).into_iter().flatten().map(|callee| worst(callee, frames, calls, depth + 1)).max();
    frames.get(name).copied().unwrap_or(0) + below.unwrap_or(0)
}
