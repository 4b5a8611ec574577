//! `cargo xtask mutants`: does a test fail when the code is broken?
//!
//! cargo-mutants breaks the core in one place at a time and runs its tests. Without `--search` it takes everything
//! outside `search/`; with it, one of ten parts of the mutants of `search/`, or whichever `--shard K/N` names. What was
//! caught in an earlier run is not tried again: delete the folder `target/mutants` to begin anew. This takes hours, so
//! it is no part of `test`.
//!
//! Mutants that may survive stand in `.cargo/mutants.toml`, each with its reason.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The part of the search that is tried unless another is asked for.
const SHARD: &str = "0/10";

/// What to break.
#[derive(clap::Args, Debug)]
pub(crate) struct Plan {
    /// Break the search instead of everything outside it
    #[arg(long)]
    search: bool,
    /// Only the part K of N, with K from 0; a tenth of the search unless another is named
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<String>,
    /// Only these files, as globs
    #[arg(value_name = "FILE")]
    files: Vec<String>,
}

impl Plan {
    /// The part to try, if not all.
    fn part(&self) -> Option<&str> {
        self.shard.as_deref().or(self.search.then_some(SHARD))
    }

    /// Where results are kept; each part of the search apart, so that a later run takes up the right one.
    fn folder(&self) -> PathBuf {
        let part = self.part().map_or(String::new(), |shard| format!("-{}", shard.replace('/', "-of-")));
        Path::new("target/mutants").join(format!("{}{part}", if self.search { "search" } else { "core" }))
    }

    fn args(&self) -> Vec<String> {
        let mut args: Vec<String> =
            ["mutants", "--package", "eeruf-core", "--iterate", "--no-shuffle", "--colors", "never", "--output"]
                .map(str::to_owned)
                .to_vec();
        args.push(self.folder().display().to_string());
        let search = "crates/eeruf-core/src/search/**";
        let (which, files): (_, &[String]) = match (&*self.files, self.search) {
            ([], true) => ("--file", &[search.to_owned()]),
            ([], false) => ("--exclude", &[search.to_owned()]),
            (files, _) => ("--file", files),
        };
        for file in files {
            args.extend([which.to_owned(), file.clone()]);
        }
        if let Some(shard) = self.part() {
            // Every N-th mutant, so that each part has some of each file.
            args.extend(["--shard", shard, "--sharding", "round-robin"].map(str::to_owned));
        }
        args
    }
}

/// Reads a part, "K/N".
fn shard(text: &str) -> Result<String, String> {
    let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse::<u32>().ok()?, n.parse::<u32>().ok()?)));
    match parts {
        Some((k, n)) if k < n => Ok(text.to_owned()),
        _ => Err(format!("expected K/N with K from 0 to N - 1, such as {SHARD}")),
    }
}

/// How many mutants came to what, over all runs.
#[derive(Debug, Default, PartialEq)]
struct Outcomes {
    caught: usize,
    missed: Vec<String>,
    timeouts: Vec<String>,
}

impl Outcomes {
    /// Adds up the lists that one run left, and what earlier runs had caught.
    fn read(folder: &Path) -> Self {
        let lines = |name: &str| -> Vec<String> {
            let text = std::fs::read_to_string(folder.join("mutants.out").join(name)).unwrap_or_default();
            text.lines().map(str::to_owned).collect()
        };
        let mut caught = lines("caught.txt");
        caught.extend(lines("previously_caught.txt"));
        caught.sort_unstable();
        caught.dedup();
        let timeouts = lines("timeout.txt");
        caught.retain(|mutant| !timeouts.contains(mutant));
        Self { caught: caught.len(), missed: lines("missed.txt"), timeouts }
    }

    /// A test that never ends has noticed the mutant, too.
    fn summary(&self) -> String {
        let (missed, timeouts) = (self.missed.len(), self.timeouts.len());
        let noticed = self.caught + timeouts;
        let all = noticed + missed;
        if all == 0 {
            return "no mutants were tried".to_owned();
        }
        let percent = 100.0 * noticed as f64 / all as f64;
        format!("{} caught, {timeouts} timeouts, {missed} missed of {all}: {percent:.1} % noticed", self.caught)
    }
}

/// Breaks what the plan names, and says what no test noticed.
pub(crate) fn run(plan: &Plan) -> ExitCode {
    let installed = Command::new("cargo").args(["mutants", "--version"]).output().is_ok_and(|out| out.status.success());
    if !installed {
        eprintln!("NOT RUN: cargo-mutants is missing; install it with `cargo install --locked cargo-mutants`");
        return ExitCode::FAILURE;
    }
    let folder = plan.folder();
    if let Err(error) = std::fs::create_dir_all(&folder) {
        eprintln!("{}: {error}", folder.display());
        return ExitCode::FAILURE;
    }
    // 0 is all caught, 2 some missed and 3 some without end; anything else is trouble, such as tests that fail
    // unbroken.
    let status = match Command::new("cargo").args(plan.args()).status() {
        Ok(status) => status,
        Err(error) => {
            eprintln!("cargo mutants: {error}");
            return ExitCode::FAILURE;
        }
    };
    let outcomes = Outcomes::read(&folder);
    for mutant in &outcomes.missed {
        println!("missed: {mutant}");
    }
    for mutant in &outcomes.timeouts {
        println!("timeout: {mutant}");
    }
    println!("{}", outcomes.summary());
    match status.code() {
        Some(0 | 2 | 3) if outcomes.missed.is_empty() => ExitCode::SUCCESS,
        Some(0 | 2 | 3) => ExitCode::FAILURE,
        _ => {
            eprintln!("cargo mutants did not finish: {status}; run this again to take it up where it stopped");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(search: bool, shard: Option<&str>) -> Plan {
        Plan { search, shard: shard.map(str::to_owned), files: vec![] }
    }

    #[test]
    fn the_search_is_tried_in_tenths_unless_another_part_is_named() {
        let tenth = plan(true, None);
        assert_eq!((tenth.part(), tenth.folder()), (Some("0/10"), "target/mutants/search-0-of-10".into()));
        let other = plan(true, Some("3/20")).args().join(" ");
        assert!(
            other.ends_with("--file crates/eeruf-core/src/search/** --shard 3/20 --sharding round-robin"),
            "{other}"
        );
        let rest = plan(false, None).args().join(" ");
        assert!(rest.ends_with("--output target/mutants/core --exclude crates/eeruf-core/src/search/**"), "{rest}");
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in ["", "3", "3/3", "-1/3", "1/x"] {
            assert_eq!(shard(text).unwrap_err(), "expected K/N with K from 0 to N - 1, such as 0/10");
        }
    }

    #[test]
    fn the_summary_counts_what_earlier_runs_caught_once() {
        let folder = std::env::temp_dir().join(format!("eeruf-mutants-{}", std::process::id()));
        let out = folder.join("mutants.out");
        std::fs::create_dir_all(&out).unwrap();
        for (name, text) in [
            ("caught.txt", "a\nb\n"),
            ("previously_caught.txt", "b\nc\nd\n"),
            ("missed.txt", "e\n"),
            ("timeout.txt", "d\n"),
        ] {
            std::fs::write(out.join(name), text).unwrap();
        }
        let outcomes = Outcomes::read(&folder);
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(outcomes.summary(), "3 caught, 1 timeouts, 1 missed of 5: 80.0 % noticed");
        assert_eq!(Outcomes::default().summary(), "no mutants were tried");
    }
}
