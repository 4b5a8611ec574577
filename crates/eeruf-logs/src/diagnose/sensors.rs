//! Sounds of each sensor (its own echo, others' sound, unexplained echoes), and the phases in which it is blind.

use std::collections::BTreeMap;

use super::share::Share;
use super::{FoundPath, Named};
use crate::firings::FiringLog;

/// Sounds of one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Hearing {
    /// The sensor, from 0.
    pub sensor: u8,
    /// Firings with any echo.
    pub echoes: Share,
    /// Firings whose reading is certainly the sensor's own echo.
    pub own: Share,
    /// Firings whose reading is certainly another sensor's sound.
    pub foreign: Share,
    /// Share of firings with an echo whose sender is uncertain: several paths fit, or none.
    pub unnamed: Share,
    /// Share of firings with an echo that fits no path.
    pub unexplained: Share,
    /// True if the sensor hears nothing: nothing is in range, or it is deaf.
    pub is_silent: bool,
    /// True if the sensor's own echo was found as a path.
    pub has_own_path: bool,
    /// The phases with at least five firings in which its own echo was never first, with the number of firings.
    pub blind_phases: Vec<(u8, u32)>,
}

/// Number of firings below which a sensor is not judged.
const FEW: u32 = 50;
/// Share of firings with an echo below which a sensor is deaf.
const DEAF: f64 = 0.02;
/// Number of firings below which a phase is not judged.
const FEW_IN_PHASE: u32 = 5;

pub(super) fn hearing(
    log: &FiringLog,
    paths: &[FoundPath],
    named: &[Option<Named>],
    fits_none: &[bool],
) -> Vec<Hearing> {
    (0..log.sensors() as u8).map(|sensor| of_sensor(sensor, log, paths, named, fits_none)).collect()
}

fn of_sensor(sensor: u8, log: &FiringLog, paths: &[FoundPath], named: &[Option<Named>], fits_none: &[bool]) -> Hearing {
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
    let blind =
        |(&phase, &(fired, own)): (&u8, &(u32, u32))| (own == 0 && fired >= FEW_IN_PHASE).then_some((phase, fired));
    Hearing {
        sensor,
        echoes: Share { count: echoes, of: firings },
        own: Share { count: own, of: firings },
        foreign: Share { count: foreign, of: firings },
        unnamed: Share { count: echoes.saturating_sub(own + foreign), of: echoes },
        unexplained: Share { count: unexplained, of: echoes },
        has_own_path,
        is_silent: is_silent(Share { count: echoes, of: firings }),
        // Where nothing is known of its own echo, nothing is known of its phases.
        blind_phases: if has_own_path { phases.iter().filter_map(blind).collect() } else { Vec::new() },
    }
}

/// Returns true if a sensor hears nothing: out of range, or deaf.
fn is_silent(echoes: Share) -> bool {
    echoes.of >= FEW && echoes.value() < DEAF
}
