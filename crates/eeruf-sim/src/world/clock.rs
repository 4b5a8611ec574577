//! A robot's clock: a free-running microsecond counter that starts anywhere, runs a little fast or slow, and wraps.
//!
//! True time is counted in whole nanoseconds from the start of the simulation, so that the order of events never
//! depends on rounding.

use eeruf_core::Instant;

/// How a robot's clock relates to true time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// What the counter reads at the start, in microseconds.
    pub offset_us: u32,
    /// How much faster than true time it runs, in parts per million, -1000 to 1000.
    pub drift_ppm: f64,
}

/// The fastest and slowest clock that makes sense, in parts per million: a choice, ten times a
/// crystal's and about an RC oscillator's.
pub const MAX_DRIFT_PPM: f64 = 1000.0;

/// A clock with its drift as a ratio of whole numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ticker {
    offset_us: u32,
    /// Nanoseconds that the clock gains in a second.
    gain_ppb: i64,
}

const BILLION: i64 = 1_000_000_000;

impl Ticker {
    pub(crate) fn new(clock: Clock) -> Self {
        let drift_ppm = clock.drift_ppm.clamp(-MAX_DRIFT_PPM, MAX_DRIFT_PPM);
        Self { offset_us: clock.offset_us, gain_ppb: (drift_ppm * 1000.0).round() as i64 }
    }

    /// Whole microseconds that the clock has counted at a true time.
    pub(crate) fn ticks(&self, true_ns: u64) -> u64 {
        if self.gain_ppb == 0 {
            return true_ns / 1000;
        }
        let own_ns = i128::from(true_ns) * i128::from(BILLION + self.gain_ppb) / i128::from(BILLION);
        (own_ns / 1000) as u64
    }

    /// The first true time at which the clock has counted that many microseconds.
    pub(crate) fn reaches(&self, ticks: u64) -> u64 {
        if self.gain_ppb == 0 {
            return ticks * 1000;
        }
        let (own_ns, rate) = (i128::from(ticks) * 1000 * i128::from(BILLION), i128::from(BILLION + self.gain_ppb));
        ((own_ns + rate - 1) / rate) as u64
    }

    /// What the counter reads after that many ticks.
    pub(crate) fn instant(&self, ticks: u64) -> Instant {
        Instant::from_micros(self.offset_us.wrapping_add(ticks as u32))
    }

    /// The true length of a time that the clock measures.
    pub(crate) fn true_ns(&self, own_us: u32) -> u64 {
        self.reaches(u64::from(own_us))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_fast_clock_counts_more_and_wraps() {
        let fast = Ticker::new(Clock { offset_us: u32::MAX - 9, drift_ppm: 100.0 });
        assert_eq!(fast.ticks(1_000_000_000), 1_000_100);
        assert_eq!(fast.instant(10), Instant::from_micros(0));
        assert_eq!(fast.reaches(1_000_100), 1_000_000_000);
    }

    proptest! {
        #[test]
        fn a_tick_is_reached_at_the_first_nanosecond_that_counts_it(
            ticks in 1u64..1u64 << 40,
            drift in -1000.0..1000.0f64,
        ) {
            let clock = Ticker::new(Clock { offset_us: 7, drift_ppm: drift });
            let at = clock.reaches(ticks);
            prop_assert_eq!(clock.ticks(at), ticks);
            prop_assert!(clock.ticks(at - 1) < ticks);
        }
    }
}
