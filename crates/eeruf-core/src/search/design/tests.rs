//! The bounds by counting against the search: nothing is found below them.

extern crate std;

use std::vec;

use super::bounds::{Changes, Classes};
use super::firing::Firing;
use super::problem::{CheckedProblem, Problem};
use super::random::Random;
use super::solver::Solver;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Outcome;

fn rows(sensors: usize, n: usize, layout: &str) -> [u64; MAX_SENSORS] {
    let mut rows = [0; MAX_SENSORS];
    for x in 0..sensors {
        for y in 0..sensors {
            let apart = x.abs_diff(y);
            let conflict = match layout {
                "line" => apart < n,
                "ring" => apart.min(sensors - apart) < n,
                _ => x / n == y / n,
            };
            rows[x] |= u64::from(x != y && conflict) << y;
        }
    }
    rows
}

/// Searches without fixing the positions of a clique first, which rests on the same argument.
fn search(problem: &CheckedProblem, period: i32, budget: u64, memory: &mut [i32]) -> Outcome<Firing> {
    let mut solver = Solver::new(problem, period, memory).without_clique_positions();
    solver.restart(None, None);
    solver.run(budget)
}

#[test]
fn no_schedule_is_found_below_the_bound_of_classes() {
    let mut memory = [0; super::memory_words(10)];
    let (mut proven, mut met) = (0, 0);
    for layout in ["line", "ring", "blocks"] {
        for (sensors, n) in
            [(4, 2), (5, 2), (6, 2), (5, 3), (6, 3), (7, 3), (8, 3), (9, 3), (8, 4), (9, 4), (10, 4), (5, 5)]
        {
            for (separation, interval, window) in
                [(1, 7, 7), (1, 15, 30), (2, 8, 20), (2, 15, 15), (3, 16, 32), (2, 15, 45)]
            {
                for stale_echo in [false, true] {
                    let rows = rows(sensors, n, layout);
                    let conflicts = &rows[..sensors];
                    let problem = Problem { sensors, conflicts, separation, interval, window, stale_echo };
                    let checked = problem.checked().unwrap();
                    let bound = Classes::new(&checked).unwrap().period(&checked);
                    match search(&checked, bound - 1, 4_000, &mut memory) {
                        Outcome::Found(_) => panic!("{layout} {n}: {problem:?} below {bound}"),
                        Outcome::Exhausted => proven += 1,
                        Outcome::BudgetSpent => {}
                    }
                    let outcome = search(&checked, bound, 1_000, &mut memory);
                    met += i32::from(matches!(outcome, Outcome::Found(_)));
                }
            }
        }
    }
    assert!(proven > 350 && met > 200, "{proven} proven, {met} met");
}

#[test]
fn no_schedule_is_found_below_a_bound_beyond_half_an_interval_to_spare() {
    let mut memory = vec![0; super::memory_words(14)];
    let mut random = Random::new(1);
    // By how the places may change: not, once in a line, twice in a ring.
    let mut proven = [0; 3];
    for _ in 0..4000 {
        let layout = ["line", "ring", "ring"][random.below(3) as usize];
        let n = 2 + random.below(4) as usize;
        let sensors =
            if layout == "ring" { n * 2 + n * random.below(2) as usize } else { n + 1 + random.below(9) as usize };
        let (interval, separation) = (4 + random.below(30), 1 + random.below(6));
        let reach = if random.below(2) == 0 { 4 } else { n as u32 * interval };
        let window = interval + random.below(reach);
        let rows = rows(sensors, n, layout);
        let conflicts = &rows[..sensors.min(14)];
        let problem = Problem { sensors, conflicts, separation, interval, window, stale_echo: false };
        let Ok(checked) = problem.checked() else { continue };
        let Some(classes) = Classes::new(&checked) else { continue };
        let period = classes.period(&checked) - 1;
        if 2 * (period - classes.clique() as i32 * checked.interval) < checked.interval {
            continue;
        }
        let branch = match classes.changes(&checked, period) {
            Changes::None => 0,
            Changes::One => 1,
            Changes::Two { .. } => 2,
            Changes::Any => panic!("{problem:?}: a bound without an argument"),
        };
        match search(&checked, period, 4_000, &mut memory) {
            Outcome::Found(_) => panic!("{layout} {n}: {problem:?} at {period}"),
            Outcome::Exhausted => proven[branch] += 1,
            Outcome::BudgetSpent => {}
        }
    }
    assert!(proven.iter().all(|&proven| proven > 4), "{proven:?}");
}
