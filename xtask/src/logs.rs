//! `cargo xtask logs`: measurements of logs that take minutes: bags of a million messages, as `rosbags` writes them,
//! diagnoses in alcoves, and the data set. Its tests are in `cargo xtask test`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use crate::python::environment;
use crate::steps::{Steps, empty, output, run, run_line};

const HOME: &str = "target/logs";
/// Topics, and messages on each: a million, and a tenth of that.
const SIZES: [(u32, [u32; 2]); 2] = [(8, [125_000, 12_500]), (24, [41_667, 4_167])];
/// Scenes in which senders are named, as arguments of `cargo lab diagnose-places`, and the least share in percent that
/// must be named; none can be in the paper's two phases.
const SENDERS: [(&str, f64); 3] =
    [("40000 200 flow 1000 plain", 60.0), ("40000 200 flow 1000 default", 60.0), ("40000 200 eeruf 1000 plain", 0.0)];
const DATA_CARD: &str = "docs/how-to/dataset.md";

pub(crate) fn logs(steps: &mut Steps) {
    for (topics, messages) in SIZES {
        steps.step(&format!("bags of a million messages on {topics} topics"), || bags(topics, messages));
    }
    for (places, least) in SENDERS {
        steps.step(&format!("senders in {places}"), || senders(places, least));
    }
    steps.step("verdicts on 200 logs of each kind", || {
        run_line("cargo run --release --locked -p eeruf-logs --example verdicts 20000 200")
    });
    steps.step("10^8 readings of a server", || {
        let python = environment(&Path::new(HOME).join("wheel"), &[".", "aiohttp", "fsspec"])?;
        run(Command::new(python).args(["tests/python/far_log.py", "100000000"]))
    });
    steps.step("the data set", data_set);
}

/// Writes bags of every kind, replays them, and deletes them.
fn bags(topics: u32, messages: [u32; 2]) -> Result<()> {
    let python = environment(&Path::new(HOME).join("python"), &["rosbags"])?;
    run_line("cargo build --release --locked -p eeruf")?;
    let folders = messages.map(|messages| PathBuf::from(HOME).join(format!("bags-{topics}-{messages}")));
    for (folder, messages) in folders.iter().zip(messages) {
        let size = ["--topics", &topics.to_string(), "--messages", &messages.to_string()];
        run(Command::new(&python).arg("crates/eeruf-logs/tests/write_bags.py").arg(folder).args(size))?;
    }
    let mut replay = Command::new(&python);
    replay.args(["crates/eeruf-logs/tests/replay_bags.py", "target/release/eeruf"]);
    let replayed = run(replay.args([&folders[1], &folders[0]]).arg((topics * messages[0]).to_string()));
    folders.iter().try_for_each(fs::remove_dir_all)?;
    replayed
}

/// Compares names of senders with the simulator's knowledge: at least this share of foreign readings is named, 99 % of
/// the names correctly.
fn senders(places: &str, least: f64) -> Result<()> {
    let said = output(Command::new("cargo").args(["lab", "diagnose-places"]).args(places.split(' ')))?;
    println!("{said}");
    // "named rightly: 300757, 80.5 % of those" and "named: 300874, of which rightly 99.96 %".
    let percent = |name: &str| {
        let line = said.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().rev().find_map(|word| word.parse::<f64>().ok())
    };
    let (share, right) = percent("named rightly: ").zip(percent("named: ")).context("two lines with a percentage")?;
    let is_fine = if least == 0.0 { share < 1.0 } else { share >= least && right >= 99.0 };
    ensure!(is_fine, "{share} % named rightly, {right} % of the names right; expected {least} % and 99 %");
    Ok(())
}

/// Writes the data set and compares its check sum with that on its card, by the command on the card.
fn data_set() -> Result<()> {
    let folder = Path::new(HOME).join("dataset");
    empty(&folder)?;
    run(Command::new(crate::toolchain::program()?).arg("dataset").arg(&folder))?;
    let sum = ["-c", "find . -type f | LC_ALL=C sort | xargs cat | sha256sum | cut -d ' ' -f 1"];
    let said = output(Command::new("sh").args(sum).current_dir(&folder))?;
    let sum = said.trim();
    ensure!(fs::read_to_string(DATA_CARD)?.contains(sum), "{DATA_CARD}: has not the check sum {sum}");
    Ok(())
}
