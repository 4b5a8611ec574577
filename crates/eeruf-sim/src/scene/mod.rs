//! Objects of a scene: walls, poles and air, checked once, with the mesh and the mirrors derived from them. It uses
//! only `geometry`; `world` adds robots, noise and seeds.

mod body;
mod bounce;
mod contact;
mod error;
mod material;
mod mesh;
mod pole;
mod room;
#[allow(clippy::module_inception, reason = "the scene itself")]
mod scene;
mod wall;

pub use body::{Body, MAX_CORNERS, Outline, OutlineError};
pub use bounce::Bounce;
pub use contact::Contact;
pub use eeruf_modules::Air;
pub use error::{MAX_COORDINATE_M, MAX_POLE_M, MAX_WALLS, MIN_WALL_M, SceneError};
pub use material::Material;
pub use mesh::edges::Edge;
pub(crate) use mesh::extents::{End, Surface};
pub(crate) use mesh::{Beyond, Exit, Gate, Mesh, NONE};
pub use pole::Pole;
pub use room::{DEFAULT_HEIGHT_M, Room};
pub use scene::Scene;
pub use wall::{Faces, Wall};
