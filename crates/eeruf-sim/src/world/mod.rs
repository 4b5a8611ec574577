//! Worlds: robots with rings, clocks and motions in a scene, with noise and a seed, from code or a TOML file. It uses
//! `geometry`, `scene`, `acoustics` and `tracing`; time passes only in `simulation`.

mod check;
mod clock;
mod error;
mod fault;
mod file;
mod motion;
mod noise;
mod robot;
mod sketch;
#[allow(clippy::module_inception, reason = "the world itself")]
mod world;

pub(crate) use clock::Ticker;
pub use clock::{Clock, MAX_DRIFT_PPM};
pub use eeruf_files::{AnySchedule, RobotRing, ScheduleFile};
pub use error::WorldError;
pub(crate) use fault::scene_with;
pub use fault::{Fault, FaultKind};
pub use file::{ReadRing, WorldParts, cover_motion, heading_rad, world_file};
pub use motion::{MAX_SPEED, Motion};
pub(crate) use noise::{FARTHEST, Normal};
pub use noise::{Noise, Random};
pub(crate) use robot::offset;
pub use robot::{MAX_ROBOTS, Robot, ring_of};
pub use sketch::{FiringTable, Sketch};
pub use world::{DEFAULT_ORDER, World};
