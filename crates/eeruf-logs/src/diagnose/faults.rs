//! Broken parts: sensors that hear nothing, that lose echoes, that chatter, whose lines are swapped or whose triggers
//! are late.
//!
//! Nothing in range is not deaf, and an echo at its threshold is not a bad contact. A sensor is called broken where the
//! log rules that out: others hear its sound loudly, and it does not hear theirs along the same paths; or all others
//! hear in nearly every firing, so that the room has no open side.

use super::alike::Alike;
use super::reciprocity::{Wiring, wiring};
use super::sensors::{Hearing, Share};
use super::timeline::Timeline;
use super::{FoundPath, Settings};

/// Something that is broken, with what speaks for it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A sensor hears nothing that it should: it is deaf, or its echo line is open.
    Deaf {
        /// The sensor, from 0.
        sensor: u8,
        /// Firings with an echo.
        echoes: Share,
        /// True if others hear its sound, so that it is not its trigger.
        is_heard: bool,
    },
    /// A sensor misses echoes at random: a bad contact, or a receiver that is nearly deaf.
    Losing {
        /// The sensor, from 0.
        sensor: u8,
        /// Firings without an echo, of those after one with an echo at which the ring fired alike.
        lost: Share,
    },
    /// A sensor's echoes come from nowhere and at any time.
    Chattering {
        /// The sensor, from 0.
        sensor: u8,
        /// Firings whose echo fits no path and does not come back when the ring fires alike.
        wandering: Share,
    },
    /// The echo lines of two sensors are swapped, or their triggers. Sound takes the same time from x to y as from y to
    /// x; with these two lines exchanged so do the paths of the log, and as it stands they do not.
    Swapped {
        /// The two sensors, from 0.
        sensors: (u8, u8),
        /// Paths that are heard back if the lines are exchanged, of those that should be.
        exchanged: Share,
        /// The same as the log stands.
        as_it_is: Share,
        /// Number of explanations as good that are expected in a whole ring by accident.
        accidents: f64,
    },
    /// A sensor fires later than the log says. Its sound takes longer to the others than theirs to it.
    Late {
        /// The sensor, from 0.
        sensor: u8,
        /// Delay of its trigger, in microseconds.
        late_us: f64,
        /// Paths that are heard back with this delay, of those that should be.
        delayed: Share,
        /// The same as the log stands.
        as_it_is: Share,
        /// Number of explanations as good that are expected in a whole ring by accident.
        accidents: f64,
    },
}

impl Fault {
    /// The name, as `--json` and Python give it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Deaf { .. } => "deaf",
            Self::Losing { .. } => "losing",
            Self::Chattering { .. } => "chattering",
            Self::Swapped { .. } => "swapped",
            Self::Late { .. } => "late",
        }
    }

    /// The sensors that have it, from 0.
    pub fn sensors(&self) -> Vec<u8> {
        match *self {
            Self::Deaf { sensor, .. }
            | Self::Losing { sensor, .. }
            | Self::Chattering { sensor, .. }
            | Self::Late { sensor, .. } => vec![sensor],
            Self::Swapped { sensors: (one, other), .. } => vec![one, other],
        }
    }
}

/// A sensor with fewer firings is not judged.
const FEW: u32 = 50;
/// In a log with fewer of each a robot that drives along a wall looks like one that stands.
const SHORT: u32 = 200;
/// A deaf sensor has an echo in fewer of its firings.
const DEAF: f64 = 0.02;
/// A room without an open side is heard by all others in this share of their firings.
const CLOSED: f64 = 0.9;
/// A sensor that hears so few of the arrivals that it should is broken, of this many.
const ANSWERS: f64 = 0.75;
const ARRIVALS: u32 = 20;
/// A sensor that loses echoes hears one in fewer of the firings at which it should, of this many.
const KEEPS: f64 = 0.8;
const COMPARED: u32 = 8;
/// Misses at random come as often after a miss as after an echo; those of a sound that fades come in runs.
const RANDOM: f64 = 0.1;
const RUNS: f64 = 0.3;
/// Firings of a chattering sensor whose echoes wander, at least.
const CHATTERS: f64 = 0.065;
/// Noise has no memory; who walks by makes echoes wander one after the other.
const EPISODES: f64 = 2.0;
/// Not more than one other sensor does so this much as often.
const AS_OTHERS: f64 = 0.4;

