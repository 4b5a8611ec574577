//! Largest sizes of a [`Schedule`](super::Schedule), and its phases.

use core::fmt;

use crate::time::Micros;

/// The most sensors one schedule can hold: one bit each in a `u64`, in which the search and [`Layout`](crate::Layout)
/// keep sets of sensors.
pub const MAX_SENSORS: usize = 64;
/// The most phases one schedule can have. The paper has two; [`Ring`](crate::Ring) keeps a phase in three bits.
pub const MAX_PHASES: usize = 8;
/// The longest period: 2^28 us (268 s). A cycle of [`MAX_PHASES`] periods then takes at most 2^31 us, half a turn of
/// the clock, beyond which two instants have no order.
pub const MAX_PERIOD: Micros = Micros::new(1 << 28);

/// One of the phases of a schedule, counted from 0 and printed `a`, `b`, .., `z`, `aa`, ..
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Phase(pub u8);

impl Phase {
    /// The first phase, in which the paper's waits are `T_wait,a`.
    pub const A: Self = Self(0);
    /// The second phase, in which the paper's waits are `T_wait,b`.
    pub const B: Self = Self(1);
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = |number: u8| char::from(b'a'.saturating_add(number));
        match self.0 / 26 {
            0 => write!(f, "{}", letter(self.0)),
            many => write!(f, "{}{}", letter(many - 1), letter(self.0 % 26)),
        }
    }
}
