//! Broken parts: sensors that hear nothing, that chatter, or whose lines are swapped.

use super::sensors::{Hearing, Share};
use super::statistics::{ln_at_least, median};
use super::{FoundPath, Settings};

/// Something that is broken, with what speaks for it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A sensor hears nothing, while most others do: it is deaf, or its echo line is open, or nothing is in its range.
    Deaf {
        /// The sensor, from 0.
        sensor: u8,
        /// Firings with an echo.
        echoes: Share,
        /// True if others hear its sound, so that it is not its trigger.
        is_heard: bool,
    },
    /// A sensor's echoes come from nowhere and at any time.
    Chattering {
        /// The sensor, from 0.
        sensor: u8,
        /// Echoes that fit no path and do not come back when the ring fires alike.
        wandering: Share,
    },
    /// The echo lines of two sensors are swapped, or their triggers. Sound takes the same time from x to y as from y to
    /// x; with these two lines exchanged so do the paths of the log, and as it stands they do not.
    Swapped {
        /// The two sensors, from 0.
        sensors: (u8, u8),
        /// Number of paths of these two that have their like in the other direction if the lines are exchanged, of how
        /// many.
        exchanged: Share,
        /// The same as the log stands.
        as_it_is: Share,
        /// Number of such pairs that are expected in a whole ring by accident.
        accidents: f64,
    },
}

/// A sensor with fewer firings is not judged.
const FEW: u32 = 50;
/// A deaf sensor has an echo in fewer of its firings, and the others in more.
const DEAF: f64 = 0.02;
const OTHERS_HEAR: f64 = 0.2;
/// Echoes of a chattering sensor that wander: of all of them, and as a multiple of the others' median share, at least.
const CHATTERS: f64 = 0.1;
const AS_OTHERS: f64 = 4.0;

/// Rooms are regular: this share of paths must have their like only if lines are exchanged, and this share be without
/// it else.
const MATCHES: u32 = 3;

pub(super) fn faults(paths: &[FoundPath], hearing: &[Hearing], settings: &Settings) -> Vec<Fault> {
    let mut faults = Vec::new();
    for of in hearing.iter().filter(|of| of.echoes.of >= FEW) {
        let others = || hearing.iter().filter(|other| other.sensor != of.sensor);
        let hear = others().filter(|other| other.echoes.value() > OTHERS_HEAR).count();
        let sensor = of.sensor;
        if of.echoes.interval_95().1 < DEAF && 2 * hear > others().count() {
            let is_heard = paths.iter().any(|path| path.sender == sensor && path.receiver != sensor);
            faults.push(Fault::Deaf { sensor, echoes: of.echoes, is_heard });
        }
        // Where nothing is named in the whole ring, nothing can be said of one sensor.
        let usual = median(&mut others().map(|other| other.wandering.value()).collect::<Vec<_>>());
        let least = of.wandering.interval_95().0;
        if of.wandering.of >= FEW && least > CHATTERS && least > AS_OTHERS * usual {
            faults.push(Fault::Chattering { sensor, wandering: of.wandering });
        }
    }
    let sensors = hearing.len() as u8;
    let pairs = f64::from(sensors) * f64::from(sensors.saturating_sub(1)) / 2.0;
    for a in 0..sensors {
        for b in a + 1..sensors {
            let (as_it_is, by_accident) = reciprocal(paths, None, (a, b), settings);
            let (exchanged, _) = reciprocal(paths, Some((a, b)), (a, b), settings);
            let accidents = pairs * ln_at_least(exchanged.count, exchanged.of, by_accident).exp();
            let speaks = exchanged.count >= MATCHES && as_it_is.of >= MATCHES && exchanged.count > 3 * as_it_is.count;
            if accidents < settings.accidents && speaks {
                faults.push(Fault::Swapped { sensors: (a, b), exchanged, as_it_is, accidents });
            }
        }
    }
    faults
}

/// Of the paths between one of two sensors and another, how many have their like in the other direction, if the echo
/// lines of two sensors are exchanged; and the mean chance of that by accident.
fn reciprocal(paths: &[FoundPath], exchanged: Option<(u8, u8)>, of: (u8, u8), settings: &Settings) -> (Share, f64) {
    let listens = |path: &FoundPath| match exchanged {
        Some((a, b)) if path.receiver == a => b,
        Some((a, b)) if path.receiver == b => a,
        _ => path.receiver,
    };
    let concerns = |sensor: u8| sensor == of.0 || sensor == of.1;
    let (mut count, mut all, mut accident) = (0, 0, 0.0);
    for path in paths {
        let (sender, receiver) = (path.sender, listens(path));
        // Each path and its like count once.
        if sender >= receiver || !(concerns(sender) || concerns(receiver)) {
            continue;
        }
        let back = paths.iter().filter(|back| (back.sender, listens(back)) == (receiver, sender));
        let (mut ways, mut is_matched) = (0, false);
        for back in back {
            ways += 1;
            let error = 4.0 * path.travel_error_us.hypot(back.travel_error_us) + 5.0;
            is_matched |= (back.travel_us - path.travel_us).abs() <= error.min(f64::from(settings.tolerance_us));
        }
        if ways > 0 {
            all += 1;
            count += u32::from(is_matched);
            // Paths of one pair are spread over some 20 ms.
            accident += (f64::from(ways) * f64::from(2 * settings.tolerance_us) / 20_000.0).min(1.0);
        }
    }
    (Share { count, of: all }, accident / f64::from(all.max(1)))
}
