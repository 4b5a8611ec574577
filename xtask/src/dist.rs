//! `cargo xtask dist`: wheels for Linux and static programs, as a release has them, and whether two builds are alike.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Steps, Trouble, output, run};

/// Targets: Rust's name, and the oldest system that the wheel is for.
const TARGETS: [(&str, &str); 4] = [
    ("x86_64-unknown-linux-gnu", "manylinux2014"),
    ("x86_64-unknown-linux-musl", "musllinux_1_2"),
    ("aarch64-unknown-linux-gnu", "manylinux2014"),
    ("aarch64-unknown-linux-musl", "musllinux_1_2"),
];
/// Where the files of a release lie.
const DIST: &str = "target/dist";
/// Commands that the programs for all targets must answer alike.
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
    #[arg(long = "target", value_name = "TARGET")]
    targets: Vec<String>,
    /// Build all a second time, from a clone in another folder, and say what differs
    #[arg(long)]
    twice: bool,
}

pub(crate) fn dist(plan: &Plan, steps: &mut Steps) {
    if let Some(unknown) = plan.targets.iter().find(|target| TARGETS.iter().all(|(name, _)| name != target)) {
        let names = TARGETS.map(|(name, _)| name).join(", ");
        return steps.step("targets", || Err(Trouble::Failed(format!("{unknown:?}: expected one of {names}"))));
    }
    let mut tools_there = false;
    steps.step("tools", || {
        tools()?;
        tools_there = true;
        Ok(())
    });
    if !tools_there {
        return;
    }
    steps.step("notices", crate::release::notices);
    let (mut first, mut answers) = (Vec::new(), None);
    for (target, system) in TARGETS {
        if !plan.targets.is_empty() && !plan.targets.iter().any(|wanted| wanted == target) {
            continue;
        }
        steps.step(&format!("wheel for {target}"), || {
            let wheel = wheel(Path::new("."), target, system)?;
            run(Command::new(tool("python")).args(["-m", "abi3audit", "--strict"]).arg(&wheel))?;
            if target == "x86_64-unknown-linux-gnu" && cfg!(all(target_arch = "x86_64", target_env = "gnu")) {
                crate::python::under_each_python(&wheel)?;
            }
            first.push((target, system, wheel));
            Ok(())
        });
        if target.ends_with("-musl") {
            steps.step(&format!("program for {target}"), || {
                let program = program(Path::new("."), target)?;
                stands_alone(&program)?;
                if let Some(said) = says(&program, target)? {
                    let before = answers.get_or_insert_with(|| said.clone());
                    if *before != said {
                        return Err(Trouble::Failed("it says something else than the one before".to_owned()));
                    }
                }
                first.push((target, "", program));
                Ok(())
            });
        }
    }
    steps.step("sizes and sums", || {
        for (.., file) in &first {
            println!("{} bytes", fs::metadata(file).map_or(0, |file| file.len()));
            run(Command::new("sha256sum").arg(file))?;
        }
        Ok(())
    });
    if plan.twice {
        steps.step("a second time, in another folder", || again(&first));
    }
}

/// A program of the tools' environment.
fn tool(name: &str) -> PathBuf {
    env::current_dir().unwrap_or_default().join(TOOLS).join("bin").join(name)
}

fn tools() -> Result<(), Trouble> {
    if !tool("python").exists() {
        run(Command::new("python3").args(["-m", "venv", TOOLS]))?;
    }
    let packages = ["maturin>=1.16,<2", "ziglang", "cargo-zigbuild", "abi3audit"];
    run(Command::new(tool("python")).args(["-m", "pip", "install", "--quiet"]).args(packages))
}

/// A compiler that has the libraries of a target, or makes them.
struct Compiler {
    /// Environment of a build that makes it be taken.
    environment: Vec<(&'static str, &'static str)>,
    /// Compilers that come from different places must not share a folder.
    target_folder: &'static str,
}

