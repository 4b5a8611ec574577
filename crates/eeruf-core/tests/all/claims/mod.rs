//! What the paper claims of schedules, ring and filter, one module for each claim.

mod conditions;
mod crosstalk;
mod immediate_refiring;
mod ring;
