//! Conversion between echo time and distance in integers, since firmware often lacks floats.

use crate::time::Micros;

/// The speed of sound in air, in mm/s.
///
/// ```
/// use eeruf_core::{Micros, SpeedOfSound};
/// let c = SpeedOfSound::at_celsius_tenths(200);
/// assert_eq!(c.mm_per_s(), 343_200);
/// assert_eq!(c.distance_mm(Micros::from_millis(12)), 2059);
/// assert_eq!(c.echo_time(2059), Micros::new(11_999));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedOfSound {
    mm_per_s: u32,
}

impl SpeedOfSound {
    /// Speed of sound at 20 C: 343.2 m/s (ISO 9613-1).
    pub const AT_20_CELSIUS: Self = Self { mm_per_s: 343_200 };

    /// A speed of sound in mm/s.
    pub const fn from_mm_per_s(mm_per_s: u32) -> Self {
        Self { mm_per_s }
    }

    /// Returns the speed of sound at a temperature in tenths of a degree Celsius: `343.2 sqrt(T / 293.15 K)` m/s (ISO
    /// 9613-1), rounded down to mm/s; 0 below absolute zero.
    pub const fn at_celsius_tenths(tenths: i16) -> Self {
        let kelvin_hundredths = 27_315 + 10 * tenths as i32;
        if kelvin_hundredths < 0 {
            return Self { mm_per_s: 0 };
        }
        // 343,200^2 * 355,000 stays below 2^63, and the root below 2^32.
        let squared = 343_200_u64 * 343_200 * kelvin_hundredths as u64 / 29_315;
        Self { mm_per_s: squared.isqrt() as u32 }
    }

    /// The speed in mm/s.
    pub const fn mm_per_s(self) -> u32 {
        self.mm_per_s
    }

    /// The distance to an object whose echo came back after `t_echo`, to the nearest mm: `c t / 2`.
    pub const fn distance_mm(self, t_echo: Micros) -> u32 {
        // At most 2^64 / 2,000,000.
        let distance = (self.mm_per_s as u64 * t_echo.as_micros() as u64 + 1_000_000) / 2_000_000;
        if distance > u32::MAX as u64 { u32::MAX } else { distance as u32 }
    }

    /// The echo time of an object at this distance in mm: `2 s / c`, to the nearest microsecond, at most
    /// [`Micros::MAX`].
    #[doc(alias = "T_echo")]
    pub const fn echo_time(self, distance_mm: u32) -> Micros {
        if self.mm_per_s == 0 {
            return Micros::MAX;
        }
        let us = (distance_mm as u64 * 2_000_000 + self.mm_per_s as u64 / 2) / self.mm_per_s as u64;
        Micros::new(if us > u32::MAX as u64 { u32::MAX } else { us as u32 })
    }
}

impl Default for SpeedOfSound {
    fn default() -> Self {
        Self::AT_20_CELSIUS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_of_sound_follows_iso_9613_1() {
        for (celsius_tenths, mm_per_s) in [(0, 331_285), (100, 337_295), (200, 343_200), (300, 349_004)] {
            let speed = SpeedOfSound::at_celsius_tenths(celsius_tenths).mm_per_s();
            assert!(speed.abs_diff(mm_per_s) <= 1, "{celsius_tenths}: {speed}");
        }
        assert_eq!(SpeedOfSound::at_celsius_tenths(i16::MIN).mm_per_s(), 0);
        assert!(SpeedOfSound::at_celsius_tenths(i16::MAX).mm_per_s() > 1_000_000);
    }

    #[test]
    fn there_and_back_loses_at_most_half_a_millimetre() {
        let c = SpeedOfSound::AT_20_CELSIUS;
        for mm in (0..11_000).step_by(7) {
            assert_eq!(c.distance_mm(c.echo_time(mm)), mm);
        }
    }

    #[test]
    fn extreme_values_stop_at_the_border() {
        assert_eq!(SpeedOfSound::from_mm_per_s(0).echo_time(5), Micros::MAX);
        assert_eq!(SpeedOfSound::from_mm_per_s(1).echo_time(u32::MAX), Micros::MAX);
        assert_eq!(SpeedOfSound::from_mm_per_s(u32::MAX).distance_mm(Micros::MAX), u32::MAX);
    }
}
