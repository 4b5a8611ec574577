//! The paper's experiments, made repeatable: Set I before three walls, Set II through courses of poles; and Set III
//! among robots of one make. This module uses all others, and none uses it.

mod by_name;
mod conditions;
mod difference;
mod error;
pub mod measure;
mod progress;
pub mod rooms;
pub mod set_one;
pub mod set_three;
pub mod set_two;
mod spread;

pub use conditions::Conditions;
pub use difference::Difference;
pub use error::ExperimentError;
pub use spread::Spread;

/// The number of the first geometry or course unless another is asked for. Parameters were tuned on numbers below
/// 2,000, so reports start far from them.
pub const FIRST: u64 = 20_000;
