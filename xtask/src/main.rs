//! The project's own commands.
//!
//! `cargo xtask test` runs every check there is, the cheap ones first. A check whose tools are not installed is skipped
//! with a loud word on what to install; with `--nothing-skipped`, as in CI, that counts as a failure.

mod checks;
mod firmware;
mod listings;
mod mutants;
mod printed;
mod python;
mod steps;
mod toolchain;

use std::process::ExitCode;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match args[..] {
        ["test"] => checks::run_all(false),
        ["test", "--nothing-skipped"] => checks::run_all(true),
        ["firmware"] => {
            let mut steps = steps::Steps::default();
            steps.step("lint of the firmware", firmware::lint);
            steps.step("firmware on emulated boards", firmware::firmware);
            steps.finish(true)
        }
        ["python"] => {
            let mut steps = steps::Steps::default();
            steps.step("Python package", python::python);
            steps.finish(true)
        }
        ["mutants", ref args @ ..] => mutants::run(args),
        ["reprint", document] => {
            let mut steps = steps::Steps::default();
            steps.step("what the program prints", || printed::reprint(document));
            steps.finish(true)
        }
        _ => {
            eprintln!("usage: cargo xtask test [--nothing-skipped] | firmware | python | mutants | reprint DOCUMENT");
            ExitCode::from(2)
        }
    }
}
