//! What happens in time: rings fire, sound travels along channels, receivers hear, and a recorder writes down the
//! readings. It uses all rooms from `geometry` to `results`; a pilot who steers by the readings is a `Kinematics`.

mod arrivals;
mod changing;
mod channels;
mod error;
mod event_loop;
mod kinematics;
mod lock_step;
mod open;
mod options;
mod receiver;
mod recorder;
mod running_ring;
mod simulate;
mod steered;

pub(crate) use changing::simulate_in_turn;
pub use error::SimulationError;
pub use event_loop::expected_readings;
pub(crate) use event_loop::run;
pub(crate) use kinematics::Kinematics;
pub use lock_step::LockStep;
pub use open::Simulation;
pub use options::Options;
pub use simulate::{simulate, simulate_until, simulate_while};
