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

/// Measures echo times from a firing that was this much later; negative for earlier. Returns false if the first of them
/// came before it; it then counts as having come with it.
pub(crate) fn shift<const E: usize>(echoes: &mut [u32; E], later_us: i32) -> bool {
    let mut all_after = true;
    for echo in echoes.iter_mut().filter(|echo| **echo != NO_ECHO) {
        let since = i64::from(*echo) - i64::from(later_us);
        all_after &= since >= 0;
        // Within the range by the bounds.
        *echo = since.clamp(0, i64::from(NO_ECHO - 1)) as u32;
    }
    all_after
}
