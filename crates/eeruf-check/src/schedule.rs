//! Checks a schedule longhand: every requirement, for every pair of sensors, firing by firing.

use crate::problem::Problem;

/// Says what the schedule violates, if anything.
pub(crate) fn check(problem: &Problem, period: u32, fire: &[Vec<u32>; 2]) -> Result<(), String> {
    let sensors = problem.sensors();
    // Three periods: a, b, a again. What follows is a repetition.
    let firings = |x: usize| [fire[0][x], period + fire[1][x], 2 * period + fire[0][x]];
    let change = |x: usize| fire[0][x].abs_diff(fire[1][x]);
    for x in 0..sensors {
        let [first, second, third] = firings(x);
        let pause = (second - first).min(third - second);
        if pause < problem.window[x] {
            return Err(format!("sensor {x} fires again after {pause}, its window is {}", problem.window[x]));
        }
        if problem.stale_echo && 2 * change(x) < problem.separation[x] {
            return Err(format!("sensor {x}: twice |d| is {}, expected {}", 2 * change(x), problem.separation[x]));
        }
        for y in 0..x {
            let apart = change(x).abs_diff(change(y));
            let needed = problem.separation[x].max(problem.separation[y]);
            let are_together = problem.together.iter().any(|group| group.contains(&x) && group.contains(&y));
            if are_together && firings(x) != firings(y) {
                return Err(format!("sensors {y} and {x} must fire together and do not"));
            }
            if !are_together && apart < needed {
                return Err(format!("sensors {y} and {x}: |d| differ by {apart}, expected at least {needed}"));
            }
        }
    }
    for &(x, y, after_x, after_y) in &problem.gaps {
        for (x, y, gap) in [(x, y, after_x), (y, x, after_y)] {
            for earlier in firings(x) {
                for later in firings(y) {
                    // At the same instant each is after the other.
                    if earlier <= later && later - earlier < gap {
                        let after = later - earlier;
                        return Err(format!("sensor {y} fires {after} after sensor {x}, expected at least {gap}"));
                    }
                }
            }
        }
    }
    Ok(())
}
