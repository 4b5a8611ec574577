//! `cargo xtask veripb`: has VeriPB, a checker of pseudo-Boolean proofs that others wrote, judge the proofs of the
//! table's rings and of `rings/`, and refuse broken ones.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::certificates::{files, table};
use crate::steps::{Steps, Trouble, output, run};

/// Parts to check.
#[derive(clap::Args)]
pub(crate) struct Plan {
    /// The program, where it is installed already; otherwise it is built from crates.io into target/veripb
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// The table's rings with up to this many sensors
    #[arg(long, default_value_t = 24, value_name = "K")]
    sensors: u32,
    /// Ticks, in microseconds
    #[arg(long, default_value_t = 1000, value_name = "US")]
    tick_us: u32,
}

const FOLDER: &str = "target/veripb";
/// The version that the formats are written for.
const VERSION: &str = "3.0.2";

pub(crate) fn run_all(plan: &Plan, steps: &mut Steps) {
    let installed = PathBuf::from(FOLDER).join("bin/veripb");
    let program = plan.program.clone().unwrap_or(installed);
    steps.step("build", || {
        fs::create_dir_all(FOLDER).map_err(|error| Trouble::Failed(format!("{FOLDER}: {error}")))?;
        run(Command::new("cargo").args(["build", "--release", "--locked", "-p", "eeruf"]))?;
        if program.exists() {
            return Ok(());
        }
        // `--locked`: with the versions that its authors tested.
        run(Command::new("cargo").args(["install", "veripb", "--version", VERSION, "--locked", "--root", FOLDER]))
    });
    let sensors: Vec<u32> = [8, 12, 16, 24].into_iter().filter(|sensors| *sensors <= plan.sensors).collect();
    let mut rows = "| ring | nodes | model, bytes | proof, bytes | VeriPB |\n|---|---|---|---|---|\n".to_owned();
    let (mut judged, mut total) = (0, Duration::ZERO);
    for (name, ring) in table(&sensors, plan.tick_us).into_iter().chain(files()) {
        steps.step(&name, || {
            let took = judge(&program, &name, &ring, &mut rows)?;
            judged += 1;
            total += took;
            Ok(())
        });
    }
    println!(
        "\n{rows}\n{judged} proofs accepted in {:.1} s, each that has sums refused when broken",
        total.as_secs_f64()
    );
}

/// Designs a ring, and has VeriPB accept the proof and refuse three that cannot be one. How long it took to accept it.
fn judge(program: &Path, name: &str, ring: &str, rows: &mut String) -> Result<Duration, Trouble> {
    let path = |ending: &str| PathBuf::from(FOLDER).join(format!("{name}.{ending}"));
    let failed = |path: &Path, error: std::io::Error| Trouble::Failed(format!("{}: {error}", path.display()));
    let write = |path: &Path, text: &str| fs::write(path, text).map_err(|error| failed(path, error));
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| failed(path, error));
    let [file, model, proof] = ["toml", "opb", "pbp"].map(path);
    write(&file, ring)?;
    let mut design = Command::new("target/release/eeruf");
    design.args(["design", "--emit", "toml", "--certificate-form", "veripb", "--certificate"]).arg(&proof).arg(&file);
    let said = design.output().map_err(|error| failed(&file, error))?;
    let said = String::from_utf8_lossy(&said.stderr).trim().to_owned();
    println!("{said}");
    let nodes =
        said.rsplit("; ").next().and_then(|rest| rest.split_once(" nodes")).map_or("?", |(nodes, _)| nodes).to_owned();
    let began = Instant::now();
    if !accepts(program, &model, &proof) {
        return Err(Trouble::Failed(format!("{}: VeriPB refuses it", proof.display())));
    }
    let took = began.elapsed();
    let (model_text, proof_text) = (read(&model)?, read(&proof)?);
    let seconds = took.as_secs_f64();
    let _ = writeln!(rows, "| {name} | {nodes} | {} | {} | {seconds:.1} s |", model_text.len(), proof_text.len());
    // Without sums, unit propagation refutes the model before the first line, so that no line can be wrong.
    if !proof_text.lines().any(|line| line.starts_with("pol")) {
        return Ok(took);
    }
    let broken = path("broken.pbp");
    for (what, text) in broken_proofs(&proof_text) {
        write(&broken, &text)?;
        if accepts(program, &model, &broken) {
            return Err(Trouble::Failed(format!("{}: VeriPB accepts it {what}", broken.display())));
        }
    }
    // Without intervals there is a schedule, so that model cannot be refuted.
    let less = path("less.opb");
    let is_order = |line: &str| line.contains("~oa") || line.contains("~ob");
    let lines = model_text.lines().map(|line| if is_order(line) { loosened(line) } else { line.to_owned() });
    write(&less, &(lines.collect::<Vec<_>>().join("\n") + "\n"))?;
    if accepts(program, &less, &proof) {
        return Err(Trouble::Failed(format!("{}: VeriPB accepts the proof without intervals", less.display())));
    }
    Ok(took)
}

/// The inequality, saying nothing.
fn loosened(line: &str) -> String {
    line.rsplit_once(">= ").map_or_else(|| line.to_owned(), |(sum, _)| format!("{sum}>= -1000000 ;"))
}

/// The proof with one line broken: its first clause claims a contradiction; the witness of its first symmetry forgets a
/// variable. And without all of its sums, of which one alone may be spared, since others lead the same way.
fn broken_proofs(proof: &str) -> Vec<(&'static str, String)> {
    let lines: Vec<&str> = proof.lines().collect();
    let with = |at: usize, line: &str| {
        let mut broken = lines.clone();
        broken[at] = line;
        broken.join("\n") + "\n"
    };
    let mut broken = Vec::new();
    let last = lines.iter().rposition(|line| line.starts_with("red")).unwrap_or(0);
    if let Some(clause) = (last..lines.len()).find(|&i| lines[i].starts_with("rup +")) {
        broken.push(("with a clause that claims too much", with(clause, "rup >= 1;")));
    }
    if let Some(first) = lines.iter().position(|line| line.starts_with("red")) {
        let words: Vec<&str> = lines[first].split(' ').collect();
        let forgetful = words[..words.len() - 3].join(" ") + ";";
        broken.push(("with a witness that forgets a variable", with(first, &forgetful)));
    }
    let sums = lines.iter().map(|line| if line.starts_with("pol") { "pol 1;" } else { line });
    broken.push(("without its sums", sums.collect::<Vec<_>>().join("\n") + "\n"));
    broken
}

/// Returns true if VeriPB accepts the proof that the model has no solution.
fn accepts(program: &Path, model: &Path, proof: &Path) -> bool {
    output(Command::new(program).arg(model).arg(proof)).is_some_and(|said| said.contains("VERIFIED UNSATISFIABLE"))
}
