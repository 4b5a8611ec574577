//! A permutation of the places in a clique for which the classes have room, found by trying them place by place.

use crate::schedule::MAX_SENSORS;
use crate::search::common::Outcome;

/// The places tried before giving up.
const STEPS: u32 = 1 << 15;

/// What fits into the classes.
pub(super) struct Room {
    /// How many places of the permutation may be in each class.
    pub(super) places: [i32; MAX_SENSORS],
    /// How many of those in class 0 may be passed by others.
    pub(super) crossed: i32,
    /// How many `|d|` fit into each class.
    pub(super) values: [i32; MAX_SENSORS],
}

impl Room {
    /// A permutation of the places for which there is room and that `suits`, given how much of each class it takes;
    /// place q takes `sizes[q]` and is tried at `offsets[q]` first.
    ///
    /// Places are below n, the length of both, which is at most `MAX_SENSORS`, and so are distances: all indices are in
    /// range.
    pub(super) fn permutation(
        &self,
        sizes: &[i32],
        offsets: &[u8],
        suits: impl Fn(&[i32]) -> bool,
    ) -> Outcome<[u8; MAX_SENSORS]> {
        let n = sizes.len();
        let mut to = [0u8; MAX_SENSORS];
        // The alternatives of each place that were tried.
        let mut tried = [0usize; MAX_SENSORS];
        let mut moved = [0i32; MAX_SENSORS];
        let (mut used, mut crossed, mut from) = (0u64, 0, 0);
        for _ in 0..STEPS {
            if from == n {
                if suits(&moved[..n]) {
                    return Outcome::Found(to);
                }
            } else {
                let passed = used != !(u64::MAX << from);
                let next = (tried[from]..n).map(|i| (i, (i + usize::from(offsets[from])) % n)).find(|&(_, p)| {
                    let class = p.abs_diff(from);
                    used >> p & 1 == 0
                        && moved[class] + sizes[from] <= self.places[class]
                        && (class > 0 || !passed || crossed < self.crossed)
                });
                if let Some((i, p)) = next {
                    moved[p.abs_diff(from)] += sizes[from];
                    crossed += i32::from(p == from && passed);
                    used |= 1 << p;
                    // A place is below 64.
                    to[from] = p as u8;
                    tried[from] = i + 1;
                    from += 1;
                    if from < n {
                        tried[from] = 0;
                    }
                    continue;
                }
            }
            if from == 0 {
                return Outcome::Exhausted;
            }
            from -= 1;
            let p = usize::from(to[from]);
            used &= !(1 << p);
            moved[p.abs_diff(from)] -= sizes[from];
            crossed -= i32::from(p == from && used != !(u64::MAX << from));
        }
        Outcome::BudgetSpent
    }
}
