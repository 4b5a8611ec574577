//! Paths of sound: every specular path from a source to its receivers, its audibility and its course. It uses
//! `geometry`, `scene` and `acoustics`; time and noise belong to `simulation`.

mod audibility;
mod beam;
mod bounce_points;
mod crosstalk;
mod edges;
mod ends;
mod error;
mod limits;
mod panels;
mod paths;
mod poles;
mod ranking;
mod reception;
mod short_forms;
mod tracer;
mod vertical;
mod write;

pub(crate) use crosstalk::Moved;
pub use crosstalk::{CriticalPath, CrosstalkMatrix, CrosstalkQuery};
pub use error::PathsError;
pub(crate) use limits::Matters;
pub use limits::{DEFAULT_FREQUENCY_HZ, Limits, MAX_BEAMS, MAX_ORDER};
pub use paths::Paths;
pub(crate) use reception::reception_at;
pub use reception::{Reception, reception, reception_along};
pub use tracer::{Heights, Tracer};
pub use vertical::VERTICAL_ORDER;
