//! `cargo xtask deb`: the Debian package of `eeruf-ros2` with its systemd unit, built by cargo-deb with the settings in
//! `crates/eeruf-ros2/Cargo.toml`, and tried in a clean root.

use std::path::{Path, absolute};
use std::process::{Command, Stdio};

use anyhow::{Result, ensure};
use clap::Args;
use fs_err as fs;

use crate::steps::{command, empty, need, output, run, run_line};

/// Parts to run.
#[derive(Args)]
pub(crate) struct Plan {
    /// Install the package into a root that debootstrap makes, as root, and run the unit's command against a board
    /// that a test plays
    #[arg(long)]
    test: bool,
}

const HOME: &str = "target/deb";
const UNIT: &str = "packaging/deb/eeruf-ros2.service";

pub(crate) fn deb(plan: &Plan) -> Result<()> {
    need("cargo deb --version", "cargo install cargo-deb --locked")?;
    if !Path::new("LICENSE-THIRD-PARTY.txt").exists() {
        println!("the package has no notices: `cargo xtask notices` makes them, for one that goes to others");
    }
    fs::create_dir_all(HOME)?;
    // The command prints the package's path.
    let said = output(&mut command(&format!("cargo deb --package eeruf-ros2 --locked --strip --output {HOME}")))?;
    let package = absolute(said.lines().last().unwrap_or_default())?;
    println!("{}", package.display());
    verify_unit()?;
    if plan.test { test(&package) } else { Ok(()) }
}

/// Has `systemd-analyze verify` look at the unit, with the program that was built in place of the installed one.
fn verify_unit() -> Result<()> {
    need("systemd-analyze --version", "apt install systemd")?;
    let program = absolute("target/release/eeruf-ros2")?;
    let copy = Path::new(HOME).join("eeruf-ros2.service");
    fs::write(&copy, fs::read_to_string(UNIT)?.replace("/usr/bin/eeruf-ros2", &program.display().to_string()))?;
    let verified = Command::new("systemd-analyze").arg("verify").arg(&copy).output()?;
    let said = String::from_utf8_lossy(&verified.stderr).into_owned();
    let of_ours = said.lines().any(|line| line.contains("eeruf-ros2"));
    ensure!(verified.status.success() && !of_ours, "systemd-analyze verify: {}\n{said}", verified.status);
    Ok(())
}

/// Installs the package into a new root and starts its service's command there.
fn test(package: &Path) -> Result<()> {
    need("test -w /", "it as root, for debootstrap and chroot")?;
    need("debootstrap --version", "apt install debootstrap")?;
    let python = crate::ros2::environment()?;
    let root = absolute(Path::new(HOME).join("clean"))?;
    let terminals = root.join("dev/pts");
    // An aborted run leaves a mount there, and everything in it would be removed too.
    if output(Command::new("mountpoint").arg("-q").arg(&terminals)).is_ok() {
        run(Command::new("umount").arg(&terminals))?;
    }
    empty(&root)?;
    let release = output(Command::new("sh").args(["-c", ". /etc/os-release; echo $VERSION_CODENAME"]))?;
    run(Command::new("debootstrap").args(["--variant=minbase", &release]).arg(&root).stdout(Stdio::null()))?;
    fs::copy(package, root.join("eeruf-ros2.deb"))?;
    run(Command::new("chroot").arg(&root).args(["dpkg", "--install", "/eeruf-ros2.deb"]))?;
    run(Command::new("mount").args(["--bind", "/dev/pts"]).arg(&terminals))?;
    let tested = run(Command::new(python)
        .args(["-m", "pytest", "-s", "-o", "pythonpath=tests/ros2", "packaging/test_deb.py"])
        .env("EERUF_ROS2", "/usr/bin/eeruf-ros2")
        .env("EERUF_CLEAN_ROOT", &root));
    run(Command::new("umount").arg(&terminals))?;
    tested?;
    run_line(&format!("rm -r {HOME}/clean"))
}
