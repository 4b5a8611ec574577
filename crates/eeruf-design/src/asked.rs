//! Rooms in which a ring is judged.

use eeruf_sim::experiments::rooms::RoomGroup;

/// Rooms for judging ways of firing.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsAsked {
    /// The caller's own rooms; empty for the usual ones.
    pub own: Vec<RoomGroup>,
    /// Number of usual rooms of each kind. The default is 6.
    pub places: u64,
    /// Number of the first room of each kind. The default is 0: ways are chosen on numbers below 2,000, and reported
    /// from 20,000 on.
    pub first: u64,
    /// True to measure every way, and to give the answer beside other robots and with the other gain too.
    pub all: bool,
}

impl Default for RoomsAsked {
    fn default() -> Self {
        Self { own: vec![], places: 6, first: 0, all: false }
    }
}
