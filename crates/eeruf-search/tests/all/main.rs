//! The searches against shared tables, slow and obvious judges, and their own limits, in one binary.

mod brute_force;
mod common;
mod effort;
mod period_corpus;
mod period_edges;
mod period_limits;
mod period_small;
mod period_ticks;
mod period_variants;
mod wait_answers;
mod wait_limits;
mod wait_small;
mod wait_tables;
