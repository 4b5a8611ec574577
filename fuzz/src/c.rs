//! The C library compared with the crates: both get a ring with the same random events and must agree.

use eeruf_c_equal::{Random, flow, modules, ring};

/// Compares one ring; the first byte chooses its kind.
///
/// # Panics
/// If C and Rust differ.
pub fn check(bytes: &[u8]) {
    let r = &Random::of_bytes(bytes);
    match r.within(0, 8) {
        0 => ring::run::<1>(r),
        1 | 2 => ring::run::<2>(r),
        3 => ring::run::<3>(r),
        4 => ring::run::<8>(r),
        5 => flow::run::<2>(r),
        6 => flow::run::<8>(r),
        7 => flow::run::<12>(r),
        _ => modules::run(r),
    };
}
