//! Set I (Sec. 4): eight sensors before three walls at right angles. Each reading is compared with the reading that the
//! sensor would have alone.
//!
//! The paper does not give the dimensions of the alcove. Here it is a U 1.0 to 2.4 m wide and 0.9 to 2.0 m deep. A ring
//! of radius 0.30 m in or near its mouth heads into it within 20 degrees. Everything else is the default of
//! [`Robot::ring`](crate::Robot::ring): a period of 60 ms, a window of 36 ms, `T_delta` = 0.5 ms.

mod alcove;
mod figures;
mod multi_echo;
mod options;
mod step;
mod table;

pub use alcove::{Alcove, RADIUS_M, SENSORS, SPACING_DEG};
pub use figures::{Figures, Run};
pub use multi_echo::MultiEcho;
pub use options::{READINGS, SetOneOptions};
pub use step::{Latency, NewStep, STEP_M, Steps};
pub use table::{SetOne, set_one, world_of};
