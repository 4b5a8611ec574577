//! A robot's clock: a free-running microsecond counter with any start, a small drift, and wraps.
//!
//! True time is counted in whole nanoseconds from the start of the simulation, so that the order of events never
//! depends on rounding.

use eeruf_core::Instant;
use serde::{Deserialize, Serialize};

/// Relation of a robot's clock to true time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Clock {
    /// The counter at the start, in microseconds.
    pub offset_us: u32,
    /// Drift relative to true time, in parts per million, -1000 to 1000.
    pub drift_ppm: f64,
}

/// Largest drift of a clock, in parts per million: a choice, ten times a crystal's and about that of an RC oscillator.
pub const MAX_DRIFT_PPM: f64 = 1000.0;

/// A clock whose drift, a ratio of whole numbers, may change for a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ticker {
    offset_us: u32,
    /// Consecutive stretches; unused stretches never begin.
    stretches: [Stretch; 3],
}

/// A stretch of time with a constant clock rate.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Start, in true nanoseconds.
    from: u64,
    /// Time counted by the clock until then, in nanoseconds.
    own: u64,
    /// Nanoseconds that the clock gains in a second.
    gain_ppb: i64,
}

const BILLION: i64 = 1_000_000_000;
const NEVER: Stretch = Stretch { from: u64::MAX, own: u64::MAX, gain_ppb: 0 };

impl Stretch {
    fn counted(&self, true_ns: u64) -> u64 {
        let since = i128::from(true_ns - self.from);
        self.own + (since * i128::from(BILLION + self.gain_ppb) / i128::from(BILLION)) as u64
    }
}

impl Ticker {
    pub(crate) fn new(clock: Clock) -> Self {
        let drift_ppm = clock.drift_ppm.clamp(-MAX_DRIFT_PPM, MAX_DRIFT_PPM);
        let gain_ppb = (drift_ppm * 1000.0).round() as i64;
        Self { offset_us: clock.offset_us, stretches: [Stretch { from: 0, own: 0, gain_ppb }, NEVER, NEVER] }
    }

    /// Returns the clock with an additional drift between two true times, in nanoseconds.
    pub(crate) fn drifting(mut self, more_ppm: f64, from: u64, to: u64) -> Self {
        let [usual, ..] = self.stretches;
        let gain_ppb = usual.gain_ppb + (more_ppm * 1000.0).round() as i64;
        let drifting = Stretch { from, own: usual.counted(from), gain_ppb };
        self.stretches[1] = drifting;
        if to < u64::MAX {
            self.stretches[2] = Stretch { from: to, own: drifting.counted(to), ..usual };
        }
        self
    }

    /// Returns the whole microseconds that the clock has counted at a true time.
    pub(crate) fn ticks(&self, true_ns: u64) -> u64 {
        let stretch = self.stretches.iter().rev().find(|stretch| stretch.from <= true_ns).unwrap_or(&self.stretches[0]);
        if stretch.from == 0 && stretch.gain_ppb == 0 {
            return true_ns / 1000;
        }
        stretch.counted(true_ns) / 1000
    }

    /// Returns the first true time at which the clock has counted this many microseconds.
    pub(crate) fn reaches(&self, ticks: u64) -> u64 {
        let own_ns = ticks.saturating_mul(1000);
        let stretch = self.stretches.iter().rev().find(|stretch| stretch.own <= own_ns).unwrap_or(&self.stretches[0]);
        if stretch.from == 0 && stretch.gain_ppb == 0 {
            return own_ns;
        }
        let (own_ns, rate) =
            (i128::from(own_ns - stretch.own) * i128::from(BILLION), i128::from(BILLION + stretch.gain_ppb));
        stretch.from + ((own_ns + rate - 1) / rate) as u64
    }

    /// Returns the reading of the counter after this many ticks.
    pub(crate) fn instant(&self, ticks: u64) -> Instant {
        Instant::from_micros(self.offset_us.wrapping_add(ticks as u32))
    }

    /// Returns the true length of a time that the clock measures at its usual rate.
    pub(crate) fn true_ns(&self, own_us: u32) -> u64 {
        let [usual, ..] = self.stretches;
        Self { stretches: [usual, NEVER, NEVER], ..*self }.reaches(u64::from(own_us))
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

    #[test]
    fn a_clock_that_drifts_for_a_time_gains_in_that_time_alone() {
        let drifts = Ticker::new(Clock::default()).drifting(1000.0, 1_000_000_000, 3_000_000_000);
        let counted = [500, 1_000, 2_000, 3_000, 4_000].map(|ms| drifts.ticks(ms * 1_000_000));
        assert_eq!(counted, [500_000, 1_000_000, 2_001_000, 3_002_000, 4_002_000]);
        for ticks in [1, 999_999, 1_000_000, 1_000_001, 2_500_000, 3_002_000, 3_002_001, 9_000_000] {
            let at = drifts.reaches(ticks);
            assert!(drifts.ticks(at) >= ticks && drifts.ticks(at - 1) < ticks, "{ticks}");
        }
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
