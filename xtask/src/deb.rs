//! `cargo xtask deb`: the Debian package of `eeruf-ros2` with its systemd unit, and whether it works in a clean root.

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use clap::Args;

use crate::steps::{Trouble, output, run};

/// Parts to run.
#[derive(Args)]
pub(crate) struct Plan {
    /// Pack this program, instead of building one with `cargo build --release`
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Install the package into a root that debootstrap makes, as root, and run the unit's command against a board
    /// that a test plays
    #[arg(long)]
    test: bool,
}

const HOME: &str = "target/deb";
const UNIT: &str = "usr/lib/systemd/system/eeruf-ros2.service";

pub(crate) fn deb(plan: &Plan) -> Result<(), Trouble> {
    if output(Command::new("dpkg-deb").arg("--version")).is_none() {
        return Err(Trouble::Skipped("dpkg-deb is not installed: this is for Debian and Ubuntu".to_owned()));
    }
    let package = pack(plan.program.as_deref())?;
    println!("{}", package.display());
    if plan.test { test(&package) } else { Ok(()) }
}

fn failed(error: impl Into<Box<dyn Error>>) -> Trouble {
    Trouble::Failed(error.into().to_string())
}

fn copy(from: impl AsRef<Path>, to: &Path, mode: u32) -> Result<(), Trouble> {
    let from = from.as_ref();
    write(to, &fs::read(from).map_err(|error| failed(format!("{}: {error}", from.display())))?, mode)
}

fn write(to: &Path, content: &[u8], mode: u32) -> Result<(), Trouble> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    fs::write(to, content).map_err(|error| failed(format!("{}: {error}", to.display())))?;
    run(Command::new("chmod").arg(format!("{mode:o}")).arg(to))
}

/// Lays out the package's files, has systemd look at the unit, and packs them; the package.
fn pack(program: Option<&Path>) -> Result<PathBuf, Trouble> {
    let program = match program {
        Some(program) => program.to_owned(),
        None => {
            run(Command::new("cargo").args(["build", "--release", "--locked", "--package", "eeruf-ros2"]))?;
            PathBuf::from("target/release/eeruf-ros2")
        }
    };
    let root = Path::new(HOME).join("root");
    if root.exists() {
        fs::remove_dir_all(&root).map_err(failed)?;
    }
    let installed = root.join("usr/bin/eeruf-ros2");
    copy(&program, &installed, 0o755)?;
    run(Command::new("strip").arg(&installed))?;
    copy("packaging/deb/eeruf-ros2.service", &root.join(UNIT), 0o644)?;
    copy("crates/eeruf-ros2/config/eeruf.yaml", &root.join("etc/eeruf/eeruf.yaml"), 0o644)?;
    let mut terms = Vec::new();
    for file in ["LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY.txt"] {
        match fs::read_to_string(file) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                println!("the package has no {file}: `cargo xtask notices` makes it, for one that goes to others");
            }
            text => terms.push(text.map_err(failed)?),
        }
    }
    write(&root.join("usr/share/doc/eeruf-ros2/copyright"), terms.join("\n\n").as_bytes(), 0o644)?;
    let ask = |program: &str, arguments: &[&str]| {
        let said = output(Command::new(program).args(arguments));
        said.ok_or_else(|| failed(format!("{program} {}: no answer", arguments.join(" "))))
    };
    let architecture = ask("dpkg", &["--print-architecture"])?;
    // It runs with the C library that it was linked with, and later ones.
    let libc = ask("dpkg-query", &["--show", "--showformat=${Version}", "libc6"])?;
    let libc = libc.split('-').next().unwrap_or_default();
    let said = output(Command::new(&program).arg("--version")).unwrap_or_default();
    let version = said.strip_prefix("eeruf-ros2 ").ok_or_else(|| failed(format!("{}: {said}", program.display())))?;
    let depends = format!("libc6 (>= {libc})");
    let fields = [
        ("Package", "eeruf-ros2"),
        ("Version", version),
        ("Architecture", &architecture),
        ("Section", "misc"),
        ("Priority", "optional"),
        ("Depends", &depends),
        ("Maintainer", "The eeruf contributors <eeruf@users.noreply.github.com>"),
        ("Homepage", "https://github.com/eeruf/eeruf"),
        ("Description", "node for rings of ultrasonic sensors without crosstalk"),
        ("", "Reads a board's serial line; publishes ROS 2 ranges, a cloud, transforms and"),
        ("", "diagnostics; sends MAVLink; writes logs. Needs no ROS."),
    ];
    // Further lines of a field begin with a space.
    let line = |(field, value): &(&str, &str)| match *field {
        "" => format!(" {value}\n"),
        field => format!("{field}: {value}\n"),
    };
    let control: String = fields.iter().map(line).collect();
    write(&root.join("DEBIAN/control"), control.as_bytes(), 0o644)?;
    write(&root.join("DEBIAN/conffiles"), b"/etc/eeruf/eeruf.yaml\n", 0o644)?;
    for script in ["postinst", "prerm"] {
        copy(Path::new("packaging/deb").join(script), &root.join("DEBIAN").join(script), 0o755)?;
    }
    verify_unit(&root)?;
    let package = Path::new(HOME).join(format!("eeruf-ros2_{version}_{architecture}.deb"));
    run(Command::new("dpkg-deb").args(["--root-owner-group", "--build"]).arg(&root).arg(&package))?;
    absolute(package).map_err(failed)
}

