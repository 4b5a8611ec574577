//! Exact critical paths and the acoustics along them.

pub mod air;
pub mod alhazen;
mod amplitude;
mod beam;
pub mod collide;
pub mod crosstalk;
pub mod error;
pub mod material;
mod mesh;
pub mod moving;
pub mod paths;
pub mod piston;
pub mod plane;
pub mod pole;
mod pole_paths;
pub mod scatter;
pub mod scene;
pub mod transducer;
pub mod wall;

pub use air::Air;
pub use alhazen::{Specular, alhazen, alhazen_twice};
pub use collide::{Body, Contact};
pub use crosstalk::{CriticalPath, CrosstalkMatrix, ring_of};
pub use error::{PathsError, SceneError};
pub use material::Material;
pub use moving::{Reception, reception, reception_along};
pub use paths::{Bounce, Limits, Paths, Tracer};
pub use piston::Piston;
pub use plane::{Point, Pose, Vector};
pub use pole::Pole;
pub use scatter::{edge_diffraction, pole_wave_correction, rigid_cylinder_form};
pub use scene::Scene;
pub use transducer::{GainProfile, Transducer};
pub use wall::{Faces, Wall};
