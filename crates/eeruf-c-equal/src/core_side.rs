//! Events and errors of `eeruf-core`, converted to the numbers that C returns.

use eeruf_core::{
    Micros, PeriodStats, Phase, Reading, ReadingKind, RingError, RingEvent, Tally,
    conditions::ViolationKind,
    judge::Explanation,
    plan::Upcoming,
    watch::{Doubt, SensorState},
};

use crate::{Flat, NO_ECHO};

/// Returns an event as numbers.
pub fn flat(event: &RingEvent) -> Flat {
    let mut flat = [0; 18];
    match *event {
        RingEvent::Fire { sensor, phase: Phase(phase), due } => {
            flat[1..4].copy_from_slice(&[sensor.into(), phase.into(), due.as_micros()]);
        }
        RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by }) => {
            let numbers = [echo(t_echo), echo(previous), age.unwrap_or(u16::MAX).into(), explanation(explained_by)];
            flat[..5].copy_from_slice(&[1, sensor.into(), phase.0.into(), period, kind as u32]);
            flat[5..9].copy_from_slice(&numbers);
        }
        RingEvent::PeriodEnded(PeriodStats { period, phase, tally, max_late, sum_late }) => {
            flat[..4].copy_from_slice(&[2, 0, phase.0.into(), period]);
            flat[4..6].copy_from_slice(&[max_late, sum_late].map(Micros::as_micros));
            flat[6..].copy_from_slice(&counts(&tally));
        }
    }
    flat
}

/// Returns the number of readings of each kind.
fn counts(tally: &Tally<u8>) -> [u32; 12] {
    ReadingKind::ALL.map(|kind| tally.of(kind))
}

/// Returns an explanation as a number.
pub fn explanation(explained_by: Option<Explanation>) -> u32 {
    match explained_by {
        None => 0xFF,
        Some(Explanation::Sensor(sensor)) => sensor.into(),
        Some(Explanation::History) => 0xFE,
    }
}

/// Returns an echo time as a number.
pub fn echo(t_echo: Option<Micros>) -> u32 {
    t_echo.map_or(NO_ECHO, Micros::as_micros)
}

/// Returns upcoming firings as numbers: sensor and instant.
pub fn upcoming(upcoming: impl Iterator<Item = Upcoming>) -> Vec<[u32; 2]> {
    upcoming.map(|Upcoming { sensor, due, .. }| [sensor.into(), due.as_micros()]).collect()
}

/// Returns a state as numbers: kind, echo, age, why, explanation.
pub fn state(state: SensorState) -> [u32; 5] {
    let known = |kind, t_echo: Option<Micros>, age: Micros| [kind, echo(t_echo), age.as_micros(), 0, 0xFF];
    match state {
        SensorState::Obstacle { t_echo, age } => known(1, Some(t_echo), age),
        SensorState::Clear { age } => known(2, None, age),
        SensorState::TooClose { age } => known(3, None, age),
        SensorState::Unanswered { since } => known(4, None, since),
        SensorState::Unknown { since, why } => {
            let (why, by) = match why {
                Doubt::NoFiring => (0, 0xFF),
                Doubt::Unsure => (1, 0xFF),
                Doubt::Rejected => (2, 0xFF),
                Doubt::Ambiguous(by) => (3, explanation(Some(by))),
                Doubt::NoWitness => (4, 0xFF),
                _ => unreachable!("{why:?}"),
            };
            [0, NO_ECHO, since.as_micros(), why, by]
        }
        _ => unreachable!("{state:?}"),
    }
}

/// The settings of a flow ring, in the order of their statuses.
const SETTINGS: [&str; 11] =
    ["t_delta", "near", "path_change", "top_speed_mm_s", "hold", "most", "least", "rest", "dice", "seed", "window"];

/// Returns C's status for an error.
pub fn status_of(error: &RingError) -> i32 {
    match error {
        RingError::Unverified => -14,
        RingError::TDelta { .. } => -15,
        RingError::VerifiedWindow { .. } => -16,
        RingError::Window { .. } => -17,
        RingError::Blanking { .. } => -18,
        RingError::CoarseTDelta { .. } => -19,
        RingError::Consecutive { .. } => -20,
        RingError::Audible { .. } => -29,
        RingError::PathChange { .. } => -30,
        RingError::Setting { name: "audible", .. } => -29,
        RingError::Setting { name, .. } => SETTINGS.iter().position(|of| of == name).map_or(-26, |at| -40 - at as i32),
        RingError::Sensor(_) => -5,
        RingError::Interval { .. } => -32,
        _ => unreachable!("{error}"),
    }
}

/// Returns C's status for the first violation.
pub const fn status_of_violation(kind: ViolationKind) -> i32 {
    match kind {
        ViolationKind::CrosstalkA | ViolationKind::CrosstalkB => -11,
        ViolationKind::StaleEcho => -12,
        ViolationKind::Interval => -13,
        ViolationKind::Window => -17,
        ViolationKind::Together => -31,
        _ => 0,
    }
}
