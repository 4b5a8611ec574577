//! The plane, exactly: points and directions, mirrors, and reflection at circles.
//! It knows nothing of sound or of what stands in a scene, and uses no other room.

mod alhazen;
mod mirror;
mod moment;
mod plane;

pub use alhazen::{Specular, alhazen, alhazen_twice};
pub(crate) use mirror::Mirror;
pub use moment::Moment;
pub use plane::{Point, Pose, TOUCH_M, Vector};
pub(crate) use plane::{SAME_DIRECTION, cross, opposite, wrap_angle};
