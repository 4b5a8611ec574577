//! Sounds of each sensor: its own echo, others' sound, or what no path explains; and the phases in which it is blind.

use std::collections::BTreeMap;

use super::alike::Alike;
use super::faults::{is_silent, misses_at_random};
use super::{FoundPath, Named};
use crate::firings::FiringLog;

/// A share of a number of trials, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of sensors.
    pub count: u32,
    /// Of how many.
    pub of: u32,
}

impl Share {
    pub(super) const NONE: Self = Self { count: 0, of: 0 };

    pub(super) fn add(&mut self, counts: bool) {
        self.count += u32::from(counts);
        self.of += 1;
    }

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
    /// at which it fired alike four times at least.
    pub wandering: Share,
    /// True if it hears nothing: nothing is in its range, or it is deaf.
    pub is_silent: bool,
    /// True if it misses echoes at random: it loses them, or they are at its threshold.
    pub misses_at_random: bool,
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
    alike: &[Alike],
) -> Vec<Hearing> {
    let sensors = (0..log.sensors() as u8).zip(alike);
    sensors.map(|(sensor, alike)| of_sensor(sensor, log, paths, named, fits_none, alike)).collect()
}

fn of_sensor(
    sensor: u8,
    log: &FiringLog,
    paths: &[FoundPath],
    named: &[Option<Named>],
    fits_none: &[bool],
    alike: &Alike,
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
        wandering: alike.wandering,
        has_own_path,
        is_silent: is_silent(Share { count: echoes, of: firings }),
        misses_at_random: misses_at_random(alike),
        // Where nothing is known of its own echo, nothing is known of its phases.
        blind_phases: if has_own_path { phases.iter().filter_map(blind).collect() } else { Vec::new() },
    }
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
}
