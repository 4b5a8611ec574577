//! Steps of each search for its answer, the same on each machine: written down in `tests/data/search-effort.txt`. A
//! change that makes it take other steps shows there what it costs or saves. `EERUF_WRITE=1` rewrites the file.

use std::fmt::{Debug, Write as _};
use std::ops::ControlFlow;

use eeruf_core::Criterion;
use eeruf_core::search::design::{
    Problem, decide, maximize_interval, maximize_separation, memory_words as period_words, prefer, shortest,
};
use eeruf_core::search::wait::{Budget, Objective, memory_words as wait_words};
use eeruf_core::search::{Outcome, Progress};

use crate::common::Owned;
use crate::common::naive::{self, Layout};
use crate::common::random::Random;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/search-effort.txt");

/// The nodes that a question may cost.
const BUDGET: u64 = 3000;

/// Adds what it is shown to a sum, in order: two walks of the same sum went the same way.
struct Trace {
    polls: u32,
    sum: u64,
}

impl Trace {
    const NEW: Self = Self { polls: 0, sum: 0xcbf2_9ce4_8422_2325 };

    /// FNV-1a over what `Debug` says.
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
    /// Asks a question: what is asked is handed a watcher, and says its answer, the nodes it took and a schedule.
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

    /// All questions about periods, for one problem.
    fn ask_periods(&mut self, name: &str, problem: &Problem<'_>) {
        let mut memory = vec![0; period_words(problem.sensors)];
        let mut found = None;
        self.ask(&format!("{name} shortest"), |mut control| {
            let shortest = shortest(problem, BUDGET, &mut memory, &mut control).unwrap();
            found = Some(shortest);
            (format!("{} >= {}", shortest.period, shortest.bound), shortest.nodes, shortest.firing)
        });
        let shortest = found.unwrap();
        self.ask(&format!("{name} prefer"), |mut control| {
            let preferred = prefer(problem, &shortest, BUDGET, &mut memory, &mut control).unwrap();
            let optima = [preferred.separation, preferred.interval, preferred.window];
            let says = optima.map(|optimum| format!("{} <= {}", optimum.value, optimum.bound)).join(", ");
            (says, preferred.nodes, preferred.firing)
        });
        let longer = shortest.period + shortest.period / 8;
        for objective in [Objective::Interval, Objective::Separation] {
            self.ask(&format!("{name} {objective:?} at {longer}"), |mut control| {
                let most = match objective {
                    Objective::Interval => maximize_interval(problem, longer, BUDGET, &mut memory, &mut control),
                    Objective::Separation => maximize_separation(problem, longer, BUDGET, &mut memory, &mut control),
                };
                let most = most.unwrap();
                let value = most.found.map(|(value, _)| value);
                (format!("{value:?} <= {:?}", most.bound), most.nodes, most.found)
            });
        }
        // The longest that is excluded, and the shortest that was found.
        for period in [shortest.bound.max(2) - 1, shortest.period] {
            self.ask(&format!("{name} decide {period}"), |mut control| {
                let decided = decide(problem, period, BUDGET, &mut memory, &mut control).unwrap();
                (decided.outcome.is_found().to_string(), decided.nodes, decided.outcome)
            });
        }
    }

    /// All questions about waits, for one problem.
    fn ask_waits(&mut self, name: &str, owned: &Owned) {
        let sensors = owned.lag.len();
        let search = owned.search();
        let mut memory = vec![0; wait_words(sensors)];
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
        // The best table's own pairs, given to other sensors.
        let pairs: Vec<(u32, u32)> = a.iter().copied().zip(b.iter().copied()).rev().collect();
        self.ask(&format!("{name} assigned"), |mut control| {
            let mut budget = Budget::nodes_at_most(BUDGET).watched(100, &mut control);
            let best = search.assign(&pairs).unwrap().best_interval(&mut budget, &mut a, &mut b).unwrap();
            (format!("{:?} <= {}", best.value, best.bound), best.nodes, (&a, &b))
        });
        for words in [60, 4000] {
            self.ask(&format!("{name} count with {words} words"), |mut control| {
                let mut budget = Budget::nodes_at_most(10 * BUDGET).watched(1000, &mut control);
                let counted = search.count(None, &mut vec![0; words], &mut budget);
                let whole = if counted.outcome == Outcome::Exhausted { "" } else { " or more" };
                (format!("{}{whole}", counted.count), counted.nodes, ())
            });
        }
    }
}

/// Rings, lines and blocks of the sizes that are built, in ticks of different lengths, and any graphs.
fn ask_all() -> Record {
    let mut record = Record::default();
    for (layout, sensors, neighbours, scale) in [
        (Layout::Line, 4, 4, 1),
        (Layout::Line, 8, 4, 10),
        (Layout::Line, 9, 3, 1),
        (Layout::Line, 12, 4, 1),
        (Layout::Line, 10, 5, 1),
        (Layout::Ring, 8, 4, 1),
        (Layout::Ring, 8, 4, 3),
        (Layout::Ring, 12, 4, 1),
        (Layout::Ring, 13, 3, 2),
        (Layout::Ring, 20, 4, 1),
        (Layout::Blocks, 12, 4, 1),
        (Layout::Blocks, 8, 3, 4),
    ] {
        let rows = naive::conflicts(layout, sensors, neighbours);
        for (window, extra, stale_echo) in [(30, 0, false), (15, 1, true)] {
            // With one tick more of separation no coarser tick measures all three.
            let (separation, interval, window) = (2 * scale + extra, 15 * scale, window * scale);
            let problem = Problem { sensors, conflicts: &rows, separation, interval, window, stale_echo };
            record.ask_periods(&format!("{layout:?} {sensors}/{neighbours} x{scale} window {window}"), &problem);
        }
    }
    let mut random = Random(20_261_123);
    for case in 0..24 {
        let sensors = 3 + random.up_to(7) as usize;
        let density = 30 + random.up_to(60);
        let rows = graph(&mut random, sensors, density);
        let scale = [1, 1, 2, 5][case % 4];
        let mut any = |least, most| least + random.up_to(most - least);
        let (separation, interval) = (any(1, 5) * scale, any(3, 20) * scale);
        let (window, stale_echo) = (any(2, 60) * scale, any(0, 3) == 0);
        let problem = Problem { sensors, conflicts: &rows, separation, interval, window, stale_echo };
        record.ask_periods(&format!("graph {case} of {sensors}"), &problem);
    }
    for (layout, sensors, separation) in [
        (Layout::Line, 4, 3),
        (Layout::Line, 6, 3),
        (Layout::Line, 8, 2),
        (Layout::Ring, 8, 2),
        (Layout::Ring, 12, 1),
        (Layout::Line, 12, 2),
        (Layout::Blocks, 8, 3),
    ] {
        for criterion in [Criterion::Exact, Criterion::Paper] {
            let owned = Owned::paper(sensors, layout, separation, 1, criterion);
            record.ask_waits(&format!("waits of {layout:?} {sensors} {criterion:?} D{separation}"), &owned);
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
    naive::conflicts_where(sensors, |x, y| drawn[x * sensors + y])
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