pub(super) fn faults(
    paths: &[FoundPath],
    hearing: &[Hearing],
    alike: &[Alike],
    timeline: &Timeline,
    settings: &Settings,
    moved: bool,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (of, like) in hearing.iter().zip(alike).filter(|(of, _)| of.echoes.of >= FEW) {
        let sensor = of.sensor;
        let mut others = hearing.iter().filter(|other| other.sensor != sensor);
        let is_closed = hearing.len() > 2 && others.all(|other| other.echoes.value() > CLOSED);
        let misses_others = like.answers.of >= ARRIVALS && like.answers.interval_95().1 < ANSWERS;
        let stands = !moved && of.echoes.of >= SHORT;
        let fades_slowly = alike.iter().any(|other| other.runs() > RUNS);
        if of.is_silent && (is_closed || misses_others) {
            let is_heard = paths.iter().any(|path| path.sender == sensor && path.receiver != sensor);
            faults.push(Fault::Deaf { sensor, echoes: of.echoes, is_heard });
        } else if stands && of.misses_at_random && (is_closed || misses_others || fades_slowly) {
            let Share { count, of } = like.repeats;
            faults.push(Fault::Losing { sensor, lost: Share { count: of - count, of } });
        }
        // Who walks by makes echoes of several sensors wander, for a while.
        let as_much = |other: &&Alike| other.wandering.value() > AS_OTHERS * like.wandering.value();
        let [after_none, after_one] = like.wanders_after;
        let alone = alike.iter().filter(as_much).count() <= 2
            && after_one.interval_95().0 < EPISODES * after_none.interval_95().1;
        if stands && alone && like.wandering.of >= FEW && like.wanders_steadily > CHATTERS {
            faults.push(Fault::Chattering { sensor, wandering: like.wandering });
        }
    }
    if moved {
        return faults;
    }
    let blames = |fault: &Fault| match *fault {
        Fault::Deaf { sensor, .. } | Fault::Losing { sensor, .. } | Fault::Chattering { sensor, .. } => Some(sensor),
        _ => None,
    };
    let broken: Vec<_> = faults.iter().filter_map(blames).collect();
    match wiring(paths, timeline, &broken, settings) {
        Some((Wiring::Swapped(a, b), score, as_it_is, accidents)) => faults.push(Fault::Swapped {
            sensors: (a, b),
            exchanged: score.share(),
            as_it_is: as_it_is.share(),
            accidents,
        }),
        Some((Wiring::Late(sensor, late_us), score, as_it_is, accidents)) => {
            faults.push(Fault::Late { sensor, late_us, delayed: score.share(), as_it_is: as_it_is.share(), accidents });
        }
        _ => {}
    }
    faults
}

/// Returns true if a sensor hears nothing: out of range, or deaf.
pub(super) fn is_silent(echoes: Share) -> bool {
    echoes.of >= FEW && echoes.interval_95().1 < DEAF
}

/// Returns true if a sensor misses echoes at random: it loses them, or they are at its threshold and fade
/// independently at every firing.
pub(super) fn misses_at_random(like: &Alike) -> bool {
    let hears_others = like.answers.of >= ARRIVALS && like.answers.interval_95().0 > ANSWERS;
    like.repeats.of >= COMPARED
        && like.repeats.interval_95().1 < KEEPS
        && !hears_others
        && like.repeats.differs(like.returns).abs() < RANDOM
        && like.after[1].differs(like.after[0]).abs() < RANDOM
}

impl Alike {
    /// The share by which a sensor surely hears more often after an echo than after a miss.
    fn runs(&self) -> f64 {
        if self.after.iter().any(|share| share.of < ARRIVALS) { 0.0 } else { self.after[1].differs(self.after[0]) }
    }
}

impl Share {
    /// The difference that two shares surely have, within two standard errors.
    fn differs(self, other: Self) -> f64 {
        let variance = |share: Self| {
            let value = share.value();
            (value * (1.0 - value) + 0.02) / f64::from(share.of.max(1))
        };
        let by = self.value() - other.value();
        (by.abs() - 2.0 * (variance(self) + variance(other)).sqrt()).max(0.0).copysign(by)
    }
}
