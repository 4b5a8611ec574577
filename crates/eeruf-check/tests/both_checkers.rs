//! The checker in Python says the same: of certificates of the table, and of mutated ones.

#[path = "../../eeruf-period/tests/common/mod.rs"]
mod common;

use eeruf_check::check;
use eeruf_period::engine::prove::prove;
use std::path::Path;
use std::process::Command;

fn python() -> (Command, std::path::PathBuf) {
    (Command::new("python3"), Path::new(env!("CARGO_MANIFEST_DIR")).join("../../checker"))
}

#[test]
fn the_checker_in_python_accepts_certificates_of_the_table() {
    for (name, claim) in common::table(1).into_iter().filter(|(_, claim)| claim.problem.sensors() == 8) {
        let certificate = prove(&claim, 100_000).expect("a proof");
        let file = format!("{}/{}.txt", env!("CARGO_TARGET_TMPDIR"), name.replace(' ', "-"));
        std::fs::write(&file, &certificate).expect("the folder can be written to");
        let (mut python, checker) = python();
        let done = python.arg(checker.join("check_period.py")).arg(file).output().expect("python3 runs");
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        assert_eq!(said.trim_end(), check(&certificate).expect("accepted").to_string(), "{name}: {done:?}");
    }
}

#[test]
fn both_checkers_say_the_same_of_300_mutated_certificates() {
    let program = Path::new(env!("CARGO_BIN_EXE_eeruf-check"));
    let folder = program.parent().expect("a program is in a folder");
    let (mut python, checker) = python();
    let done = python.arg(checker.join("compare.py")).arg(folder).args(["300", "1"]).output().expect("python3 runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}
