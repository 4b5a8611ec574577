//! The paper's experiments, made repeatable: Set I before three walls, Set II through courses of poles.
//! It uses all other rooms, and none uses it.

mod by_name;
mod error;
mod progress;
pub mod set_one;
pub mod set_two;
mod spread;

pub use error::ExperimentError;
pub use spread::Spread;
