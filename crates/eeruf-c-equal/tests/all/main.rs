//! C and Rust get the same configurations, echoes, faults, lateness and clock jumps, and must give the same results.
//!
//! Each test compares 200,000 events, or as many as `EERUF_C_EVENTS` says.

mod constants;
mod deferred;
mod line_faults;
mod odometry;
mod parts;
mod serial;
mod settings;

use eeruf_c_equal::{Random, flow, modules, ring};

/// Number of events to compare.
fn events() -> u64 {
    std::env::var("EERUF_C_EVENTS").map_or(200_000, |events| events.parse().expect("a number of events"))
}

#[test]
fn table_ring_equals_rust_event_by_event() {
    let (mut count, mut seed) = (0, 0);
    while count < crate::events() {
        count += match seed % 8 {
            5 => ring::run::<1>(&Random::new(seed)),
            6 => ring::run::<3>(&Random::new(seed)),
            7 => ring::run::<8>(&Random::new(seed)),
            _ => ring::run::<2>(&Random::new(seed)),
        };
        seed += 1;
    }
    println!("{count} events of {seed} rings");
}

#[test]
fn a_flow_ring_says_the_same_event_by_event() {
    let (mut count, mut seed) = (0, 0);
    while count < crate::events() {
        count += match seed % 8 {
            0 => flow::run::<1>(&Random::new(seed)),
            1 => flow::run::<2>(&Random::new(seed)),
            2 => flow::run::<5>(&Random::new(seed)),
            5 => flow::run::<6>(&Random::new(seed)),
            3 => flow::run::<24>(&Random::new(seed)),
            4 => flow::run::<12>(&Random::new(seed)),
            _ => flow::run::<8>(&Random::new(seed)),
        };
        seed += 1;
    }
    println!("{count} events of {seed} rings");
}

#[test]
fn modules_say_the_same_event_by_event_and_are_as_healthy() {
    let (mut count, mut seed) = (0, 0);
    while count < crate::events() {
        count += modules::run(&Random::new(seed));
        seed += 1;
    }
    println!("{count} events of {seed} rings");
}
