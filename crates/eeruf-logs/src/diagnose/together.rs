//! Echo lines that are exchanged between modules that listen only after their own trigger: one line is silent, and the
//! other has echoes only while the silent sensor listens.
//!
//! The module at the other's line times its own echo. If sensor a fires before b, line a shows b's echoes, later by the
//! time between the two firings, and b's line shows nothing, as a's echo has come by then.

use super::Settings;
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

fn with(sensor: u8, silent: u8, timeline: &Timeline) -> Option<Together> {
    let fired: Vec<i64> = timeline.heard_by(silent).iter().map(|heard| heard.fired_us).collect();
    let window_us = timeline.window_us;
    let last = |until_us: i64| fired[..fired.partition_point(|&at| at <= until_us)].last().copied();
    let (mut with, mut without, mut otherwise) = (Share::NONE, Share::NONE, Share::NONE);
    for firing in timeline.heard_by(sensor) {
        let end = firing.fired_us + window_us - DEAF_US;
        let both_listen = last(end).is_some_and(|at| at + window_us > firing.fired_us + DEAF_US);
        let share = if both_listen { &mut with } else { &mut without };
        share.add(firing.echo_us.is_some());
        if let Some(echo_us) = firing.echo_us {
            let at = firing.fired_us + echo_us;
            otherwise.add(last(at - DEAF_US).is_none_or(|fired_us| at - fired_us > window_us));
        }
    }
    let enough = with.count >= FEW && without.of >= FEW;
    if !enough || without.value() > OTHERWISE || otherwise.value() > OTHERWISE {
        return None;
    }
    let (all, share) = (with.count + without.count, f64::from(with.of) / f64::from(with.of + without.of));
    let pairs = (timeline.sensors() * timeline.sensors()) as f64;
    let accidents = pairs * ln_at_least(with.count, all, share).exp();
    Some(Together { sensor, with, without, accidents })
}