impl Compiler {
    /// The compiler at hand, where it has the target; else the one whose sources of the standard library are here.
    fn of(target: &str) -> Result<Self, Trouble> {
        let printed = |what: &str| output(Command::new("rustc").args(["--print", what, "--target", target]));
        let has_std = |folder: String| {
            let mut entries = Path::new(&folder).read_dir().ok()?.flatten();
            Some(entries.any(|entry| entry.file_name().to_string_lossy().starts_with("libstd-")))
        };
        let has_sources = |root: &Path| root.join("lib/rustlib/src/rust/library/Cargo.lock").exists();
        if printed("target-libdir").and_then(has_std) == Some(true) {
            return Ok(Self { environment: vec![], target_folder: "target" });
        }
        let from_sources = vec![("RUSTC_BOOTSTRAP", "1"), ("CARGO_UNSTABLE_BUILD_STD", "std,panic_unwind")];
        if printed("sysroot").is_some_and(|root| has_sources(Path::new(&root))) {
            return Ok(Self { environment: from_sources, target_folder: "target" });
        }
        if ["/usr/bin/cargo", "/usr/bin/rustc"].iter().all(|path| Path::new(path).exists())
            && has_sources(Path::new("/usr"))
        {
            let debian = vec![("CARGO", "/usr/bin/cargo"), ("RUSTC", "/usr/bin/rustc")];
            return Ok(Self { environment: [from_sources, debian].concat(), target_folder: "target/debian" });
        }
        Err(Trouble::Skipped(format!(
            "no standard library for {target}; try: rustup target add {target}, or rustup component add rust-src, or \
             Debian's rustc-web, cargo-web and rust-web-src"
        )))
    }

    /// A build with it in this folder, like one in any other: paths are named from it, times are the commit's.
    fn set_up(&self, command: &mut Command, folder: &Path) -> Result<(), Trouble> {
        let folder = std::path::absolute(folder).map_err(|error| Trouble::Failed(error.to_string()))?;
        let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
        let cargo = env::var_os("CARGO_HOME").map_or(home.join(".cargo"), PathBuf::from);
        let root = folder.components().collect::<PathBuf>();
        let flags = [(&cargo, "/cargo"), (&root, "/eeruf")]
            .map(|(from, to)| format!("--remap-path-prefix={}={to}", from.display()));
        let mut flags = flags.join(" ");
        if !self.environment.is_empty() {
            // Sources bring no start-up files of musl's; zig has them.
            flags += " -Clink-self-contained=no";
        }
        let time = output(Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(&folder));
        let time = time.ok_or_else(|| Trouble::Failed("no git log to take the time from".to_owned()))?;
        let mut path = vec![tool("")];
        // maturin and zigbuild call compilers by their bare names.
        path.extend((self.target_folder != "target").then(|| PathBuf::from("/usr/bin")));
        path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
        let path = env::join_paths(path).map_err(|error| Trouble::Failed(error.to_string()))?;
        command
            .current_dir(&folder)
            .envs(self.environment.iter().copied())
            .env("CARGO_TARGET_DIR", folder.join(self.target_folder))
            .env("RUSTFLAGS", flags)
            .env("CFLAGS", format!("-ffile-prefix-map={}=/cargo", cargo.display()))
            .env("SOURCE_DATE_EPOCH", time)
            .env("PATH", path);
        Ok(())
    }
}

/// Builds the wheel from the clone in this folder, and packs it so that it is alike in any folder.
fn wheel(folder: &Path, target: &str, system: &str) -> Result<PathBuf, Trouble> {
    let compiler = Compiler::of(target)?;
    let to = folder.join(DIST).join(target);
    if to.exists() {
        fs::remove_dir_all(&to).map_err(|error| Trouble::Failed(format!("{}: {error}", to.display())))?;
    }
    let mut maturin = Command::new(tool("maturin"));
    maturin.args(crate::python::BUILD);
    maturin.args(["--zig", "--target", target, "--compatibility", system, "--out"]);
    maturin.arg(Path::new(DIST).join(target));
    compiler.set_up(&mut maturin, folder)?;
    run(&mut maturin)?;
    let wheel = crate::python::only_file(&to)?;
    run(Command::new(tool("python")).arg("xtask/repack.py").arg(&wheel))?;
    Ok(wheel)
}

/// Builds the program from the clone in this folder.
fn program(folder: &Path, target: &str) -> Result<PathBuf, Trouble> {
    let compiler = Compiler::of(target)?;
    let mut cargo = Command::new("cargo");
    cargo.args(["zigbuild", "--locked", "--profile", "wheel", "--package", "eeruf", "--target", target]);
    compiler.set_up(&mut cargo, folder)?;
    run(&mut cargo)?;
    Ok(folder.join(compiler.target_folder).join(target).join("wheel/eeruf"))
}

