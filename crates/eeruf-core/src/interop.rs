//! Conversions to and from the time types of other crates, each behind the feature of that crate's name.

#[cfg(any(feature = "embassy-time", feature = "fugit"))]
use crate::time::{Instant, Micros};

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

/// The low 32 bits of a clock of 64.
#[cfg(feature = "embassy-time")]
impl From<embassy_time::Instant> for Instant {
    fn from(instant: embassy_time::Instant) -> Self {
        Self::from_micros(instant.as_micros() as u32)
    }
}

#[cfg(all(test, feature = "fugit"))]
mod tests {
    use super::*;

    #[test]
    fn fugits_times_go_there_and_back() {
        let duration = fugit::MicrosDurationU32::from_millis(24);
        assert_eq!(Micros::from(duration), Micros::from_millis(24));
        assert_eq!(fugit::MicrosDurationU32::from(Micros::from_millis(24)), duration);
        let instant = fugit::WrappingTimerInstantU32::<1_000_000>::from_ticks(u32::MAX);
        assert_eq!(fugit::WrappingTimerInstantU32::from(Instant::from(instant)), instant);
    }
}
