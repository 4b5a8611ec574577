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
    Outcome { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}

pub(crate) fn json(args: &[&str]) -> Value {
    let outcome = eeruf(args);
    assert_eq!(outcome.err, "");
    assert_eq!(outcome.out.lines().count(), 1, "{}", outcome.out);
    serde_json::from_str(&outcome.out).expect("one JSON object")
}

/// A file that is gone when this is dropped.
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
