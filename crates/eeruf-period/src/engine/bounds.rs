//! A difference-bound matrix of firing times, kept closed (rule 1 of docs/reference/certificate.md).

use crate::engine::problem::MAX_SENSORS;

/// A bound on a difference of two times, in ticks.
pub(crate) type Bound = i32;

/// The error that the requirements contradict each other at this node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Refuted;

/// The closed matrix of bounds: `at(i, j)` is the least upper bound on `t_j - t_i` that follows. A log of overwritten
/// rows restores it to an earlier mark.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    events: usize,
    matrix: Vec<Bound>,
    /// Buffer for a row.
    onward: Vec<Bound>,
    /// Old contents of changed rows: the bounds, then the row's number.
    log: Vec<Bound>,
    /// The step in which each row was last logged: once per step is enough.
    saved: Vec<u32>,
    step: u32,
    /// Number of changes of the matrix so far, including undone ones.
    version: u64,
    /// The rows that changed since [`take_changed`](Self::take_changed) returned them, as bits.
    changed: [u64; CHANGED],
}

/// Number of words with one bit for each row.
const CHANGED: usize = (2 * MAX_SENSORS + 1).div_ceil(64);

impl Bounds {
    /// A matrix in which every difference of two of `events` times is at most `widest`.
    pub(crate) fn new(events: usize, widest: Bound) -> Self {
        let mut matrix = vec![widest; events * events];
        for i in 0..events {
            matrix[i * events + i] = 0;
        }
        let changed = core::array::from_fn(|word| {
            (0..64).filter(|bit| 64 * word + bit < events).fold(0, |set, bit| set | 1 << bit)
        });
        let (onward, saved) = (vec![0; events], vec![0; events]);
        Self { events, matrix, onward, log: Vec::new(), saved, step: 1, version: 1, changed }
    }

    /// The upper bound on `t_j - t_i`.
    #[inline]
    pub(crate) fn at(&self, i: usize, j: usize) -> Bound {
        self.matrix[i * self.events + j]
    }

    /// A number that identifies this state of the matrix within the search.
    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// A row that changed since it was last returned. At first all rows count as changed.
    pub(crate) fn take_changed(&mut self) -> Option<usize> {
        let (word, bits) = self.changed.iter_mut().enumerate().find(|(_, bits)| **bits != 0)?;
        let row = 64 * word + bits.trailing_zeros() as usize;
        *bits &= *bits - 1;
        Some(row)
    }

    /// Begins a step, and returns a mark for [`undo`](Self::undo).
    pub(crate) fn mark(&mut self) -> usize {
        self.begin_step();
        self.log.len()
    }

    fn begin_step(&mut self) {
        self.step = self.step.wrapping_add(1);
        if self.step == 0 {
            self.saved.fill(0);
            self.step = 1;
        }
    }

    /// Restores the matrix at the mark. Later marks become invalid.
    pub(crate) fn undo(&mut self, mark: usize) {
        let n = self.events;
        while self.log.len() > mark {
            let end = self.log.len() - 1;
            let row = self.log[end] as usize;
            self.matrix[row * n..(row + 1) * n].copy_from_slice(&self.log[end - n..end]);
            self.log.truncate(end - n);
        }
        self.begin_step();
        self.version += 1;
        // At a mark, all rules have been applied.
        self.changed = [0; CHANGED];
    }

    /// Adds the bound `t_j - t_i <= bound`, and closes the matrix again. Returns true if the bound was new.
    #[inline]
    pub(crate) fn learn(&mut self, i: usize, j: usize, bound: Bound) -> Result<bool, Refuted> {
        if bound >= self.at(i, j) {
            return Ok(false);
        }
        // A cycle of differences is 0, so a bound below 0 on it cannot hold.
        if bound + self.at(j, i) < 0 {
            return Err(Refuted);
        }
        self.close(i, j, bound);
        Ok(true)
    }

    fn close(&mut self, i: usize, j: usize, bound: Bound) {
        let n = self.events;
        let Self { matrix, onward, log, saved, step, version, changed, .. } = self;
        *version += 1;
        onward.copy_from_slice(&matrix[j * n..(j + 1) * n]);
        for (number, (row, saved)) in matrix.chunks_exact_mut(n).zip(saved).enumerate() {
            let through = row[i] + bound;
            if through < row[j] {
                changed[number / 64] |= 1 << (number % 64);
                if *saved != *step {
                    *saved = *step;
                    log.extend_from_slice(row);
                    log.push(number as Bound);
                }
                for (old, onward) in row.iter_mut().zip(onward.iter()) {
                    *old = (*old).min(through + onward);
                }
            }
        }
    }
}
