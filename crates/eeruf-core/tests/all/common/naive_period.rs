//! A slow, obvious judge of firing times, and plain nested loops over them. It shares nothing with the search but the
//! problem's type.

use eeruf_core::search::design::{Firing, Problem};

/// Violations of a schedule: each need is checked as it is written, pair by pair.
pub fn check(problem: &Problem<'_>, period: u32, a: &[u32], b: &[u32]) -> Result<(), String> {
    let k = problem.sensors;
    if a.len() != k || b.len() != k {
        return Err(format!("{} and {} times for {k} sensors", a.len(), b.len()));
    }
    let t = i64::from(period);
    let (a, b): (Vec<i64>, Vec<i64>) = (a.iter().map(|&t| t.into()).collect(), b.iter().map(|&t| t.into()).collect());
    for x in 0..k {
        let d = (a[x] - b[x]).abs();
        if a[x] >= t
            || b[x] >= t
            || t - d < problem.window.into()
            || (problem.stale_echo && 2 * d < problem.separation.into())
        {
            return Err(format!("sensor {x}: {} {}", a[x], b[x]));
        }
        for y in 0..x {
            let other = (a[y] - b[y]).abs();
            if (d - other).abs() < problem.separation.into() {
                return Err(format!("sensors {x} and {y} are separated by {}", (d - other).abs()));
            }
            if problem.conflicts[x] >> y & 1 == 1 {
                // All firings of both sensors on the circle of two periods.
                for u in [a[x], t + b[x]] {
                    for v in [a[y], t + b[y]] {
                        let gap = (u - v).rem_euclid(2 * t).min((v - u).rem_euclid(2 * t));
                        if gap < problem.interval.into() {
                            return Err(format!("sensors {x} and {y} fire {gap} apart"));
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

pub fn assert_serves(problem: &Problem<'_>, period: u32, firing: &Firing) {
    assert_eq!(check(problem, period, firing.fire_a(), firing.fire_b()), Ok(()), "{problem:?} at {period}");
}

/// Returns true if any schedule exists, by trying all times of one sensor after the other.
pub fn nested_loops(problem: &Problem<'_>, period: u32) -> bool {
    fn assign(problem: &Problem<'_>, period: u32, a: &mut Vec<u32>, b: &mut Vec<u32>) -> bool {
        let k = a.len();
        if k > 0 {
            let rows: Vec<u64> = problem.conflicts[..k].iter().map(|row| row & ((1 << k) - 1)).collect();
            let part = Problem { sensors: k, conflicts: &rows, ..*problem };
            if check(&part, period, a, b).is_err() {
                return false;
            }
        }
        if k == problem.sensors {
            return true;
        }
        for ta in 0..period {
            for tb in 0..period {
                a.push(ta);
                b.push(tb);
                let done = assign(problem, period, a, b);
                a.pop();
                b.pop();
                if done {
                    return true;
                }
            }
        }
        false
    }
    assign(problem, period, &mut Vec::new(), &mut Vec::new())
}

/// The paper's half ring of 12: 2 ms separation, 15 ms interval, 30 ms window, in ticks of `1 ms / scale`.
pub fn paper_12(rows: &[u64], scale: u32) -> Problem<'_> {
    Problem {
        sensors: 12,
        conflicts: rows,
        separation: 2 * scale,
        interval: 15 * scale,
        window: 30 * scale,
        stale_echo: false,
    }
}
