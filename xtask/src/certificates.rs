//! `cargo xtask certificates`: designs every ring of the tables and of `rings/`, and has both checkers judge the
//! certificates; and gives both the same mutated ones.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::steps::{Steps, output, run, run_line, stem};

/// Parts to check.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Number of mutated certificates to give both checkers; half of tiny problems, half of the table's smaller rings
    #[arg(long, default_value_t = 10_000)]
    mutations: u32,
    /// Seed of the mutations
    #[arg(long, default_value_t = 20_000)]
    seed: u32,
}

const FOLDER: &str = "target/certificates";
/// The table's intervals and separations, see docs/explanation/search.md.
const WINDOWS_MS: [u32; 4] = [15, 30, 45, 60];
pub(crate) const TABLE: [u32; 4] = [8, 12, 16, 24];

/// Rings that are designed together, and the checkers that judge them.
struct Group {
    name: &'static str,
    rings: Vec<(String, String)>,
    by_python: bool,
}

pub(crate) fn run_all(plan: &Plan, steps: &mut Steps) {
    steps.step("build", || {
        fs::create_dir_all(FOLDER)?;
        run_line("cargo build --release --locked -p eeruf")?;
        run_line("cargo build --release --locked -p eeruf-check --bins --examples")
    });
    let groups = [
        Group { name: "the table, ticks of 1 ms", rings: table(&TABLE, 1000), by_python: true },
        Group { name: "the table, ticks of 0.1 ms", rings: table(&TABLE, 100), by_python: false },
        Group { name: "32 sensors", rings: table(&[32], 1000), by_python: false },
        Group { name: "rings/", rings: files(), by_python: false },
    ];
    let mut rows =
        "| rings | certificates | nodes | bytes | eeruf-check | check_period.py |\n|---|---|---|---|---|---|\n"
            .to_owned();
    for group in groups {
        rows += &steps.step(group.name, || certify(&group)).unwrap_or_default();
    }
    for (what, given) in [("tiny problems", vec![]), ("the table", mutated())] {
        let name = format!("{} mutated certificates of {what}", plan.mutations / 2);
        let counts = [plan.mutations / 2, plan.seed].map(|number| number.to_string());
        steps.step(&name, || {
            let mut python = Command::new("python3");
            run(python.arg("checker/compare.py").arg("target/release").args(counts).args(given))
        });
    }
    println!("\n{rows}");
}

/// Designs each ring with a certificate, checks all, and gives the row of the table.
fn certify(group: &Group) -> Result<String> {
    let (mut nodes, mut bytes) = (0, 0);
    let (mut in_rust, mut in_python) = (Duration::ZERO, Duration::ZERO);
    for (name, ring) in &group.rings {
        let path = |ending: &str| PathBuf::from(FOLDER).join(format!("{name}.{ending}"));
        let (file, certificate) = (path("toml"), path("txt"));
        fs::write(&file, ring)?;
        let mut design = Command::new("target/release/eeruf");
        design.args(["design", "--emit", "toml", "--certificate"]).arg(&certificate).arg(&file);
        output(&mut design)?;
        let text = fs::read_to_string(&certificate).unwrap_or_default();
        bytes += text.len();
        // A binary tree: one leaf more than there are branchings.
        let words = ["a ", "b ", "sign ", "rank ", "split "];
        nodes += 2 * text.lines().filter(|line| words.iter().any(|word| line.starts_with(word))).count() + 1;
        let said = timed(Command::new("target/release/eeruf-check").arg(&certificate), &mut in_rust)?;
        println!("{name}: {said}");
        ensure!(said.contains("is the shortest period"), "{name}: {said}");
        if group.by_python {
            let mut checker = Command::new("python3");
            let by_python = timed(checker.arg("checker/check_period.py").arg(&certificate), &mut in_python)?;
            ensure!(by_python == said, "{name}: check_period.py says {by_python}");
        }
    }
    let seconds = |time: Duration, run: bool| if run { format!("{:.1} s", time.as_secs_f64()) } else { "-".to_owned() };
    let (in_rust, in_python) = (seconds(in_rust, true), seconds(in_python, group.by_python));
    Ok(format!("| {} | {} | {nodes} | {bytes} | {in_rust} | {in_python} |\n", group.name, group.rings.len()))
}

/// Verdict of a checker, and its duration.
fn timed(command: &mut Command, total: &mut Duration) -> Result<String> {
    let began = Instant::now();
    let said = output(command)?;
    *total += began.elapsed();
    Ok(said)
}

/// Ring files for the table of docs/explanation/search.md with this many sensors.
pub(crate) fn table(sensors: &[u32], tick_us: u32) -> Vec<(String, String)> {
    let mut rings = Vec::new();
    for layout in ["line", "ring"] {
        for sensors in sensors {
            for window_ms in WINDOWS_MS {
                let mut ring = String::new();
                let _ = writeln!(ring, "sensors = {sensors}\nlayout = \"{layout}\"\nneighbours = 4\nt_delta_us = 999");
                let _ = writeln!(ring, "min_interval_us = 15_000\nwindow_us = {window_ms}_000\ntick_us = {tick_us}");
                rings.push((name(layout, *sensors, window_ms, tick_us), ring));
            }
        }
    }
    rings
}

fn name(layout: &str, sensors: u32, window_ms: u32, tick_us: u32) -> String {
    format!("{layout}-{sensors}-window-{window_ms}-tick-{tick_us}")
}

/// The ring files that users copy.
pub(crate) fn files() -> Vec<(String, String)> {
    let entries = fs::read_dir("rings").into_iter().flatten().flatten().map(|entry| entry.path());
    let rings = entries.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).filter_map(|path| {
        let text = fs::read_to_string(&path).ok()?;
        let is_searched = text.contains("sensors =") && !text.contains("wait_max_us");
        is_searched.then(|| (stem(&path), text))
    });
    let mut rings: Vec<_> = rings.collect();
    rings.sort();
    rings
}

/// Certificates of the table whose proof takes Python a moment only.
fn mutated() -> Vec<PathBuf> {
    let of = |layout, window| Path::new(FOLDER).join(name(layout, 8, window, 1000) + ".txt");
    [("line", 60), ("ring", 45), ("ring", 15)].map(|(layout, window)| of(layout, window)).into()
}
