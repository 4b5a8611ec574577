//! Sounds of each sensor: its own echo, others' sound, or what no path explains; and the phases in which it is blind.

use std::collections::{BTreeMap, HashMap};

use super::{FoundPath, Named};
use crate::firings::{Firing, FiringLog};

/// A share of a number of trials, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of sensors.
    pub count: u32,
    /// Of how many.
    pub of: u32,
}

impl Share {
    /// The share itself; 0 of nothing.
    pub fn value(&self) -> f64 {
        f64::from(self.count) / f64::from(self.of.max(1))
    }

    /// The 95 % interval by Wilson's score, which holds for small counts too.
    pub fn interval_95(&self) -> (f64, f64) {
        const Z: f64 = 1.959_964;
        let n = f64::from(self.of);
        if self.of == 0 {
            return (0.0, 1.0);
        }
        let share = self.value();
        let middle = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        ((middle - half).max(0.0), (middle + half).min(1.0))
    }
}

/// Sounds of one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Hearing {
    /// The sensor, from 0.
    pub sensor: u8,
    /// Firings with any echo.
    pub echoes: Share,
    /// Firings whose reading is surely its own echo.
    pub own: Share,
    /// Firings whose reading is surely another sensor's sound.
    pub foreign: Share,
    /// Firings with an echo that cannot surely be named, of those with an echo: several paths fit, or none.
    pub unnamed: Share,
    /// Firings with an echo that fits no path, of those with an echo.
    pub unexplained: Share,
    /// Firings whose echo fits no path and does not even come back at the same time when the ring fires alike: of those
    /// with an echo in a phase and beside firings that there were four times at least.
    pub wandering: Share,
    /// True if its own echo was found as a path.
    pub has_own_path: bool,
    /// The phases in which it fired at least five times and its own echo was never first, with the number of firings.
    pub blind_phases: Vec<(u8, u32)>,
}

/// Fewer firings in a phase say nothing about it.
const FEW: u32 = 5;

pub(super) fn hearing(
    log: &FiringLog,
    paths: &[FoundPath],
    named: &[Option<Named>],
    fits_none: &[bool],
    tolerance_us: u32,
) -> Vec<Hearing> {
    (0..log.sensors() as u8).map(|sensor| of_sensor(sensor, log, paths, named, fits_none, tolerance_us)).collect()
}

fn of_sensor(
    sensor: u8,
    log: &FiringLog,
    paths: &[FoundPath],
    named: &[Option<Named>],
    fits_none: &[bool],
    tolerance_us: u32,
) -> Hearing {
    let (mut firings, mut echoes, mut own, mut foreign, mut unexplained) = (0, 0, 0, 0, 0);
    // By phase: firings, and own echoes among them.
    let mut phases = BTreeMap::<u8, (u32, u32)>::new();
    let firings_of = log.firings.iter().zip(named).zip(fits_none).filter(|((firing, _), _)| firing.sensor == sensor);
    for ((firing, named), fits_none) in firings_of {
        firings += 1;
        echoes += u32::from(firing.t_echo_us.is_some());
        let is_own = named.is_some_and(|named| named.sender == sensor);
        own += u32::from(is_own);
        foreign += u32::from(named.is_some() && !is_own);
        unexplained += u32::from(*fits_none);
        let phase = phases.entry(firing.phase).or_default();
        phase.0 += 1;
        phase.1 += u32::from(is_own);
    }
    let has_own_path = paths.iter().any(|path| (path.sender, path.receiver) == (sensor, sensor));
    let blind = |(&phase, &(fired, own)): (&u8, &(u32, u32))| (own == 0 && fired >= FEW).then_some((phase, fired));
    Hearing {
        sensor,
        echoes: Share { count: echoes, of: firings },
        own: Share { count: own, of: firings },
        foreign: Share { count: foreign, of: firings },
        unnamed: Share { count: echoes.saturating_sub(own + foreign), of: echoes },
        unexplained: Share { count: unexplained, of: echoes },
        wandering: wandering(sensor, log, fits_none, tolerance_us),
        has_own_path,
        // Where nothing is known of its own echo, nothing is known of its phases.
        blind_phases: if has_own_path { phases.iter().filter_map(blind).collect() } else { Vec::new() },
    }
}

/// Firings whose echo fits no path and does not repeat. Sound along a path that was not found comes back at the same
/// time whenever the ring fires alike; noise does not.
fn wandering(sensor: u8, log: &FiringLog, fits_none: &[bool], tolerance_us: u32) -> Share {
    // Without any tolerance firings stand alike to the microsecond.
    let tolerance = i64::from(tolerance_us.max(1));
    // Alike: the same phase, and the last two others that fired before the edge stand alike.
    let mut alike = HashMap::<_, Vec<(i64, bool)>>::new();
    for (place, firing) in log.firings.iter().enumerate().filter(|(_, firing)| firing.sensor == sensor) {
        let Some(echo_us) = firing.t_echo_us.map(i64::from) else { continue };
        let until = log.firings.partition_point(|other| other.fired_us <= firing.fired_us + echo_us);
        let before = log.firings[..until].iter().rev().filter(|other| other.sensor != sensor).take(2);
        let stand = |other: &Firing| (other.sensor, (other.fired_us - firing.fired_us).div_euclid(2 * tolerance));
        let key = (firing.phase, before.map(stand).collect::<Vec<_>>());
        alike.entry(key).or_default().push((echo_us, fits_none[place]));
    }
    let mut share = Share { count: 0, of: 0 };
    for mut group in alike.into_values().filter(|group| group.len() >= 4) {
        group.sort_unstable();
        share.of += group.len() as u32;
        for (place, &(echo_us, fits_none)) in group.iter().enumerate() {
            let near = |other: Option<&(i64, bool)>| other.is_some_and(|other| (other.0 - echo_us).abs() <= tolerance);
            let repeats = near(group.get(place + 1)) || place > 0 && near(group.get(place - 1));
            share.count += u32::from(fits_none && !repeats);
        }
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_wilsons() {
        let near = |share: Share, expected: (f64, f64)| {
            let (low, high) = share.interval_95();
            assert!((low - expected.0).abs() < 5e-5 && (high - expected.1).abs() < 5e-5, "{low} {high}");
        };
        // Newcombe (1998), Table I: 81 of 263, 15 of 148, 0 of 20.
        near(Share { count: 81, of: 263 }, (0.2553, 0.3662));
        near(Share { count: 15, of: 148 }, (0.0624, 0.1605));
        near(Share { count: 0, of: 20 }, (0.0, 0.1611));
    }

    #[test]
    fn without_any_tolerance_edges_repeat_to_the_microsecond() {
        let firing = |period: u32| Firing {
            sensor: 0,
            fired_us: 100_000 * i64::from(period),
            period,
            phase: 0,
            t_echo_us: Some(if period == 3 { 7_001 } else { 7_000 }),
            rejected: None,
            weighed: None,
        };
        let log = FiringLog::new("board", (0..6).map(firing).collect());
        assert_eq!(wandering(0, &log, &[true; 6], 0), Share { count: 0, of: 6 });
        let far = Firing { t_echo_us: Some(9_000), ..firing(6) };
        let log = FiringLog::new("board", (0..6).map(firing).chain([far]).collect());
        assert_eq!(wandering(0, &log, &[true; 7], 0), Share { count: 1, of: 7 });
    }
}
