//! The doctor's verdicts on logs with known truth: no false `none seen`, and no false blame. `cargo run --release
//! --example verdicts` counts over more.

use std::fmt;

use eeruf_logs::{Examination, LogVerdict};

use crate::worlds::{Healthy, blocking_loop, free_running, healthy};

/// Counts over logs.
#[derive(Debug, Default)]
pub(crate) struct Counts {
    /// Free-running logs with at least 5 % wrong readings: all, those called none seen, and those with a suspect or a
    /// fooled sensor.
    pub(crate) free: [usize; 3],
    /// Pairs that fool in at least 60 % of the rounds of a blocking loop: all, and those named; then
    /// the named pairs of sensors that take no part in crosstalk.
    pub(crate) pairs: [usize; 3],
    /// Healthy logs: all, those blamed, and those with a suspect though nothing chatters.
    pub(crate) healthy: [usize; 3],
    /// Logs with stamps of firings in turn or by alternating lags, without chatter: all, and those called none seen.
    pub(crate) seen: [usize; 2],
}

fn is_blamed(found: &Examination) -> bool {
    found.verdict == LogVerdict::Crosstalk || found.suspects.iter().any(|of| of.by.is_some())
}

impl Counts {
    /// Counts over this many logs of each kind, from a seed on.
    pub(crate) fn of(first: u64, logs: u64) -> Self {
        let mut all = Self::default();
        for seed in first..first + logs {
            let log = free_running(seed, true, false);
            if log.wrong >= 0.05 {
                let found = log.examine();
                let is_seen = found.verdict == LogVerdict::NoneSeen;
                let flagged = !found.suspects.is_empty() || found.verdict == LogVerdict::Crosstalk;
                all.free = [all.free[0] + 1, all.free[1] + usize::from(is_seen), all.free[2] + usize::from(flagged)];
            }
            let log = blocking_loop(seed, true);
            let found = log.examine();
            let named: Vec<_> = found.suspects.iter().filter_map(|of| Some((of.by?, of.sensor))).collect();
            let fooled: Vec<_> = log.fooled.iter().filter(|(_, share)| **share >= 0.6).map(|(pair, _)| pair).collect();
            all.pairs[0] += fooled.len();
            all.pairs[1] += fooled.iter().filter(|pair| named.contains(pair)).count();
            // In a chain a third sensor moves with two; a pair is false if neither takes part in crosstalk.
            let is_of = |sensor: usize| log.fooled.keys().any(|&(a, b)| sensor == a || sensor == b);
            all.pairs[2] += named.iter().filter(|pair| !is_of(pair.0) && !is_of(pair.1)).count();
            all.healthy[1] += usize::from(is_blamed(&blocking_loop(seed, false).examine()));
            all.healthy[0] += 1;
            for kind in [Healthy::InTurn, Healthy::Alternating, Healthy::Polled, Healthy::Server] {
                let chatter = (seed + kind as u64).is_multiple_of(10);
                let found = healthy(seed, kind, chatter).examine();
                all.healthy[0] += 1;
                all.healthy[1] += usize::from(is_blamed(&found));
                all.healthy[2] += usize::from(!chatter && !found.suspects.is_empty());
                if !chatter && matches!(kind, Healthy::InTurn | Healthy::Alternating) {
                    all.seen[0] += 1;
                    all.seen[1] += usize::from(found.verdict == LogVerdict::NoneSeen);
                }
            }
        }
        all
    }
}

impl Counts {
    /// Panics if too many verdicts are wrong, or too few are given.
    pub(crate) fn hold(&self) {
        let Self { free, pairs, healthy, seen } = self;
        assert!(free[0] >= 10 && free[1] == 0 && free[2] * 10 >= free[0] * 8, "{self}");
        assert!(pairs[1] * 10 >= pairs[0] * 8 && pairs[2] * 100 <= pairs[0], "{self}");
        assert!(healthy[1] * 100 <= healthy[0] && seen[1] * 10 >= seen[0] * 6, "{self}");
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { free, pairs, healthy, seen } = self;
        writeln!(f, "free-running, 5 % wrong: {} logs, none seen {}, flagged {}", free[0], free[1], free[2])?;
        writeln!(f, "blocking loops: {} pairs, named {}; without part in any: {}", pairs[0], pairs[1], pairs[2])?;
        writeln!(f, "healthy: {} logs, blamed {}, suspected {}", healthy[0], healthy[1], healthy[2])?;
        write!(f, "in turn or alternating, 300 rounds: {} logs, none seen {}", seen[0], seen[1])
    }
}

#[test]
fn verdicts_hold_on_logs_of_known_truth() {
    Counts::of(20_000, 12).hold();
}
