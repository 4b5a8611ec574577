//! Results: every reading with its cause, the figures of a method, and the sensors that fooled each sensor. It uses
//! names of `methods` and `scene`; `simulation` fills it.

mod attribution;
mod belief;
mod parts;
mod readings;
mod summary;

pub use attribution::Attribution;
pub use belief::{BELIEF_LASTS_S, BeliefShares};
pub use readings::{Cause, HeardPath, NO_PATH, Readings, SensorId};
pub use summary::{Age, DEFAULT_TOLERANCE_US, Summary, quantile};
