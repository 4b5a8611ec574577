//! `cargo xtask mutants`: does a test fail when the code is broken?
//!
//! cargo-mutants breaks the core in one place at a time and runs its tests. Without `--search` it takes everything
//! outside `search/`; with it, one of ten parts of the mutants of `search/`, or whichever `--shard K/N` names. This
//! takes hours, so it is no part of `test`.
//!
//! First the quick tests run for each mutant; the comparison with the C library runs only for those that the quick
//! ones leave (not for the search, which C does not have), and all tests of the core only for what that leaves. What
//! came of a mutant is written down and not tried again, also when a run was ended early: `--again` tries once more
//! what no test noticed, as after new tests; delete the folder `target/mutants` to begin anew. What it builds stands
//! there too, so that a later run need not build what the tests use.
//!
//! Mutants that may survive stand in `.cargo/mutants.toml`, each with its reason.

mod outcomes;

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use outcomes::Outcomes;

/// The part of the search that is tried unless another is asked for.
const SHARD: &str = "0/10";

/// Tests that each take longer than all others together, by parts of their paths, so that none is left out for its name
/// alone; of the search, and of the rest.
const SLOW_OF_SEARCH: [&str; 4] = [
    "every_code_up_to_64_sensors",
    "period_ticks::",
    "of_64_sensors_is_found_up_to_the_longest_period",
    "sixty_four_sensors_in_one_clique",
];
const SLOW_OF_REST: [&str; 16] = [
    "every_code_up_to_64_sensors",
    "brute_force::",
    "effort::",
    "period_corpus::",
    "period_edges::",
    "period_limits::",
    "period_small::",
    "period_ticks::",
    "period_variants::",
    "wait_limits::",
    "wait_small::",
    "wait_tables::",
    "immediate_refiring_keeps",
    "finer_ticks_gain",
    "no_repeating_pattern",
    "below_the_bound_of_classes",
];

/// Features of the core that have tests.
const FEATURES: &str = "embassy-time,fugit,serde";

/// Tests of a round.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Round {
    Quick,
    /// The comparison with the C library, event by event.
    Twin,
    All,
}

impl Round {
    const EACH: [Self; 3] = [Self::Quick, Self::Twin, Self::All];

    fn of(name: &str) -> Self {
        Self::EACH.into_iter().find(|round| format!("{round:?}") == name).unwrap_or(Self::All)
    }

    /// Tests that use the processor for longer than this are ended and have failed: a loop without end takes little of
    /// a busy machine's time, and a machine that is only busy ends nothing. Unbroken they take a third of it.
    fn most_seconds(self, search: bool) -> Option<u32> {
        match self {
            _ if !cfg!(target_os = "linux") => None,
            Self::Quick | Self::Twin => Some(if search { 30 } else { 10 }),
            Self::All => None,
        }
    }

    /// Environment of a round beside what is set for all: few cases, and the same ones for each mutant.
    fn environment(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Quick => &[("PROPTEST_CASES", "16"), ("PROPTEST_RNG_SEED", "1")],
            Self::Twin => &[("EERUF_C_EVENTS", "100000")],
            Self::All => &[],
        }
    }
}

/// Parts to break.
#[derive(clap::Args, Debug)]
pub(crate) struct Plan {
    /// Break the search instead of everything outside it
    #[arg(long)]
    search: bool,
    /// Only the part K of N, with K from 0; a tenth of the search unless another is named
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<String>,
    /// Try again what no test noticed before
    #[arg(long)]
    again: bool,
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

    /// The shard of their mutants.
    fn shard(&self) -> Vec<String> {
        // Every N-th mutant, so that each part has some of each file.
        let shard = self.part().map(|part| ["--shard", part, "--sharding", "round-robin"].map(str::to_owned));
        shard.into_iter().flatten().collect()
    }

