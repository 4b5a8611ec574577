//! `cargo xtask dist`: wheels for Linux and static programs for a release.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::python::{environment, interpreter, only_file};
use crate::steps::{Steps, empty, need, output, run, run_line, skip};
use crate::toolchain::{DEBIAN_CARGO, DEBIAN_RUSTC, has_library};

/// Targets: Rust's name, and the oldest system that the wheel is for.
const TARGETS: [(&str, &str); 4] = [
    ("x86_64-unknown-linux-gnu", "manylinux2014"),
    ("x86_64-unknown-linux-musl", "musllinux_1_2"),
    ("aarch64-unknown-linux-gnu", "manylinux2014"),
    ("aarch64-unknown-linux-musl", "musllinux_1_2"),
];
/// Commands that the programs for all targets must answer in the same way.
const SAY_ALIKE: [&[&str]; 3] = [
    &["--version"],
    &["design", "rings/hc-sr04-8.toml", "--no-atlas", "--period-only", "--emit", "c"],
    &["study", "scenes/alcove-hc-sr04.toml", "--periods", "100"],
];
/// The environment of the tools from `PyPI`: maturin, zig as linker and compiler of C for any system, abi3audit.
const TOOLS: &str = "target/dist-tools";

#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Build for this target alone; may be given several times
    #[arg(long = "target", value_name = "TARGET", value_parser = TARGETS.map(|(name, _)| name))]
    targets: Vec<String>,
}

pub(crate) fn dist(plan: &Plan, steps: &mut Steps) {
    let packages = ["maturin>=1.16,<2", "ziglang", "cargo-zigbuild", "abi3audit"];
    if steps.step("tools", || environment(Path::new(TOOLS), &packages)).is_none() {
        return;
    }
    steps.step("notices", crate::release::notices);
    steps.step("docstrings", || run_line("cargo build --quiet --locked --package eeruf-py"));
    let (mut files, mut answers) = (Vec::new(), None);
    for (target, system) in TARGETS {
        if !plan.targets.is_empty() && !plan.targets.iter().any(|wanted| wanted == target) {
            continue;
        }
        files.extend(steps.step(&format!("wheel for {target}"), || {
            let wheel = wheel(target, system)?;
            run(Command::new(tool("python")).args(["-m", "abi3audit", "--strict"]).arg(&wheel))?;
            if target == "x86_64-unknown-linux-gnu" && cfg!(all(target_arch = "x86_64", target_env = "gnu")) {
                crate::python::fresh(&wheel)?;
            }
            Ok(wheel)
        }));
        if target.ends_with("-musl") {
            files.extend(steps.step(&format!("program for {target}"), || {
                let program = program(target)?;
                stands_alone(&program)?;
                if let Some(said) = says(&program, target)? {
                    let before = answers.get_or_insert_with(|| said.clone());
                    ensure!(*before == said, "it says something else than the one before");
                }
                Ok(program)
            }));
        }
    }
    steps.step("sizes and sums", || {
        for file in &files {
            println!("{} bytes", fs::metadata(file)?.len());
            run(Command::new("sha256sum").arg(file))?;
        }
        Ok(())
    });
}

/// A program of the tools' environment.
fn tool(name: &str) -> PathBuf {
    interpreter(&env::current_dir().unwrap_or_default().join(TOOLS)).with_file_name(name)
}

/// A compiler that has the libraries of a target, or builds them.
struct Compiler {
    /// Environment variables of a build by this compiler.
    environment: Vec<(&'static str, &'static str)>,
    /// Folder of the builds; compilers from different places must not share one.
    target_folder: &'static str,
}

impl Compiler {
    /// The default compiler if it has the target; else the one whose sources of the standard library are installed.
    fn of(target: &str) -> Result<Self> {
        let has_sources = |root: &Path| root.join("lib/rustlib/src/rust/library/Cargo.lock").exists();
        if has_library("std", target) {
            return Ok(Self { environment: vec![], target_folder: "target" });
        }
        let from_sources = vec![("RUSTC_BOOTSTRAP", "1"), ("CARGO_UNSTABLE_BUILD_STD", "std,panic_unwind")];
        if has_sources(Path::new(&output(Command::new("rustc").args(["--print", "sysroot"]))?)) {
            return Ok(Self { environment: from_sources, target_folder: "target" });
        }
        if [DEBIAN_CARGO, DEBIAN_RUSTC].iter().all(|path| Path::new(path).exists()) && has_sources(Path::new("/usr")) {
            let debian = vec![("CARGO", DEBIAN_CARGO), ("RUSTC", DEBIAN_RUSTC)];
            return Ok(Self { environment: [from_sources, debian].concat(), target_folder: "target/debian" });
        }
        skip(format!(
            "no standard library for {target}; try: rustup target add {target}, or rustup component add rust-src, or \
             Debian's rustc-web, cargo-web and rust-web-src"
        ))
    }

