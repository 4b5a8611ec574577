//! EERUF's simulator: which ways sound takes from one ultrasonic sensor to another, exactly, how loud it is when it arrives,
//! and what whole rings make of it under each firing method.
//!
//! - A [`Scene`] is walls, poles and air, checked once. [`Scene::paths`] answers with *every* specular path; a [`Tracer`]
//!   does so again and again without allocating.
//! - [`Transducer`], [`Piston`], [`Material`] and [`Air`] turn a path into an amplitude; [`CrosstalkMatrix`] does so for a
//!   whole ring and says who hears whom.
//! - [`reception`] solves for the moment at which sound meets a moving receiver; [`Scene::contact`] for what a robot touches.
//! - A [`World`] puts robots with rings, clocks and motions into a scene, from a TOML file or from code; [`simulate()`] drives
//!   the ring of `eeruf-core` through simulated time under a [`Method`]. Every one of the [`Readings`] knows what caused it;
//!   [`Summary`] counts the errors and [`Attribution`] says who was fooled by whom.
//!
//! Paths are found with a beam tree over a constrained triangulation of the scene, poles with Alhazen's problem; positions
//! are good to about 1e-12 of the scene's size and sets of paths are complete. Units are metres, seconds and radians; walls,
//! poles, sensors and receivers are counted from 0.
//!
//! The method that all this is for: J. Borenstein and Y. Koren, "Error Eliminating Rapid Ultrasonic Firing for Mobile Robot
//! Obstacle Avoidance", IEEE Transactions on Robotics and Automation 11(1), 1995, pp. 132-138.
//!
//! ```
//! use eeruf_sim::*;
//! // A ring of eight sensors in a small room: who hears sensor 0?
//! let room = Wall::polyline(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]]).collect();
//! let scene = Scene::new(room, vec![], Air::default())?;
//! let robot = Pose::new(Vector::new(1.5, 1.0), 0.0);
//! let ring: Vec<_> = ring_of(&robot, 8, 0.3, 0.0, std::f64::consts::FRAC_PI_4).collect();
//! let transducer = Transducer::POLAROID_6500;
//! let mut matrix = CrosstalkMatrix::new();
//! matrix.compute(&mut Tracer::new(), &scene, &ring, &transducer, Limits::order(4), transducer.detection_floor(scene.air()))?;
//! let echo = &matrix.between(0, 0)[0];
//! assert!((echo.length_m - 2.4).abs() < 1e-12); // the wall ahead
//! assert!(!matrix.between(0, 1).is_empty()); // the neighbour hears it too
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod air;
pub mod alhazen;
mod amplitude;
mod attribution;
mod beam;
pub mod best;
pub mod clock;
pub mod collide;
pub mod crosstalk;
mod detector;
mod dither;
mod drive;
pub mod error;
mod events;
pub mod experiments;
mod gate;
mod guide;
pub mod himm;
mod joints;
mod judge;
pub mod labmate;
mod lockstep;
pub mod material;
mod mesh;
pub mod method;
pub mod motion;
pub mod moving;
pub mod noise;
pub mod paths;
pub mod piston;
pub mod plane;
pub mod pole;
mod pole_paths;
mod polyline;
pub mod readings;
pub mod robot;
pub mod scatter;
pub mod scene;
pub mod schedule_file;
pub mod simulate;
pub mod summary;
pub mod transducer;
pub mod vfh;
pub mod wall;
mod ways;
pub mod world;
mod world_file;

pub use air::Air;
pub use alhazen::{Specular, alhazen, alhazen_twice};
pub use attribution::Attribution;
pub use clock::Clock;
pub use collide::{Body, Contact};
pub use crosstalk::{CriticalPath, CrosstalkMatrix, ring_of};
pub use error::{PathsError, SceneError};
pub use himm::Himm;
pub use lockstep::LockStep;
pub use material::Material;
pub use method::{AnySchedule, Method, UnknownMethod, table_i_d_for};
pub use motion::{Moment, Motion};
pub use moving::{Reception, reception, reception_along};
pub use noise::{Chance, Noise};
pub use paths::{Bounce, Limits, Paths, Tracer, paths_of_many};
pub use piston::Piston;
pub use plane::{Point, Pose, Vector};
pub use pole::Pole;
pub use readings::{Cause, HeardPath, NO_PATH, Readings, SensorId};
pub use robot::Robot;
pub use scatter::{edge_diffraction, pole_wave_correction, rigid_cylinder_form};
pub use scene::Scene;
pub use schedule_file::ScheduleFile;
pub use simulate::{Options, SimulationError, simulate, simulate_while, sweep};
pub use summary::{Age, DEFAULT_TOLERANCE_US, Summary, quantile};
pub use transducer::{GainProfile, Transducer};
pub use vfh::Vfh;
pub use wall::{Faces, Wall};
pub use world::{World, WorldError};
pub use world_file::WorldFileError;
