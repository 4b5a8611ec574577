//! Noise: fading and jitter of echoes, bursts from outside, and the random numbers behind them.
//!
//! The noise of an arrival depends only on the seed, the firing and the path ([`Random::of`]). So it does not depend on
//! the order of arrivals, on the method, or on the number of threads.

mod normal;

use serde::{Deserialize, Serialize};

use super::error::WorldError;

pub use eeruf_period::Random;
pub(crate) use normal::{FARTHEST, Normal};

/// Noise of a world.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Noise {
    /// Root mean square of each arrival's change of level, in dB.
    pub fading_db_rms: f64,
    /// Root mean square of each arrival's change of time, in microseconds.
    pub jitter_us_rms: f64,
    /// Mean number of bursts from outside (compressed air, keys, another make of sensor) that are heard per second.
    pub bursts_per_s: f64,
    /// Level of a burst above the threshold, in dB.
    pub burst_db: f64,
}

impl Default for Noise {
    /// 1.5 dB, 15 us, no bursts.
    fn default() -> Self {
        Self { fading_db_rms: 1.5, jitter_us_rms: 15.0, bursts_per_s: 0.0, burst_db: 20.0 }
    }
}

impl Noise {
    /// No noise.
    pub const NONE: Self = Self { fading_db_rms: 0.0, jitter_us_rms: 0.0, bursts_per_s: 0.0, burst_db: 0.0 };

    pub(crate) fn check(&self) -> Result<(), WorldError> {
        for (field, value, most, expected) in [
            ("fading_db_rms", self.fading_db_rms, 20.0, "0 to 20"),
            ("jitter_us_rms", self.jitter_us_rms, 10_000.0, "0 to 10000"),
            ("bursts_per_s", self.bursts_per_s, 10_000.0, "0 to 10000"),
        ] {
            if !(0.0..=most).contains(&value) {
                return Err(WorldError::Noise { field, value, expected });
            }
        }
        if !(-200.0..=200.0).contains(&self.burst_db) {
            return Err(WorldError::Noise { field: "burst_db", value: self.burst_db, expected: "-200 to 200" });
        }
        Ok(())
    }
}
