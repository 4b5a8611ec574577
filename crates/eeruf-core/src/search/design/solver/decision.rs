//! One decision of the search with its remaining alternatives, packed into lent words.

/// Words of one decision.
pub(crate) const DECISION_WORDS: usize = 6;

/// The subject of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branch {
    /// The sensor with the largest `|d|`.
    Top,
    /// The order of two firings in the same phase.
    Order,
    /// The sensor with the largest `|d|` of those without a rank, and its sign.
    Rank,
    /// The value of `|d|` of a sensor.
    Value,
}

impl Branch {
    const ALL: [Self; 4] = [Self::Top, Self::Order, Self::Rank, Self::Value];
}

/// A decision, with the alternative being tried in `x`, `y` and `tried`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decision {
    pub(crate) branch: Branch,
    /// A sensor; for [`Branch::Order`] the node to fire first in the first alternative.
    pub(crate) x: u8,
    /// For [`Branch::Order`] the other node; for ranks 1 if d is negative.
    pub(crate) y: u8,
    /// Alternatives started, for [`Branch::Order`] and [`Branch::Value`].
    pub(crate) tried: u8,
    /// Where the log of the difference bounds stood before the decision.
    pub(crate) mark: u32,
    /// Remaining sensors with positive d; for [`Branch::Value`] the smallest value.
    pub(crate) positive: u64,
    /// Remaining sensors with negative d; for [`Branch::Value`] the largest value.
    pub(crate) negative: u64,
}

impl Decision {
    pub(crate) fn new(branch: Branch) -> Self {
        Self { branch, x: 0, y: 0, tried: 0, mark: 0, positive: 0, negative: 0 }
    }

    pub(crate) fn pack(&self) -> [i32; DECISION_WORDS] {
        let branch = Branch::ALL.iter().position(|&branch| branch == self.branch).unwrap_or(0) as u8;
        [
            i32::from_le_bytes([branch, self.x, self.y, self.tried]),
            self.mark as i32,
            self.positive as i32,
            (self.positive >> 32) as i32,
            self.negative as i32,
            (self.negative >> 32) as i32,
        ]
    }

    pub(crate) fn unpack(words: &[i32]) -> Self {
        let [first, mark, p, q, r, s] = *words else {
            return Self::new(Branch::Value);
        };
        let [branch, x, y, tried] = first.to_le_bytes();
        let branch = Branch::ALL.get(usize::from(branch)).copied().unwrap_or(Branch::Value);
        let join = |low: i32, high: i32| u64::from(high as u32) << 32 | u64::from(low as u32);
        Self { branch, x, y, tried, mark: mark as u32, positive: join(p, q), negative: join(r, s) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_unpacked_up_to_the_64th_sensor() {
        for branch in [Branch::Top, Branch::Order, Branch::Rank, Branch::Value] {
            let mut decision = Decision::new(branch);
            (decision.x, decision.y, decision.tried, decision.mark) = (63, 128, 3, 0x1234_5678);
            (decision.positive, decision.negative) = (0x8123_4567_89ab_cdef, 0xfedc_ba98_7654_3210);
            let again = Decision::unpack(&decision.pack());
            assert_eq!((again.branch, again.x, again.y, again.tried), (branch, 63, 128, 3));
            assert_eq!(
                (again.mark, again.positive, again.negative),
                (0x1234_5678, decision.positive, decision.negative)
            );
        }
    }
}
