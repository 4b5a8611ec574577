//! Bounds on the differences of firing times, and their closure (rule 1 of docs/reference/certificate.md).
//!
//! A bound is one integer: `2 v` says "at most v", `2 v - 1` says "less than v". So comparing integers compares bounds,
//! and whole ticks and real times are treated alike: in whole ticks no bound is odd.

/// A bound: `t_j - t_i <= v` is stored as `2 v`, `t_j - t_i < v` as `2 v - 1`.
pub(crate) type Bound = i32;

/// The requirements contradict each other here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Refuted;

/// The bound on a sum of two differences: `< v` and `< w` give `< v + w`, so of two odd numbers one -1 goes.
pub(crate) fn sum(v: Bound, w: Bound) -> Bound {
    v + w + (v & w & 1)
}

/// The closed matrix of bounds: `at(i, j)` is the least upper bound on `t_j - t_i` that follows.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    events: usize,
    matrix: Vec<Bound>,
    /// Room for two rows.
    onward: Vec<Bound>,
}

impl Bounds {
    /// Every difference of two of `events` times is at most `widest`.
    pub(crate) fn new(events: usize, widest: Bound) -> Self {
        let mut matrix = vec![widest; events * events];
        for i in 0..events {
            matrix[i * events + i] = 0;
        }
        Self { events, matrix, onward: vec![0; 2 * events] }
    }

    /// The upper bound on `t_j - t_i`.
    pub(crate) fn at(&self, i: usize, j: usize) -> Bound {
        self.matrix[i * self.events + j]
    }

    /// Learns that `t_j - t_i` is at most `bound`, and closes the matrix again. Says whether that was news.
    pub(crate) fn learn(&mut self, i: usize, j: usize, bound: Bound) -> Result<bool, Refuted> {
        if bound >= self.at(i, j) {
            return Ok(false);
        }
        // A cycle of differences is 0, so a bound below 0 on it cannot hold.
        if sum(bound, self.at(j, i)) < 0 {
            return Err(Refuted);
        }
        let n = self.events;
        let Self { matrix, onward, .. } = self;
        // `sum` with an odd number: the other is rounded up to an even one.
        let (even, odd) = onward.split_at_mut(n);
        even.copy_from_slice(&matrix[j * n..(j + 1) * n]);
        for (odd, even) in odd.iter_mut().zip(even.iter()) {
            *odd = even + (even & 1);
        }
        for row in matrix.chunks_exact_mut(n) {
            let through = sum(row[i], bound);
            if through < row[j] {
                let onward = if through & 1 == 0 { &*even } else { &*odd };
                for (old, onward) in row.iter_mut().zip(onward) {
                    *old = (*old).min(through + onward);
                }
            }
        }
        Ok(true)
    }
}
