//! Deaf sensors.
//!
//! A sensor with nothing in range is not deaf. A sensor is called deaf if the log rules that out: others hear its
//! sound, and sound takes equally long both ways, so it should hear theirs along the same paths.

use super::sensors::Hearing;
use super::timeline::Timeline;
use super::{FoundPath, Settings};
use crate::statistics::ln_at_least;
use crate::symptom::{Finding, Symptom};

/// Least ratio of the share of arrivals heard on the way back to that on the way there.
const BACK: f64 = 0.5;
/// Greatest probability that the silence is an accident.
const ACCIDENT: f64 = 0.001;
/// Time in microseconds after a sensor's firing before which it hears no other sensor.
const DEAF_US: i64 = 3000;

/// The deaf sensors of a ring.
pub(super) fn faults(
    paths: &[FoundPath],
    hearing: &[Hearing],
    timeline: &Timeline,
    settings: &Settings,
) -> Vec<Finding> {
    let silent = hearing.iter().filter(|of| of.is_silent && is_unheard(of.sensor, paths, timeline, settings));
    let deaf = silent.map(|of| Finding {
        sensor: of.sensor.into(),
        symptom: Symptom::Deaf,
        said: format!(
            "an echo in {} of {} firings (95 %: under {:.1} %), while others hear its sound",
            of.echoes.count,
            of.echoes.of,
            100.0 * of.echoes.interval_95().1
        ),
    });
    deaf.collect()
}

/// Returns true if others hear a silent sensor along paths on which it should hear them, except by an accident.
fn is_unheard(silent: u8, paths: &[FoundPath], timeline: &Timeline, settings: &Settings) -> bool {
    let out = paths.iter().filter(|path| path.sender == silent && path.receiver != silent);
    let ln_accident = |path: &FoundPath| {
        let (heard, of) = heard_back(path, timeline, settings.tolerance_us.into());
        ln_at_least(of - heard, of, 1.0 - BACK * path.heard)
    };
    out.map(ln_accident).sum::<f64>() < ACCIDENT.ln()
}

/// Number of arrivals heard at a path's sender on the way back, and of all arrivals that nothing earlier hid.
fn heard_back(path: &FoundPath, timeline: &Timeline, tolerance: i64) -> (u32, u32) {
    let (mut heard, mut of) = (0, 0);
    let travel_us = path.travel_us.round() as i64;
    for firing in timeline.heard_by(path.sender) {
        let sent = timeline.before(firing.fired_us + timeline.window_us).filter(|of| of.1 == path.receiver);
        for at in sent.map(|(fired_us, _)| fired_us + travel_us - firing.fired_us) {
            let is_hidden = firing.echo_us.is_some_and(|echo| echo < at - 2 * tolerance);
            if at >= DEAF_US && at + 2 * tolerance <= timeline.window_us && !is_hidden {
                heard += u32::from(firing.echo_us.is_some_and(|echo| echo <= at + 2 * tolerance));
                of += 1;
            }
        }
    }
    (heard, of)
}
