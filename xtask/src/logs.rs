//! `cargo xtask logs`: what is measured of logs and takes minutes: bags of a million messages, as `rosbags` writes
//! them, who fools whom in 200 alcoves, and the data set. The tests of the same are in `cargo xtask test`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use crate::python::environment;
use crate::steps::{Steps, empty, output, run, run_line};

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

/// Writes bags of every kind, replays them, and deletes them.
fn bags(topics: u32, messages: [u32; 2]) -> Result<()> {
    let python = environment(&Path::new(HOME).join("python"), &["rosbags"])?;
    let program = crate::toolchain::program()?;
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
        fs::remove_dir_all(folder)?;
    }
    replayed
}

/// The verdicts of `eeruf logs` on logs of alcoves, which fail if they break what docs/how-to/logs.md promises.
fn doctor(physics: &str) -> Result<()> {
    run_line(&format!("cargo lab doctor-alcoves 20000 100 1000 {physics}"))
}

/// Names of senders, held against the simulator's knowledge: of three fifths of the rejected foreign readings at 99 %
/// precision where hops are many; of none where there are two phases.
fn senders(method: &str, physics: &str) -> Result<()> {
    let lab = ["lab", "diagnose-places", "40000", "200", method, "1000", physics];
    let said = output(Command::new("cargo").args(lab))?;
    println!("{said}");
    // "named rightly: 300757, 80.5 % of those" and "named: 300874, of which rightly 99.96 %".
    let percent = |line: &str| {
        let line = said.lines().find_map(|said| said.strip_prefix(line));
        line.and_then(|line| line.split_whitespace().rev().find_map(|word| word.parse::<f64>().ok()))
            .with_context(|| format!("no line `{line:?}` with a percentage"))
    };
    let (share, right) = (percent("named rightly: ")?, percent("named: ")?);
    let fine = if method == "eeruf" { share < 1.0 } else { share >= 60.0 && right >= 99.0 };
    ensure!(fine, "{share} % named rightly, {right} % of the names right");
    Ok(())
}

/// The data set, whose check sum stands on its card, by the command that stands there.
fn data_set() -> Result<()> {
    let folder = Path::new(HOME).join("dataset");
    empty(&folder)?;
    run(Command::new(crate::toolchain::program()?).arg("dataset").arg(&folder))?;
    let mut sum = Command::new("sh");
    sum.args(["-c", "find . -type f | LC_ALL=C sort | xargs cat | sha256sum"]).current_dir(&folder);
    let said = output(&mut sum)?;
    let sum = said.split(' ').next().unwrap_or_default();
    println!("{sum}");
    ensure!(fs::read_to_string(DATA_CARD)?.contains(sum), "{DATA_CARD}: has not the check sum {sum}");
    Ok(())
}
