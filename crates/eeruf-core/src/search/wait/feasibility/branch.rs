//! Branchings of the search for a table, packed into lent words.

use super::super::difference_constraints::Order;

/// A choice that the search makes next.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Branch {
    /// The order of two sensors in a phase.
    Order(Order),
    /// The sensor with this rank of `|d|`, and its sign.
    Rank(usize),
    /// The value of `|d|` with this rank.
    Value(usize),
    /// The order of two sensors by `s`.
    Sum(usize, usize),
}

impl Branch {
    /// The branch as a word.
    pub(super) const fn pack(self) -> u32 {
        let (kind, x, y, z) = match self {
            Self::Order(Order { phase, first, second }) => (0, first, second, phase),
            Self::Rank(rank) => (1, rank, 0, 0),
            Self::Value(rank) => (2, rank, 0, 0),
            Self::Sum(low, high) => (3, low, high, 0),
        };
        kind | (x as u32) << 8 | (y as u32) << 16 | (z as u32) << 24
    }

    /// The branch that was packed.
    pub(super) const fn unpack(word: u32) -> Self {
        let (x, y, z) = ((word >> 8 & 255) as usize, (word >> 16 & 255) as usize, (word >> 24) as usize);
        match word & 255 {
            0 => Self::Order(Order { phase: z, first: x, second: y }),
            1 => Self::Rank(x),
            2 => Self::Value(x),
            _ => Self::Sum(x, y),
        }
    }
}
