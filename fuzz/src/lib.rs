//! What the fuzz targets check: each module takes whatever the fuzzer makes up and panics where a promise is broken.
//!
//! The targets in `fuzz_targets` only call these, so that a finding can be replayed by an ordinary test.

pub mod files;
pub mod filter;
pub mod ring;
