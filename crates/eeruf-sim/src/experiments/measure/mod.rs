//! Ways of firing measured by what a robot needs: how soon it sees what steps in its way, and how often it stops for
//! nothing.
//!
//! **Trial.** A room of the [set](crate::experiments::rooms), in which the robot stands, drives along its free way and
//! back, or turns on the spot, alone or (in the rooms of the kind `meeting`) with another robot of its make. Physics
//! are the default ones, between floor and ceiling. At an instant uniform in 5 to 15 s one of five [things](ThingKind)
//! appears and stays: before a uniformly drawn sensor, its nearest point uniform in 0.3 to 2 m from it and within 7.5
//! degrees of its axis, with a clear line, touching nothing. Where that sensor, alone in quiet air at this pose, does
//! not read it as its first echo in 9 of 10 firings, a second apart, or reads something as far away without it, another
//! thing is drawn, and the share of those is the module's blindness. The trial ends 5 s later, when the robot would
//! touch the thing, or when all settings have seen it. Paths of a robot that moves are searched for every 6 cm or 6
//! degrees, once for all ways of firing, and carried on to each firing.
//!
//! **Seen** is the thing at the first belief within 8.6 cm of its nearest point, of any sensor whose reading alone
//! would be that. Latency counts from its appearing to the end of the echo that completes the belief. The **t95** is
//! the 95th percentile with what is never seen as infinite.
//!
//! **A false stop** is a belief in foreign, stale or outside sound, nearer than 1.5 m and nearer by 15 cm than every
//! surface within 60 degrees of the sensor's axis, before the thing appears. It is the robot's: an onset after 1 s
//! without one counts one, each further second of it one more.
//!
//! **A belief** lasts until another replaces it, until the robot has moved 0.15 m or turned by 10 degrees, or for 2 s.
//! It needs [votes](Setting). One simulation's readings serve all settings.
//!
//! **One cost.** In rooms on which nothing is reported each [family](Family) of ways gets its setting, the least t95
//! with at most one false stop a minute; in others the [cost](Measured::costs) is measured: the geometric mean over the
//! conditions of its t95 relative to the best one by one. Intervals come from 2,000 bootstraps over rooms. Where the
//! interval of a difference holds none, the simpler way is recommended.

mod bootstrap;
mod cost;
mod heard;
mod run;
mod sight;
mod things;
mod trial;
mod votes;
mod ways;

pub use bootstrap::Estimate;
pub use cost::{Cell, Cost, Costs, ONE_A_MINUTE, Operating, Point};
pub use heard::Control;
pub use run::{BySetting, MeasureAsked, Measured, Place, Under, measure, measure_in_scene};
pub use sight::Sight;
pub use things::{Draws, ThingKind};
pub use trial::{Condition, Moving, NEVER_S, Speeds, VERSION};
pub use votes::Setting;
pub use ways::{Family, MeasuredWay, measured_ways};
