//! Searches for firing times: exhaustive, and clear about what they proved.

pub mod wait;
