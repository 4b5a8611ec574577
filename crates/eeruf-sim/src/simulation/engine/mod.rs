//! The event loop, which decides the next ring to act, the next sound to arrive and the readings to record. It uses
//! channels, receivers and kinematics.

mod arrivals;
mod event_loop;
mod faults;
mod filter;
mod own;
mod recorder;
mod running_ring;

pub(super) use arrivals::Propagation;
pub use event_loop::expected_readings;
pub(crate) use event_loop::run;
pub(super) use event_loop::{EventLoop, end_of};
pub use filter::{Filter, Filtered, FiredReading};
pub use own::Own;
pub(super) use running_ring::plans;
