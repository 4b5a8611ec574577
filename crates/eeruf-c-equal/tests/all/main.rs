//! C and Rust get the same configurations, echoes, faults, lateness and clock jumps, and must say the same.
//!
//! Each test compares 200,000 events; with `EERUF_C_EVENTS=10000000` as many as that.

mod corpus;
mod hopping;
mod modules;
mod parts;
mod ring;
mod serial;
mod world;

/// How many events to compare.
fn events() -> u64 {
    std::env::var("EERUF_C_EVENTS").map_or(200_000, |events| events.parse().expect("a number of events"))
}
