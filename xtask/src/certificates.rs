//! `cargo xtask certificates`: designs every ring of the tables and of `rings/`, and has the checker judge their
//! certificates; then runs the tests of certificates, with more problems and without leaving out large ones.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::steps::{Steps, command, output, run, run_line, stem};

/// Parts to check.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Number of tiny problems whose certificates, mutated too, are compared with nested loops
    #[arg(long, default_value_t = 20_000)]
    tiny: u32,
}

const FOLDER: &str = "target/certificates";
/// The table's intervals and separations, see docs/explanation/search.md.
const WINDOWS_MS: [u32; 4] = [15, 30, 45, 60];
pub(crate) const TABLE: [u32; 4] = [8, 12, 16, 24];
/// Longest time that the checker may take for a file.
const MOST: Duration = Duration::from_secs(60);

pub(crate) fn run_all(plan: &Plan, steps: &mut Steps) {
    steps.step("build", || {
        fs::create_dir_all(FOLDER)?;
        run_line("cargo build --release --locked -p eeruf")
    });
    let groups = [
        ("the table, ticks of 1 ms", table(&TABLE, 1000)),
        ("the table, ticks of 0.1 ms", table(&TABLE, 100)),
        ("32 sensors", table(&[32], 1000)),
        ("rings/", files()),
    ];
    let mut rows =
        "| rings | certificates | nodes | bytes | `check_period.py` | slowest |\n|---|---|---|---|---|---|\n"
            .to_owned();
    for (name, rings) in groups {
        rows += &steps.step(name, || certify(name, &rings)).unwrap_or_default();
    }
    let tests = |test: &str| {
        let mut cargo = command("cargo test --release --locked -p eeruf-period -p eeruf-design --all-features");
        cargo.args(["--test", "all", test, "--", "--nocapture"]);
        cargo.env("EERUF_NODES", u32::MAX.to_string()).env("EERUF_PROOFS", "3");
        cargo
    };
    steps.step(&format!("{} tiny problems against nested loops", plan.tiny), || {
        run(tests("checker::accepted_claims").env("EERUF_CASES", plan.tiny.to_string()))
    });
    for test in ["brute_force::", "checker::broken", "twins::", "table::", "uneven::"] {
        steps.step(&format!("all certificates of {test}"), || run(&mut tests(test)));
    }
    println!("\n{rows}");
}

/// Designs each ring with a certificate, checks all, and gives the row of the table.
fn certify(group: &str, rings: &[(String, String)]) -> Result<String> {
    let (mut nodes, mut bytes, mut times) = (0, 0, Vec::new());
    for (name, ring) in rings {
        let path = |ending: &str| PathBuf::from(FOLDER).join(format!("{name}.{ending}"));
        let (file, certificate) = (path("toml"), path("txt"));
        fs::write(&file, ring)?;
        let mut design = Command::new("target/release/eeruf");
        design.args(["design", "--emit", "toml", "--certificate"]).arg(&certificate).arg(&file);
        output(&mut design)?;
        let text = fs::read_to_string(&certificate)?;
        bytes += text.len();
        // A binary tree: one leaf more than there are branchings.
        let words = ["a ", "b ", "sign ", "rank ", "split "];
        nodes += 2 * text.lines().filter(|line| words.iter().any(|word| line.starts_with(word))).count() + 1;
        let began = Instant::now();
        let said = output(Command::new("python3").arg("checker/check_period.py").arg(&certificate))?;
        let took = began.elapsed();
        println!("{name}: {said}, {:.1} s", took.as_secs_f64());
        ensure!(said.contains("is the shortest period"), "{name}: {said}");
        ensure!(took <= MOST, "{name}: {took:?}; expected at most {MOST:?}");
        times.push(took.as_secs_f64());
    }
    let (all, slowest) = (times.iter().sum::<f64>(), times.iter().fold(0.0, |most: f64, &time| most.max(time)));
    Ok(format!("| {group} | {} | {nodes} | {bytes} | {all:.1} s | {slowest:.1} s |\n", rings.len()))
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
