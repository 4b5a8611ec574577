//! A schedule checked longhand: every need, for every pair of sensors, firing by firing.

use crate::engine::problem::Problem;

impl Problem {
    /// Returns true if the schedule keeps all needs.
    pub(crate) fn is_kept_by(&self, period: u32, fire: &[Vec<u32>; 2]) -> bool {
        let sensors = self.sensors();
        // Three periods: a, b, a again. What follows is a repetition.
        let firings = |x: usize| [fire[0][x], period + fire[1][x], 2 * period + fire[0][x]];
        let change = |x: usize| fire[0][x].abs_diff(fire[1][x]);
        let alone = |x: usize| {
            let [first, second, third] = firings(x);
            let refires = (second - first).min(third - second) >= self.window[x];
            refires && (!self.stale_echo || 2 * change(x) >= self.separation[x])
        };
        let apart = |x: usize, y: usize| {
            if self.together.iter().any(|group| group.contains(&x) && group.contains(&y)) {
                return firings(x) == firings(y);
            }
            change(x).abs_diff(change(y)) >= self.separation[x].max(self.separation[y])
        };
        // At the same instant each is after the other.
        let follows = |x: usize, y: usize, gap: u32| {
            firings(x).iter().all(|earlier| firings(y).iter().all(|later| earlier > later || later - earlier >= gap))
        };
        (0..sensors).all(|x| alone(x) && (0..x).all(|y| apart(x, y)))
            && self.gaps.iter().all(|&(x, y, after_x, after_y)| follows(x, y, after_x) && follows(y, x, after_y))
    }
}