/// Verdict of `systemd-analyze verify` on the unit, where its program stands as if installed.
fn verify_unit(root: &Path) -> Result<(), Trouble> {
    let unit = fs::read_to_string(root.join(UNIT)).map_err(failed)?;
    let program = absolute(root.join("usr/bin/eeruf-ros2")).map_err(failed)?;
    let copy = Path::new(HOME).join("eeruf-ros2.service");
    let there = unit.replace("ExecStart=/usr/bin/eeruf-ros2", &format!("ExecStart={}", program.display()));
    fs::write(&copy, there).map_err(failed)?;
    let verified = Command::new("systemd-analyze").arg("verify").arg(&copy).output();
    let verified = verified.map_err(|_| Trouble::Skipped("systemd-analyze is not installed".to_owned()))?;
    let said = String::from_utf8_lossy(&verified.stderr).into_owned();
    let of_ours: Vec<&str> = said.lines().filter(|line| line.contains("eeruf-ros2")).collect();
    let fine = verified.status.success() && of_ours.is_empty();
    if fine { Ok(()) } else { Err(failed(format!("systemd-analyze verify: {}\n{said}", verified.status))) }
}

/// Installs the package into a new root and starts its service's command there.
fn test(package: &Path) -> Result<(), Trouble> {
    if output(Command::new("id").arg("-u")).as_deref() != Some("0") {
        return Err(Trouble::Skipped("debootstrap and chroot need root".to_owned()));
    }
    if output(Command::new("debootstrap").arg("--version")).is_none() {
        return Err(Trouble::Skipped("debootstrap is not installed: apt install debootstrap".to_owned()));
    }
    let python = crate::ros2::environment()?;
    let root = absolute(Path::new(HOME).join("clean")).map_err(failed)?;
    if root.exists() {
        // What is mounted there from a run that broke off would be removed, too.
        if output(Command::new("mountpoint").arg("-q").arg(root.join("dev/pts"))).is_some() {
            run(Command::new("umount").arg(root.join("dev/pts")))?;
        }
        fs::remove_dir_all(&root).map_err(failed)?;
    }
    let release = output(Command::new("sh").args(["-c", ". /etc/os-release; echo $VERSION_CODENAME"]));
    let release = release.ok_or_else(|| failed("/etc/os-release: no VERSION_CODENAME"))?;
    run(Command::new("debootstrap")
        .args(["--variant=minbase", &release])
        .arg(&root)
        .stdout(std::process::Stdio::null()))?;
    fs::copy(package, root.join("eeruf-ros2.deb")).map_err(failed)?;
    run(Command::new("chroot").arg(&root).args(["dpkg", "--install", "/eeruf-ros2.deb"]))?;
    run(Command::new("mount").args([OsStr::new("--bind"), OsStr::new("/dev/pts")]).arg(root.join("dev/pts")))?;
    let tested = run(Command::new(python)
        .args(["-m", "pytest", "-s", "-o", "pythonpath=tests/ros2", "packaging/test_deb.py"])
        .env("EERUF_ROS2", "/usr/bin/eeruf-ros2")
        .env("EERUF_CLEAN_ROOT", &root));
    run(Command::new("umount").arg(root.join("dev/pts")))?;
    tested?;
    fs::remove_dir_all(&root).map_err(failed)
}
