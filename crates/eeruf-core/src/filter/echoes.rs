//! The echoes of one firing as a sorted array.

use crate::time::Micros;

/// Marker of a missing echo inside this crate: longer than any listening window.
pub(crate) const NO_ECHO: Micros = Micros::MAX;
/// Marker of silence with a witness among stored echo times: later than any echo.
pub(crate) const SILENCE: Micros = Micros::new(u32::MAX - 1);

/// The latest echo time that is not taken for silence.
pub(super) const LATEST: Micros = Micros::new(u32::MAX - 1);

/// The echoes of a sorted array, without the markers of missing ones.
pub(crate) fn heard<const E: usize>(echoes: &[Micros; E]) -> &[Micros] {
    let heard = echoes.iter().take_while(|&&echo| echo != NO_ECHO).count();
    echoes.get(..heard).unwrap_or_default()
}

/// Puts one more echo into a sorted array, dropping the latest if it is full. Missing echoes sort last.
pub(crate) fn insert<const E: usize>(echoes: &mut [Micros; E], mut echo: Micros) {
    for held in echoes {
        if echo < *held {
            core::mem::swap(held, &mut echo);
        }
    }
}

/// The echo time of an entry; `None` for a marker.
pub(super) fn echo_time(echo: Micros) -> Option<Micros> {
    (echo != NO_ECHO).then_some(echo)
}

/// Moves the origin of echo times to a firing this much later; negative for earlier. Returns false if the first echo
/// came before that firing; such an echo then counts as simultaneous.
pub(crate) fn shift<const E: usize>(echoes: &mut [Micros; E], later_us: i32) -> bool {
    let mut all_after = true;
    for echo in echoes.iter_mut().filter(|echo| **echo != NO_ECHO) {
        let since = i64::from(echo.as_micros()) - i64::from(later_us);
        all_after &= since >= 0;
        // In range, since it is clamped.
        *echo = Micros::new(since.clamp(0, i64::from(NO_ECHO.as_micros() - 1)) as u32);
    }
    all_after
}
