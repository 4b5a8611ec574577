//! Results of the experiments, as tables.

pub(crate) mod set_one;
pub(crate) mod set_three;
pub(crate) mod set_two;
