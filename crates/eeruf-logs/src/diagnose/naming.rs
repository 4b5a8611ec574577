//! Names the sender of each reading.

use super::timeline::Timeline;
use super::{FoundPath, Settings};

/// The sender of a reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Named {
    /// The sensor that sent the sound, from 0: the receiver itself for its own echo.
    pub sender: u8,
    /// Travel time of the sound, in microseconds.
    pub travel_us: f64,
    /// Confidence, 0 to 1.
    pub sure: f64,
}

/// Half width of the interval of echo times for the density of readings that no path explains, in microseconds.
const NEAR_US: f64 = 2000.0;

/// For each reading, weighs the paths that predict it, by how often they are heard and how well they fit, against the
/// density of readings that no path explains, which are marked.
pub(super) fn name_senders(
    receiver: u8,
    found: &[FoundPath],
    timeline: &Timeline,
    settings: &Settings,
    named: &mut [Option<Named>],
    fits_none: &mut [bool],
) {
    let heard = timeline.heard_by(receiver);
    let tolerance = f64::from(settings.tolerance_us);
    let mut fits = Vec::with_capacity(heard.len());
    let mut open = Vec::new();
    for reading in heard {
        let mut weights: Vec<(u8, f64, f64)> = Vec::new();
        if let Some(echo_us) = reading.echo_us {
            for (fired_us, sensor) in timeline.before(reading.fired_us + echo_us) {
                let travel_us = (reading.fired_us + echo_us - fired_us) as f64;
                for path in found.iter().filter(|path| path.sender == sensor) {
                    let off = travel_us - path.travel_us;
                    if off.abs() <= tolerance {
                        let scatter = path.scatter_us.max(10.0);
                        let normal = (-0.5 * (off / scatter).powi(2)).exp() / (scatter * 2.506_628_274_631);
                        weights.push((sensor, path.travel_us, path.heard * normal));
                    }
                }
            }
            if weights.is_empty() {
                open.push(echo_us);
                fits_none[reading.firing] = true;
            }
        }
        fits.push(weights);
    }
    open.sort_unstable();
    for (reading, weights) in heard.iter().zip(fits) {
        let Some(echo_us) = reading.echo_us else { continue };
        let Some(&(sender, travel_us, _)) = weights.iter().max_by(|a, b| a.2.total_cmp(&b.2)) else { continue };
        let below = |limit: f64| open.partition_point(|&open| (open as f64) < limit);
        let near = below(echo_us as f64 + NEAR_US) - below(echo_us as f64 - NEAR_US);
        let unexplained = (near as f64 + 1.0) / heard.len() as f64 / (2.0 * NEAR_US);
        let all: f64 = weights.iter().map(|weight| weight.2).sum::<f64>() + unexplained;
        let own: f64 = weights.iter().filter(|weight| weight.0 == sender).map(|weight| weight.2).sum();
        let sure = own / all;
        if sure >= settings.sure {
            named[reading.firing] = Some(Named { sender, travel_us, sure });
        }
    }
}
