//! Set II (Sec. 4): a `LabMate` drives through a course of thin poles in a closed loop. Its ring's readings fill a HIMM
//! grid, and a vector field histogram steers the platform by it. The ring is core's own under the event simulation;
//! only the robot's way is not known beforehand.

mod course;
mod figures;
mod odometry;
mod options;
mod own_pilots;
mod pilot;
mod pilots;
mod run;
mod runs;

pub use crate::navigation::Piloting;
pub use course::{Course, POLE_RADIUS_M, ROOM_M, SECOND_AHEAD, SECOND_BEHIND};
pub use figures::Figures;
pub use odometry::OdometryNoise;
pub use options::SetTwoOptions;
pub use pilots::{Pilots, UnknownPilot};
pub use run::{Cell, Ending, Run, TrackPoint};
pub use runs::{Drive, MULTI_ECHO_CONSECUTIVE, SetTwo, SpeedStep, drive, set_two, speed_sweep};
