//! Exhaustive searches for schedules, with proofs.

pub mod design;
