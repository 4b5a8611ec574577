//! Limits up to which sound is followed, and of how much may be asked at once.

/// The highest order that may be asked for: a choice; sound is inaudible long before.
pub const MAX_ORDER: u32 = 1000;
/// The most beams that one question may grow, some hundreds of megabytes: a choice.
pub const MAX_BEAMS: usize = 1 << 22;
/// The frequency that amplitudes are given for unless another is asked for: Polaroid's 49.4 kHz.
pub const DEFAULT_FREQUENCY_HZ: f64 = 49_400.0;

/// Returns true if sound may matter to a receiver, by its number, after a path of this length in metres. Paths that do
/// not are found, and not weighed.
pub(crate) type Matters<'a> = &'a dyn Fn(usize, f64) -> bool;

/// Limits up to which the sound is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The most bounces.
    pub max_order: u32,
    /// The longest path in metres; infinity for no limit.
    pub max_length_m: f64,
}

impl Limits {
    /// Limits of an order, at any length.
    pub const fn order(max_order: u32) -> Self {
        Self { max_order, max_length_m: f64::INFINITY }
    }
}
