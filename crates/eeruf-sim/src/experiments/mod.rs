//! The paper's experiments, made repeatable.

mod error;
mod going;
pub mod set_one;
pub mod set_two;
mod spread;

pub use error::ExperimentError;
pub use spread::Spread;
