//! Limits up to which sound is followed, and limits of a query's size.

/// The highest order of a query: a choice; sound is inaudible long before that.
pub const MAX_ORDER: u32 = 1000;
/// The largest number of beams of one query, some hundreds of megabytes: a choice.
pub const MAX_BEAMS: usize = 1 << 22;
/// The default frequency of amplitudes: Polaroid's 49.4 kHz.
pub const DEFAULT_FREQUENCY_HZ: f64 = 49_400.0;

/// Returns true if sound may matter to a receiver, given by its number, after a path of this length in metres. Paths
/// that do not matter are found, but not evaluated.
pub(crate) type Matters<'a> = &'a dyn Fn(usize, f64) -> bool;

/// Limits up to which sound is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest number of bounces.
    pub max_order: u32,
    /// The longest path in metres; infinity for no limit.
    pub max_length_m: f64,
}

impl Limits {
    /// Makes limits with this order and any length.
    pub const fn order(max_order: u32) -> Self {
        Self { max_order, max_length_m: f64::INFINITY }
    }
}
