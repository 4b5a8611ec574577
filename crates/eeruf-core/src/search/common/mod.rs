//! The language of both engines: how a search ends, how the caller watches it, why a problem is invalid, and sets of
//! sensors. It uses nothing of either engine.

mod control;
mod error;
mod members;
mod outcome;

pub use control::{Control, Progress};
pub use error::ProblemError;
pub(super) use error::check_conflicts;
pub(super) use members::Members;
pub use outcome::Outcome;
