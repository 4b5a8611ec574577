//! The bounds by counting against the search: nothing is found below them.

use super::bounds::Classes;
use super::problem::Problem;
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

#[test]
fn no_schedule_is_found_below_the_bound_of_classes() {
    let mut memory = [0; super::memory_words(10)];
    let (mut proven, mut met) = (0, 0);
    for (layout, sensors, n) in [
        ("blocks", 3, 3),
        ("blocks", 4, 4),
        ("blocks", 5, 5),
        ("blocks", 7, 7),
        ("blocks", 6, 3),
        ("blocks", 8, 4),
        ("line", 5, 3),
        ("line", 7, 3),
        ("line", 10, 4),
        ("ring", 6, 3),
        ("ring", 9, 3),
        ("ring", 8, 4),
        ("ring", 7, 5),
    ] {
        for (separation, interval, window) in
            [(1, 7, 7), (1, 15, 30), (2, 8, 20), (2, 15, 15), (3, 16, 32), (2, 15, 45)]
        {
            for stale_echo in [false, true] {
                let rows = rows(sensors, n, layout);
                let conflicts = &rows[..sensors];
                let problem = Problem { sensors, conflicts, separation, interval, window, stale_echo };
                let checked = problem.checked().unwrap();
                let bound = Classes::new(&checked).unwrap().period(&checked);
                let mut search = |period, budget| {
                    let mut solver = Solver::new(&checked, period, &mut memory);
                    solver.restart(None, None);
                    solver.run(budget)
                };
                match search(bound as i32 - 1, 4_000) {
                    Outcome::Found(_) => panic!("{layout} {n}: {problem:?} below {bound}"),
                    Outcome::Exhausted => proven += 1,
                    Outcome::BudgetSpent => {}
                }
                met += i32::from(search(bound as i32, 1_000).is_found());
            }
        }
    }
    assert!(proven > 80 && met > 40, "{proven} proven, {met} met");
}
