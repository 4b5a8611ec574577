//! The steps that the search for waits takes, the same on every machine, recorded in `effort.txt`: the file shows what
//! a change of the search costs or saves. `EERUF_WRITE=1` rewrites it.

extern crate std;

use std::fmt::{Debug, Write as _};
use std::ops::ControlFlow;
use std::string::String;
use std::vec::Vec;
use std::{format, vec};

use super::{Budget, Objective, Owned, Random, Search, memory_words};
use crate::layout::Layout;
use crate::requirements::Criterion;
use crate::search::{Outcome, Progress};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/search/wait/tests/effort.txt");

/// The nodes that a question may cost.
const BUDGET: u64 = 3000;

/// A running checksum of steps: walks with equal sums took the same steps.
struct Trace {
    polls: u32,
    sum: u64,
}

impl Trace {
    const NEW: Self = Self { polls: 0, sum: 0xcbf2_9ce4_8422_2325 };

    /// Adds the `Debug` text of a value, by FNV-1a.
    fn add(&mut self, what: &impl Debug) {
        for byte in format!("{what:?};").bytes() {
            self.sum = (self.sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn poll(&mut self, progress: &Progress) -> ControlFlow<()> {
        self.polls += 1;
        self.add(progress);
        ControlFlow::Continue(())
    }
}

/// A line for each question asked.
#[derive(Default)]
struct Record(String);

impl Record {
    /// Runs a search with a watcher, and records its answer, its nodes and its schedule.
    fn ask<S: Debug>(
        &mut self,
        question: &str,
        answer: impl FnOnce(&mut dyn FnMut(&Progress) -> ControlFlow<()>) -> (String, u64, S),
    ) {
        let mut trace = Trace::NEW;
        let (says, nodes, schedule) = answer(&mut |progress| trace.poll(progress));
        trace.add(&schedule);
        let Trace { polls, sum } = trace;
        writeln!(self.0, "{question}: {says}; {nodes} nodes, {polls} polls, {:08x}", sum as u32).unwrap();
    }

    /// All questions about waits, for one problem.
    fn ask_waits(&mut self, name: &str, owned: &Owned) {
        let sensors = owned.lag.len();
        let search = Search::new(owned.problem());
        let mut memory = vec![0; memory_words(sensors)];
        let (mut a, mut b) = (vec![0; sensors], vec![0; sensors]);
        self.ask(&format!("{name} first"), |mut control| {
            let mut budget = Budget::nodes_at_most(BUDGET).watched(100, &mut control);
            let outcome = search.first(&mut memory, &mut budget, &mut a, &mut b).unwrap();
            (format!("{outcome:?}"), budget.nodes(), (&a, &b))
        });
        for objective in [Objective::Interval, Objective::Separation] {
            self.ask(&format!("{name} {objective:?}"), |mut control| {
                let mut budget = Budget::nodes_at_most(BUDGET).watched(100, &mut control);
                let best = search.best(objective, &mut memory, &mut budget, &mut a, &mut b).unwrap();
                (format!("{:?} <= {}", best.value, best.bound), best.nodes, (&a, &b))
            });
        }
        for words in [60, 4000] {
            self.ask(&format!("{name} count with {words} words"), |mut control| {
                let mut budget = Budget::nodes_at_most(10 * BUDGET).watched(1000, &mut control);
                let (outcome, count) = search.count(None, &mut vec![0; words], &mut budget);
                let whole = if outcome == Outcome::Exhausted { "" } else { " or more" };
                (format!("{count}{whole}"), budget.nodes(), ())
            });
        }
    }
}

/// Searches with the paper's lags in lines, rings and blocks of usual sizes, and with random graphs.
fn ask_all() -> Record {
    let mut record = Record::default();
    let mut random = Random(20_261_123);
    for (layout, name, sensors, separation) in [
        (Layout::Line(4), "Line", 4, 3),
        (Layout::Line(4), "Line", 6, 3),
        (Layout::Line(4), "Line", 8, 2),
        (Layout::Ring(4), "Ring", 8, 2),
        (Layout::Ring(4), "Ring", 12, 1),
        (Layout::Line(4), "Line", 12, 2),
        (Layout::Blocks(4), "Blocks", 8, 3),
    ] {
        for criterion in [Criterion::Exact, Criterion::Paper] {
            let owned = Owned::paper(sensors, layout, separation, criterion);
            record.ask_waits(&format!("waits of {name} {sensors} {criterion:?} D{separation}"), &owned);
        }
    }
    for case in 0..16 {
        let sensors = 2 + random.up_to(4) as usize;
        let density = 30 + random.up_to(60);
        let conflicts = graph(&mut random, sensors, density);
        let mut any = |least, most| least + random.up_to(most - least);
        let (period, wait_max) = (any(30, 60), any(5, 40));
        let wait_max = wait_max.min(period / 2);
        let lag = (0..sensors).map(|_| any(0, period - 1 - wait_max)).collect();
        let (separation, interval) = (any(0, 3), any(2, 12));
        let criterion = if case % 2 == 0 { Criterion::Exact } else { Criterion::Paper };
        let owned = Owned { lag, conflicts, period, wait_max, separation, interval, criterion };
        record.ask_waits(&format!("waits {case} of {sensors}"), &owned);
    }
    record
}

/// Conflicts between any two sensors, each with a probability of `density` percent.
fn graph(random: &mut Random, sensors: usize, density: u32) -> Vec<u64> {
    let mut drawn = vec![false; sensors * sensors];
    drawn.fill_with(|| random.up_to(99) < density);
    let conflict = |x: usize, y: usize| x != y && drawn[x.max(y) * sensors + x.min(y)];
    (0..sensors).map(|x| (0..sensors).filter(|&y| conflict(x, y)).map(|y| 1 << y).sum()).collect()
}

#[test]
fn each_search_takes_the_steps_that_are_written_down() {
    let Record(now) = ask_all();
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(FILE, &now).unwrap();
    }
    let kept = std::fs::read_to_string(FILE).unwrap_or_default();
    for (kept, now) in kept.lines().zip(now.lines()) {
        assert_eq!(now, kept, "the search takes other steps than are written down; EERUF_WRITE=1 rewrites them");
    }
    assert_eq!(now.lines().count(), kept.lines().count(), "EERUF_WRITE=1 writes what is asked now");
}
