//! `cargo xtask mutants`: does a test fail when the code is broken?
//!
//! cargo-mutants breaks the core in one place at a time and runs its tests. Without `--search` it takes everything
//! outside `search/`; with it, one of ten parts of the mutants of `search/`, or whichever `--shard K/N` names. This
//! takes hours, so it is no part of `test`.
//!
//! First the quick tests run for each mutant; all tests run only for those that the quick ones leave. What was caught
//! is written down and not tried again, also when a run was ended early: delete the folder `target/mutants` to begin
//! anew. What it builds stands there too, so that a later run need not build what the tests use.
//!
//! Mutants that may survive stand in `.cargo/mutants.toml`, each with its reason.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The part of the search that is tried unless another is asked for.
const SHARD: &str = "0/10";

/// Tests that each take longer than all others together, by parts of their names; of the search, and of the rest.
const SLOW_OF_SEARCH: [&str; 4] = [
    "every_code_up_to_64_sensors",
    "period_ticks::",
    "of_64_sensors_is_found_up_to_the_longest_period",
    "sixty_four_sensors_in_one_clique",
];
const SLOW_OF_REST: [&str; 6] =
    ["every_code_up_to_64_sensors", "period_", "brute_force::", "wait_", "immediate_refiring_keeps", "one_path_of_any"];

/// Which tests run.
#[derive(Clone, Copy, Debug)]
enum Round {
    Quick,
    All,
}

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

    /// The files whose mutants are meant.
    fn source(&self) -> Vec<String> {
        let mut args = vec!["--package".to_owned(), "eeruf-core".to_owned()];
        let search = "crates/eeruf-core/src/search/**";
        let (which, files): (_, &[String]) = match (&*self.files, self.search) {
            ([], true) => ("--file", &[search.to_owned()]),
            ([], false) => ("--exclude", &[search.to_owned()]),
            (files, _) => ("--file", files),
        };
        for file in files {
            args.extend([which.to_owned(), file.clone()]);
        }
        args
    }

    /// Which of their mutants.
    fn shard(&self) -> Vec<String> {
        // Every N-th mutant, so that each part has some of each file.
        let shard = self.part().map(|part| ["--shard", part, "--sharding", "round-robin"].map(str::to_owned));
        shard.into_iter().flatten().collect()
    }

    /// How to try those that are not listed as caught before.
    fn args(&self, round: Round) -> Vec<String> {
        let mut args: Vec<String> =
            ["mutants", "--iterate", "--no-shuffle", "--colors", "never", "--output"].map(str::to_owned).to_vec();
        args.push(self.folder().display().to_string());
        args.extend(self.source());
        if let Round::Quick = round {
            // Nothing else is built.
            args.extend(["--cargo-arg=--lib", "--cargo-arg=--test=all", "--", "--"].map(str::to_owned));
            let slow: &[&str] = if self.search { &SLOW_OF_SEARCH } else { &SLOW_OF_REST };
            args.extend(slow.iter().flat_map(|name| ["--skip".to_owned(), (*name).to_owned()]));
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

/// What came of mutants, over all runs.
#[derive(Debug, Default, PartialEq)]
struct Outcomes {
    caught: BTreeSet<String>,
    timeouts: BTreeSet<String>,
    unviable: BTreeSet<String>,
    /// What the quick tests left, and what all did when they ran last.
    left: BTreeSet<String>,
    missed: BTreeSet<String>,
}

impl Outcomes {
    /// What was written down.
    fn read(folder: &Path) -> Self {
        let of = |name: &str| lines(&folder.join(name));
        let (caught, unviable) = (of("caught.txt"), of("unviable.txt"));
        Self { caught, timeouts: of("timeout.txt"), unviable, left: of("left.txt"), missed: of("missed.txt") }
    }

    /// Adds what the last run found, also one that was ended early, and writes all down.
    fn add(&mut self, folder: &Path, round: Round) -> io::Result<()> {
        let last = |name: &str| lines(&folder.join("mutants.out").join(name));
        self.caught.extend(last("caught.txt"));
        self.timeouts.extend(last("timeout.txt"));
        self.unviable.extend(last("unviable.txt"));
        match round {
            Round::Quick => self.left.extend(last("missed.txt")),
            Round::All => self.missed.extend(last("missed.txt")),
        }
        let Self { caught, timeouts, unviable, left, missed } = self;
        timeouts.retain(|mutant| !caught.contains(mutant));
        for open in [&mut *left, &mut *missed] {
            open.retain(|mutant| !caught.contains(mutant) && !timeouts.contains(mutant));
        }
        for (name, mutants) in [
            ("caught.txt", caught),
            ("timeout.txt", timeouts),
            ("unviable.txt", unviable),
            ("left.txt", left),
            ("missed.txt", missed),
        ] {
            let text: String = mutants.iter().map(|mutant| format!("{mutant}\n")).collect();
            std::fs::write(folder.join(name), text)?;
        }
        // What was added is not added again as what another round found; its logs stay.
        let (out, last) = (folder.join("mutants.out"), folder.join("last"));
        if out.exists() {
            _ = std::fs::remove_dir_all(&last);
            std::fs::rename(out, last)?;
        }
        Ok(())
    }

    /// Which of these are still to be tried in a round.
    fn open<'m>(&self, wanted: &'m BTreeSet<String>, round: Round) -> Vec<&'m String> {
        let done = |mutant: &&String| {
            let known = [&self.caught, &self.timeouts, &self.unviable].iter().any(|set| set.contains(*mutant));
            known || (matches!(round, Round::Quick) && self.left.contains(*mutant))
        };
        wanted.iter().filter(|mutant| !done(mutant)).collect()
    }

    /// A test that never ends has noticed the mutant, too.
    fn summary(&self, wanted: &BTreeSet<String>) -> String {
        let count = |set: &BTreeSet<String>| set.intersection(wanted).count();
        let (caught, timeouts, missed) = (count(&self.caught), count(&self.timeouts), count(&self.missed));
        let (noticed, unviable) = (caught + timeouts, count(&self.unviable));
        let all = noticed + missed;
        if all == 0 {
            return "no mutants were tried".to_owned();
        }
        let percent = 100.0 * noticed as f64 / all as f64;
        format!(
            "{caught} caught, {timeouts} timeouts, {missed} missed of {all}: {percent:.1} % noticed; \
             {unviable} more do not compile"
        )
    }
}

