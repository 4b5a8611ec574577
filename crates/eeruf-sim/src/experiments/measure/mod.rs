//! Ways of firing measured by a robot's needs: how soon it sees an object that appears, and how often it stops for no
//! reason.
//!
//! ****Trial.** The robot stands still, drives along its free way and back, or turns on the spot in a room of the
//! [set](crate::experiments::rooms), alone or (in rooms of the kind `meeting`) with another robot of its make. The
//! physics is the default, between floor and ceiling. At a uniformly drawn instant in 5 to 15 s one of five
//! [things](ThingKind) appears and stays. It appears before a uniformly drawn sensor: its nearest point is 0.3 to 2 m
//! away and within 7.5 degrees of the axis, with a clear line, and it touches nothing. Alone in quiet air at this pose,
//! the sensor must read the thing as its first echo in 9 of 10 firings, and no other echo from as far away. Otherwise
//! another thing is drawn; the share of these things is the module's blindness. The trial ends after 5 s, before a
//! contact, or when all settings have seen the thing. Paths of a moving robot are searched for every 6 cm or 6 degrees,
//! once for all ways of firing, and carried on to each firing.
//!
//! A thing is **seen** at the first belief within 8.6 cm of its nearest point, by a sensor whose reading alone is as
//! near. Latency counts from the appearance to the end of the echo that completes the belief. The **t95** is the 95th
//! percentile of the latency, which is infinite for things that are never seen.
//!
//! **A false stop** is a belief, before the thing appears, in foreign, stale or outside sound that is nearer than 1.5
//! m, and by 15 cm nearer than every surface within 60 degrees of the sensor's axis. It counts for the whole robot:
//! once if there was none for 1 s, and once more for each further second.
//!
//! **A belief** lasts until another replaces it, until the robot has moved 0.15 m or turned by 10 degrees, or for 2 s.
//! It needs [votes](Setting). The readings of one simulation serve all settings.
//!
//! **One cost.** In rooms that are not reported each [family](Family) of ways gets its setting, the quickest with at
//! most one false stop a minute; in others the [cost](Measured::costs) is measured: the mean time until a thing is
//! seen, at most a second each, relative to the best one by one, and over the conditions its geometric mean. Its
//! scatter between sets of rooms is a fifth of that of the t95. Intervals come from 2,000 bootstraps over rooms. If the
//! interval of a ratio contains 1, the simpler way is recommended.

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
pub use ways::{Family, RoomWay, with_other_gain};
