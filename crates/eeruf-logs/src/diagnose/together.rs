//! Echo lines that are exchanged between modules that listen only after their own trigger: one line is silent, and the
//! other has echoes only while the silent sensor listens.
//!
//! The module at the other's line times its own echo. If sensor a fires before b, line a shows b's echoes, later by the
//! time between the two firings, and b's line shows nothing, as a's echo has come by then.

use super::Settings;
use super::reciprocity::Contradicted;
use super::share::Share;
use super::statistics::ln_at_least;
use super::timeline::Timeline;

/// A sensor that hears only in company of a silent one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Together {
    pub(super) sensor: u8,
    /// Its firings with an echo, of those with a firing of the silent sensor at which both listen.
    pub(super) with: Share,
    /// The same of its other firings.
    pub(super) without: Share,
    /// Number of such pairs expected in a whole ring by accident, if echoes do not depend on the silent sensor.
    pub(super) accidents: f64,
}

/// Fewer firings of a kind say nothing.
const FEW: u32 = 20;
/// The share of echoes that may come otherwise, as noise does.
const OTHERWISE: f64 = 0.02;
/// No sensor hears sooner after it fired, in microseconds.
const DEAF_US: i64 = 500;

/// The only sensor whose echoes all come while a silent one listens, and that hears nothing when that one does not
/// fire.
pub(super) fn together(silent: u8, timeline: &Timeline, settings: &Settings) -> Option<Together> {
    let others = (0..timeline.sensors() as u8).filter(|&sensor| sensor != silent);
    let mut found = others.filter_map(|sensor| with(sensor, silent, timeline));
    let one = found.next().filter(|_| found.next().is_none())?;
    (one.accidents < settings.accidents).then_some(one)
}

/// The only pair of lines that explains what contradicts the way back: its sensors have a part in all of that, and one
/// has a part in some that the other, a silent one, does not explain; and it hears while that one listens, and only
/// then.
pub(super) fn exchanged(
    silent: &[u8],
    contradicted: &[Contradicted],
    timeline: &Timeline,
    settings: &Settings,
) -> Option<(u8, Together)> {
    let sensors = timeline.sensors() as u8;
    let pairs = silent.iter().flat_map(|&silent| (0..sensors).map(move |sensor| (silent, sensor)));
    let explains = |&(silent, sensor): &(u8, u8)| {
        !contradicted.iter().all(|of| of.is_of(silent))
            && contradicted.iter().all(|of| of.is_of(silent) || of.is_of(sensor))
    };
    let mut found = pairs.filter(explains).filter_map(|(silent, sensor)| {
        let Company { with, without, otherwise } = company(sensor, silent, timeline);
        let ln_accident: f64 = contradicted.iter().map(|of| of.ln_accident).sum();
        let accidents = f64::from(sensors).powi(2) * ln_accident.exp();
        let is_alone = without.of >= FEW && without.value() > OTHERWISE;
        // A silent sensor may be whole, but not if it is contradicted, too.
        let is_known = without.of >= FEW || contradicted.iter().any(|of| of.is_of(silent));
        let is_so = with.count >= FEW && otherwise.value() <= OTHERWISE && !is_alone && is_known;
        is_so.then_some((silent, Together { sensor, with, without, accidents }))
    });
    let one = found.next().filter(|_| found.next().is_none())?;
    (one.1.accidents < settings.accidents).then_some(one)
}

/// Firings of a sensor with an echo, by those of another.
struct Company {
    with: Share,
    without: Share,
    /// Echoes while the other does not listen.
    otherwise: Share,
}

fn with(sensor: u8, silent: u8, timeline: &Timeline) -> Option<Together> {
    let Company { with, without, otherwise } = company(sensor, silent, timeline);
    let enough = with.count >= FEW && without.of >= FEW;
    if !enough || without.value() > OTHERWISE || otherwise.value() > OTHERWISE {
        return None;
    }
    let (all, share) = (with.count + without.count, f64::from(with.of) / f64::from(with.of + without.of));
    let pairs = (timeline.sensors() * timeline.sensors()) as f64;
    let accidents = pairs * ln_at_least(with.count, all, share).exp();
    Some(Together { sensor, with, without, accidents })
}

fn company(sensor: u8, silent: u8, timeline: &Timeline) -> Company {
    let fired: Vec<i64> = timeline.heard_by(silent).iter().map(|heard| heard.fired_us).collect();
    let window_us = timeline.window_us;
    let last = |until_us: i64| fired[..fired.partition_point(|&at| at <= until_us)].last().copied();
    let mut company = Company { with: Share::NONE, without: Share::NONE, otherwise: Share::NONE };
    for firing in timeline.heard_by(sensor) {
        let end = firing.fired_us + window_us - DEAF_US;
        let both_listen = last(end).is_some_and(|at| at + window_us > firing.fired_us + DEAF_US);
        let share = if both_listen { &mut company.with } else { &mut company.without };
        share.add(firing.echo_us.is_some());
        if let Some(echo_us) = firing.echo_us {
            let at = firing.fired_us + echo_us;
            company.otherwise.add(last(at - DEAF_US).is_none_or(|fired_us| at - fired_us > window_us));
        }
    }
    company
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firings::{Firing, FiringLog};

    /// Sensor 0 is silent, 1 hears 5 ms after 0 fired, and 2 hears its own echo. 0 and 2 move against 1.
    fn timeline() -> Timeline {
        let mut firings = vec![];
        for period in 0..200_u32 {
            let start = i64::from(period) * 60_000;
            let by = i64::from(period % 10);
            // Echo lines give what comes after the sensor fired.
            let of_one = u32::try_from(4_000 * by - 5_000).ok();
            for (sensor, at, t_echo_us) in [(0, 4_000 * by, None), (1, 10_000, of_one), (2, 6_000 * by, Some(30_000))] {
                firings.push(Firing {
                    sensor,
                    fired_us: start + at,
                    period,
                    phase: 0,
                    t_echo_us,
                    reading: None,
                    g_us_ms: None,
                });
            }
        }
        firings.sort_by_key(|firing| firing.fired_us);
        Timeline::of(&FiringLog::new("test", firings), &Settings::default())
    }

    // A silent sensor that alone contradicts the way back is deaf; where another one does, its line tells the pair.
    #[test]
    fn contradictions_of_another_tell_exchanged_lines() {
        let of = |sender, receiver| Contradicted { sender, receiver, ln_accident: -20.0 };
        let pair = |contradicted: &[Contradicted]| {
            exchanged(&[0], contradicted, &timeline(), &Settings::default()).map(|(silent, with)| (silent, with.sensor))
        };
        assert_eq!(pair(&[of(0, 1), of(1, 2)]), Some((0, 1)));
        assert_eq!(pair(&[of(0, 1)]), None);
        // 2 hears while 0 does not listen.
        assert_eq!(pair(&[of(0, 1), of(2, 3)]), None);
    }
}
