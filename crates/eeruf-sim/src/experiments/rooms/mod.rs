//! Rooms in which ways of firing a ring are judged, to recommend the one that is right most of the time.
//!
//! The paper's sets test a method before three walls and among poles; users want its results in their own rooms.
//! [`RoomPlan`] is a versioned set of rooms of eight [kinds](RoomKind). [`RoomWay`] is a way of firing one ring,
//! baselines first. [`judge`] runs each way in each room and recommends one.

mod judge;
mod plan;
mod way;

pub use judge::{JudgedWay, Judgement, RoomFigures, RoomGroup, RoomsOptions, judge, with_other_gain};
pub use plan::{DRIVING_S, RoomKind, RoomPlan, UnknownRoom, VERSION};
pub use way::{Condition, RoomWay};
