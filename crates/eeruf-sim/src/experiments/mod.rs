//! The paper's experiments, made repeatable.

pub mod set_one;
