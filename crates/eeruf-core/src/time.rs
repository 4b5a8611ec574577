//! Time: [`Micros`] for every duration, [`Instant`] for a reading of the caller's clock.
//!
//! Both are 32 bits of microseconds, because that is what the free-running timers of small microcontrollers count. Such
//! a counter wraps every 71.6 minutes, so two instants have no order of their own: only the *difference* of two
//! instants less than 35.8 minutes apart means something. `Instant` therefore is not `Ord`; ask
//! [`Instant::has_reached`] or [`Instant::since`]. A wider clock is truncated: [`Instant::from_wide`].

use core::fmt;
use core::ops::{Add, AddAssign};

/// A duration in microseconds, 0 to 71.6 minutes.
///
/// There is no `-` operator, since it could wrap: use [`abs_diff`](Self::abs_diff) or
/// [`checked_sub`](Self::checked_sub).
///
/// ```
/// # use eeruf_core::Micros;
/// assert_eq!(Micros::from_millis(24).as_micros(), 24_000);
/// assert_eq!(Micros::new(24_500).to_string(), "24.5 ms");
/// assert_eq!(Micros::new(999).to_string(), "999 us");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Micros(u32);

impl Micros {
    /// A duration of zero.
    pub const ZERO: Self = Self(0);
    /// The longest duration, 4294.967295 s.
    pub const MAX: Self = Self(u32::MAX);

    /// A duration of `us` microseconds.
    pub const fn new(us: u32) -> Self {
        Self(us)
    }

    /// A duration of `ms` milliseconds; saturates at [`Micros::MAX`] (from 4,294,968 ms on).
    pub const fn from_millis(ms: u32) -> Self {
        Self(ms.saturating_mul(1000))
    }

    /// The number of microseconds.
    pub const fn as_micros(self) -> u32 {
        self.0
    }

    /// `|self - other|`: the form in which the paper's conditions (13a), (13b) use times.
    pub const fn abs_diff(self, other: Self) -> Self {
        Self(self.0.abs_diff(other.0))
    }

    /// `self + other`, or `None` beyond [`Micros::MAX`].
    pub const fn checked_add(self, other: Self) -> Option<Self> {
        match self.0.checked_add(other.0) {
            Some(us) => Some(Self(us)),
            None => None,
        }
    }

    /// `self - other`, or `None` if `other` is longer.
    pub const fn checked_sub(self, other: Self) -> Option<Self> {
        match self.0.checked_sub(other.0) {
            Some(us) => Some(Self(us)),
            None => None,
        }
    }

    /// `self + other`, at most [`Micros::MAX`].
    pub const fn saturating_add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }

    /// `self - other`, at least zero.
    pub const fn saturating_sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

/// The shorter of two times, usable in a `const fn`.
pub(crate) const fn shorter(one: Micros, other: Micros) -> Micros {
    if one.as_micros() < other.as_micros() { one } else { other }
}

/// The longer of two times, usable in a `const fn`.
pub(crate) const fn longer(one: Micros, other: Micros) -> Micros {
    if one.as_micros() > other.as_micros() { one } else { other }
}

impl fmt::Display for Micros {
    /// Writes milliseconds without trailing zeros (`24 ms`, `24.5 ms`), or microseconds below one millisecond (`999
    /// us`).
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ms, us) = (self.0 / 1000, self.0 % 1000);
        if ms == 0 {
            write!(f, "{us} us")
        } else if us == 0 {
            write!(f, "{ms} ms")
        } else if us % 100 == 0 {
            write!(f, "{ms}.{} ms", us / 100)
        } else if us % 10 == 0 {
            write!(f, "{ms}.{:02} ms", us / 10)
        } else {
            write!(f, "{ms}.{us:03} ms")
        }
    }
}

