//! Broken parts: sensors that hear nothing, that lose echoes, that chatter, whose lines are swapped or whose triggers
//! are late.
//!
//! Nothing in range is not deaf, and an echo at its threshold is not a bad contact. A sensor is called broken where the
//! log rules that out: others hear its sound loudly, and it does not hear theirs along the same paths; or all others
//! hear in nearly every firing, so that the room has no open side.

use super::alike::Alike;
use super::reciprocity::{Wiring, contradicted, is_unheard, wiring};
use super::sensors::{FEW, Hearing};
use super::share::Share;
use super::statistics::median;
use super::timeline::Timeline;
use super::together::{Together, exchanged, together};
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
        /// Number of such pairs expected in a whole ring by accident: if the other's echoes do not depend on the silent
        /// sensor, or where both have a part in paths that are not heard back, if these fade.
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
/// The mean share of their firings whose echo stays is larger: it is their own. So is that with an echo of those at
/// which no other sound is in the air, if these are as many.
const OWN: f64 = 0.5;
const FEW_ALONE: u32 = 10;
/// While a robot drives all others hear in this share of their firings, and on average in the other.
const TURNS: f64 = 0.3;
const TURNS_MEAN: f64 = 0.65;
/// Firings of a chattering sensor whose echoes wander, at least.
const CHATTERS: f64 = 0.05;
/// Echoes that come this many times as late as the usual ones of other sensors are faint.
const FAR: f64 = 2.0;
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
    let is_contradicted = |sensor: u8| contradicted.iter().any(|of| of.is_of(sensor));
    let silent: Vec<_> = hearing.iter().filter(|of| of.is_silent).map(|of| of.sensor).collect();
    let by_contradiction = exchanged(&silent, &contradicted, timeline, settings);
    let is_exchanged = |of: &Hearing| by_contradiction.is_some_and(|(_, with)| with.sensor == of.sensor);
    for (of, like) in hearing.iter().zip(alike).filter(|(of, _)| of.echoes.of >= FEW && !is_exchanged(of)) {
        let sensor = of.sensor;
        // Another sensor that hears only while this one listens, if this is the only one that is silent.
        let pair =
            (of.is_silent && silent.len() == 1 && !moved).then(|| together(sensor, timeline, settings)).flatten();
        let is_other = |of: &Hearing| of.sensor != sensor && pair.is_none_or(|pair| of.sensor != pair.sensor);
        let others: Vec<_> = hearing.iter().zip(alike).filter(|(of, _)| is_other(of)).collect();
        let is_closed = is_closed(&others, timeline.has_many_phases, moved);
        let misses_others = like.misses_others();
        // An echo at its threshold is missed as one that is lost. In a room in which all hear their own echoes there is
        // none; with two phases nobody knows whose they are, and faint ones come from far.
        let is_faint = if timeline.has_many_phases { !hear_own(&others) } else { is_far(like, &others) };
        let stands = !moved && of.echoes.of >= SHORT;
        let exchanged = pair.filter(|pair| is_closed || is_contradicted(sensor) || is_contradicted(pair.sensor));
        let exchanged = by_contradiction.filter(|pair| pair.0 == sensor).map(|pair| pair.1).or(exchanged);
        if let Some(Together { sensor: other, with: together, without: alone, accidents }) = exchanged {
            faults.push(Fault::Exchanged { sensors: (sensor, other), together, alone, accidents });
        } else if of.is_silent
            && (is_closed && of.echoes.count == 0 || misses_others || is_unheard(sensor, paths, timeline, settings))
        {
            let is_heard = paths.iter().any(|path| path.sender == sensor && path.receiver != sensor);
            faults.push(Fault::Deaf { sensor, echoes: of.echoes, is_heard });
        } else if stands && of.misses_at_random && (is_closed && !is_faint || misses_others) {
            let Share { count, of } = like.repeats;
            faults.push(Fault::Losing { sensor, lost: Share { count: of - count, of } });
        }
        // Who walks by makes echoes of several sensors wander, for a while.
        let as_much = |other: &&Alike| other.wandering.value() > AS_OTHERS * like.wandering.value();
        let alone = alike.iter().filter(as_much).count() <= 2;
        let chatters = like.wandering.of >= FEW && like.wandering.value() > CHATTERS && like.wanders_steadily;
        if stands && alone && chatters {
            faults.push(Fault::Chattering { sensor, wandering: like.wandering });
        }
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

/// Returns true if a sensor's echoes come much later than those of others usually do: what comes from far is faint.
fn is_far(like: &Alike, others: &[(&Hearing, &Alike)]) -> bool {
    let mut usual: Vec<_> = others.iter().map(|(_, other)| other.echo_us).collect();
    like.echo_us > FAR * median(&mut usual)
}

/// Returns true if sensors mostly hear their own echoes, which stay from firing to firing.
fn hear_own(others: &[(&Hearing, &Alike)]) -> bool {
    let steady: f64 = others.iter().map(|(_, like)| like.steady.value()).sum();
    steady > OWN * others.len() as f64
}

/// Returns true if every sensor of a whole ring would hear there, as these others say. While the robot drives each of
/// them hears for a while. Where it stands they hear in nearly every firing, and mostly their own echoes, or none of
/// them falls silent when no other sound is in the air. With two phases others' sound recurs like an own echo, so that
/// all must hear the more often.
fn is_closed(others: &[(&Hearing, &Alike)], has_many_phases: bool, moved: bool) -> bool {
    let all_hear = |share: f64| others.iter().all(|(of, _)| of.echoes.value() > share);
    let mean = others.iter().map(|(of, _)| of.echoes.value()).sum::<f64>() / others.len() as f64;
    others.len() > 1
        && match (moved, has_many_phases) {
            (true, _) => all_hear(TURNS) && mean > TURNS_MEAN,
            (false, true) => {
                let hear_alone = others.iter().all(|(_, like)| like.alone.of < FEW_ALONE || like.alone.value() > OWN);
                all_hear(CLOSED) && (hear_alone || hear_own(others))
            }
            (false, false) => all_hear(CLOSED_BY_TWO),
        }
}
