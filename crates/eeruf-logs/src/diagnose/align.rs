//! Puts a log without instants onto a fixed schedule, and says how sure it is that the ring fired by it.
//!
//! What speaks for a schedule are readings that move from one phase to the next: another sensor's sound moves by as
//! much as the two firings do, and the schedule says by how much that is. Where sound is read in phase p of a sensor,
//! its most frequent move to the next phase is one observation, which some other sensor's firings must explain. Lags
//! cancel in moves, so that they moved shows in something else: readings of one phase that stay, and then stay
//! elsewhere, of many sensors at once.

use core::fmt;
use std::collections::BTreeMap;

use super::statistics::{ln_at_least, median};
use crate::firings::FiringLog;

/// The fit of a log to a schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// The log's phase p is the schedule's phase p + `rotation`, counted round.
    pub rotation: u8,
    /// Of how many observed moves the schedule explains how many.
    pub moves: (u32, u32),
    /// Number of schedules that would explain as many by accident, of as many as there are rotations. Above 0.01 the
    /// readings do not say whether the ring fired by it.
    pub accidents: f64,
    /// Confidence in the rotation among all, 0 to 1.
    pub sure: f64,
}

/// Why a log cannot be put onto a schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AlignError {
    /// The log has a sensor or a phase that the schedule does not have.
    NotScheduled {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase, from 0.
        phase: u8,
    },
    /// Phases do not follow each other from period to period.
    Phases {
        /// The first period whose phase is another than the period says.
        period: u32,
    },
    /// Readings of many sensors jump at once: lags have moved, or the robot has.
    Moved {
        /// The period.
        period: u32,
        /// Number of series of readings (of a sensor in a phase) that jump, and of those that stay before and after.
        jumps: (u32, u32),
    },
    /// Readings do not move as by this schedule.
    Unlike {
        /// Of how many observed moves the schedule explains how many.
        moves: (u32, u32),
    },
}

impl fmt::Display for AlignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotScheduled { sensor, phase } => {
                write!(f, "the log has sensor {} in phase {phase}, which the schedule does not have", sensor + 1)
            }
            Self::Phases { period } => {
                write!(f, "in period {period} the phase is not the next one; expected phases in turn")
            }
            Self::Moved { period, jumps: (jumps, of) } => write!(
                f,
                "at period {period} the readings of {jumps} of {of} sensors and phases jump at once; expected lags \
                 that did not move, and a robot that stood"
            ),
            Self::Unlike { moves: (explained, of) } => write!(
                f,
                "of {of} moves of readings from phase to phase it explains {explained}, no more than another \
                 schedule may; \
                 expected the schedule that the ring fired by, and sensors that hear each other"
            ),
        }
    }
}

impl core::error::Error for AlignError {}

/// A series stays if it has this many readings running within the tolerance.
const STAYS: usize = 4;
/// Of the series that stay before and after a period at most this share jumps there where lags have not moved.
const JUMPS: f64 = 0.25;
/// This many moves must agree to be an observation.
const AGREE: usize = 3;
/// More accidents than this, and nothing is known.
const ACCIDENTS: f64 = 0.01;
/// The schedule explains at least this share of the moves. One of another step shares some moves with it, all multiples
/// of both steps, and explains up to a fifth; that is more than accidents do.
const EXPLAINS: f64 = 1.0 / 3.0;
/// This many moves would say whether it is the schedule. Two phases give fewer: a sensor mostly reads its own echo in
/// one and another's sound in the other, and that move depends on unknown lengths of paths.
const ENOUGH: u32 = 20;

