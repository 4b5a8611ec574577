//! Events in time: rings fire, sound travels along channels, receivers hear, and a recorder stores the readings. It
//! uses all modules from `geometry` to `results`; a pilot that steers by the readings is a `Kinematics`.

mod changing;
mod channels;
mod engine;
mod entry;
mod error;
mod kinematics;
mod lock_step;
mod open;
mod options;
mod receiver;
mod ring_paths;
mod simulate;
mod steered;

pub(crate) use changing::simulate_in_turn;
pub(crate) use channels::SharedPaths;
pub use engine::expected_readings;
pub(crate) use engine::run;
pub use engine::{Filter, Filtered, FiredReading, Own};
pub use entry::{Entry, MakeOwn};
pub use error::SimulationError;
pub(crate) use kinematics::Kinematics;
pub use lock_step::LockStep;
pub use open::Simulation;
pub use options::Options;
pub use receiver::Echo;
pub use simulate::{simulate, simulate_until, simulate_while};
