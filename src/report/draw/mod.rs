//! Pictures: one file for each kind, on top of `picture` and `style`.

mod atlas;
mod course;
mod crosstalk;
mod kinds;
mod methods;
mod picture;
mod readings;
mod scene;
mod spreads;
mod style;
mod timing;

pub(crate) use atlas::atlas;
pub(crate) use course::courses;
pub(crate) use crosstalk::two_periods;
pub(crate) use kinds::kinds_over_time;
pub(crate) use methods::{blind_sensors, methods_chart};
pub(crate) use picture::Picture;
pub(crate) use readings::readings_over_time;
pub(crate) use scene::{DrawnPath, Panel, scene_with_paths};
pub(crate) use spreads::{robots_of_one_make, set_one};
pub(crate) use timing::timing_diagram;
