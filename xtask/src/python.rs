//! `cargo xtask python`: builds the wheel once, installs it into a virtual environment of its own, and runs its tests,
//! types and examples, and the comparison with Rust.

use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf, absolute};
use std::process::{Command, Stdio};

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use crate::steps::{empty, need, run};

/// The environment of the tests.
const HOME: &str = "target/python";

/// Runs everything about the Python package.
pub(crate) fn python() -> Result<()> {
    let home = Path::new(HOME);
    let python = tested()?;
    let wheels = home.join("wheels");
    // The folder then has only the wheel of this build.
    empty(&wheels)?;
    let tool = |name: &str| {
        let mut command = Command::new(&python);
        command.args(["-m", name]);
        command
    };
    let wheel = wheel(&python, &wheels)?;
    sources_are_whole(&python, &home.join("sources"))?;
    run(tool("pip").args(["install", "--quiet", "--force-reinstall", "--no-deps"]).arg(&wheel))?;
    let backend = ["packaging/backend.py", "packaging/finish.py"];
    let sources = ["python", "tests/python", "benches/python", "examples/raspberry-pi"];
    run(tool("ruff").arg("check").args(backend).args(sources))?;
    run(tool("ruff").args(["format", "--check"]).args(backend).args(sources))?;
    let typed = ["tests/python", "benches/python", "examples/raspberry-pi"];
    run(tool("mypy").args(backend).args(typed))?;
    run(tool("mypy.stubtest").args(["eeruf", "--ignore-missing-stub", "--mypy-config-file", "pyproject.toml"]))?;
    fresh(&wheel)?;
    // Python is compared with the program, and with the paths of the corpus.
    let (program, lab) = (crate::toolchain::program()?, crate::toolchain::lab()?);
    let mut tests = tool("pytest");
    tests.args(["--numprocesses", "auto"]);
    tests.env("EERUF_WHEEL", &wheel).env("EERUF_PROGRAM", program).env("EERUF_LAB", lab);
    run(&mut tests)
}

/// Builds the wheel as pip does from a clone, by the repository's own backend, into an empty folder.
fn wheel(python: &Path, folder: &Path) -> Result<PathBuf> {
    let mut pip = Command::new(python);
    pip.args(["-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", ".", "--wheel-dir"]).arg(folder);
    // The backend calls maturin by its name.
    let programs = absolute(python.with_file_name(""))?;
    let others = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&others)))?;
    run(pip.env("MATURIN_PEP517_ARGS", "--locked").env("PATH", path))?;
    only_file(folder)
}

/// Packs the sources, and has Cargo read their manifests outside the repository by checking the smallest package: an
/// error names a file that was not packed. `release` builds all of it.
fn sources_are_whole(python: &Path, folder: &Path) -> Result<()> {
    empty(folder)?;
    run(Command::new(python).args(["-m", "maturin", "sdist", "--out"]).arg(folder))?;
    let packed = only_file(folder)?;
    run(Command::new(python).args(["-m", "tarfile", "-e"]).arg(&packed).arg(folder))?;
    fs::remove_file(&packed)?;
    let manifest = only_file(folder)?.join("Cargo.toml");
    run(Command::new("cargo").args(["check", "--quiet", "--package", "eeruf-core", "--manifest-path"]).arg(manifest))
}

/// Writes the reference from docstrings and stubs into a folder: of the wheel that `EERUF_WHEEL` names, or of one built
/// now.
pub(crate) fn reference(folder: &Path) -> Result<()> {
    let wheel = std::env::var("EERUF_WHEEL").unwrap_or_else(|_| ".".to_owned());
    // Annotations name types of these packages.
    let packages = ["--force-reinstall", "pdoc", "pandas", "polars", &format!("{wheel}[plot]")];
    let python = environment(Path::new("target/python-reference"), &packages)?;
    run(Command::new(&python).arg("xtask/reference.py").arg(folder))
}