/// A reading of the caller's free-running microsecond counter, which may wrap at any moment.
///
/// ```
/// # use eeruf_core::{Instant, Micros};
/// let before_the_wrap = Instant::from_micros(u32::MAX - 4);
/// let after = before_the_wrap + Micros::new(10);
/// assert_eq!(after.as_micros(), 5);
/// assert_eq!(after.since(before_the_wrap), Micros::new(10));
/// assert!(after.has_reached(before_the_wrap) && !before_the_wrap.has_reached(after));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(transparent)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(transparent))]
pub struct Instant(u32);

impl Instant {
    /// The instant at which the caller's counter reads `us` (for a wider counter: [`from_wide`](Self::from_wide)).
    pub const fn from_micros(us: u32) -> Self {
        Self(us)
    }

    /// The instant at which a clock of 64 bits reads `us` microseconds: its low 32 bits.
    pub const fn from_wide(us: u64) -> Self {
        Self(us as u32)
    }

    /// The reading of a clock of 64 bits at this instant: the one nearest to `now_us`, its current reading, but not
    /// before the clock began.
    ///
    /// ```
    /// # use eeruf_core::{Instant, Micros};
    /// let now_us = 3 << 32;
    /// let deadline = Instant::from_wide(now_us) + Micros::from_millis(24);
    /// assert_eq!(deadline.to_wide(now_us), now_us + 24_000);
    /// assert_eq!(deadline.to_wide(now_us + 30_000), now_us + 24_000); // it has passed
    /// ```
    pub const fn to_wide(self, now_us: u64) -> u64 {
        // Up to half a turn of the clock ahead or back.
        now_us.saturating_add_signed(self.0.wrapping_sub(now_us as u32) as i32 as i64)
    }

    /// The value of the caller's counter.
    pub const fn as_micros(self) -> u32 {
        self.0
    }

    /// The time from `earlier` to `self`, counted forward through a wrap of the counter.
    pub const fn since(self, earlier: Self) -> Micros {
        Micros(self.0.wrapping_sub(earlier.0))
    }

    /// Returns true if `self` is `deadline` or up to 35.8 minutes past it.
    pub const fn has_reached(self, deadline: Self) -> bool {
        self.0.wrapping_sub(deadline.0) <= u32::MAX / 2
    }
}

impl Add<Micros> for Instant {
    type Output = Self;
    /// The instant `later` after `self`, through a wrap of the counter.
    fn add(self, later: Micros) -> Self {
        Self(self.0.wrapping_add(later.0))
    }
}

impl AddAssign<Micros> for Instant {
    fn add_assign(&mut self, later: Micros) {
        *self = *self + later;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn durations_print_as_a_designer_writes_them() {
        for (us, text) in [
            (0, "0 us"),
            (999, "999 us"),
            (1000, "1 ms"),
            (24_000, "24 ms"),
            (24_500, "24.5 ms"),
            (24_050, "24.05 ms"),
            (24_005, "24.005 ms"),
            (u32::MAX, "4294967.295 ms"),
        ] {
            assert_eq!(Micros::new(us).to_string(), text);
        }
    }

    #[test]
    fn arithmetic_stops_at_its_borders_instead_of_wrapping() {
        assert_eq!(Micros::MAX.checked_add(Micros::new(1)), None);
        assert_eq!(Micros::ZERO.checked_sub(Micros::new(1)), None);
        assert_eq!(Micros::MAX.saturating_add(Micros::new(1)), Micros::MAX);
        assert_eq!(Micros::ZERO.saturating_sub(Micros::new(1)), Micros::ZERO);
        assert_eq!(Micros::from_millis(u32::MAX), Micros::MAX);
    }

    #[test]
    fn instants_are_ordered_by_their_difference_across_the_wrap() {
        for start in [0, 1, u32::MAX / 2, u32::MAX - 1, u32::MAX] {
            let start = Instant::from_micros(start);
            let half = Micros::new(u32::MAX / 2);
            assert!(start.has_reached(start));
            assert!((start + half).has_reached(start));
            assert!(!start.has_reached(start + half));
            assert!(!(start + half + Micros::new(1)).has_reached(start));
        }
    }
}
