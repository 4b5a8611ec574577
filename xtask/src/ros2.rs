//! `cargo xtask ros2`: the ring of `firmware/hil` on an emulated board, its serial line, the node `eeruf-ros2`, and
//! Cyclone DDS and pymavlink, which must receive what the ring read.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use crate::steps::{Trouble, output, run};

/// What listens; the newest versions.
const LISTENERS: [&str; 3] = ["cyclonedds", "pymavlink", "pytest"];

pub(crate) fn ros2() -> Result<(), Trouble> {
    if !cfg!(target_os = "linux") {
        return Err(Trouble::Skipped("pseudo-terminals and sockets as Linux has them".to_owned()));
    }
    let emulator = crate::firmware::serial_board()?;
    let python = environment()?;
    let programs = ["eeruf-ros2", "eeruf-hil", "eeruf"];
    crate::program::build(&programs.map(|program| ["--bin", program]).concat())?;
    let mut tests = Command::new(python);
    tests.args(["-m", "pytest", "-o", "pythonpath=tests/ros2", "tests/ros2"]).env("EERUF_EMULATOR", emulator);
    for (program, variable) in programs.iter().zip(["EERUF_ROS2", "EERUF_HIL", "EERUF_PROGRAM"]) {
        let path = absolute(format!("target/debug/{program}{EXE_SUFFIX}"));
        tests.env(variable, path.map_err(|error| Trouble::Failed(error.to_string()))?);
    }
    run(&mut tests)
}

/// A virtual environment with those who listen; its Python.
fn environment() -> Result<PathBuf, Trouble> {
    let home = Path::new("target/ros2");
    if output(Command::new("python3").args(["-c", "import venv, ensurepip"])).is_none() {
        return Err(Trouble::Skipped("python3 with venv is not installed".to_owned()));
    }
    let python = home.join("bin/python");
    if !python.exists() {
        fs::create_dir_all(home).map_err(|error| Trouble::Failed(error.to_string()))?;
        run(Command::new("python3").args(["-m", "venv"]).arg(home))?;
    }
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", "cyclonedds"];
    run(Command::new(&python).args(install).args(LISTENERS))
        .map_err(|_| Trouble::Skipped(format!("pip cannot install {}", LISTENERS.join(", "))))?;
    Ok(python)
}
