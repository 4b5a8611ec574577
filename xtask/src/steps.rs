//! Steps of a check: each passes, fails, or is skipped with a reason; the last line counts them.

use std::fs::{self, File};
use std::io;
use std::process::{Command, ExitCode};
use std::thread::{self, JoinHandle};
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

    /// Waits for commands that run beside the steps, shows their output, and counts their steps with these.
    pub(crate) fn join(&mut self, beside: Beside) {
        for (verb, output) in beside.0.join().unwrap_or_default() {
            let output = output.unwrap_or_else(|error| error.to_string());
            println!("\n=== ran beside: cargo xtask {verb}\n{output}");
            self.count(&verb, &output);
        }
    }

    /// Adds the steps of a command by the lines with which [`Steps::finish`] ends its output.
    fn count(&mut self, verb: &str, output: &str) {
        let Some(passed) = output.lines().next_back().and_then(passed_in) else {
            self.failed.push(format!("{verb}: ended without a sum of its steps"));
            return;
        };
        self.passed += passed;
        let last = output.rsplit_once("\n=== ").map_or(output, |(_, last)| last);
        self.failed.extend(last.lines().filter_map(|line| line.strip_prefix("FAILED  ")).map(str::to_owned));
        self.skipped.extend(last.lines().filter_map(|line| line.strip_prefix("SKIPPED ")).map(str::to_owned));
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

/// The number of steps that passed, of the line that sums them up.
fn passed_in(line: &str) -> Option<u32> {
    let (passed, _) = line.ends_with(" skipped").then(|| line.split_once(" passed, "))??;
    passed.parse().ok()
}

/// Commands of this program that run one after the other beside the steps, on what processors those leave idle.
pub(crate) struct Beside(JoinHandle<Vec<(String, io::Result<String>)>>);

impl Beside {
    /// Starts the first; each writes what it says to a file of its own in `target/beside`.
    pub(crate) fn begin(commands: &'static [&'static [&'static str]]) -> Self {
        Self(thread::spawn(|| {
            commands.iter().map(|arguments| (arguments.join(" "), said_to_file(arguments))).collect()
        }))
    }
}

fn said_to_file(arguments: &[&str]) -> io::Result<String> {
    fs::create_dir_all("target/beside")?;
    let path = format!("target/beside/{}.log", arguments.join(""));
    let file = File::create(&path)?;
    Command::new(std::env::current_exe()?).args(arguments).stdout(file.try_clone()?).stderr(file).status()?;
    Ok(String::from_utf8_lossy(&fs::read(path)?).into_owned())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_a_command_beside_are_counted_by_its_last_lines() {
        let mut steps = Steps::default();
        steps.count(
            "c",
            "=== a\nFAILED  of a tool\n=== a: FAILED: exit status: 1\n\nFAILED  a: exit status: 1\nSKIPPED b: no gcc\n\
             3 passed, 1 failed, 1 skipped\n",
        );
        assert_eq!(
            (steps.passed, &steps.failed[..], &steps.skipped[..]),
            (3, &["a: exit status: 1".to_owned()][..], &["b: no gcc".to_owned()][..])
        );
    }

    #[test]
    fn a_command_beside_that_was_killed_is_a_failure() {
        for output in ["", "=== a\n", "3 passed"] {
            let mut steps = Steps::default();
            steps.count("c", output);
            assert_eq!((steps.passed, steps.failed.len()), (0, 1), "{output}");
        }
    }
}
