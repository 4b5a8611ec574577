//! The echoes of one firing as a sorted array of numbers.

use crate::time::Micros;

/// Stands for "no echo" inside this crate: longer than any listening window.
pub(crate) const NO_ECHO: u32 = u32::MAX;

/// Puts one more echo into a sorted array, dropping the latest if it is full. What is no echo sorts last.
pub(crate) fn insert<const E: usize>(echoes: &mut [u32; E], mut echo: u32) {
    for held in echoes {
        if echo < *held {
            core::mem::swap(held, &mut echo);
        }
    }
}

/// The echo time that a number stands for.
pub(super) fn echo_time(echo: u32) -> Option<Micros> {
    (echo != NO_ECHO).then_some(Micros::new(echo))
}
