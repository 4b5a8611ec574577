//! `cargo xtask ros2`: a ring whose echo lines play edges, its serial line, the node `eeruf-ros2`, and Cyclone DDS,
//! Fast DDS and pymavlink, which must receive the ring's readings; then `ros2/` as a ROS 2 package.

use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use anyhow::{Result, ensure};

use crate::steps::{empty, need, output, run, skip};
use crate::toolchain::{built, example};

/// Clients that listen, in their newest versions.
const LISTENERS: [&str; 3] = ["cyclonedds", "pymavlink", "pytest"];

pub(crate) fn ros2() -> Result<()> {
    if !cfg!(target_os = "linux") {
        return skip("pseudo-terminals and sockets as Linux has them".to_owned());
    }
    let python = environment()?;
    let fast_dds = fast_dds();
    let mut tests = Command::new(python);
    tests.args(["-m", "pytest", "-o", "pythonpath=tests/ros2", "tests/ros2"]);
    tests.env("EERUF_ROS2", built("eeruf-ros2")?).env("EERUF_PROGRAM", built("eeruf")?);
    tests.env("EERUF_PLAYED_RING", example("played_ring")?);
    if let Ok(program) = &fast_dds {
        tests.env("EERUF_FAST_DDS", program);
    }
    run(&mut tests)?;
    // Without Fast DDS, all other tests have passed.
    fast_dds.map(drop)
}

/// Compiles the listener that uses Fast DDS, against the version that Debian has.
fn fast_dds() -> Result<PathBuf> {
    let headers = ["-xc++", "-E", "-include", "fastcdr/Cdr.h", "-include", "fastrtps/config.h", "/dev/null"];
    if output(Command::new("g++").args(headers)).is_err() {
        return skip("tests of Fast DDS: it is not installed; try: apt install g++ libfastrtps-dev libfastcdr-dev");
    }
    let program = absolute("target/ros2/fast_dds")?;
    let strict = ["-std=c++17", "-Wall", "-Wextra", "-Werror"];
    let libraries = ["-lfastrtps", "-lfastcdr", "-o"];
    run(Command::new("g++").args(strict).arg("tests/ros2/fast_dds.cpp").args(libraries).arg(&program))?;
    Ok(program)
}

/// Builds `ros2/` with colcon and ament as Debian has them, around the program that is already built, and checks the
/// installed files. Launch files are only compiled: Debian has no `launch`.
pub(crate) fn package() -> Result<()> {
    need("colcon build --help", "apt install colcon python3-colcon-ros python3-colcon-cmake ament-cmake")?;
    let program = built("eeruf-ros2")?;
    let home = absolute("target/colcon")?;
    empty(&home)?;
    let mut colcon = Command::new("colcon");
    colcon.arg("--log-base").arg(home.join("log")).args(["build", "--base-paths", "ros2"]);
    colcon.arg("--build-base").arg(home.join("build")).arg("--install-base").arg(home.join("install"));
    colcon.args(["--cmake-args", &format!("-DEERUF_ROS2_PROGRAM={}", program.display())]);
    // ament needs the Python that Debian installed it for.
    run(colcon.env("PATH", "/usr/bin:/bin"))?;
    let installed = home.join("install/eeruf_ros2");
    let share = installed.join("share/eeruf_ros2");
    for file in ["package.xml", "config/eeruf.yaml", "config/nav2.yaml", "launch/eeruf.launch.py"] {
        ensure!(share.join(file).exists(), "{}: not installed", share.join(file).display());
    }
    run(Command::new("python3").args(["-m", "py_compile"]).arg(share.join("launch/eeruf.launch.py")))?;
    // The node reads its file, in a namespace, and ends before it joins a domain.
    let node = Command::new(installed.join("lib/eeruf_ros2/eeruf-ros2"))
        .args(["--ros-args", "-r", "__ns:=/robot_1", "--params-file"])
        .arg(share.join("config/eeruf.yaml"))
        .args(["-p", "sensors:=65"])
        .output()?;
    let said = String::from_utf8_lossy(&node.stderr).into_owned();
    let expected = "eeruf-ros2: sensors: 65; expected 1 to 64\n";
    ensure!(said == expected, "{said:?}; expected {expected:?}");
    Ok(())
}

/// Makes a virtual environment with the listeners; returns its Python.
pub(crate) fn environment() -> Result<PathBuf> {
    let packages = [&["--only-binary", "cyclonedds"][..], &LISTENERS].concat();
    crate::python::environment(Path::new("target/ros2"), &packages)
}
