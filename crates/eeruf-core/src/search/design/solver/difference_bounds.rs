//! A simple temporal network in a difference-bound matrix, closed after each bound, with an undo log in lent memory.
//!
//! Node 0 is the start of the period; node `1 + i` is sensor i's firing in phase a, node `1 + K + i` its firing in
//! phase b. The cell `(u, v)` is the largest value that `time(u) - time(v)` can still take. The matrix is always closed
//! (no path is shorter than its cell), so each cell is the *exact* bound that follows from all differences added so
//! far, and any row or column read as times satisfies them all.
//!
//! Indices: `u`, `v` and `i` are below `nodes` wherever they are used, and `bound` holds `nodes * nodes` cells;
//! [`DifferenceBounds::new`] makes it so.

use crate::schedule::MAX_SENSORS;

/// Nodes of the largest problem: the start, and two firings of each sensor.
pub(crate) const MAX_NODES: usize = 2 * MAX_SENSORS + 1;

/// The bounds added so far cannot all hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conflict;

/// All bounds on the differences between two firing times.
pub(crate) struct DifferenceBounds<'m> {
    nodes: usize,
    bound: &'m mut [i32],
    /// Rows as they were before they changed: the cells, then the row's number.
    log: &'m mut [i32],
    used: usize,
    /// A row is logged once per step; `saved` says in which step that was last.
    step: u32,
    saved: [u32; MAX_NODES],
    /// The log ran over since the flag was last taken: nothing before now can be undone.
    overrun: bool,
    changes: u64,
}

impl<'m> DifferenceBounds<'m> {
    /// A network without any bound but `far`, which must exceed every difference that can occur.
    ///
    /// `bound` must hold `nodes * nodes` words and `log` at least one row; the caller has divided the memory so.
    pub(crate) fn new(nodes: usize, far: i32, bound: &'m mut [i32], log: &'m mut [i32]) -> Self {
        bound.fill(far);
        for u in 0..nodes {
            bound[u * nodes + u] = 0;
        }
        Self { nodes, bound, log, used: 0, step: 1, saved: [0; MAX_NODES], overrun: false, changes: 0 }
    }

    /// The largest value of `time(u) - time(v)`.
    #[inline(always)]
    pub(crate) fn at_most(&self, u: usize, v: usize) -> i32 {
        self.bound[u * self.nodes + v]
    }

    /// The number of bounds that were new so far.
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// Adds `time(u) - time(v) <= most` and all bounds that follow from it.
    #[inline]
    pub(crate) fn add_bound(&mut self, u: usize, v: usize, most: i32) -> Result<(), Conflict> {
        if self.at_most(u, v) <= most {
            return Ok(());
        }
        if most.saturating_add(self.at_most(v, u)) < 0 {
            return Err(Conflict);
        }
        self.close_over(u, v, most);
        Ok(())
    }

    /// Every path may now go over `u -> v` at the cost of `most`.
    fn close_over(&mut self, u: usize, v: usize, most: i32) {
        let n = self.nodes;
        self.changes += 1;
        // Row v itself cannot change: that would be a cycle of negative length, which `add_bound` has excluded.
        let mut beyond = [0; MAX_NODES];
        for (beyond, &rest) in beyond.iter_mut().zip(&self.bound[v * n..(v + 1) * n]) {
            *beyond = rest + most;
        }
        for i in 0..n {
            let first = self.bound[i * n + u];
            if first + most >= self.bound[i * n + v] {
                continue;
            }
            self.save(i);
            for (cell, &rest) in self.bound[i * n..(i + 1) * n].iter_mut().zip(&beyond) {
                *cell = (*cell).min(first + rest);
            }
        }
    }

    /// Logs row `i`, once per step.
    fn save(&mut self, i: usize) {
        if self.saved[i] == self.step {
            return;
        }
        self.saved[i] = self.step;
        let n = self.nodes;
        if self.log.len() - self.used <= n {
            self.used = 0;
            self.overrun = true;
        }
        let end = self.used + n;
        self.log[self.used..end].copy_from_slice(&self.bound[i * n..(i + 1) * n]);
        // A row number is below 129.
        self.log[end] = i as i32;
        self.used = end + 1;
    }

    /// Begins a step and returns the mark to which [`undo`](Self::undo) can return.
    pub(crate) fn mark(&mut self) -> usize {
        self.step += 1;
        if self.step == u32::MAX {
            self.step = 1;
            self.saved.fill(0);
        }
        self.used
    }

    /// Returns to `mark`; the marks taken since are void.
    pub(crate) fn undo(&mut self, mark: usize) {
        let n = self.nodes;
        while self.used > mark {
            let end = self.used - 1;
            let i = self.log[end] as usize;
            self.used = end - n;
            self.bound[i * n..(i + 1) * n].copy_from_slice(&self.log[self.used..end]);
        }
    }

    /// Returns true if the log ran over since the last call; then all marks before are void.
    pub(crate) fn take_overrun(&mut self) -> bool {
        core::mem::take(&mut self.overrun)
    }

    /// Copies all bounds out, for [`reset`](Self::reset).
    pub(crate) fn copy_to(&self, root: &mut [i32]) {
        root.copy_from_slice(self.bound);
    }

    /// Takes all bounds from a copy and empties the log.
    pub(crate) fn reset(&mut self, root: &[i32]) {
        self.bound.copy_from_slice(root);
        self.used = 0;
        self.overrun = false;
        self.mark();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn that_the_log_ran_over_is_said_once_and_only_then() {
        // Room for two rows of three nodes.
        let (mut bound, mut log) = ([0; 9], [0; 8]);
        let mut differences = DifferenceBounds::new(3, 1000, &mut bound, &mut log);
        let overruns = [(0, 1), (0, 2), (1, 2)].map(|(u, v)| {
            differences.mark();
            differences.add_bound(u, v, 5).unwrap();
            differences.take_overrun()
        });
        assert_eq!((overruns, differences.take_overrun()), ([false, false, true], false));
    }
}
