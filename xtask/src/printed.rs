//! What documents quote of the program's output: `<!-- printed by: eeruf ARGUMENTS -->` stands before it, `<!-- end -->`
//! after it.

use std::fs;
use std::process::Command;

use crate::steps::{Trouble, output, run};

const PRINTED_BY: &str = "<!-- printed by: eeruf ";
const END: &str = "<!-- end -->";

/// Runs every such command of a document again and puts what it prints in place of what stands there.
pub(crate) fn reprint(document: &str) -> Result<(), Trouble> {
    run(Command::new("cargo").args(["build", "--release", "--locked", "--package", "eeruf", "--bin", "eeruf"]))?;
    let failed = |why: String| Trouble::Failed(format!("{document}: {why}"));
    let text = fs::read_to_string(document).map_err(|error| failed(error.to_string()))?;
    let mut fresh = String::new();
    for (place, block) in text.split(PRINTED_BY).enumerate() {
        if place == 0 {
            fresh += block;
            continue;
        }
        let (arguments, rest) = block.split_once(" -->\n").ok_or_else(|| failed("a comment has no end".to_owned()))?;
        let (_, after) = rest.split_once(END).ok_or_else(|| failed(format!("no end after {arguments}")))?;
        println!("eeruf {arguments}");
        let printed = output(Command::new("target/release/eeruf").args(arguments.split_whitespace()))
            .ok_or_else(|| failed(format!("eeruf {arguments} fails")))?;
        fresh += &format!("{PRINTED_BY}{arguments} -->\n\n{printed}\n\n{END}{after}");
    }
    fs::write(document, fresh).map_err(|error| failed(error.to_string()))
}
