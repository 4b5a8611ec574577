//! Settings of votes: what is believed of a sensor's readings.

use core::fmt;

use super::heard::Heard;
use super::things::agree;
use crate::results::Cause;

/// Votes that a reading needs to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Setting {
    /// `m` of a sensor's last `n` readings agree with it, itself included: within 8.6 cm, carried on by odometry, or
    /// both silent.
    Votes {
        /// Number of readings that must agree.
        m: usize,
        /// Of this number.
        n: usize,
    },
    /// The median of a sensor's last three readings is believed. Silence is beyond all echoes.
    Median,
}

impl Setting {
    /// All, the most eager first and the most cautious last of the votes.
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

/// A belief from one reading on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Believed {
    /// The reading that completed it.
    pub(super) heard: Heard,
    /// Its echo time; NaN for silence.
    pub(super) t_echo_us: f64,
    pub(super) cause: Cause,
    /// Until when it lasts.
    pub(super) until_s: f64,
}

/// The beliefs of one sensor, from its readings in order: each ends when the next begins, or when its life is over.
/// `holds_s` is how long nothing replaces one.
pub(super) fn believed(heard: &[Heard], setting: Setting, [life_s, holds_s]: [f64; 2]) -> Vec<Believed> {
    let mut beliefs: Vec<Believed> = vec![];
    // The last five readings, the newest first; none for one that its way does not believe.
    let mut last: [Option<(f64, Cause)>; 5] = [None; 5];
    for (number, reading) in heard.iter().enumerate() {
        for (t_echo_us, _) in last.iter_mut().flatten() {
            *t_echo_us += if setting == Setting::Median { 0.0 } else { reading.change_us };
        }
        last.rotate_right(1);
        last[0] = reading.accepted.then_some((reading.t_echo_us, reading.cause));
        let says = match (setting, last[0]) {
            (Setting::Votes { m, n }, Some((t_echo_us, cause))) => {
                let agrees = |other: &&(f64, Cause)| agree(other.0, t_echo_us);
                let votes = last.iter().take(n).flatten().filter(agrees).count();
                (votes >= m).then_some((t_echo_us, cause))
            }
            (Setting::Median, _) if number >= 2 => {
                let mut three: Vec<_> = last.iter().take(3).flatten().copied().collect();
                three.sort_by(|one, other| beyond(one.0).total_cmp(&beyond(other.0)));
                three.get(1).copied().filter(|_| three.len() == 3)
            }
            _ => None,
        };
        let Some((t_echo_us, cause)) = says else { continue };
        if let Some(before) = beliefs.last_mut() {
            if reading.ready_s < before.heard.ready_s + holds_s {
                continue;
            }
            before.until_s = before.until_s.min(reading.ready_s);
        }
        beliefs.push(Believed {
            heard: *reading,
            t_echo_us,
            cause,
            until_s: (reading.fired_s + life_s).max(reading.ready_s),
        });
    }
    beliefs
}

/// Silence as a time beyond all echoes.
fn beyond(t_echo_us: f64) -> f64 {
    if t_echo_us.is_nan() { f64::INFINITY } else { t_echo_us }
}