/// The mutants that a file names; none if there is no such file.
fn lines(file: &Path) -> BTreeSet<String> {
    std::fs::read_to_string(file).unwrap_or_default().lines().map(str::to_owned).collect()
}

/// Lists mutants as caught before, which cargo-mutants then leaves out. It does not deal out the parts itself: it would
/// do so after it has left out these, so that a part which is taken up again would be another one.
fn leave_out<'m>(folder: &Path, mutants: impl Iterator<Item = &'m String>) -> io::Result<()> {
    let out = folder.join("mutants.out");
    std::fs::create_dir_all(&out)?;
    let text: String = mutants.map(|mutant| format!("{mutant}\n")).collect();
    std::fs::write(out.join("previously_caught.txt"), text)
}

/// Breaks what the plan names, and says what no test noticed.
pub(crate) fn run(plan: &Plan) -> ExitCode {
    let installed = Command::new("cargo").args(["mutants", "--version"]).output().is_ok_and(|out| out.status.success());
    if !installed {
        eprintln!("NOT RUN: cargo-mutants is missing; install it with `cargo install --locked cargo-mutants`");
        return ExitCode::FAILURE;
    }
    match try_all(plan) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// How many were missed.
fn try_all(plan: &Plan) -> Result<usize, String> {
    let folder = plan.folder();
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    let cargo_failed = |error: io::Error| format!("cargo mutants: {error}");
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let list = |more: Vec<String>| -> Result<BTreeSet<String>, String> {
        let listed = Command::new("cargo").args(["mutants", "--list"]).args(plan.source()).args(more).output();
        let listed = listed.map_err(cargo_failed)?;
        if !listed.status.success() {
            return Err(String::from_utf8_lossy(&listed.stderr).into_owned());
        }
        Ok(String::from_utf8_lossy(&listed.stdout).lines().map(str::to_owned).collect())
    };
    let (all, wanted) = (list(vec![])?, list(plan.shard())?);
    let build = std::env::current_dir().map_err(failed)?.join("target/mutants/build");
    let mut outcomes = Outcomes::read(&folder);
    for round in [Round::Quick, Round::All] {
        // What a run left that was ended early.
        let began_in = folder.join("round.txt");
        if let Ok(began) = std::fs::read_to_string(&began_in) {
            outcomes.add(&folder, if began == "All" { Round::All } else { Round::Quick }).map_err(failed)?;
        }
        let open = outcomes.open(&wanted, round);
        if open.is_empty() {
            continue;
        }
        println!("{} mutants to try in round {round:?}", open.len());
        outcomes.missed.retain(|mutant| !open.contains(&mutant));
        std::fs::write(&began_in, format!("{round:?}")).map_err(failed)?;
        leave_out(&folder, all.iter().filter(|mutant| !open.contains(mutant))).map_err(failed)?;
        let mut cargo = Command::new("cargo");
        cargo.args(plan.args(round)).env("CARGO_TARGET_DIR", &build).env("CARGO_INCREMENTAL", "1");
        let status = cargo.status().map_err(cargo_failed)?;
        outcomes.add(&folder, round).map_err(failed)?;
        // 0 is all caught, 2 some missed and 3 some without end; anything else is trouble, such as tests that fail
        // unbroken.
        if !matches!(status.code(), Some(0 | 2 | 3)) {
            return Err(format!("cargo mutants did not finish: {status}; run this again to go on from there"));
        }
    }
    let missed: Vec<_> = outcomes.missed.intersection(&wanted).collect();
    for mutant in &missed {
        println!("missed: {mutant}");
    }
    for mutant in outcomes.timeouts.intersection(&wanted) {
        println!("timeout: {mutant}");
    }
    println!("{}", outcomes.summary(&wanted));
    Ok(missed.len())
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
        let other = plan(true, Some("3/20"));
        assert_eq!(other.source().join(" "), "--package eeruf-core --file crates/eeruf-core/src/search/**");
        assert_eq!(other.shard().join(" "), "--shard 3/20 --sharding round-robin");
        let rest = plan(false, None);
        assert!(rest.source().join(" ").ends_with("--exclude crates/eeruf-core/src/search/**"), "{rest:?}");
        assert!(rest.shard().is_empty());
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in ["", "3", "3/3", "-1/3", "1/x"] {
            assert_eq!(shard(text).unwrap_err(), "expected K/N with K from 0 to N - 1, such as 0/10");
        }
    }

    #[test]
    fn the_quick_tests_come_first_and_differ_for_the_search() {
        let quick = plan(false, Some("0/17")).args(Round::Quick).join(" ");
        assert!(quick.contains("--cargo-arg=--lib --cargo-arg=--test=all -- -- --skip every_code"), "{quick}");
        assert!(quick.contains("--skip brute_force::") && !quick.contains("--shard"), "{quick}");
        let search = plan(true, None).args(Round::Quick).join(" ");
        assert!(!search.contains("brute_force"), "what judges the search is needed there: {search}");
        let all = plan(false, None).args(Round::All).join(" ");
        assert!(all.ends_with("--exclude crates/eeruf-core/src/search/**"), "{all}");
    }

    #[test]
    fn what_earlier_runs_found_is_kept_and_what_does_not_compile_is_not_counted() {
        let folder = std::env::temp_dir().join(format!("eeruf-mutants-{}", std::process::id()));
        let out = folder.join("mutants.out");
        let wanted: BTreeSet<String> = ["a", "b", "c", "d", "e", "f", "g"].map(str::to_owned).into();
        let run = |round, files: [(&str, &str); 4]| {
            std::fs::create_dir_all(&out).unwrap();
            for (name, text) in files {
                std::fs::write(out.join(name), text).unwrap();
            }
            let mut outcomes = Outcomes::read(&folder);
            outcomes.add(&folder, round).unwrap();
            assert_eq!(Outcomes::read(&folder), outcomes, "all of it is written down");
            outcomes
        };
        // Ended before `g` was tried.
        let quick =
            [("caught.txt", "a\nb\n"), ("missed.txt", "c\nd\n"), ("timeout.txt", "e\n"), ("unviable.txt", "f\n")];
        let outcomes = run(Round::Quick, quick);
        assert_eq!(outcomes.open(&wanted, Round::Quick), ["g"]);
        assert_eq!(outcomes.open(&wanted, Round::All), ["c", "d", "g"]);
        let all = [("caught.txt", "c\n"), ("missed.txt", "d\n"), ("timeout.txt", ""), ("unviable.txt", "")];
        let outcomes = run(Round::All, all);
        let says = "3 caught, 1 timeouts, 1 missed of 5: 80.0 % noticed; 1 more do not compile";
        assert_eq!(outcomes.summary(&wanted), says);
        // What stood elsewhere before the source changed is not counted.
        let now: BTreeSet<String> = ["a", "d"].map(str::to_owned).into();
        assert_eq!(
            outcomes.summary(&now),
            "1 caught, 0 timeouts, 1 missed of 2: 50.0 % noticed; 0 more do not compile"
        );
        assert!(!out.exists(), "or it would be added once more");
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(Outcomes::default().summary(&wanted), "no mutants were tried");
    }
}
