//! The project's own commands.
//!
//! `cargo xtask test` runs every check there is, the cheap ones first. A check whose tools are not installed is
//! skipped, and prints what to install; with `--nothing-skipped`, as in CI, that counts as a failure.

mod api;
mod arduino;
mod blocks;
mod c;
mod changed;
mod deb;
mod examples;
mod firmware;
mod house;
mod links;
mod logs;
mod measured;
mod package;
mod page;
mod printed;
mod python;
mod release;
mod ros2;
mod site;
mod steps;
mod test;
mod toolchain;
#[cfg(test)]
mod unused_tests;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::steps::Steps;

/// The project's own commands: check everything, a part, or what changed; reprint the tables of the documents.
#[derive(Parser)]
#[command(bin_name = "cargo xtask", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Run every check that CI runs, the cheap ones first; each step prints how long it took
    Test {
        /// Only formatting, lints, the documents' listings, and the unit tests of the packages that changed since the
        /// branch left the main one
        #[arg(long, conflicts_with = "nothing_skipped")]
        quick: bool,
        /// Fail where a tool is not installed, instead of skipping what needs it
        #[arg(long)]
        nothing_skipped: bool,
    },
    /// Build the firmware, run it on emulated boards, and compare its figures with those of tests/data/boards.txt
    Firmware(firmware::Plan),
    /// Compile the C library strictly, misuse it, and compare it with the Rust crates under sanitizers
    C,
    /// Pack the Arduino library, build its examples, and run them on a simulated Uno among simulated modules
    Arduino(arduino::Plan),
    /// Build the programs in examples/ that one flashes onto a board (minutes)
    Examples {
        /// Only this one
        #[arg(value_name = "BOARD", value_parser = examples::BOARDS.map(|(board, _)| board))]
        board: Option<String>,
    },
    /// Run the tests of c/micropython in MicroPython's WebAssembly build and in CPython
    Micropython,
    /// Build what `eeruf design --program` writes in each language, and run it to what it accepts, on a simulated Uno
    /// too
    Programs(arduino::Drawn),
    /// Build the wheel and test it: types, examples, and the same results as in Rust
    Python,
    /// Run a ring whose echo lines play faults, its serial line and the ROS 2 node, and listen with Cyclone DDS, Fast
    /// DDS and pymavlink; build ros2/ with colcon
    Ros2,
    /// Pack the Debian package of eeruf-ros2 with its systemd unit into target/deb
    Deb(deb::Plan),
    /// Replay bags of a million messages, name senders in 200 alcoves, write the data set: the figures of
    /// docs/how-to/logs.md, docs/how-to/diagnose.md and docs/how-to/dataset.md, which are also what must hold (many
    /// minutes)
    Logs,
    /// Build the page in playground/, as a folder for a server and as one file for a disk
    Page {
        /// Run its tests, those that CI runs
        #[arg(long)]
        test: bool,
        /// Run all of its tests: 2,000 random actions, screenshots into target/page/pictures, figures
        #[arg(long)]
        long: bool,
    },
    /// Run the commands that printed the documents' tables again, and put what they print in place of what stands there
    Reprint {
        /// Only compare, all documents if none is named; timings are left alone
        #[arg(long)]
        check: bool,
        /// The document
        #[arg(value_name = "DOCUMENT", required_unless_present = "check")]
        document: Option<String>,
    },
    /// Pack the crates that are published, and build and test each from its tarball, in a folder of its own (minutes)
    Package,
    /// List the public items of eeruf-core and eeruf-hc-sr04 in target/api, and count names and types
    Api,
    /// Write what is in each published crate, as a bill of materials, into target/materials
    Materials,
    /// Write the notices of what others wrote in program and wheel into LICENSE-THIRD-PARTY.txt, which both then carry
    Notices,
    /// Build the documents as one book, with the page and the references for Rust and Python, and follow every link
    Site,
    /// Do everything of a release but uploading, and print what a person must still do (many minutes)
    Release {
        /// Upload nothing: only the workflow uploads, for a tag. Required, so that no one expects an upload
        #[arg(long, required = true)]
        dry_run: bool,
    },
}

fn main() -> ExitCode {
    let mut steps = Steps::default();
    match Cli::parse().verb {
        Verb::Test { quick: true, .. } => return test::run_quick(),
        Verb::Test { nothing_skipped, .. } => return test::run_all(nothing_skipped),
        Verb::Firmware(plan) => firmware::run_all(&plan, &mut steps),
        Verb::C => one(&mut steps, "C library", c::c),
        Verb::Arduino(plan) => arduino::arduino(&plan, &mut steps),
        Verb::Examples { board } => examples::examples(board.as_deref(), &mut steps),
        Verb::Micropython => one(&mut steps, "MicroPython", c::micropython),
        Verb::Programs(drawn) => one(&mut steps, "programs of `eeruf design`", || arduino::programs(&drawn, false)),
        Verb::Python => one(&mut steps, "Python package", python::python),
        Verb::Ros2 => {
            one(&mut steps, "ROS 2 node", ros2::ros2);
            one(&mut steps, "ROS 2 package", ros2::package);
        }
        Verb::Deb(plan) => one(&mut steps, "Debian package", || deb::deb(&plan)),
        Verb::Logs => logs::logs(&mut steps),
        Verb::Page { test, long } => one(&mut steps, "the page", || page::page(test, long)),
        Verb::Reprint { check, document } => one(&mut steps, "what the programs print", || match document {
            Some(document) if check => printed::check(&[document], printed::Which::All),
            Some(document) => printed::reprint(&document),
            None => printed::check(&printed::documents()?, printed::Which::All),
        }),
        Verb::Package => package::package(&mut steps),
        Verb::Api => one(&mut steps, "public items", api::api),
        Verb::Materials => one(&mut steps, "bills of materials", release::materials),
        Verb::Notices => one(&mut steps, "notices", release::notices),
        Verb::Site => site::site(&mut steps),
        Verb::Release { .. } => release::release(&mut steps),
    }
    steps.finish(true)
}

fn one(steps: &mut Steps, name: &str, run: impl FnOnce() -> Result<()>) {
    steps.step(name, run);
}
