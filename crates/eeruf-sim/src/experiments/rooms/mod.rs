//! Rooms in which rings are judged.
//!
//! The paper's sets ask how a method does before three walls and among poles; whoever mounts a ring asks how it does in
//! rooms like theirs. [`RoomPlan`] is a room of a versioned set of eight [kinds](RoomKind), or the caller's own;
//! [`measure`](super::measure) runs each way of firing a ring in each.

mod group;
mod plan;

pub use group::RoomGroup;
pub use plan::{DRIVING_S, RoomKind, RoomPlan, UnknownRoom, VERSION};
