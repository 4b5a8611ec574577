//! Standard output: a full disk, and a reader that closes the pipe.

use std::fs::OpenOptions;
use std::process::{Command, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_eeruf");

/// One run of each command that prints, fast.
const RUNS: [&[&str]; 18] = [
    &["design", "rings/paper-12.toml", "--period-only"],
    &["design", "rings/paper-12.toml", "--period-only", "--json"],
    &["design", "rings/paper-12.toml", "--period-only", "--emit", "rust"],
    &["verify", "rings/table-i-d.toml"],
    &["verify", "rings/table-i-d.toml", "--json"],
    &["search", "rings/table-i-waits.toml"],
    &["study", "scenes/alcove.toml", "--periods", "2", "--method", "eeruf"],
    &["paths", "scenes/alcove.toml", "--order", "1"],
    &["replay", "tests/data/scitos-g5-24-sonars.csv", "--t-delta-us", "500"],
    &["experiment", "set-one", "--seeds", "1", "--method", "sequential"],
    &["atlas"],
    &["examples"],
    &["completions", "bash"],
    &["licenses"],
    &["--help"],
    &["--version"],
    &["help", "design"],
    &["verify", "--help"],
];

fn run(words: &[&str], out: impl Into<Stdio>) -> std::process::Output {
    let mut command = Command::new(PROGRAM);
    command.args(words).current_dir(env!("CARGO_MANIFEST_DIR")).stdout(out);
    command.output().expect("the program was built beside this test")
}

#[test]
#[cfg(target_os = "linux")]
fn full_disk_is_exit_74_and_a_sentence() {
    for words in RUNS {
        let full = OpenOptions::new().write(true).open("/dev/full").expect("a device of Linux");
        let outcome = run(words, full);
        let err = String::from_utf8_lossy(&outcome.stderr);
        assert_eq!(outcome.status.code(), Some(74), "{words:?}: {err}");
        assert!(err.starts_with("eeruf: standard output: No space left"), "{words:?}: {err}");
        assert!(err.contains("; expected room for it") && err.lines().count() == 1, "{words:?}: {err}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn full_disk_under_a_named_file_is_exit_74() {
    let design = ["design", "rings/paper-12.toml", "--period-only"];
    let study = ["study", "scenes/alcove.toml", "--method=eeruf", "--periods=2"];
    let runs = [(&design[..], "--certificate"), (&study, "--log"), (&study, "--mcap")];
    for (words, option) in runs {
        let outcome = run(&[words, &[option, "/dev/full"]].concat(), Stdio::null());
        let err = String::from_utf8_lossy(&outcome.stderr);
        assert!(outcome.status.code() == Some(74) && err.starts_with("eeruf: /dev/full: No space left"), "{err}");
    }
}

// Errors, warnings and notes need a place; without one the exit code is what is left of them.
#[test]
#[cfg(target_os = "linux")]
fn full_standard_error_is_no_panic() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let file = folder.path().join("ring.cert");
    let file = file.to_str().expect("UTF-8");
    let design: &[&str] = &["design", "rings/paper-12.toml", "--period-only", "--certificate", file];
    let warned: &[&str] = &["verify", "rings/table-i-d.toml", "--t-delta-us", "2"];
    for (words, code) in [(design, 0), (warned, 0), (&["verify", "none.toml"], 2), (&["--none"], 2)] {
        let full = OpenOptions::new().write(true).open("/dev/full").expect("a device of Linux");
        let mut command = Command::new(PROGRAM);
        let status =
            command.args(words).current_dir(env!("CARGO_MANIFEST_DIR")).stdout(Stdio::null()).stderr(full).status();
        assert_eq!(status.expect("the program was built beside this test").code(), Some(code), "{words:?}");
    }
}

#[test]
fn closed_pipe_ends_quietly() {
    for words in RUNS {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let outcome = run(words, writer);
        assert_eq!(String::from_utf8_lossy(&outcome.stderr), "", "{words:?}");
        assert!(matches!(outcome.status.code(), None | Some(0)), "{words:?}: {}", outcome.status);
    }
}

// Options that few need are in `--help` alone.
#[test]
fn short_help_of_each_verb_is_one_screen() {
    for verb in ["", "design", "study", "logs", "verify", "examples", "completions", "man", "licenses", "lab"] {
        let words: Vec<_> = verb.split_whitespace().chain(["-h"]).collect();
        let help = crate::common::eeruf_at_80(&words);
        let lines = help.lines().count();
        assert!(lines > 10 && lines <= 48 && help.lines().all(|line| line.chars().count() <= 80), "{lines}\n{help}");
    }
}

// After 20 s a line on standard error says so, also where a command waits for its file; and how far the work is.
#[test]
#[cfg(unix)]
fn long_work_is_said_without_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let files = "lab paths, lab scene, lab merge, lab search, lab atlas, study, design --all, verify, logs, diagnose";
    let mut all: Vec<_> = files.split(", ").map(|words| format!("{words} pipe")).collect();
    all.push("lab experiment set-one --seeds 100000 --method eeruf".to_owned());
    let runs = all.iter().enumerate().map(|(n, words)| format!("timeout 30 eeruf {words} > out-{n} 2> {n} &\n"));
    crate::newcomers::shell(&format!("mkfifo pipe; {} wait", runs.collect::<String>()), folder.path());
    for (n, words) in all.iter().enumerate() {
        let said = std::fs::read_to_string(folder.path().join(n.to_string())).unwrap();
        let how_far = if words.contains("set-one") { ": 100000 alcoves by 1 methods, " } else { "\n" };
        assert!(said.starts_with("eeruf: at work for 20 s") && said.contains(how_far), "{words}: {said}");
    }
}
