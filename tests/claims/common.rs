//! The program as a test calls it.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

pub(crate) fn eeruf(args: &[&str]) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_eeruf"))
        .args(args)
        .env_remove("COLUMNS")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program was built beside this test");
    let text = |bytes| String::from_utf8(bytes).expect("the program prints UTF-8");
    // How far a long command has come depends on the machine.
    let is_said = |line: &&str| !line.starts_with("eeruf: at work for ");
    let err = text(output.stderr).split_inclusive('\n').filter(is_said).collect();
    Outcome { code: output.status.code(), out: text(output.stdout), err }
}

/// Runs the program on a terminal of 80 columns; returns what it prints.
pub(crate) fn eeruf_at_80(args: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_eeruf"));
    command.args(args).env("COLUMNS", "80").current_dir(env!("CARGO_MANIFEST_DIR"));
    String::from_utf8(command.output().expect("the program was built beside this test").stdout).expect("UTF-8")
}

pub(crate) fn json(args: &[&str]) -> Value {
    let outcome = eeruf(args);
    assert_eq!(outcome.err, "");
    assert_eq!(outcome.out.lines().count(), 1, "{}", outcome.out);
    serde_json::from_str(&outcome.out).expect("one JSON object")
}

/// A file that is removed when this is dropped.
pub(crate) struct Scratch(tempfile::TempDir);

impl Scratch {
    pub(crate) fn new(name: &str, contents: &str) -> (Self, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder for temporary files");
        let file = folder.path().join(name);
        std::fs::write(&file, contents).expect("it can be written to");
        (Self(folder), file)
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }
}

/// A C compiler, which everyone who builds Rust has.
pub(crate) const C: &[&str] = &["gcc", "-std=c99"];

/// Returns a compiler of C++, if there is one; without it `cargo xtask c` is skipped with a message.
pub(crate) fn cpp() -> Option<&'static [&'static str]> {
    let language: &[&str] = &["g++", "-xc++", "-std=c++11"];
    Command::new(language[0]).arg("--version").output().is_ok().then_some(language)
}

/// Compiles a program without a warning, and runs it successfully.
pub(crate) fn compile_and_run(folder: &Scratch, text: &str, compiler: &[&str]) {
    let (user, program) = (folder.path().join("user.c"), folder.path().join("user"));
    std::fs::write(&user, text).unwrap();
    let strict = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Ic", "-I"];
    let mut command = Command::new(compiler[0]);
    command.args(strict).arg(folder.path()).args(&compiler[1..]).arg(&user).arg("-o").arg(&program);
    assert!(command.status().unwrap().success(), "{compiler:?}");
    assert!(Command::new(program).status().unwrap().success(), "{compiler:?}");
}
