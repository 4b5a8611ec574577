//! `cargo xtask ros2`: the ring of `firmware/hil` on an emulated board, its serial line, the node `eeruf-ros2`, and
//! Cyclone DDS, Fast DDS and pymavlink, which must receive what the ring read. Then `ros2/` as a package of ROS 2.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use crate::steps::{Trouble, output, run};

/// Clients that listen; the newest versions.
const LISTENERS: [&str; 3] = ["cyclonedds", "pymavlink", "pytest"];

pub(crate) fn ros2() -> Result<(), Trouble> {
    if !cfg!(target_os = "linux") {
        return Err(Trouble::Skipped("pseudo-terminals and sockets as Linux has them".to_owned()));
    }
    let emulator = crate::firmware::serial_board()?;
    let python = environment()?;
    let fast_dds = fast_dds();
    let programs = ["eeruf-ros2", "eeruf-hil", "eeruf"];
    crate::program::build(&programs.map(|program| ["--bin", program]).concat())?;
    let mut tests = Command::new(python);
    tests.args(["-m", "pytest", "-o", "pythonpath=tests/ros2", "tests/ros2"]).env("EERUF_EMULATOR", emulator);
    for (program, variable) in programs.iter().zip(["EERUF_ROS2", "EERUF_HIL", "EERUF_PROGRAM"]) {
        let path = absolute(format!("target/debug/{program}{EXE_SUFFIX}"));
        tests.env(variable, path.map_err(|error| Trouble::Failed(error.to_string()))?);
    }
    if let Ok(program) = &fast_dds {
        tests.env("EERUF_FAST_DDS", program);
    }
    run(&mut tests)?;
    // Without it, all but its tests have passed.
    fast_dds.map(drop)
}

/// Compiles the listener that uses Fast DDS, against the version that Debian has.
fn fast_dds() -> Result<PathBuf, Trouble> {
    let headers = ["-xc++", "-E", "-include", "fastcdr/Cdr.h", "-include", "fastrtps/config.h", "/dev/null"];
    if output(Command::new("g++").args(headers)).is_none() {
        let packages = "g++ libfastrtps-dev libfastcdr-dev";
        return Err(Trouble::Skipped(format!("tests of Fast DDS: it is not installed; try: apt install {packages}")));
    }
    let program = absolute("target/ros2/fast_dds").map_err(|error| Trouble::Failed(error.to_string()))?;
    let strict = ["-std=c++17", "-Wall", "-Wextra", "-Werror"];
    let libraries = ["-lfastrtps", "-lfastcdr", "-o"];
    run(Command::new("g++").args(strict).arg("tests/ros2/fast_dds.cpp").args(libraries).arg(&program))?;
    Ok(program)
}

/// Builds `ros2/` with colcon and ament as Debian has them, around the program that is already built, and looks at what
/// is installed. Launch files are only compiled: Debian has no `launch`.
pub(crate) fn package() -> Result<(), Trouble> {
    if output(Command::new("colcon").args(["build", "--help"])).is_none() {
        let packages = "colcon, python3-colcon-ros, python3-colcon-cmake and ament-cmake";
        return Err(Trouble::Skipped(format!("colcon is not installed: Debian's {packages}")));
    }
    crate::program::build(&["--bin", "eeruf-ros2"])?;
    let failed = |error: std::io::Error| Trouble::Failed(error.to_string());
    let home = absolute("target/colcon").map_err(failed)?;
    if home.exists() {
        fs::remove_dir_all(&home).map_err(failed)?;
    }
    let program = absolute(format!("target/debug/eeruf-ros2{EXE_SUFFIX}")).map_err(failed)?;
    let mut colcon = Command::new("colcon");
    colcon.arg("--log-base").arg(home.join("log")).args(["build", "--base-paths", "ros2"]);
    colcon.arg("--build-base").arg(home.join("build")).arg("--install-base").arg(home.join("install"));
    colcon.args(["--cmake-args", &format!("-DEERUF_ROS2_PROGRAM={}", program.display())]);
    // ament needs the Python that Debian installed it for.
    run(colcon.env("PATH", "/usr/bin:/bin"))?;
    let installed = home.join("install/eeruf_ros2");
    let share = installed.join("share/eeruf_ros2");
    for file in ["package.xml", "config/eeruf.yaml", "config/nav2.yaml", "launch/eeruf.launch.py"] {
        if !share.join(file).exists() {
            return Err(Trouble::Failed(format!("{}: not installed", share.join(file).display())));
        }
    }
    run(Command::new("python3").args(["-m", "py_compile"]).arg(share.join("launch/eeruf.launch.py")))?;
    // It reads its file, in a namespace, and ends before it joins a domain.
    let node = Command::new(installed.join("lib/eeruf_ros2/eeruf-ros2"))
        .args(["--ros-args", "-r", "__ns:=/robot_1", "--params-file"])
        .arg(share.join("config/eeruf.yaml"))
        .args(["-p", "sensors:=65"])
        .output()
        .map_err(failed)?;
    let said = String::from_utf8_lossy(&node.stderr).into_owned();
    let expected = "eeruf-ros2: sensors: 65; expected 1 to 64\n";
    if said == expected { Ok(()) } else { Err(Trouble::Failed(format!("{said:?}; expected {expected:?}"))) }
}

/// A virtual environment with those who listen; its Python.
pub(crate) fn environment() -> Result<PathBuf, Trouble> {
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
