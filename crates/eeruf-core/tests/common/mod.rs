//! What the tests of the wait search share: the slow judge and the shared tables.

#![allow(dead_code, unreachable_pub)]

pub mod naive;
pub mod tables;