/// Returns true if a program needs no library and no loader.
fn stands_alone(program: &Path) -> Result<(), Trouble> {
    let said = output(Command::new("readelf").args(["--wide", "--program-headers", "--dynamic"]).arg(program))
        .ok_or_else(|| Trouble::Skipped("no readelf; try: apt install binutils".to_owned()))?;
    let needs: Vec<_> = said.lines().filter(|line| line.contains("(NEEDED)") || line.contains("INTERP")).collect();
    if needs.is_empty() { Ok(()) } else { Err(Trouble::Failed(format!("it is not static: {needs:?}"))) }
}

/// Output of a program, here or in an emulator; nothing where neither can run it.
fn says(program: &Path, target: &str) -> Result<Option<Vec<String>>, Trouble> {
    let (architecture, _) = target.split_once('-').unwrap_or((target, ""));
    let emulator = format!("qemu-{architecture}");
    let start = if architecture == env::consts::ARCH {
        Command::new(program)
    } else if output(Command::new(&emulator).arg("--version")).is_some() {
        let mut start = Command::new(emulator);
        start.arg(program);
        start
    } else {
        println!("not run: no {emulator}; try: apt install qemu-user");
        return Ok(None);
    };
    let mut answers = Vec::new();
    for words in SAY_ALIKE {
        let mut command = Command::new(start.get_program());
        let said = output(command.args(start.get_args()).args(words));
        let said = said.ok_or_else(|| Trouble::Failed(format!("{command:?}: no answer")))?;
        println!("{command:?}: {} bytes", said.len());
        answers.push(said);
    }
    Ok(Some(answers))
}

/// Builds from a clone elsewhere what was built here, and compares.
fn again(first: &[(&str, &str, PathBuf)]) -> Result<(), Trouble> {
    let folder = env::temp_dir().join("eeruf-again");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| Trouble::Failed(format!("{}: {error}", folder.display())))?;
    }
    run(Command::new("git").args(["clone", "--quiet", "."]).arg(&folder))?;
    let notices = "LICENSE-THIRD-PARTY.txt";
    if Path::new(notices).exists() {
        fs::copy(notices, folder.join(notices)).map_err(|error| Trouble::Failed(format!("{notices}: {error}")))?;
    }
    let mut differ = Vec::new();
    for (target, system, one) in first {
        let other = if system.is_empty() { program(&folder, target)? } else { wheel(&folder, target, system)? };
        differ.extend(differences(one, &other)?);
    }
    if differ.is_empty() { Ok(()) } else { Err(Trouble::Failed(format!("two builds differ in {}", differ.join(", ")))) }
}

/// The files that differ within two wheels; the name of a wheel or a program that differs for another reason.
fn differences(one: &Path, other: &Path) -> Result<Vec<String>, Trouble> {
    if one.extension().is_some_and(|ending| ending == "whl") {
        let (one, other) = (parts(one)?, parts(other)?);
        let names = one.keys().chain(other.keys()).filter(|name| one.get(*name) != other.get(*name));
        let mut names: Vec<_> = names.cloned().collect();
        names.sort();
        names.dedup();
        if !names.is_empty() {
            return Ok(names);
        }
    }
    let read = |file: &Path| fs::read(file).map_err(|error| Trouble::Failed(format!("{}: {error}", file.display())));
    Ok(if read(one)? == read(other)? { vec![] } else { vec![one.display().to_string()] })
}

/// The check sums of a wheel's files.
fn parts(wheel: &Path) -> Result<BTreeMap<String, String>, Trouble> {
    let listed = output(Command::new(tool("python")).arg("-c").arg(PARTS).arg(wheel));
    let listed = listed.ok_or_else(|| Trouble::Failed(format!("{}: not a wheel", wheel.display())))?;
    Ok(listed.lines().filter_map(|line| line.split_once(' ')).map(|(sum, name)| (name.into(), sum.into())).collect())
}

/// Prints a SHA-256 and a name for each file of a wheel.
const PARTS: &str = "
import hashlib, sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
for name in sorted(wheel.namelist()):
    print(hashlib.sha256(wheel.read(name)).hexdigest(), name)
";
