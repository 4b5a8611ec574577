//! The project's own commands.
//!
//! `cargo xtask test` runs every check there is, the cheap ones first. A check whose tools are not installed is
//! skipped, and says loudly what to install; with `--nothing-skipped`, as in CI, that counts as a failure.

mod api;
mod arduino;
mod blocks;
mod c;
mod certificates;
mod changed;
mod deb;
#[cfg(test)]
mod dependencies;
mod dist;
mod examples;
mod firmware;
mod house;
mod links;
mod listings;
mod logs;
mod materials;
mod measured;
mod micropython;
mod notices;
mod package;
mod page;
mod periods;
mod printed;
mod program;
mod python;
mod quick;
mod release;
mod rerun;
mod ros2;
mod site;
mod steps;
mod test;
mod toolchain;
mod tune;
mod veripb;
mod zephyr;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::steps::{Steps, Trouble};

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
    /// Build the firmware, run it on emulated boards, and compare its figures with those of docs/log/firmware.md
    Firmware(firmware::Plan),
    /// Compile the C library strictly, misuse it, and compare it with the Rust crates under sanitizers
    C,
    /// Pack the Arduino library, build its examples, and run them on a simulated Uno among simulated modules
    Arduino(arduino::Plan),
    /// Build the programs in examples/ that one flashes onto a board (minutes)
    Examples {
        /// Only this one: uno, pico, nucleo-f401 or esp32-c3
        #[arg(value_name = "BOARD")]
        board: Option<String>,
    },
    /// Run the tests of c/micropython in MicroPython's WebAssembly build and in CPython
    Micropython,
    /// Run NewPing beside the Arduino library on a simulated Uno, and print the table that docs/how-to/arduino.md shows
    Newping {
        /// A folder with NewPing.h and NewPing.cpp, which are not part of this project
        #[arg(value_name = "DIR")]
        folder: std::path::PathBuf,
    },
    /// Build the wheel and test it: types, examples, and against what Rust says
    Python,
    /// Run a ring on an emulated board, its serial line and the ROS 2 node, and listen with Cyclone DDS, Fast DDS and
    /// pymavlink; build ros2/ with colcon
    Ros2,
    /// Pack the Debian package of eeruf-ros2 with its systemd unit into target/deb
    Deb(deb::Plan),
    /// Load a recording in Rerun, whose wheel has 170 MB, and see that none of it is raw bytes
    Rerun,
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
    /// Certify the rings of the tables, and have both checkers judge them and mutated ones (minutes)
    Certificates(certificates::Plan),
    /// Build the proof checker VeriPB, and have it judge the proofs of the table and of rings/ (minutes)
    Veripb(veripb::Plan),
    /// Pack the crates that are published, and build and test each from its tarball, in a folder of its own (minutes)
    Package,
    /// List the public items of eeruf-core and eeruf-hc-sr04 in target/api, and count names and types
    Api,
    /// Build wheels for Linux (glibc and musl, AMD64 and aarch64) and static programs into target/dist (many minutes)
    Dist(dist::Plan),
    /// Write what is in each published crate, as a bill of materials, into target/materials
    Materials,
    /// Hold the notices of what others wrote in program and wheel against what cargo-about finds
    Notices {
        /// Write LICENSE-THIRD-PARTY.txt instead
        #[arg(long)]
        write: bool,
    },
    /// Build the documents as one book, with the page and the references for Rust and Python, and follow every link
    Site,
    /// Do everything of a release but uploading, and print what a person must still do (many minutes)
    Release(release::Plan),
    /// Find the pilots of Set II, and what several echoes are compared by in Set I, and put them into the source (an
    /// hour; takes up where it stopped)
    Tune {
        /// Only compare
        #[arg(long)]
        check: bool,
    },
    /// Print the table of shortest periods that docs/log/search.md shows
    Periods {
        /// Arguments for the example `shortest_periods` of eeruf-core
        #[arg(value_name = "ARGUMENT")]
        arguments: Vec<String>,
    },
}

fn main() -> ExitCode {
    match Cli::parse().verb {
        Verb::Test { quick: true, .. } => quick::run_quick(),
        Verb::Test { nothing_skipped, .. } => test::run_all(nothing_skipped),
        Verb::Firmware(plan) => {
            let mut steps = Steps::default();
            if plan.is_whole() {
                steps.step("lint of the firmware", firmware::lint);
            }
            steps.step("firmware on emulated boards", || firmware::firmware(&plan));
            steps.finish(true)
        }
        Verb::C => one_step("C library", c::c),
        Verb::Arduino(plan) => {
            let mut steps = Steps::default();
            arduino::arduino(&plan, &mut steps);
            steps.finish(true)
        }
        Verb::Examples { board } => {
            let mut steps = Steps::default();
            examples::examples(board.as_deref(), &mut steps);
            steps.finish(true)
        }
        Verb::Micropython => one_step("MicroPython", micropython::micropython),
        Verb::Newping { folder } => {
            let mut steps = Steps::default();
            arduino::newping(&folder, &mut steps);
            steps.finish(true)
        }
        Verb::Python => one_step("Python package", python::python),
        Verb::Ros2 => {
            let mut steps = Steps::default();
            steps.step("ROS 2 node", ros2::ros2);
            steps.step("ROS 2 package", ros2::package);
            steps.finish(true)
        }
        Verb::Deb(plan) => one_step("Debian package", || deb::deb(&plan)),
        Verb::Rerun => one_step("recording in Rerun", rerun::rerun),
        Verb::Logs => {
            let mut steps = Steps::default();
            logs::logs(&mut steps);
            steps.finish(true)
        }
        Verb::Page { test, long } => one_step("the page", || {
            page::page(match (test, long) {
                (_, true) => page::Tests::Long,
                (true, false) => page::Tests::Short,
                (false, false) => page::Tests::No,
            })
        }),
        Verb::Reprint { check, document } => one_step("what the programs print", || match document {
            Some(document) if check => printed::check(&[document], printed::Which::All),
            Some(document) => printed::reprint(&document),
            None => printed::check(&printed::documents()?, printed::Which::All),
        }),
        Verb::Tune { check } => one_step("what the experiments are run with", || tune::tune(check)),
        Verb::Periods { arguments } => match periods::table(&arguments) {
            Ok(table) => {
                print!("{table}");
                ExitCode::SUCCESS
            }
            Err(Trouble::Failed(why) | Trouble::Skipped(why)) => {
                eprintln!("{why}");
                ExitCode::FAILURE
            }
        },
        Verb::Certificates(plan) => {
            let mut steps = Steps::default();
            certificates::run_all(&plan, &mut steps);
            steps.finish(true)
        }
        Verb::Veripb(plan) => {
            let mut steps = Steps::default();
            veripb::run_all(&plan, &mut steps);
            steps.finish(true)
        }
        Verb::Package => {
            let mut steps = Steps::default();
            package::package(&mut steps);
            steps.finish(true)
        }
        Verb::Api => one_step("public items", api::api),
        Verb::Dist(plan) => {
            let mut steps = Steps::default();
            dist::dist(&plan, &mut steps);
            steps.finish(true)
        }
        Verb::Materials => one_step("bills of materials", materials::materials),
        Verb::Notices { write } => one_step("notices", || notices::notices(write)),
        Verb::Site => {
            let mut steps = Steps::default();
            site::site(&mut steps);
            steps.finish(true)
        }
        Verb::Release(plan) => release::release(&plan),
    }
}

fn one_step(name: &str, run: impl FnOnce() -> Result<(), Trouble>) -> ExitCode {
    let mut steps = Steps::default();
    steps.step(name, run);
    steps.finish(true)
}
