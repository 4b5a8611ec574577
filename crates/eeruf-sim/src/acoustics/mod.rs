//! Loudness of sound: directivity and gain of transducers, reflection, spreading, and waves at poles and edges. It uses
//! `geometry` and `scene`; `tracing` applies it to the paths that it finds.

mod diffraction;
mod panel;
mod physics;
mod reflection;
mod spreading;
mod transducer;

pub use diffraction::{edge_diffraction, pole_wave_correction, rigid_cylinder_form};
pub use eeruf_modules::{Beam, Gain as GainProfile, Piston};
pub(crate) use panel::{LOUDEST_PANEL, panel_share};
pub use physics::{Physics, UnknownPhysics};
pub(crate) use reflection::reflected;
pub(crate) use spreading::pole_spread;
pub use transducer::{Transducer, gain_at};
