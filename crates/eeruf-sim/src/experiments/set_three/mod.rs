//! Set III: two to six robots of one make, near each other, all firing by the same method with clocks of their own.
//!
//! The paper claims that a ring also rejects other robots' sound (Sec. 5), but does not measure it for two alike. Here
//! rings of twelve sensors stand, meet or follow each other in a corridor and in a hall. They share period, window and
//! table; only the phases and drifts of their clocks differ. The rooms, places and drifts are choices. The methods of
//! [today's rings](crate::Method::is_sketch) have two arrays of six, four groups of three, and modules that rest for 65
//! ms like a Polaroid 6500; otherwise they use the defaults of [`Sketch`](crate::Sketch).

mod figures;
mod placing;
mod table;

pub use figures::{Brief, Figures, Run};
pub use placing::{Arrangement, DRIFT_PPM, PERIOD, Placing, SENSORS, SPEED_M_S, Site};
pub use table::{Group, SetThree, SetThreeOptions, group, set_three, usual, world_of};
