//! `cargo xtask rerun`: loads a study's recording in Rerun. Its wheel of 170 MB is too much for each run of the tests.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::steps::{Trouble, output, run};

const HOME: &str = "target/rerun";

/// Converts a recording by `rerun mcap convert`, and checks that nothing of it is kept as bytes; then runs the script
/// of docs/how-to/logs.md.
pub(crate) fn rerun() -> Result<(), Trouble> {
    if output(Command::new("python3").args(["-c", "import venv, ensurepip"])).is_none() {
        return Err(Trouble::Skipped("python3 with venv is not installed".to_owned()));
    }
    let python = Path::new(HOME).join("bin/python");
    if !python.exists() {
        run(Command::new("python3").args(["-m", "venv", HOME]))?;
    }
    let packages = ["rerun-sdk>=0.41,<0.42", "mcap-ros2-support"];
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages))?;
    let [study, converted, shown] = ["study.mcap", "study.rrd", "shown.rrd"].map(|name| Path::new(HOME).join(name));
    for old in [&converted, &shown] {
        let _ = fs::remove_file(old);
    }
    let program = crate::program::program()?;
    let args = ["study", "scenes/alcove.toml", "--method", "conventional,eeruf_hopping", "--periods", "40", "--mcap"];
    run(Command::new(program).args(args).arg(&study).stdout(std::process::Stdio::null()))?;
    let rerun = || {
        let mut rerun = Command::new(python.with_file_name("rerun"));
        rerun.env("RERUN_ANALYTICS_ENABLED", "false");
        rerun
    };
    run(rerun().args(["mcap", "convert"]).arg(&study).arg("-o").arg(&converted))?;
    let printed = output(rerun().args(["rrd", "print", "-v"]).arg(&converted));
    let printed = printed.ok_or_else(|| Trouble::Failed("rerun rrd print failed".to_owned()))?;
    let needed = [
        "/tf@Transform3D:translation",
        "/conventional/robot_1/sonar_1@Scalars:scalars",
        "/scene@visualization_msgs.msg.MarkerArray:message",
        "/robot_1/odom@nav_msgs.msg.Odometry:message",
        "/eeruf_hopping/firings@eeruf_msgs.msg.Firing:message",
    ];
    if let Some(missing) = needed.into_iter().find(|needed| !printed.contains(needed)) {
        return Err(Trouble::Failed(format!("{}: no {missing}", converted.display())));
    }
    if let Some(raw) = printed.lines().find(|line| line.contains("McapMessage")) {
        return Err(Trouble::Failed(format!("{}: raw bytes: {raw}", converted.display())));
    }
    run(Command::new(&python).arg("docs/show_in_rerun.py").args([&study, &shown]))?;
    let size = fs::metadata(&shown).map_or(0, |file| file.len());
    if size < 20_000 { Err(Trouble::Failed(format!("{}: {size} bytes", shown.display()))) } else { Ok(()) }
}
