//! Steering by range readings: certainty grid (HIMM), vector field histogram (VFH) and a platform with two driven
//! wheels. It uses `geometry`, and `scene` for the platform's outline; it can be used without sonar.

mod differential_drive;
mod himm;
mod piloting;
mod vfh;

pub use differential_drive::{Driven, LabMate};
pub use himm::{DECREMENT, Himm, INCREMENT, MAX_VALUE};
pub use piloting::Piloting;
pub(crate) use piloting::tuned;
pub use vfh::{Histogram, SECTOR_RAD, SECTORS, Steering, Valley, Vfh, sector_of};
