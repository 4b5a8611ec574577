//! Conversions to and from the time types of `core` and of other crates, the latter behind a feature named after the
//! crate.

use core::time::Duration;

#[cfg(any(feature = "embassy-time", feature = "fugit"))]
use crate::time::Instant;
use crate::time::Micros;

#[cfg(feature = "fugit")]
impl From<fugit::MicrosDurationU32> for Micros {
    fn from(duration: fugit::MicrosDurationU32) -> Self {
        Self::new(duration.as_ticks())
    }
}

#[cfg(feature = "fugit")]
impl From<Micros> for fugit::MicrosDurationU32 {
    fn from(duration: Micros) -> Self {
        Self::from_ticks(duration.as_micros())
    }
}

#[cfg(feature = "fugit")]
impl From<fugit::WrappingTimerInstantU32<1_000_000>> for Instant {
    fn from(instant: fugit::WrappingTimerInstantU32<1_000_000>) -> Self {
        Self::from_micros(instant.as_ticks())
    }
}

#[cfg(feature = "fugit")]
impl From<Instant> for fugit::WrappingTimerInstantU32<1_000_000> {
    fn from(instant: Instant) -> Self {
        Self::from_ticks(instant.as_micros())
    }
}

#[cfg(feature = "embassy-time")]
impl From<Micros> for embassy_time::Duration {
    fn from(duration: Micros) -> Self {
        Self::from_micros(duration.as_micros().into())
    }
}

/// Conversion that saturates at [`Micros::MAX`].
#[cfg(feature = "embassy-time")]
impl From<embassy_time::Duration> for Micros {
    fn from(duration: embassy_time::Duration) -> Self {
        Self::new(u32::try_from(duration.as_micros()).unwrap_or(u32::MAX))
    }
}

/// Conversion that keeps the low 32 bits of the 64-bit clock.
#[cfg(feature = "embassy-time")]
impl From<embassy_time::Instant> for Instant {
    fn from(instant: embassy_time::Instant) -> Self {
        Self::from_wide(instant.as_micros())
    }
}

#[cfg(feature = "embassy-time")]
impl Instant {
    /// Extends an [`Instant`] to embassy's 64-bit clock: the instant nearest to `now`.
    pub fn to_embassy(self, now: embassy_time::Instant) -> embassy_time::Instant {
        embassy_time::Instant::from_micros(self.to_wide(now.as_micros()))
    }
}

impl From<Micros> for Duration {
    fn from(duration: Micros) -> Self {
        Self::from_micros(duration.as_micros().into())
    }
}

/// Conversion to whole microseconds, rounded down; saturates at [`Micros::MAX`], longer than any window or period.
impl From<Duration> for Micros {
    fn from(duration: Duration) -> Self {
        Self::new(u32::try_from(duration.as_micros()).unwrap_or(u32::MAX))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    #[cfg(feature = "fugit")]
    #[test]
    fn fugits_times_go_there_and_back() {
        let duration = fugit::MicrosDurationU32::from_millis(24);
        assert_eq!(Micros::from(duration), Micros::from_millis(24));
        assert_eq!(fugit::MicrosDurationU32::from(Micros::from_millis(24)), duration);
        let instant = fugit::WrappingTimerInstantU32::<1_000_000>::from_ticks(u32::MAX);
        assert_eq!(fugit::WrappingTimerInstantU32::from(Instant::from(instant)), instant);
    }

    // Durations of core survive a round trip within 32 bits of microseconds.
    #[test]
    fn core_durations_round_trip_within_32_bits() {
        assert_eq!(Micros::from(Duration::from_nanos(24_000_999)), Micros::from_millis(24));
        assert_eq!(Duration::from(Micros::MAX), Duration::from_micros(u32::MAX.into()));
        assert_eq!(Micros::from(Duration::from_micros(u64::from(u32::MAX) - 1)), Micros::new(u32::MAX - 1));
        for too_long in [Duration::from(Micros::MAX), Duration::from_micros(1 << 32), Duration::MAX] {
            assert_eq!(Micros::from(too_long), Micros::MAX);
        }
    }

    // Embassy's times survive a round trip beyond 32 bits of microseconds.
    #[cfg(feature = "embassy-time")]
    #[test]
    fn embassy_times_round_trip_beyond_32_bits() {
        let duration = embassy_time::Duration::from_millis(24);
        assert_eq!(Micros::from(duration), Micros::from_millis(24));
        assert_eq!(embassy_time::Duration::from(Micros::from_millis(24)), duration);
        assert_eq!(Micros::from(embassy_time::Duration::from_secs(4295)), Micros::MAX);
        let now = embassy_time::Instant::from_micros(5 << 32);
        for away in [0, 24_000, 1 << 30] {
            for instant in
                [now + embassy_time::Duration::from_micros(away), now - embassy_time::Duration::from_micros(away)]
            {
                assert_eq!(Instant::from(instant).to_embassy(now), instant);
            }
        }
    }
}