    /// Sets up a reproducible build: paths are relative to the folder, times are the commit's.
    fn set_up(&self, command: &mut Command) -> Result<()> {
        let root = env::current_dir()?;
        let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
        let cargo = env::var_os("CARGO_HOME").map_or(home.join(".cargo"), PathBuf::from);
        let flags = [(&cargo, "/cargo"), (&root, "/eeruf")]
            .map(|(from, to)| format!("--remap-path-prefix={}={to}", from.display()));
        let mut flags = flags.join(" ");
        if !self.environment.is_empty() {
            // The sources have no start-up files of musl; zig has them.
            flags += " -Clink-self-contained=no";
        }
        let time = output(Command::new("git").args(["log", "-1", "--format=%ct"]))?;
        let mut path = vec![tool("")];
        // maturin and zigbuild call compilers by their bare names.
        path.extend((self.target_folder != "target").then(|| PathBuf::from("/usr/bin")));
        path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
        command
            .envs(self.environment.iter().copied())
            .env("CARGO_TARGET_DIR", root.join(self.target_folder))
            .env("RUSTFLAGS", flags)
            .env("CFLAGS", format!("-ffile-prefix-map={}=/cargo", cargo.display()))
            .env("SOURCE_DATE_EPOCH", time)
            .env("PATH", env::join_paths(path)?);
        Ok(())
    }
}

/// Builds the wheel, and packs it reproducibly. Its stub takes the docstrings of a module that this machine can load,
/// since the wheel's own may be for another machine.
fn wheel(target: &str, system: &str) -> Result<PathBuf> {
    let compiler = Compiler::of(target)?;
    let to = Path::new("target/dist").join(target);
    empty(&to)?;
    let mut maturin = Command::new(tool("maturin"));
    maturin.args(["build", "--locked", "--zig", "--target", target, "--compatibility", system, "--out"]).arg(&to);
    compiler.set_up(&mut maturin)?;
    run(&mut maturin)?;
    let wheel = only_file(&to)?;
    run(Command::new(tool("python")).arg("packaging/finish.py").arg(&wheel).arg("target/debug/lib_eeruf.so"))?;
    Ok(wheel)
}

/// Builds the program.
fn program(target: &str) -> Result<PathBuf> {
    let compiler = Compiler::of(target)?;
    let mut cargo = Command::new("cargo");
    cargo.args(["zigbuild", "--locked", "--profile", "wheel", "--package", "eeruf", "--target", target]);
    compiler.set_up(&mut cargo)?;
    run(&mut cargo)?;
    Ok(Path::new(compiler.target_folder).join(target).join("wheel/eeruf"))
}

/// Fails if a program needs a library or a loader.
fn stands_alone(program: &Path) -> Result<()> {
    need("readelf --version", "apt install binutils")?;
    let said = output(Command::new("readelf").args(["--wide", "--program-headers", "--dynamic"]).arg(program))?;
    let needs: Vec<_> = said.lines().filter(|line| line.contains("(NEEDED)") || line.contains("INTERP")).collect();
    ensure!(needs.is_empty(), "it is not static: {needs:?}");
    Ok(())
}

/// Returns the output of a program, here or in an emulator; `None` if neither can run it.
fn says(program: &Path, target: &str) -> Result<Option<Vec<String>>> {
    let (architecture, _) = target.split_once('-').unwrap_or((target, ""));
    let emulator = format!("qemu-{architecture}");
    let emulated = architecture != env::consts::ARCH;
    if emulated && output(Command::new(&emulator).arg("--version")).is_err() {
        println!("not run: no {emulator}; try: apt install qemu-user");
        return Ok(None);
    }
    let said = |words: &&[&str]| {
        let mut command = if emulated { Command::new(&emulator) } else { Command::new(program) };
        command.args(emulated.then_some(program)).args(*words);
        let said = output(&mut command)?;
        println!("{command:?}: {} bytes", said.len());
        Ok(said)
    };
    SAY_ALIKE.iter().map(said).collect::<Result<_>>().map(Some)
}
