//! `cargo xtask dist`: wheels for Linux and static programs, as a release has them, and whether two builds are alike.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Steps, Trouble, output, run};

/// What is built: Rust's name, and the oldest system that the wheel is for.
const TARGETS: [(&str, &str); 4] = [
    ("x86_64-unknown-linux-gnu", "manylinux2014"),
    ("x86_64-unknown-linux-musl", "musllinux_1_2"),
    ("aarch64-unknown-linux-gnu", "manylinux2014"),
    ("aarch64-unknown-linux-musl", "musllinux_1_2"),
];
/// Where the files of a release lie.
const DIST: &str = "target/dist";
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
    let mut first = Vec::new();
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
                if target.starts_with(env::consts::ARCH) {
                    run(Command::new(&program).arg("--version"))?;
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

/// What makes a build in this folder like one in any other: paths are named from it, times are the commit's.
fn alike(command: &mut Command, folder: &Path) -> Result<(), Trouble> {
    let folder = std::path::absolute(folder).map_err(|error| Trouble::Failed(error.to_string()))?;
    let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let cargo = env::var_os("CARGO_HOME").map_or(home.join(".cargo"), PathBuf::from);
    let root = folder.components().collect::<PathBuf>();
    let flags = [(&cargo, "/cargo"), (&root, "/eeruf")]
        .map(|(from, to)| format!("--remap-path-prefix={}={to}", from.display()));
    let time = output(Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(&folder));
    let time = time.ok_or_else(|| Trouble::Failed("no git log to take the time from".to_owned()))?;
    let path = env::join_paths(
        [tool("").as_path()]
            .into_iter()
            .map(Path::to_owned)
            .chain(env::split_paths(&env::var_os("PATH").unwrap_or_default())),
    );
    command
        .current_dir(&folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("RUSTFLAGS", flags.join(" "))
        .env("CFLAGS", format!("-ffile-prefix-map={}=/cargo", cargo.display()))
        .env("SOURCE_DATE_EPOCH", time)
        .env("PATH", path.map_err(|error| Trouble::Failed(error.to_string()))?);
    Ok(())
}

/// Whether the compiler has the libraries of a target.
fn wants(target: &str) -> Result<(), Trouble> {
    let libdir = output(Command::new("rustc").args(["--print", "target-libdir", "--target", target]));
    if libdir.is_some_and(|folder| Path::new(&folder).exists()) {
        return Ok(());
    }
    Err(Trouble::Skipped(format!("no standard library for {target}; try: rustup target add {target}")))
}

/// Builds the wheel from the clone in this folder.
fn wheel(folder: &Path, target: &str, system: &str) -> Result<PathBuf, Trouble> {
    wants(target)?;
    let to = folder.join(DIST).join(target);
    if to.exists() {
        fs::remove_dir_all(&to).map_err(|error| Trouble::Failed(format!("{}: {error}", to.display())))?;
    }
    let mut maturin = Command::new(tool("maturin"));
    maturin.args(crate::python::BUILD);
    maturin.args(["--zig", "--target", target, "--compatibility", system, "--out"]);
    maturin.arg(Path::new(DIST).join(target));
    alike(&mut maturin, folder)?;
    run(&mut maturin)?;
    crate::python::only_file(&to)
}

/// Builds the program from the clone in this folder.
fn program(folder: &Path, target: &str) -> Result<PathBuf, Trouble> {
    wants(target)?;
    let mut cargo = Command::new("cargo");
    cargo.args(["zigbuild", "--locked", "--profile", "wheel", "--package", "eeruf", "--target", target]);
    alike(&mut cargo, folder)?;
    run(&mut cargo)?;
    Ok(folder.join(format!("target/{target}/wheel/eeruf")))
}

/// Whether a program needs no library and no loader.
fn stands_alone(program: &Path) -> Result<(), Trouble> {
    let said = output(Command::new("readelf").args(["--wide", "--program-headers", "--dynamic"]).arg(program))
        .ok_or_else(|| Trouble::Skipped("no readelf; try: apt install binutils".to_owned()))?;
    let needs: Vec<_> = said.lines().filter(|line| line.contains("(NEEDED)") || line.contains("INTERP")).collect();
    if needs.is_empty() { Ok(()) } else { Err(Trouble::Failed(format!("it is not static: {needs:?}"))) }
}

/// Builds from a clone elsewhere what was built here, and compares.
fn again(first: &[(&str, &str, PathBuf)]) -> Result<(), Trouble> {
    let folder = env::temp_dir().join("eeruf-again");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| Trouble::Failed(format!("{}: {error}", folder.display())))?;
    }
    run(Command::new("git").args(["clone", "--quiet", "."]).arg(&folder))?;
    let mut differ = Vec::new();
    for (target, system, one) in first {
        let other = if system.is_empty() { program(&folder, target)? } else { wheel(&folder, target, system)? };
        differ.extend(differences(one, &other)?);
    }
    if differ.is_empty() { Ok(()) } else { Err(Trouble::Failed(format!("two builds differ in {}", differ.join(", ")))) }
}

/// The parts that differ between two wheels, or the names of two programs that do.
fn differences(one: &Path, other: &Path) -> Result<Vec<String>, Trouble> {
    if one.extension().is_some_and(|ending| ending == "whl") {
        let (one, other) = (parts(one)?, parts(other)?);
        let names = one.keys().chain(other.keys()).filter(|name| one.get(*name) != other.get(*name));
        let mut names: Vec<_> = names.cloned().collect();
        names.sort();
        names.dedup();
        return Ok(names);
    }
    let read = |file: &Path| fs::read(file).map_err(|error| Trouble::Failed(format!("{}: {error}", file.display())));
    Ok(if read(one)? == read(other)? { vec![] } else { vec![one.display().to_string()] })
}

/// The check sums of a wheel's files, but for what names the folder: the bill of materials, and the record of it.
fn parts(wheel: &Path) -> Result<BTreeMap<String, String>, Trouble> {
    let listed = output(Command::new(tool("python")).arg("-c").arg(PARTS).arg(wheel));
    let listed = listed.ok_or_else(|| Trouble::Failed(format!("{}: not a wheel", wheel.display())))?;
    Ok(listed.lines().filter_map(|line| line.split_once(' ')).map(|(sum, name)| (name.into(), sum.into())).collect())
}

/// Prints a SHA-256 and a name for each file of a wheel. The bill names packages by the folder that they were built in.
const PARTS: &str = r#"
import hashlib, re, sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
for name in sorted(wheel.namelist()):
    content = wheel.read(name)
    if "/sboms/" in name:
        content = re.sub(rb"path\+file://[^#\"]*?(/crates/[a-z0-9-]+)?(?=#)", rb"path+file://\1", content)
    if name.endswith("/RECORD"):
        content = re.sub(rb"(?m)^[^,]*/sboms/.*$", b"", content)
    print(hashlib.sha256(content).hexdigest(), name)
"#;
