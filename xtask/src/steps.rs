//! Steps of a check: each passes, fails, or is skipped with a reason; the last line counts them.

use std::process::{Command, ExitCode};
use std::time::Instant;

/// Why a step did not pass.
pub(crate) enum Trouble {
    /// It ran and failed.
    Failed(String),
    /// Something it needs is not installed.
    Skipped(String),
}

/// Results of all steps so far.
#[derive(Default)]
pub(crate) struct Steps {
    passed: u32,
    failed: Vec<String>,
    skipped: Vec<String>,
}

impl Steps {
    /// Runs one step and says how it went. A failure does not keep the others from running.
    pub(crate) fn step(&mut self, name: &str, run: impl FnOnce() -> Result<(), Trouble>) {
        println!("\n=== {name}");
        let began = Instant::now();
        match run() {
            Ok(()) => {
                self.passed += 1;
                println!("=== {name}: passed in {:.0} s", began.elapsed().as_secs_f64());
            }
            Err(Trouble::Failed(why)) => {
                println!("=== {name}: FAILED: {why}");
                self.failed.push(format!("{name}: {why}"));
            }
            Err(Trouble::Skipped(why)) => {
                println!("=== {name}: SKIPPED: {why}");
                self.skipped.push(format!("{name}: {why}"));
            }
        }
    }

    /// Sums up. Skipped steps are failures if nothing may be skipped.
    pub(crate) fn finish(self, nothing_skipped: bool) -> ExitCode {
        println!();
        for failed in &self.failed {
            println!("FAILED  {failed}");
        }
        for skipped in &self.skipped {
            println!("SKIPPED {skipped}");
        }
        println!("{} passed, {} failed, {} skipped", self.passed, self.failed.len(), self.skipped.len());
        let fine = self.failed.is_empty() && (self.skipped.is_empty() || !nothing_skipped);
        if fine { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

/// Runs a command with our output; an error names it.
pub(crate) fn run(command: &mut Command) -> Result<(), Trouble> {
    let line = format!("{command:?}").replace('"', "");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Trouble::Failed(format!("{line}: {status}"))),
        Err(error) => Err(Trouble::Failed(format!("{line}: {error}"))),
    }
}

/// Runs a command of cargo that comes with a component of the toolchain; it is skipped where that is not installed.
pub(crate) fn run_component(component: &str, args: &[&str]) -> Result<(), Trouble> {
    let name = args.first().copied().unwrap_or_default();
    if output(Command::new("cargo").args([name, "--version"])).is_none() {
        return Err(Trouble::Skipped(format!("no cargo {name}; try: rustup component add {component}")));
    }
    run(Command::new("cargo").args(args))
}

/// The output of a command, or `None` if it cannot be run or fails.
pub(crate) fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
