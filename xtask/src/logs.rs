//! `cargo xtask logs`: what is measured of logs and takes minutes: bags of a million messages, as `rosbags` writes
//! them, who fools whom in 200 alcoves, and the data set. The tests of the same are in `cargo xtask test`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};

use crate::steps::{Steps, Trouble, output, run};

const HOME: &str = "target/logs";
/// Topics, and messages on each: a million, and a tenth of that.
const SIZES: [(u32, [u32; 2]); 2] = [(8, [125_000, 12_500]), (24, [41_667, 4_167])];
const DATA_CARD: &str = "docs/how-to/dataset.md";

pub(crate) fn logs(steps: &mut Steps) {
    for (topics, messages) in SIZES {
        steps.step(&format!("bags of a million messages on {topics} topics"), || bags(topics, messages));
    }
    for (method, physics) in [("eeruf_hopping", "plain"), ("eeruf_hopping", "default"), ("eeruf", "plain")] {
        steps.step(&format!("senders in 200 alcoves under {method}, physics {physics}"), || senders(method, physics));
    }
    for physics in ["plain", "default"] {
        steps.step(&format!("crosstalk in 800 logs, physics {physics}"), || doctor(physics));
    }
    steps.step("the data set", data_set);
}

fn failed(what: &dyn std::fmt::Display, why: &dyn std::fmt::Display) -> Trouble {
    Trouble::Failed(format!("{what}: {why}"))
}

/// Writes bags of every kind, replays them, and deletes them.
fn bags(topics: u32, messages: [u32; 2]) -> Result<(), Trouble> {
    let python = environment()?;
    let program = crate::program::program()?;
    let folders = messages.map(|messages| PathBuf::from(HOME).join(format!("bags-{topics}-{messages}")));
    for (folder, messages) in folders.iter().zip(messages) {
        let size = ["--topics", &topics.to_string(), "--messages", &messages.to_string()];
        run(Command::new(&python).arg("crates/eeruf-logs/tests/write_bags.py").arg(folder).args(size))?;
    }
    let [large, small] = &folders;
    let mut replay = Command::new(&python);
    replay.arg("crates/eeruf-logs/tests/replay_bags.py").arg(program).args([small, large]);
    let replayed = run(replay.arg((topics * messages[0]).to_string()));
    for folder in &folders {
        fs::remove_dir_all(folder).map_err(|error| failed(&folder.display(), &error))?;
    }
    replayed
}

/// The verdicts of `eeruf logs` on logs of alcoves, which fail if they break what docs/how-to/logs.md promises.
fn doctor(physics: &str) -> Result<(), Trouble> {
    run(Command::new("cargo").args(["lab", "doctor-alcoves", "20000", "100", "1000", physics]))
}

/// A virtual environment with `rosbags`; its Python.
fn environment() -> Result<PathBuf, Trouble> {
    let home = Path::new(HOME).join("python");
    if output(Command::new("python3").args(["-c", "import venv, ensurepip"])).is_none() {
        return Err(Trouble::Skipped("python3 with venv is not installed".to_owned()));
    }
    let python = home.join("bin/python");
    if !python.exists() {
        run(Command::new("python3").args(["-m", "venv"]).arg(&home))?;
    }
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "rosbags"]))?;
    Ok(python)
}

/// Names of senders, held against the simulator's knowledge: of three fifths of the rejected foreign readings at 99 %
/// precision where hops are many; of none where there are two phases.
fn senders(method: &str, physics: &str) -> Result<(), Trouble> {
    let lab = ["lab", "diagnose-alcoves", "40000", "200", method, "1000", physics];
    let Some(said) = output(Command::new("cargo").args(lab)) else {
        return Err(Trouble::Failed("cargo lab diagnose-alcoves ended with an error".to_owned()));
    };
    println!("{said}");
    // "named rightly: 300757, 80.5 % of those" and "named: 300874, of which rightly 99.96 %".
    let percent = |line: &str| {
        let line = said.lines().find_map(|said| said.strip_prefix(line));
        line.and_then(|line| line.split_whitespace().rev().find_map(|word| word.parse::<f64>().ok()))
            .ok_or_else(|| Trouble::Failed(format!("no line `{line:?}` with a percentage")))
    };
    let (share, right) = (percent("named rightly: ")?, percent("named: ")?);
    let fine = if method == "eeruf" { share < 1.0 } else { share >= 60.0 && right >= 99.0 };
    if fine { Ok(()) } else { Err(Trouble::Failed(format!("{share} % named rightly, {right} % of the names right"))) }
}

/// The data set, whose check sum stands on its card.
fn data_set() -> Result<(), Trouble> {
    let folder = PathBuf::from(HOME).join("dataset");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| failed(&folder.display(), &error))?;
    }
    run(Command::new(crate::program::program()?).arg("dataset").arg(&folder))?;
    let mut files = vec![];
    find_files(&folder, &mut files)?;
    // As `find . -type f | LC_ALL=C sort | xargs cat | sha256sum` has it.
    files.sort_by_key(|file| file.strip_prefix(&folder).map(|name| name.to_string_lossy().into_owned()).ok());
    let (mut sum, mut bytes) = (Sha256::new(), 0);
    for file in &files {
        let read = fs::read(file).map_err(|error| failed(&file.display(), &error))?;
        bytes += read.len();
        sum.update(read);
    }
    let sum: String = sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    println!("{} files, {:.1} MB, {sum}", files.len(), bytes as f64 * 1e-6);
    let card = fs::read_to_string(DATA_CARD).map_err(|error| failed(&DATA_CARD, &error))?;
    if card.contains(&sum) { Ok(()) } else { Err(failed(&DATA_CARD, &format!("has not the check sum {sum}"))) }
}

fn find_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Trouble> {
    for entry in fs::read_dir(folder).map_err(|error| failed(&folder.display(), &error))? {
        let path = entry.map_err(|error| failed(&folder.display(), &error))?.path();
        if path.is_dir() {
            find_files(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
