//! EERUF's simulator: the exact paths of sound from one ultrasonic sensor to another, its loudness on arrival, and the
//! readings of whole rings under each firing method.
//!
//! - A [`Scene`] is walls, poles and air, checked once. [`Scene::paths`] answers with *every* specular path; a
//!   [`Tracer`] does so again and again without allocating.
//! - [`Transducer`], [`Piston`], [`Material`] and [`Air`] turn a path into an amplitude; [`CrosstalkMatrix`] does so
//!   for each pair of sensors of a ring.
//! - [`reception`] solves for the moment at which sound meets a moving receiver; [`Scene::contact`] finds the objects
//!   that a robot touches.
//! - A [`Simulation`] runs step by step under the caller's own controller, and with the caller's own [`FiringMethod`]
//!   and [`Filter`] if given ([`Own`]).
//! - A [`World`] puts robots with rings, clocks and motions into a scene, from a TOML file or from code; [`simulate()`]
//!   runs the ring of `eeruf-core` through simulated time under a [`Method`]. Every one of the [`Readings`] knows what
//!   caused it; [`Summary`] counts the errors and [`Attribution`] says who was fooled by whom.
//!
//! A world's [`Physics`] lists its effects; `docs/explanation/physics.md` in the repository explains which effects are
//! computed and which are left out.
//!
//! The modules; each uses only those before it:
//!
//! | module | contents |
//! |---|---|
//! | [`threads`] | work on all cores, and early cancellation |
//! | [`geometry`] | points, mirrors, Alhazen's problem |
//! | [`scene`] | walls, poles and air, with the mesh over them |
//! | [`maps`] | occupancy grids as walls |
//! | [`acoustics`] | loudness: directivity, reflection, spreading, diffraction |
//! | [`tracing`] | paths: beam tree, paths over poles, limits of audibility, crosstalk matrix |
//! | [`world`] | robots, motions, clocks, noise, the TOML file |
//! | [`methods`] | the table of firing methods and their schedules |
//! | [`results`] | readings, summary, attribution |
//! | [`simulation`] | events in simulated time |
//! | [`navigation`] | grid, histogram and platform; uses only `geometry` and `scene` |
//! | [`experiments`] | the paper's two sets, and Set III with several robots |
//!
//! Paths are found with a beam tree over a constrained triangulation of the scene, poles with Alhazen's problem;
//! positions are good to about 1e-12 of the scene's size and sets of paths are complete. Units are metres, seconds and
//! radians; walls, poles, sensors and receivers are counted from 0.
//!
//! The method: J. Borenstein and Y. Koren, "Error Eliminating Rapid Ultrasonic Firing for Mobile
//! Robot Obstacle Avoidance", IEEE Transactions on Robotics and Automation 11(1), 1995, pp. 132-138.
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
//! let floor = transducer.detection_floor(scene.air());
//! let (sensors, transducer, limits) = (&ring[..], &transducer, Limits::order(4));
//! matrix.compute(&mut Tracer::new(), &CrosstalkQuery::new(&scene, sensors, transducer, limits, floor))?;
//! let echo = &matrix.between(0, 0)[0];
//! assert!((echo.length_m - 2.4).abs() < 1e-12); // the wall ahead
//! assert!(!matrix.between(0, 1).is_empty()); // the neighbour hears it too
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use eeruf_modules as modules;
pub use eeruf_period::ShortestPeriod;

pub mod acoustics;
pub mod experiments;
pub mod geometry;
pub mod maps;
pub mod methods;
pub mod navigation;
pub mod results;
pub mod scene;
pub mod simulation;
pub mod threads;
pub mod tracing;
pub mod world;

pub use acoustics::{
    Beam, GainProfile, Physics, Piston, Transducer, UnknownPhysics, edge_diffraction, gain_at, pole_wave_correction,
    rigid_cylinder_form,
};
pub use geometry::{Moment, Point, Pose, Specular, Vector, alhazen, alhazen_twice, pose_of};
pub use maps::OccupancyGrid;
pub use methods::{
    FiringMethod, FiringPeriod, FlowOptions, Method, OwnError, UnknownMethod, best_schedule_for, requirements_of,
    shortest_schedule_for, table_i_d_for,
};
pub use navigation::{Driven, Himm, LabMate, Vfh};
pub use results::{
    Age, Attribution, BELIEF_LASTS_S, BeliefShares, Cause, DEFAULT_TOLERANCE_US, HeardPath, NO_PATH, Readings,
    SensorId, Summary, quantile,
};
pub use scene::{
    Air, Body, Bounce, Contact, DEFAULT_HEIGHT_M, Edge, Faces, Material, Outline, OutlineError, Pole, Room, Scene,
    SceneError, Wall,
};
pub use simulation::{
    Echo, Entry, Filter, Filtered, FiredReading, LockStep, MakeOwn, Options, Own, Simulation, SimulationError,
    simulate, simulate_until, simulate_while,
};
pub use threads::{Stop, Threads, sweep};
pub use tracing::{
    CriticalPath, CrosstalkMatrix, CrosstalkQuery, Heights, Limits, MAX_ORDER, Paths, PathsError, Reception, Tracer,
    VERTICAL_ORDER, reception, reception_along,
};
pub use world::{
    AnySchedule, Clock, Fault, FaultKind, FiringTable, Motion, Noise, Random, ReadRing, Robot, RobotRing, ScheduleFile,
    Sketch, World, WorldError, WorldParts, ring_of, world_file,
};

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