    /// Arguments that try those that are not listed as caught before.
    fn args(&self, round: Round) -> Vec<String> {
        let mut args: Vec<String> =
            ["mutants", "--iterate", "--no-shuffle", "--colors", "never", "--output"].map(str::to_owned).to_vec();
        args.push(self.folder().display().to_string());
        // Tests of the search compute for long, those of the rest hardly, and then building counts more.
        let level = u8::from(self.search);
        args.push(format!("--cargo-arg=--config=profile.dev.package.eeruf-core.opt-level={level}"));
        args.extend(self.source());
        args.extend(round.most_seconds(self.search).map(|seconds| {
            format!(r#"--cargo-arg=--config=target.'cfg(target_os = "linux")'.runner=["prlimit", "--cpu={seconds}"]"#)
        }));
        // What is built only with a feature can be noticed only with it.
        let features = format!("--features={FEATURES}");
        match round {
            Round::Quick => {
                // Nothing else is built.
                args.extend([&features, "--cargo-arg=--lib", "--cargo-arg=--test=all", "--", "--"].map(str::to_owned));
                let slow: &[&str] = if self.search { &SLOW_OF_SEARCH } else { &SLOW_OF_REST };
                args.extend(slow.iter().flat_map(|name| ["--skip".to_owned(), (*name).to_owned()]));
            }
            Round::Twin => {
                // cargo-mutants would ask the core's own tests about unbroken code; `passes_unbroken` asks these.
                let unbroken = ["--baseline=skip", "--timeout=120"];
                let twin = ["--test-package=eeruf-c-equal", "--cargo-arg=--test=all"];
                args.extend(unbroken.into_iter().chain(twin).map(str::to_owned));
            }
            Round::All => args.push(features),
        }
        args
    }

    /// The rounds that can notice anything.
    fn rounds(&self) -> impl Iterator<Item = Round> {
        let search = self.search;
        Round::EACH.into_iter().filter(move |round| !(search && *round == Round::Twin))
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

/// Lists mutants as caught before, which cargo-mutants then leaves out. It does not deal out the parts itself: it would
/// do so after it has left out these, so that a part which is taken up again would be another one.
fn leave_out<'m>(folder: &Path, mutants: impl Iterator<Item = &'m String>) -> io::Result<()> {
    let out = folder.join("mutants.out");
    std::fs::create_dir_all(&out)?;
    let text: String = mutants.map(|mutant| format!("{mutant}\n")).collect();
    std::fs::write(out.join("previously_caught.txt"), text)
}

/// Returns true if the comparison with the C library passes as the code is: else it would notice each mutant.
fn passes_unbroken(build: &Path) -> bool {
    let mut cargo = Command::new("cargo");
    cargo.args(["test", "--quiet", "--package", "eeruf-c-equal", "--test", "all"]).env("CARGO_TARGET_DIR", build);
    cargo.envs(Round::Twin.environment().iter().copied());
    cargo.status().is_ok_and(|status| status.success())
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

/// Number of mutants that were missed.
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
    // What a run left that was ended early.
    let began_in = folder.join("round.txt");
    if let Ok(began) = std::fs::read_to_string(&began_in) {
        outcomes.add(&folder, Round::of(&began)).map_err(failed)?;
    }
    if plan.again {
        outcomes.forget(&wanted);
        outcomes.write(&folder).map_err(failed)?;
    }
    for round in plan.rounds() {
        let open = outcomes.open(&wanted, round);
        if open.is_empty() {
            continue;
        }
        println!("{} mutants to try in round {round:?}", open.len());
        if round == Round::Twin && !passes_unbroken(&build) {
            return Err("the comparison with the C library fails though nothing is broken".to_owned());
        }
        outcomes.missed.retain(|mutant| !open.contains(&mutant));
        std::fs::write(&began_in, format!("{round:?}")).map_err(failed)?;
        leave_out(&folder, all.iter().filter(|mutant| !open.contains(mutant))).map_err(failed)?;
        let mut cargo = Command::new("cargo");
        cargo.args(plan.args(round)).env("CARGO_TARGET_DIR", &build).env("CARGO_INCREMENTAL", "1");
        cargo.envs(round.environment().iter().copied());
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
        Plan { search, shard: shard.map(str::to_owned), again: false, files: vec![] }
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
        assert!(quick.contains("--features=embassy-time,fugit,serde"), "{quick}");
        assert_eq!(quick.contains(r#"runner=["prlimit", "--cpu=10"]"#), cfg!(target_os = "linux"), "{quick}");
        assert!(quick.contains("--skip brute_force::") && !quick.contains("--shard"), "{quick}");
        let search = plan(true, None).args(Round::Quick).join(" ");
        assert!(!search.contains("brute_force"), "what judges the search is needed there: {search}");
        assert_eq!(search.contains(r#"runner=["prlimit", "--cpu=30"]"#), cfg!(target_os = "linux"), "{search}");
        assert!(search.contains("eeruf-core.opt-level=1") && quick.contains("eeruf-core.opt-level=0"), "{search}");
        let all = plan(false, None).args(Round::All).join(" ");
        assert!(
            all.ends_with("--exclude crates/eeruf-core/src/search/** --features=embassy-time,fugit,serde"),
            "{all}"
        );
    }

    #[test]
    fn c_judges_what_it_has_and_nothing_of_the_search() {
        let rounds = |search| plan(search, None).rounds().collect::<Vec<_>>();
        assert_eq!((rounds(false), rounds(true)), (Round::EACH.to_vec(), vec![Round::Quick, Round::All]));
        let twin = plan(false, None).args(Round::Twin).join(" ");
        assert!(twin.ends_with("--test-package=eeruf-c-equal --cargo-arg=--test=all"), "{twin}");
        assert!(Round::EACH.into_iter().all(|round| Round::of(&format!("{round:?}")) == round));
    }
}
