//! Rooms in which a ring is judged: which way of firing it is right most of the time.
//!
//! The paper's sets test a method before three walls and among poles; users want to know how it does in their own
//! rooms. [`RoomPlan`] is a versioned set of rooms of eight [kinds](RoomKind), [`RoomWay`] the ways of firing one ring,
//! baselines first, and [`judge`] runs each way in each room and recommends one.

mod judge;
mod plan;
mod way;

pub use judge::{JudgedWay, Judgement, RoomFigures, RoomGroup, RoomsOptions, judge, with_other_gain};
pub use plan::{DRIVING_S, RoomKind, RoomPlan, UnknownRoom, VERSION};
pub use way::{Condition, RoomWay};
