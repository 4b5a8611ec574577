//! Exact critical paths and the acoustics along them.

pub mod air;
pub mod alhazen;
mod amplitude;
mod beam;
pub mod error;
pub mod material;
mod mesh;
pub mod paths;
pub mod plane;
pub mod pole;
mod pole_paths;
pub mod scene;
pub mod wall;

pub use air::Air;
pub use alhazen::{Specular, alhazen, alhazen_twice};
pub use error::{PathsError, SceneError};
pub use material::Material;
pub use paths::{Bounce, Limits, Paths, Tracer};
pub use plane::{Point, Pose, Vector};
pub use pole::Pole;
pub use scene::Scene;
pub use wall::{Faces, Wall};
