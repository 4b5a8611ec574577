//! One choice of the search tree with its remaining alternatives, packed into lent words.

/// Words of one frame.
pub(crate) const FRAME_WORDS: usize = 6;

/// What is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The sensor with the largest `|d|`.
    Top,
    /// The places of a sensor in both phases, among adjacent sensors.
    Place,
    /// Which of two firings in the same phase comes first.
    Order,
    /// The sensor with the smallest `|d|` of those without a rank, and its sign.
    Low,
    /// The sensor with the largest `|d|` of those without a rank, and its sign.
    High,
    /// The value of `|d|` of a sensor.
    Value,
}

/// A choice: `now` is the alternative being tried.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) kind: Kind,
    /// A sensor; for [`Kind::Order`] the node to fire first in the first alternative.
    pub(crate) x: u8,
    /// For [`Kind::Order`] the other node; for ranks 1 if d is negative; for [`Kind::Place`] the pair of places.
    pub(crate) y: u8,
    /// Alternatives begun, for [`Kind::Order`] and [`Kind::Value`].
    pub(crate) tried: u8,
    /// Where the network's log stood before the choice.
    pub(crate) mark: u32,
    /// Remaining sensors with positive d; for [`Kind::Value`] the smallest value, for [`Kind::Place`]
    /// the remaining pairs of places.
    pub(crate) positive: u64,
    /// Remaining sensors with negative d; for [`Kind::Value`] the largest value.
    pub(crate) negative: u64,
}

impl Frame {
    pub(crate) fn new(kind: Kind) -> Self {
        Self { kind, x: 0, y: 0, tried: 0, mark: 0, positive: 0, negative: 0 }
    }

    pub(crate) fn pack(&self) -> [i32; FRAME_WORDS] {
        let kind = match self.kind {
            Kind::Top => 0,
            Kind::Order => 1,
            Kind::Low => 2,
            Kind::High => 3,
            Kind::Value => 4,
            Kind::Place => 5,
        };
        [
            i32::from_le_bytes([kind, self.x, self.y, self.tried]),
            self.mark as i32,
            self.positive as i32,
            (self.positive >> 32) as i32,
            self.negative as i32,
            (self.negative >> 32) as i32,
        ]
    }

    pub(crate) fn unpack(words: &[i32]) -> Self {
        let [first, mark, p, q, r, s] = *words else {
            return Self::new(Kind::Value);
        };
        let [kind, x, y, tried] = first.to_le_bytes();
        let kind = match kind {
            0 => Kind::Top,
            1 => Kind::Order,
            2 => Kind::Low,
            3 => Kind::High,
            5 => Kind::Place,
            _ => Kind::Value,
        };
        let join = |low: i32, high: i32| u64::from(high as u32) << 32 | u64::from(low as u32);
        Self { kind, x, y, tried, mark: mark as u32, positive: join(p, q), negative: join(r, s) }
    }
}
