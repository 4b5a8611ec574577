//! Exact geometry of the plane: points and directions, mirrors, and reflection at circles. It knows nothing of sound or
//! scenes, and uses no other module.

mod alhazen;
mod mirror;
mod plane;

pub use alhazen::{Specular, alhazen, alhazen_twice};
pub(crate) use eeruf_modules::wrap_angle;
pub(crate) use mirror::Mirror;
pub use plane::{Moment, Point, Pose, TOUCH_M, Vector, pose_of};
pub(crate) use plane::{SAME_DIRECTION, cross, opposite};
