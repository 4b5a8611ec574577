//! Settings of votes, which decide the readings that are believed.

use core::fmt;

use eeruf_core::{
    Instant, Micros, Phase, ReadingKind,
    judge::{self, FiringContext, Judge, MOfN, MedianFilter, NoSounds},
};

use super::heard::Heard;
use crate::results::{Cause, DEFAULT_TOLERANCE_US};

/// Votes that a reading needs to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Setting {
    /// A reading is believed if `m` of the sensor's last `n` readings agree with it, itself included: within 8.6 cm,
    /// adjusted by odometry, or both silent.
    Votes {
        /// Number of readings that must agree.
        m: usize,
        /// Number of the last readings that vote.
        n: usize,
    },
    /// The median of a sensor's last three readings is believed. Silence counts as longer than all echoes.
    Median,
}

impl Setting {
    /// All settings: votes from the most eager to the most cautious, then the median.
    pub const ALL: [Self; 6] = [
        Self::Votes { m: 1, n: 1 },
        Self::Votes { m: 2, n: 3 },
        Self::Votes { m: 2, n: 2 },
        Self::Votes { m: 3, n: 5 },
        Self::Votes { m: 3, n: 4 },
        Self::Median,
    ];
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Votes { m, n } => write!(f, "{m}/{n}"),
            Self::Median => f.write_str("median of 3"),
        }
    }
}

/// A belief that begins with one reading.
#[derive(Clone, Copy, Debug)]
pub(super) struct Believed {
    /// The reading that completed the belief.
    pub(super) heard: Heard,
    /// The echo time; NaN for silence.
    pub(super) t_echo_us: f64,
    pub(super) cause: Cause,
    /// Time until which the belief lasts.
    pub(super) until_s: f64,
}

/// Returns the beliefs of one sensor, from its readings in order. Each belief ends when the next begins or its life is
/// over. `life_s` is its lifetime, and the time for which nothing replaces it.
pub(super) fn believed(heard: &[Heard], setting: Setting, life_s: [f64; 2]) -> Vec<Believed> {
    let near = Micros::new(DEFAULT_TOLERANCE_US as u32);
    match setting {
        Setting::Votes { m, n } => MOfN::<1, 5>::new(m as u8, n as u8, near).map(|votes| by(votes, heard, life_s)),
        Setting::Median => MedianFilter::<1>::new(3, near).map(|median| by(median, heard, life_s)),
    }
    // At most five readings vote.
    .unwrap_or_default()
}

/// Returns the beliefs of a core judge; a reading that its way does not believe gives the judge no information.
fn by(mut judge: impl Judge, heard: &[Heard], [life_s, holds_s]: [f64; 2]) -> Vec<Believed> {
    let mut beliefs: Vec<Believed> = vec![];
    for (number, reading) in heard.iter().enumerate() {
        let echoes = [Micros::new(reading.t_echo_us.round() as u32)];
        let said = judge::Heard {
            sensor: 0,
            fired: Instant::default(),
            since_before: Micros::ZERO,
            echoes: if reading.t_echo_us.is_nan() { &[] } else { &echoes },
            firing: FiringContext { expected_change_us: reading.change_us as i32, ..FiringContext::new(Phase::A) },
            t_delta: judge.t_delta(),
        };
        let skipped = ReadingKind::Rejected;
        let verdict = if reading.accepted { judge.judge(&said, &NoSounds) } else { judge.skip(&said, skipped) };
        if !matches!(verdict.kind, ReadingKind::Accepted | ReadingKind::Clear) {
            continue;
        }
        let Heard { t_echo_us, cause, .. } = heard[number - usize::from(judge.stands_for(0))];
        if let Some(before) = beliefs.last_mut() {
            if reading.ready_s < before.heard.ready_s + holds_s {
                continue;
            }
            before.until_s = before.until_s.min(reading.ready_s);
        }
        let until_s = (reading.fired_s + life_s).max(reading.ready_s);
        beliefs.push(Believed { heard: *reading, t_echo_us, cause, until_s });
    }
    beliefs
}
