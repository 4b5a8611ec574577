//! Claims of the paper about schedules, ring and filter, one module for each claim.

mod conditions;
mod crosstalk;
mod immediate_refiring;
mod ring;