/// Builds the wheel and the source distribution into a folder, and tries each in an empty environment.
pub(crate) fn distributions(folder: &Path) -> Result<()> {
    let python = tested()?;
    empty(folder)?;
    let built = wheel(&python, &folder.join("whl"))?;
    let sources = folder.join("gz");
    run(Command::new(&python).args(["-m", "maturin", "sdist", "--out"]).arg(&sources))?;
    for distribution in [&built, &only_file(&sources)?] {
        fresh(distribution)?;
    }
    let python = environment(Path::new(HOME), &["abi3audit"])?;
    run(Command::new(&python).args(["-m", "abi3audit", "--strict"]).arg(built))
}

/// Makes a virtual environment with these packages of `PyPI`; returns its Python.
pub(crate) fn environment(home: &Path, packages: &[&str]) -> Result<PathBuf> {
    need("python3 -c __import__('ensurepip')", "apt install python3-venv")?;
    let python = interpreter(home);
    if !python.exists() {
        run(Command::new("python3").args(["-m", "venv"]).arg(home))?;
    }
    run(Command::new(&python)
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile"])
        .args(packages))?;
    Ok(python)
}

/// Makes the environment with the tests' packages; returns its Python.
fn tested() -> Result<PathBuf> {
    let home = Path::new(HOME);
    // pip reads dependency groups since 25.1.
    environment(home, &["--upgrade", "pip>=25.1"])?;
    environment(home, &["--group", "test", "numpy"])
}

/// Tries a user's first steps in an empty environment: the wheel or the source distribution, README's lines, and the
/// program that comes with it.
pub(crate) fn fresh(distribution: &Path) -> Result<()> {
    let home = Path::new("target/python-fresh");
    empty(home)?;
    let python = environment(home, &[&format!("{}[plot]", distribution.display())])?;
    run(Command::new(&python).args(["-c", README_LINES]).env("MPLBACKEND", "Agg"))?;
    let program = absolute(python.with_file_name(format!("eeruf{EXE_SUFFIX}")))?;
    run(Command::new(&program).arg("--version"))?;
    run(Command::new(&program).arg("examples").arg(home))?;
    let study = ["study", "scenes/alcove.toml", "--periods", "100"];
    run(Command::new(&program).args(study).current_dir(home).stdout(Stdio::null()))?;
    run(Command::new(&python).args(["-m", "eeruf", "--help"]).stdout(Stdio::null()))?;
    tutorial(home, &program)
}

/// Runs the tutorial's commands, without those that install, in a folder where a user has the program and no clone.
fn tutorial(home: &Path, program: &Path) -> Result<()> {
    let text = fs::read_to_string("docs/tutorial/ring.md")?;
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let commands: Vec<_> = blocks.flat_map(str::lines).filter(|line| !line.contains(" install ")).collect();
    let here = std::env::var_os("PATH").unwrap_or_default();
    let folders = program.parent().map(Path::to_owned).into_iter().chain(std::env::split_paths(&here));
    let path = std::env::join_paths(folders)?;
    for command in &commands {
        println!("$ {command}");
        let mut shell = Command::new("sh");
        run(shell.args(["-c", command]).current_dir(home).env("PATH", &path).stdout(Stdio::null()))?;
    }
    ensure!(commands.len() >= 3, "few commands in the tutorial: {commands:?}");
    Ok(())
}

const README_LINES: &str = r#"
import os, pathlib, re
lines = re.search(r"^## In Python$.*?^```python\n(.*?)^```$", pathlib.Path("README.md").read_text(), re.M | re.S)[1]
others = re.search(r"^```python\n(.*?)^```$", pathlib.Path("python/README.md").read_text(), re.M | re.S)[1]
os.chdir("target/python-fresh")
exec(others)
exec(lines)
eeruf.plot.timing(eeruf.tables.TABLE_I_D, window_us=36_000).figure.savefig("timing.png")
assert pathlib.Path("timing.png").stat().st_size > 5_000
"#;

pub(crate) fn interpreter(home: &Path) -> PathBuf {
    home.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

pub(crate) fn only_file(folder: &Path) -> Result<PathBuf> {
    let found = fs::read_dir(folder)?.next().with_context(|| format!("no file in {}", folder.display()))?;
    Ok(found?.path())
}
