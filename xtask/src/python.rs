//! `cargo xtask python`: builds the wheel once, installs it into a virtual environment of its own, and holds it against
//! its tests, its types and its examples, and against what Rust says.

use std::collections::BTreeMap;
use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::steps::{Trouble, output, run};

/// Options by which maturin makes a wheel: packed as tight as its format can, which takes a second and saves a
/// fortieth.
pub(crate) const BUILD: [&str; 4] = ["build", "--locked", "--compression-level", "9"];

/// Everything about the Python package.
pub(crate) fn python() -> Result<(), Trouble> {
    let home = PathBuf::from("target/python");
    let python = environment(&home)?;
    let wheels = home.join("wheels");
    // Only the wheel that is built now.
    remove(&wheels)?;
    let tool = |name: &str| {
        let mut command = Command::new(&python);
        command.args(["-m", name]);
        command
    };
    run(tool("maturin").args(BUILD).arg("--out").arg(&wheels))?;
    let wheel = only_file(&wheels)?;
    sources_are_whole(&python, &home)?;
    run(tool("pip").args(["install", "--quiet", "--force-reinstall", "--no-deps"]).arg(&wheel))?;
    let sources = ["python", "tests/python", "benches/python", "benches/leaderboard", "examples/raspberry-pi"];
    run(tool("ruff").arg("check").args(sources))?;
    run(tool("ruff").args(["format", "--check"]).args(sources))?;
    let typed = ["tests/python", "benches/python", "benches/leaderboard/leaderboard.py", "examples/raspberry-pi"];
    run(tool("mypy").args(typed))?;
    run(tool("mypy.stubtest").args(["eeruf", "--ignore-missing-stub", "--mypy-config-file", "pyproject.toml"]))?;
    fresh(Path::new("python3"), &wheel)?;
    // What Python is held against: the program, and the paths of the corpus.
    let (program, lab) = (crate::program::program()?, crate::program::lab()?);
    let mut tests = tool("pytest");
    tests.args(["--numprocesses", "auto"]);
    tests.env("EERUF_WHEEL", &wheel).env("EERUF_PROGRAM", program).env("EERUF_LAB", lab);
    run(&mut tests)
}

/// Packs the sources, and has Cargo read their manifests away from the repository by checking the least package: what
/// it cannot read names a file that was not packed. Building all of it is left to `release`.
fn sources_are_whole(python: &Path, home: &Path) -> Result<(), Trouble> {
    let folder = home.join("sources");
    remove(&folder)?;
    run(Command::new(python).args(["-m", "maturin", "sdist", "--out"]).arg(&folder))?;
    let packed = only_file(&folder)?;
    run(Command::new(python).args(["-m", "tarfile", "-e"]).args([&packed, &folder]))?;
    fs::remove_file(&packed).map_err(|error| Trouble::Failed(format!("{}: {error}", packed.display())))?;
    let manifest = only_file(&folder)?.join("Cargo.toml");
    run(Command::new("cargo").args(["check", "--quiet", "--package", "eeruf-check", "--manifest-path"]).arg(manifest))
}

/// Removes a folder that an earlier run left, if there is one.
fn remove(folder: &Path) -> Result<(), Trouble> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(Trouble::Failed(format!("{}: {error}", folder.display())))
        }
        _ => Ok(()),
    }
}

/// Writes the reference, made of docstrings and stubs, into a folder: of the wheel that `EERUF_WHEEL` names, or of one
/// that is built now.
pub(crate) fn reference(folder: &Path) -> Result<(), Trouble> {
    let home = Path::new("target/python-reference");
    if !interpreter(home).exists() {
        run(Command::new("python3").args(["-m", "venv"]).arg(home))?;
    }
    let python = interpreter(home);
    let wheel = std::env::var("EERUF_WHEEL").unwrap_or_else(|_| ".".to_owned());
    let wheel = format!("{wheel}[plot]");
    // Annotations name what they come from.
    let packages = ["pdoc", "pandas", "polars", &wheel];
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--force-reinstall"]).args(packages))?;
    run(Command::new(&python).arg("xtask/reference.py").arg(folder))
}

/// Builds the wheel and the source distribution into a folder, and tries each in an empty environment.
pub(crate) fn distributions(folder: &Path) -> Result<(), Trouble> {
    let python = environment(Path::new("target/python"))?;
    remove(folder)?;
    for (verb, ending) in [(&BUILD[..], "whl"), (&["sdist"], "gz")] {
        let to = folder.join(ending);
        run(Command::new(&python).args(["-m", "maturin"]).args(verb).arg("--out").arg(&to))?;
        fresh(Path::new("python3"), &only_file(&to)?)?;
    }
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "abi3audit"]))?;
    run(Command::new(&python).args(["-m", "abi3audit", "--strict"]).arg(only_file(&folder.join("whl"))?))
}

