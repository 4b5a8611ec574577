//! `cargo xtask veripb`: has VeriPB, a checker of pseudo-Boolean proofs that others wrote, judge the proofs of the
//! table's rings and of `rings/`, and refuse broken ones.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::certificates::{TABLE, files, table};
use crate::steps::{Steps, output, run_line};

const FOLDER: &str = "target/veripb";
/// The version that the formats are written for.
const VERSION: &str = "3.0.2";

pub(crate) fn run_all(steps: &mut Steps) {
    let program = Path::new(FOLDER).join("bin/veripb");
    steps.step("build", || {
        fs::create_dir_all(FOLDER)?;
        run_line("cargo build --release --locked -p eeruf")?;
        // `--locked`: with the versions that its authors tested.
        run_line(&format!("cargo install veripb --quiet --version {VERSION} --locked --root {FOLDER}"))
    });
    let mut rows = "| ring | nodes | model, bytes | proof, bytes | VeriPB |\n|---|---|---|---|---|\n".to_owned();
    let (mut judged, mut total) = (0, Duration::ZERO);
    for (name, ring) in table(&TABLE, 1000).into_iter().chain(files()) {
        if let Some(took) = steps.step(&name, || judge(&program, &name, &ring, &mut rows)) {
            judged += 1;
            total += took;
        }
    }
    let seconds = total.as_secs_f64();
    println!("\n{rows}\n{judged} proofs accepted in {seconds:.1} s, each that has sums refused when broken");
}

/// Designs a ring, and has VeriPB accept the proof and refuse three that cannot be one. How long it took to accept it.
fn judge(program: &Path, name: &str, ring: &str, rows: &mut String) -> Result<Duration> {
    let path = |ending: &str| PathBuf::from(FOLDER).join(format!("{name}.{ending}"));
    let [file, model, proof] = ["toml", "opb", "pbp"].map(path);
    fs::write(&file, ring)?;
    let mut design = Command::new("target/release/eeruf");
    design.args(["design", "--emit", "toml", "--certificate-form", "veripb", "--certificate"]).arg(&proof).arg(&file);
    let said = design.output()?;
    let said = String::from_utf8_lossy(&said.stderr).trim().to_owned();
    println!("{said}");
    let nodes =
        said.rsplit("; ").next().and_then(|rest| rest.split_once(" nodes")).map_or("?", |(nodes, _)| nodes).to_owned();
    let began = Instant::now();
    ensure!(accepts(program, &model, &proof), "{}: VeriPB refuses it", proof.display());
    let took = began.elapsed();
    let (model_text, proof_text) = (fs::read_to_string(&model)?, fs::read_to_string(&proof)?);
    let seconds = took.as_secs_f64();
    let _ = writeln!(rows, "| {name} | {nodes} | {} | {} | {seconds:.1} s |", model_text.len(), proof_text.len());
    // Without sums, unit propagation refutes the model before the first line, so that no line can be wrong.
    if !proof_text.lines().any(|line| line.starts_with("pol")) {
        return Ok(took);
    }
    let broken = path("broken.pbp");
    for (what, text) in broken_proofs(&proof_text) {
        fs::write(&broken, &text)?;
        ensure!(!accepts(program, &model, &broken), "{}: VeriPB accepts it {what}", broken.display());
    }
    // Without intervals there is a schedule, so that model cannot be refuted.
    let less = path("less.opb");
    let is_order = |line: &str| line.contains("~oa") || line.contains("~ob");
    let lines = model_text.lines().map(|line| if is_order(line) { loosened(line) } else { line.to_owned() });
    fs::write(&less, lines.collect::<Vec<_>>().join("\n") + "\n")?;
    ensure!(!accepts(program, &less, &proof), "{}: VeriPB accepts the proof without intervals", less.display());
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
    output(Command::new(program).arg(model).arg(proof)).is_ok_and(|said| said.contains("VERIFIED UNSATISFIABLE"))
}
