//! The search for periods: its tables, limits and certificates, against loops and a checker, in one binary.

mod alike;
mod brute_force;
mod checker;
mod common;
mod effort;
mod larger;
mod limits;
mod questions;
mod solver;
mod table;
mod ticks;
mod twins;
