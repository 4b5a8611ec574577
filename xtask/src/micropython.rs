//! `c/micropython/`: what it says of the shared corpus, on simulated modules and of faults of a line, in MicroPython's
//! WebAssembly build and in CPython.

use std::path::Path;
use std::process::Command;

use crate::steps::{Trouble, output, run};

const FOLDER: &str = "c/micropython";

/// Runs the tests.
pub(crate) fn micropython() -> Result<(), Trouble> {
    for (tool, package) in [("python3", "python3"), ("node", "nodejs"), ("npm", "npm")] {
        if output(Command::new(tool).arg("--version")).is_none() {
            return Err(Trouble::Skipped(format!("no {tool}; try: apt install {package}")));
        }
    }
    let folder = Path::new(FOLDER);
    for test in ["test_corpus.py", "test_modules.py", "test_line_faults.py"] {
        run(Command::new("python3").current_dir(folder).arg("-B").arg(test))?;
    }
    run(Command::new("npm").current_dir(folder).args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"]))?;
    run(Command::new("npm").current_dir(folder).args(["run", "--silent", "test"]))
}
