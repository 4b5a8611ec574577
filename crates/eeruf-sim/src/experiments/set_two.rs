//! Set II (Sec. 4): a `LabMate` drives through a course of thin poles, steered by what its ring tells: HIMM grid, vector field
//! histogram, platform, in a closed loop.
//!
//! The ring is core's own under the event simulation, as everywhere; only where the robot is is not known beforehand.

mod course;
mod pilot;
mod runs;

pub use course::{Course, POLE_RADIUS_M, ROOM_M, SECOND_AHEAD, SECOND_BEHIND};
pub use pilot::{Cell, Ending, Piloting, Place, Run};
pub use runs::{Figures, MULTI_ECHO_CONSECUTIVE, SetTwo, SetTwoOptions, SpeedStep, set_two, speed_sweep};