/// Puts the firings of a log where a fixed schedule of this many phases has them: the period in microseconds, and when
/// a sensor fires in a phase after the start of its period. What the log says of instants is not used.
///
/// # Errors
/// [`AlignError`] for a schedule that is not the ring's or cannot be known to be, and for lags that moved.
pub fn align(
    log: &FiringLog,
    tolerance_us: u32,
    (period_us, phases): (u32, u8),
    fires_at: impl Fn(u8, u8) -> Option<u32>,
) -> Result<(FiringLog, Alignment), AlignError> {
    let tolerance = i64::from(tolerance_us);
    let phases = phases.max(1);
    let first = log.firings.first().map_or((0, 0), |firing| (firing.period, firing.phase));
    for firing in &log.firings {
        let (sensor, phase) = (firing.sensor, firing.phase);
        let is_known = phase < phases && (0..phases).all(|phase| fires_at(sensor, phase).is_some());
        if !is_known {
            return Err(AlignError::NotScheduled { sensor, phase });
        }
        let ahead = i64::from(firing.period) - i64::from(first.0) + i64::from(first.1);
        if ahead.rem_euclid(phases.into()) != i64::from(phase) {
            return Err(AlignError::Phases { period: firing.period });
        }
    }
    let mut series = BTreeMap::<(u8, u8), Vec<(u32, i64)>>::new();
    let mut readings = BTreeMap::<(u8, u32), (u8, i64)>::new();
    for firing in &log.firings {
        if let Some(echo) = firing.t_echo_us {
            series.entry((firing.sensor, firing.phase)).or_default().push((firing.period, echo.into()));
            readings.insert((firing.sensor, firing.period), (firing.phase, echo.into()));
        }
    }
    jumps(&series, tolerance)?;
    let observed = moves(&readings, tolerance);
    let sensors = log.sensors() as u8;
    // The shift of x's sound in y from a phase to the next one.
    let due = |x: u8, y: u8, phase: u8, rotation: u8| {
        let at = |sensor, phase: u8| fires_at(sensor, phase).map(i64::from);
        let from = (phase + rotation) % phases;
        let to = (from + 1) % phases;
        Some((at(x, to)? - at(y, to)?) - (at(x, from)? - at(y, from)?))
    };
    let explained = |rotation: u8| {
        let is_explained = |&(y, phase, by): &(u8, u8, i64)| {
            let others = (0..sensors).filter(|&x| x != y);
            others.filter_map(|x| due(x, y, phase, rotation)).any(|due| (due - by).abs() <= tolerance)
        };
        observed.iter().filter(|observed| is_explained(observed)).count() as u32
    };
    let all: Vec<_> = (0..phases).map(explained).collect();
    let rotation = (0..phases).max_by_key(|&rotation| (all[usize::from(rotation)], phases - rotation)).unwrap_or(0);
    let (hits, of) = (all[usize::from(rotation)], observed.len() as u32);
    // Moves are spread over as much as the largest of them, to both sides.
    let widest = observed.iter().map(|observed| observed.2.abs()).max().unwrap_or(0).max(10 * tolerance);
    let chance = (f64::from(sensors) * (2 * tolerance + 1) as f64 / (2 * widest) as f64).min(0.9);
    let accidents = f64::from(phases) * ln_at_least(hits, of, chance).exp();
    let is_known = accidents <= ACCIDENTS && f64::from(hits) >= EXPLAINS * f64::from(of);
    if !is_known && of >= ENOUGH {
        return Err(AlignError::Unlike { moves: (hits, of) });
    }
    // Where readings say nothing, the log's own number of the phase is taken.
    let (rotation, hits) = if is_known { (rotation, hits) } else { (0, all[0]) };
    // Each move that only the best explains is as much likelier under it.
    let odds = if is_known { chance / (f64::from(hits) / f64::from(of.max(1))).max(chance) } else { 1.0 };
    let others = all.iter().enumerate().filter(|&(other, _)| other != usize::from(rotation));
    let against: f64 = others.map(|(_, &other)| odds.powi(hits.abs_diff(other) as i32)).sum();
    let mut firings = log.firings.clone();
    for firing in &mut firings {
        let in_period = fires_at(firing.sensor, (firing.phase + rotation) % phases).unwrap_or_default();
        firing.fired_us = i64::from(firing.period) * i64::from(period_us) + i64::from(in_period);
    }
    let aligned = FiringLog { damage: log.damage.clone(), ..FiringLog::new("the schedule's", firings) };
    Ok((aligned, Alignment { rotation, moves: (hits, of), accidents, sure: 1.0 / (1.0 + against) }))
}

/// For each sensor and phase the most frequent move of its reading to the next period: sensor, phase, and by how much.
fn moves(readings: &BTreeMap<(u8, u32), (u8, i64)>, tolerance: i64) -> Vec<(u8, u8, i64)> {
    let mut by = BTreeMap::<(u8, u8), Vec<i64>>::new();
    for (&(sensor, period), &(phase, echo)) in readings {
        if let Some((_, next)) = period.checked_add(1).and_then(|period| readings.get(&(sensor, period)))
            && (next - echo).abs() > 2 * tolerance
        {
            by.entry((sensor, phase)).or_default().push(next - echo);
        }
    }
    let mut observed = Vec::new();
    for ((sensor, phase), mut moves) in by {
        moves.sort_unstable();
        let within = |&from: &i64| moves.iter().filter(move |&&by| (from..=from + 2 * tolerance).contains(&by));
        let Some(from) = moves.iter().max_by_key(|&from| within(from).count()) else { continue };
        let mut most: Vec<_> = within(from).map(|&by| by as f64).collect();
        if most.len() >= AGREE {
            observed.push((sensor, phase, median(&mut most).round() as i64));
        }
    }
    observed
}

/// Returns true if many series of readings jump at once.
fn jumps(series: &BTreeMap<(u8, u8), Vec<(u32, i64)>>, tolerance: i64) -> Result<(), AlignError> {
    let mut at = BTreeMap::<u32, u32>::new();
    let mut steady = 0;
    for readings in series.values() {
        let stays = |part: &[(u32, i64)]| part.iter().all(|reading| (reading.1 - part[0].1).abs() <= tolerance);
        steady += u32::from(readings.windows(2 * STAYS).any(|part| stays(&part[..STAYS]) && stays(&part[STAYS..])));
        for part in readings.windows(2 * STAYS) {
            let (before, after) = part.split_at(STAYS);
            if stays(before) && stays(after) && (before[0].1 - after[0].1).abs() > 2 * tolerance {
                *at.entry(after[0].0).or_default() += 1;
            }
        }
    }
    // The phases of a cycle jump one after the other.
    let cycle = series.keys().map(|key| u32::from(key.1) + 1).max().unwrap_or(1);
    for &period in at.keys() {
        let jumps = at.range(period..period.saturating_add(cycle)).map(|(_, jumps)| jumps).sum::<u32>();
        if jumps >= 3 && f64::from(jumps) > JUMPS * f64::from(steady) {
            return Err(AlignError::Moved { period, jumps: (jumps, steady) });
        }
    }
    Ok(())
}
