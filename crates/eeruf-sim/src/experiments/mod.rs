//! The paper's experiments, made repeatable.

mod error;
pub mod set_one;
mod spread;

pub use error::ExperimentError;
pub use spread::Spread;
