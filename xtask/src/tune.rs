//! `cargo xtask tune`: finds what the experiments' methods are run with, and puts it into the source.
//!
//! What was tried is kept in `target/tune` and not tried again, also if the search was stopped; whoever changes the
//! simulator deletes that folder first. With other physics, other constants come out.

use std::fs;
use std::process::Command;

use crate::steps::{Trouble, output};

const FOLDER: &str = "target/tune";
const PILOTS: &str = "crates/eeruf-sim/src/experiments/set_two/own_pilots.rs";
const MULTI_ECHO: &str = "crates/eeruf-sim/src/experiments/set_one/multi_echo.rs";
/// Beginning of the line that holds the result for several echoes.
const LINE: &str = "    pub const TUNED: Self = ";

/// Searches, and writes or compares.
pub(crate) fn tune(check: bool) -> Result<(), Trouble> {
    let line = found(&["multi-echo"])?;
    put(MULTI_ECHO, &with_line(&read(MULTI_ECHO)?, &line), check)?;
    put(PILOTS, &format!("{}\n", found(&["pilots", FOLDER])?), check)
}

/// The text with the line of the constant replaced.
fn with_line(text: &str, line: &str) -> String {
    let lines = text.lines().map(|old| if old.starts_with(LINE) { line } else { old });
    lines.flat_map(|line| [line, "\n"]).collect()
}

fn found(arguments: &[&str]) -> Result<String, Trouble> {
    let example = ["run", "--quiet", "--release", "--locked", "--package", "eeruf-sim", "--example", "tune", "--"];
    output(Command::new("cargo").args(example).args(arguments))
        .ok_or_else(|| Trouble::Failed(format!("the example tune fails: {}", arguments.join(" "))))
}

fn put(path: &str, text: &str, check: bool) -> Result<(), Trouble> {
    if read(path)? == text {
        println!("{path} is what was found");
        return Ok(());
    }
    if check {
        return Err(Trouble::Failed(format!("{path} is not what was found:\n{text}")));
    }
    println!("{path} is written");
    fs::write(path, text).map_err(|error| Trouble::Failed(format!("{path}: {error}")))
}

fn read(path: &str) -> Result<String, Trouble> {
    fs::read_to_string(path).map_err(|error| Trouble::Failed(format!("{path}: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_line_of_the_constant_is_replaced() {
        let text = "impl A {\n    pub const TUNED: Self = Self { a: 1 };\n}\n";
        assert_eq!(with_line(text, "    pub const TUNED: Self = x;"), "impl A {\n    pub const TUNED: Self = x;\n}\n");
    }
}
