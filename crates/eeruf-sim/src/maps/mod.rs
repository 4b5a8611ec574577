//! Maps that people have: an occupancy grid, as the ROS `map_server` saves it (a picture in PGM and a YAML file beside
//! it), becomes walls. It uses `scene`; nothing but callers uses it.

mod contours;
mod grid;
mod pgm;
mod simplify;
mod yaml;

pub use grid::OccupancyGrid;