/// A virtual environment with what the tests need; its Python.
fn environment(home: &Path) -> Result<PathBuf, Trouble> {
    if output(Command::new("python3").args(["-c", "import venv, ensurepip"])).is_none() {
        return Err(Trouble::Skipped("python3 with venv is not installed".to_owned()));
    }
    let python = interpreter(home);
    if !python.exists() {
        run(Command::new("python3").args(["-m", "venv"]).arg(home))?;
    }
    // pip reads dependency groups since 25.1.
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--upgrade", "pip>=25.1"]))?;
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--group", "test", "numpy"]))?;
    Ok(python)
}

/// A user's first steps: the wheel, or the source distribution, in an empty environment, the README's lines, and the
/// program that came along.
fn fresh(python: &Path, distribution: &Path) -> Result<(), Trouble> {
    let home = Path::new("target/python-fresh");
    run(Command::new(python).args(["-m", "venv", "--clear"]).arg(home))?;
    let python = interpreter(home);
    run(Command::new(&python)
        .args(["-m", "pip", "install", "--quiet"])
        .arg(format!("{}[plot]", distribution.display())))?;
    run(Command::new(&python).args(["-c", README_LINES]).env("MPLBACKEND", "Agg"))?;
    let program = std::path::absolute(python.with_file_name(format!("eeruf{EXE_SUFFIX}")))
        .map_err(|error| Trouble::Failed(error.to_string()))?;
    run(Command::new(&program).arg("--version"))?;
    run(Command::new(&program).arg("examples").arg(home))?;
    let study = ["study", "scenes/alcove.toml", "--periods", "100"];
    run(Command::new(&program).args(study).current_dir(home).stdout(std::process::Stdio::null()))?;
    run(Command::new(&python).args(["-m", "eeruf", "--help"]).stdout(std::process::Stdio::null()))?;
    tutorial(home, &program)
}

/// Runs what the tutorial says to type, but for how to install, in a folder where a user has the program and no clone.
fn tutorial(home: &Path, program: &Path) -> Result<(), Trouble> {
    let text = fs::read_to_string("docs/tutorial/ring.md").map_err(|error| Trouble::Failed(error.to_string()))?;
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let commands: Vec<_> = blocks.flat_map(str::lines).filter(|line| !line.contains(" install ")).collect();
    let here = std::env::var_os("PATH").unwrap_or_default();
    let folders = program.parent().map(Path::to_owned).into_iter().chain(std::env::split_paths(&here));
    let path = std::env::join_paths(folders).map_err(|error| Trouble::Failed(error.to_string()))?;
    for command in &commands {
        println!("$ {command}");
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).current_dir(home).env("PATH", &path).stdout(std::process::Stdio::null());
        run(&mut shell)?;
    }
    if commands.len() < 3 {
        Err(Trouble::Failed(format!("few commands in the tutorial: {commands:?}")))
    } else {
        Ok(())
    }
}

const README_LINES: &str = r#"
import os, pathlib, re
lines = re.search(r"^## In Python$.*?^```python\n(.*?)^```$", pathlib.Path("README.md").read_text(), re.M | re.S)[1]
others = re.search(r"^```python\n(.*?)^```$", pathlib.Path("python/README.md").read_text(), re.M | re.S)[1]
os.chdir("target/python-fresh")
exec(others)
exec(lines)
eeruf.plot.timing(found.schedule, window_us=36_000).figure.savefig("timing.png")
assert pathlib.Path("timing.png").stat().st_size > 5_000
"#;

/// Installs a wheel under each CPython from 3.9 on that is at hand, and runs README's lines and the program.
pub(crate) fn under_each_python(wheel: &Path) -> Result<(), Trouble> {
    let home = PathBuf::from(std::env::var_os("HOME").unwrap_or_default());
    let kept = [home.join(".pyenv/versions"), home.join(".local/share/uv/python")];
    let kept = kept.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let named = (9..20).map(|minor| PathBuf::from(format!("python3.{minor}")));
    let mut found = BTreeMap::new();
    for python in named.chain(kept.map(|entry| entry.path().join("bin/python3"))) {
        let says = "import sys; print(sys.version_info[1] if sys.implementation.name == 'cpython' else 0)";
        let minor = output(Command::new(&python).args(["-c", says])).and_then(|said| said.parse::<u32>().ok());
        if let Some(minor) = minor.filter(|minor| *minor >= 9) {
            found.entry(minor).or_insert(python);
        }
    }
    for (minor, python) in &found {
        println!("CPython 3.{minor}");
        fresh(python, wheel)?;
    }
    if found.is_empty() { Err(Trouble::Skipped("no CPython from 3.9 on".to_owned())) } else { Ok(()) }
}

fn interpreter(home: &Path) -> PathBuf {
    home.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

pub(crate) fn only_file(folder: &Path) -> Result<PathBuf, Trouble> {
    let found = fs::read_dir(folder).ok().and_then(|mut entries| entries.next()).and_then(Result::ok);
    found.map(|entry| entry.path()).ok_or_else(|| Trouble::Failed(format!("no wheel in {}", folder.display())))
}
