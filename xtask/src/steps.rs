//! Steps of a check: each passes, fails, or is skipped with a reason; the last line counts them.

use anyhow::{Context as _, Result, bail, ensure};
use std::fmt;
use std::io;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::thread::{self, JoinHandle};
use std::time::Instant;

use fs_err::{self as fs, File};

/// The error of a step that did not run because something it needs is not installed.
#[derive(Debug)]
pub(crate) struct Skipped(String);

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Skipped {}

/// Ends a step as skipped.
pub(crate) fn skip<T>(why: impl Into<String>) -> Result<T> {
    Err(Skipped(why.into()).into())
}

/// Results of all steps so far.
#[derive(Default)]
pub(crate) struct Steps {
    passed: u32,
    failed: Vec<String>,
    skipped: Vec<String>,
}

impl Steps {
    /// Runs one step and prints the result. A failure does not stop the others. Returns the step's value if it passed.
    pub(crate) fn step<T>(&mut self, name: &str, run: impl FnOnce() -> Result<T>) -> Option<T> {
        println!("\n=== {name}");
        let began = Instant::now();
        match run() {
            Ok(given) => {
                self.passed += 1;
                println!("=== {name}: passed in {:.0} s", began.elapsed().as_secs_f64());
                Some(given)
            }
            Err(error) => {
                let (how, list) = match error.is::<Skipped>() {
                    true => ("SKIPPED", &mut self.skipped),
                    false => ("FAILED", &mut self.failed),
                };
                println!("=== {name}: {how}: {error:#}");
                list.push(format!("{name}: {error:#}"));
                None
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

/// The number of steps that passed, from the line that sums them up.
fn passed_in(line: &str) -> Option<u32> {
    let (passed, _) = line.ends_with(" skipped").then(|| line.split_once(" passed, "))??;
    passed.parse().ok()
}

/// Commands of this program that run one after the other beside the steps, on idle processors.
pub(crate) struct Beside(JoinHandle<Vec<(String, io::Result<String>)>>);

impl Beside {
    /// Starts the first command; each writes its output to a file of its own in `target/beside`.
    pub(crate) fn begin(commands: &'static [&'static [&'static str]]) -> Self {
        Self(thread::spawn(|| {
            commands.iter().map(|arguments| (arguments.join(" "), said_to_file(arguments))).collect()
        }))
    }
}

fn said_to_file(arguments: &[&str]) -> io::Result<String> {
    fs::create_dir_all("target/beside")?;
    let path = format!("target/beside/{}.log", arguments.join(""));
    let file = File::create(&path)?.into_parts().0;
    // The tests of the workspace may have built this program again, and then the file that runs here has no path.
    let program = std::env::args_os().next().unwrap_or_else(|| "target/debug/xtask".into());
    Command::new(program).args(arguments).stdout(file.try_clone()?).stderr(file).status()?;
    Ok(String::from_utf8_lossy(&fs::read(path)?).into_owned())
}

/// Runs a command with our output; an error names it.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    match command.status().with_context(|| line(command))? {
        status if status.success() => Ok(()),
        status => bail!("{}: {status}", line(command)),
    }
}

/// Runs a command of words between spaces.
pub(crate) fn run_line(words: &str) -> Result<()> {
    run(&mut command(words))
}

/// A command of words between spaces.
pub(crate) fn command(words: &str) -> Command {
    let mut words = words.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words);
    command
}

/// The output of a command, without its last line's end.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let output = command.output().with_context(|| line(command))?;
    if !output.status.success() {
        bail!("{}: {}\n{}", line(command), output.status, String::from_utf8_lossy(&output.stderr));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim_end().to_owned())
}

fn line(command: &Command) -> String {
    format!("{command:?}").replace('"', "")
}

/// Skips a step unless a program answers, as in `need("npm --version", "apt install npm")`.
pub(crate) fn need(words: &str, install: &str) -> Result<()> {
    match output(&mut command(words)) {
        Ok(_) => Ok(()),
        Err(_) => skip(format!("`{words}` does not run; try: {install}")),
    }
}

/// Runs a command of cargo that comes with a component of the toolchain; it is skipped where that is not installed.
pub(crate) fn run_component(component: &str, words: &str) -> Result<()> {
    let name = words.split(' ').next().unwrap_or_default();
    need(&format!("cargo {name} --version"), &format!("rustup component add {component}"))?;
    run_line(&format!("cargo {words}"))
}

/// Makes an empty folder, without what an earlier run left in it.
pub(crate) fn empty(folder: impl AsRef<Path>) -> Result<()> {
    let folder = folder.as_ref();
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    Ok(fs::create_dir_all(folder)?)
}

/// A text with parts replaced, each of which must occur in it.
pub(crate) fn edited(text: &str, parts: &[(&str, &str)]) -> Result<String> {
    parts.iter().try_fold(text.to_owned(), |text, (from, to)| {
        ensure!(text.contains(from), "no `{from}` in the text that it should be replaced in");
        Ok(text.replace(from, to))
    })
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

    #[test]
    fn a_missing_program_skips_a_step_and_a_failing_one_fails_it() {
        let mut steps = Steps::default();
        steps.step("a", || need("no-such-program --version", "nothing"));
        steps.step("b", || run_line("cargo no-such-command"));
        assert_eq!((steps.passed, steps.failed.len(), steps.skipped.len()), (0, 1, 1));
    }
}
