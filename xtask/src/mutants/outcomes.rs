//! Record of mutants, over all runs: files in the folder of their part.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use super::Round;

/// Fates of mutants, over all runs.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Outcomes {
    pub(super) caught: BTreeSet<String>,
    pub(super) timeouts: BTreeSet<String>,
    unviable: BTreeSet<String>,
    /// Mutants that the quick tests left, that the comparison with C left, and that all tests left when they ran last.
    left: BTreeSet<String>,
    alike: BTreeSet<String>,
    pub(super) missed: BTreeSet<String>,
}

impl Outcomes {
    /// Reads what was written down.
    pub(super) fn read(folder: &Path) -> Self {
        let of = |name: &str| lines(&folder.join(name));
        let (caught, unviable) = (of("caught.txt"), of("unviable.txt"));
        let (left, alike, missed) = (of("left.txt"), of("alike.txt"), of("missed.txt"));
        Self { caught, timeouts: of("timeout.txt"), unviable, left, alike, missed }
    }

    /// Forgets that no test noticed these.
    pub(super) fn forget(&mut self, wanted: &BTreeSet<String>) {
        for open in [&mut self.left, &mut self.alike, &mut self.missed] {
            open.retain(|mutant| !wanted.contains(mutant));
        }
    }

    /// Adds what the last run found, also one that was ended early, and writes all down.
    pub(super) fn add(&mut self, folder: &Path, round: Round) -> io::Result<()> {
        let last = |name: &str| lines(&folder.join("mutants.out").join(name));
        self.caught.extend(last("caught.txt"));
        self.timeouts.extend(last("timeout.txt"));
        self.unviable.extend(last("unviable.txt"));
        match round {
            Round::Quick => self.left.extend(last("missed.txt")),
            Round::Twin => self.alike.extend(last("missed.txt")),
            Round::All => self.missed.extend(last("missed.txt")),
        }
        self.write(folder)?;
        // What was added is not added again as what another round found; its logs stay.
        let (out, last) = (folder.join("mutants.out"), folder.join("last"));
        if out.exists() {
            _ = std::fs::remove_dir_all(&last);
            std::fs::rename(out, last)?;
        }
        Ok(())
    }

    pub(super) fn write(&mut self, folder: &Path) -> io::Result<()> {
        let Self { caught, timeouts, unviable, left, alike, missed } = self;
        timeouts.retain(|mutant| !caught.contains(mutant));
        for open in [&mut *left, &mut *alike, &mut *missed] {
            open.retain(|mutant| !caught.contains(mutant) && !timeouts.contains(mutant));
        }
        for (name, mutants) in [
            ("caught.txt", caught),
            ("timeout.txt", timeouts),
            ("unviable.txt", unviable),
            ("left.txt", left),
            ("alike.txt", alike),
            ("missed.txt", missed),
        ] {
            let text: String = mutants.iter().map(|mutant| format!("{mutant}\n")).collect();
            std::fs::write(folder.join(name), text)?;
        }
        Ok(())
    }

    /// Mutants still to be tried in a round.
    pub(super) fn open<'m>(&self, wanted: &'m BTreeSet<String>, round: Round) -> Vec<&'m String> {
        let done = |mutant: &&String| {
            let known = [&self.caught, &self.timeouts, &self.unviable].iter().any(|set| set.contains(*mutant));
            known
                || match round {
                    Round::Quick => self.left.contains(*mutant),
                    Round::Twin => self.alike.contains(*mutant),
                    Round::All => false,
                }
        };
        wanted.iter().filter(|mutant| !done(mutant)).collect()
    }

    /// A test that never ends has noticed the mutant, too.
    pub(super) fn summary(&self, wanted: &BTreeSet<String>) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_findings_are_kept() {
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
        let alike = [("caught.txt", ""), ("missed.txt", "d\n"), ("timeout.txt", ""), ("unviable.txt", "")];
        let outcomes = run(Round::Twin, alike);
        assert_eq!(outcomes.open(&wanted, Round::Twin), ["c", "g"]);
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
        let mut again = Outcomes::read(&folder);
        again.forget(&wanted);
        assert_eq!(again.open(&wanted, Round::Quick), ["d", "g"], "what was caught stays caught");
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(Outcomes::default().summary(&wanted), "no mutants were tried");
    }
}
