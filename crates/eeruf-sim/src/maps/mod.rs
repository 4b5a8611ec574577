//! Conversion of maps to walls: occupancy grids as the ROS `map_server` saves them (a picture in PGM and a YAML file
//! beside it). It uses `scene`.

mod contours;
mod grid;
mod pgm;
mod simplify;
mod yaml;

pub use grid::OccupancyGrid;
