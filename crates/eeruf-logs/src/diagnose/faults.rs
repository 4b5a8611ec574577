//! Broken parts: sensors that hear nothing, that lose echoes, that chatter, whose lines are swapped or whose triggers
//! are late.
//!
//! Nothing in range is not deaf, and an echo at its threshold is not a bad contact. A sensor is called broken where the
//! log rules that out: others hear its sound loudly, and it does not hear theirs along the same paths; or all others
//! hear in nearly every firing, so that the room has no open side.

use super::alike::Alike;
use super::reciprocity::{Wiring, contradicted, wiring};
use super::sensors::{FEW, Hearing};
use super::share::Share;
use super::timeline::Timeline;
use super::together::{Together, together};
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
    /// The echo lines of two sensors are exchanged, whose modules listen only after their own triggers. One line is
    /// silent, and the other has echoes only while the silent sensor listens.
    Exchanged {
        /// The silent sensor and the other, from 0.
        sensors: (u8, u8),
        /// Firings of the other with an echo, of those at which both listen for a while.
        together: Share,
        /// The same of its other firings.
        alone: Share,
        /// Number of such pairs expected in a whole ring by accident, if the other's echoes do not depend on the silent
        /// sensor.
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
            Self::Swapped { .. } | Self::Exchanged { .. } => "swapped",
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
            Self::Swapped { sensors: (one, other), .. } | Self::Exchanged { sensors: (one, other), .. } => {
                vec![one, other]
            }
        }
    }
}

/// In a log with fewer of each a robot that drives along a wall looks like one that stands.
const SHORT: u32 = 200;
/// A room without an open side is heard by all others in this share of their firings.
const CLOSED: f64 = 0.8;
const CLOSED_BY_TWO: f64 = 0.9;
/// The mean share of their firings whose echo stays is larger: it is their own.
const OWN: f64 = 0.5;
/// Firings of a chattering sensor whose echoes wander, at least.
const CHATTERS: f64 = 0.065;
/// Noise has no memory; who walks by makes echoes wander one after the other. With more phases lags move, and how often
/// noise comes first changes with them.
const EPISODES: f64 = 2.0;
const EPISODES_OF_TWO: f64 = 1.0;
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
    let contradicted = contradicted(paths, timeline, settings);
    let is_contradicted = |sensor: u8| contradicted.iter().any(|path| [path.0, path.1].contains(&sensor));
    let silent = hearing.iter().filter(|of| of.is_silent).count();
    for (of, like) in hearing.iter().zip(alike).filter(|(of, _)| of.echoes.of >= FEW) {
        let sensor = of.sensor;
        // Another sensor that hears only while this one listens, if this is the only one that is silent.
        let pair = (of.is_silent && silent == 1 && !moved).then(|| together(sensor, timeline, settings)).flatten();
        let is_other = |of: &Hearing| of.sensor != sensor && pair.is_none_or(|pair| of.sensor != pair.sensor);
        let others: Vec<_> = hearing.iter().zip(alike).filter(|(of, _)| is_other(of)).collect();
        let is_closed = is_closed(&others, timeline.has_many_phases);
        let misses_others = like.misses_others();
        let stands = !moved && of.echoes.of >= SHORT;
        let exchanged = pair.filter(|pair| is_closed || is_contradicted(sensor) || is_contradicted(pair.sensor));
        if let Some(Together { sensor: other, with: together, without: alone, accidents }) = exchanged {
            faults.push(Fault::Exchanged { sensors: (sensor, other), together, alone, accidents });
        } else if of.is_silent && (is_closed || misses_others || is_contradicted(sensor)) {
            let is_heard = paths.iter().any(|path| path.sender == sensor && path.receiver != sensor);
            faults.push(Fault::Deaf { sensor, echoes: of.echoes, is_heard });
        } else if stands && of.misses_at_random && (is_closed || misses_others) {
            let Share { count, of } = like.repeats;
            faults.push(Fault::Losing { sensor, lost: Share { count: of - count, of } });
        }
        // Who walks by makes echoes of several sensors wander, for a while.
        let as_much = |other: &&Alike| other.wandering.value() > AS_OTHERS * like.wandering.value();
        let [after_none, after_one] = like.wanders_after;
        let episodes = if timeline.has_many_phases { EPISODES } else { EPISODES_OF_TWO };
        let alone = alike.iter().filter(as_much).count() <= 2
            && after_one.interval_95().0 < episodes * after_none.interval_95().1;
        if stands && alone && like.wandering.of >= FEW && like.wanders_steadily > CHATTERS {
            faults.push(Fault::Chattering { sensor, wandering: like.wandering });
        }
    }
    if moved {
        return faults;
    }
    let broken: Vec<_> = faults.iter().flat_map(Fault::sensors).collect();
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

/// Returns true if a room has no open side: these sensors all hear, and mostly their own echoes. With two phases
/// others' sound recurs like an own echo, so that all must hear the more often.
fn is_closed(others: &[(&Hearing, &Alike)], has_many_phases: bool) -> bool {
    let steady: f64 = others.iter().map(|(_, like)| like.steady.value()).sum();
    let (hears, is_own) =
        if has_many_phases { (CLOSED, steady > OWN * others.len() as f64) } else { (CLOSED_BY_TWO, true) };
    others.len() > 1 && is_own && others.iter().all(|(of, _)| of.echoes.value() > hears)
}
