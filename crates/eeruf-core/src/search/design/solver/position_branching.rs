//! Branching on the positions of one clique: which sensor is next, which pairs of positions it can have, and what a
//! pair implies.

use super::clique_positions::MAX_POSITIONS;
use super::decision::{Branch, Decision};
use super::difference_bounds::Conflict;
use super::state::State;
use crate::search::common::Members;

impl State<'_, '_> {
    /// The sensor with the fewest pairs of positions left, if not all are fixed.
    pub(super) fn branch_on_positions(&self) -> Option<Decision> {
        let positions = &self.positions;
        if positions.fixed == positions.count {
            return None;
        }
        let at = &positions.at[..positions.fixed];
        let mut room = positions.room;
        for &(x, q, p) in at {
            room[usize::from(p.abs_diff(q))] -= positions.alike(self.problem, usize::from(x)).count_ones() as i32;
        }
        let open = |&&x: &&u8| at.iter().all(|&(y, ..)| y != x);
        // The first is the one with the largest |d|.
        let window = if at.is_empty() { &positions.sensors[..1] } else { &positions.sensors[..positions.count] };
        let decisions = window.iter().filter(open).map(|&x| {
            let mut decision = Decision::new(Branch::Positions);
            (decision.x, decision.positive) = (x, self.pairs(x, &room));
            decision
        });
        decisions.min_by_key(|decision| decision.positive.count_ones())
    }

    /// The pairs of positions that sensor `x` can have, as far as the matrix shows at a glance.
    fn pairs(&self, x: u8, room: &[i32; MAX_POSITIONS]) -> u64 {
        let positions = &self.positions;
        let (at, interval) = (&positions.at[..positions.fixed], self.problem.interval);
        let (mut free_q, mut free_p) = (0xffu8, 0xffu8);
        for &(y, q, p) in at {
            free_q &= !(1 << q);
            free_p &= !(1 << p);
            for (phase, position, free) in [(0, p, &mut free_p), (1, q, &mut free_q)] {
                let (u, v) = (self.node(usize::from(x), phase), self.node(usize::from(y), phase));
                // Positions below the other's are out if x cannot fire before y, and likewise above.
                if self.differences.at_most(v, u) < interval {
                    *free &= !((1u8 << position) - 1);
                }
                if self.differences.at_most(u, v) < interval {
                    *free &= (1u8 << position) - 1;
                }
            }
        }
        let size = positions.alike(self.problem, usize::from(x)).count_ones() as i32;
        let (low, high) = self.span(usize::from(x));
        let mut pairs = 0;
        for q in (0..positions.count).filter(|q| free_q >> q & 1 == 1) {
            for p in (0..positions.count).filter(|p| free_p >> p & 1 == 1) {
                let middle = (p as i32 - q as i32) * interval;
                if room[p.abs_diff(q)] >= size && middle - positions.spare <= high && middle + positions.spare >= low {
                    pairs |= 1 << (MAX_POSITIONS * q + p);
                }
            }
        }
        pairs
    }

    /// Fixes sensor `decision.x` at the pair of positions `decision.y`.
    pub(super) fn fix_positions(&mut self, decision: &Decision) -> Result<(), Conflict> {
        let (x, q, p) = (usize::from(decision.x), decision.y / MAX_POSITIONS as u8, decision.y % MAX_POSITIONS as u8);
        let i = self.positions.fixed;
        self.positions.at[i] = (decision.x, q, p);
        self.positions.fixed += 1;
        let interval = self.problem.interval;
        for j in 0..i {
            let (y, other_q, other_p) = self.positions.at[j];
            for (phase, position, other) in [(0, p, other_p), (1, q, other_q)] {
                let (u, v) = (self.node(x, phase), self.node(usize::from(y), phase));
                let (u, v) = if position < other { (u, v) } else { (v, u) };
                self.differences.add_bound(u, v, -interval)?;
            }
        }
        let moved = i32::from(p) - i32::from(q);
        let (low, high) = (moved * interval - self.positions.spare, moved * interval + self.positions.spare);
        // On a ring some sensor is overtaken on either side.
        let other = if self.positions.ring { self.problem.separation } else { 0 };
        let low = if moved > 0 { low + other } else { low };
        let high = if moved < 0 { high - other } else { high };
        for x in Members(self.positions.alike(self.problem, x)) {
            let (a, b) = (self.node(x, 0), self.node(x, 1));
            self.differences.add_bound(a, b, high)?;
            self.differences.add_bound(b, a, -low)?;
        }
        Ok(())
    }
}
