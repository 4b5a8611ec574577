//! A method's figures over placings.

use serde::{Deserialize, Serialize};

use crate::{
    experiments::spread::Spread,
    results::{BeliefShares, Cause, NO_PATH, Readings, Summary},
};

/// A method's figures over placings; shares are fractions of 1, and counts and rates are for one robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Share of the accepted readings that are another robot's sound.
    pub others_of_accepted: Option<Spread>,
    /// Largest share of another robot's sound in one sensor's accepted readings, among the sensors of all robots with
    /// at least five accepted readings.
    pub others_at_worst: Option<Spread>,
    /// Share of the accepted readings that are foreign sound, including sound from the robot's other sensors or from an
    /// earlier firing.
    pub foreign_of_accepted: Option<Spread>,
    /// Share of the good readings that were not accepted.
    pub good_lost: Option<Spread>,
    /// Right echoes accepted per second.
    pub right_echoes_per_s: Option<Spread>,
    /// Share of the time in which the last belief is right, as in [`BeliefShares`].
    pub belief_right: Option<Spread>,
    /// Share of the time in which nothing is believed.
    pub unknown: Option<Spread>,
    /// Share of the time in which foreign sound is believed.
    pub phantom: Option<Spread>,
    /// Share of the time in which one of the sensor's own later echoes is believed.
    pub too_far: Option<Spread>,
    /// Share of the time in which one of the sensor's own nearer echoes is believed.
    pub faint: Option<Spread>,
    /// Number of sensors that were right under 5 % of the times they fired.
    pub blind: Option<Spread>,
}

/// The figures by which groups of placings are compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Brief {
    /// See [`Figures::others_of_accepted`].
    pub others_of_accepted: Option<Spread>,
    /// See [`Figures::belief_right`].
    pub belief_right: Option<Spread>,
}

/// The result of one placing under one method, with the figures whose spread [`Figures`] gives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The placing's number, which seeds all random values.
    pub seed: u64,
    /// See [`Figures::others_of_accepted`].
    pub others_of_accepted: Option<f64>,
    /// See [`Figures::others_at_worst`].
    pub others_at_worst: Option<f64>,
    /// See [`Figures::foreign_of_accepted`].
    pub foreign_of_accepted: Option<f64>,
    /// See [`Figures::good_lost`].
    pub good_lost: Option<f64>,
    /// See [`Figures::right_echoes_per_s`].
    pub right_echoes_per_s: f64,
    /// Shares of the time by the state of the last belief.
    #[serde(flatten)]
    pub belief: BeliefShares,
    /// See [`Figures::blind`].
    pub blind: f64,
}

/// Least number of accepted readings for a sensor to count in [`Figures::others_at_worst`].
const ENOUGH: usize = 5;

impl Run {
    pub(super) fn of(seed: u64, readings: &Readings, robots: usize) -> Self {
        let sensors = readings.sensors.div_ceil(robots.max(1));
        let mut each = vec![(0_usize, 0_usize); readings.sensors];
        let mut foreign = 0;
        for k in (0..readings.len()).filter(|&k| readings.is_accepted(k)) {
            let (robot, cause) = (readings.robot[k], readings.cause[k]);
            let path = Some(readings.path[k]).filter(|&path| path != NO_PATH);
            let heard = path.and_then(|path| readings.paths.get(path as usize));
            foreign += usize::from(matches!(cause, Cause::Crosstalk | Cause::Stale | Cause::External));
            let place = usize::from(robot) * sensors + usize::from(readings.sensor[k]);
            if let Some((accepted, others)) = each.get_mut(place) {
                *accepted += 1;
                *others += usize::from(heard.is_some_and(|heard| heard.emitter.robot != robot));
            }
        }
        let accepted: usize = each.iter().map(|(accepted, _)| accepted).sum();
        let others: usize = each.iter().map(|(_, others)| others).sum();
        let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
        let often = each.iter().filter(|(accepted, _)| *accepted >= ENOUGH);
        let Summary { good_lost, right_echoes_per_s, belief, blind, .. } = readings.summary();
        let of_one = robots.max(1) as f64;
        Self {
            seed,
            others_of_accepted: share(others, accepted),
            others_at_worst: often.filter_map(|&(accepted, others)| share(others, accepted)).reduce(f64::max),
            foreign_of_accepted: share(foreign, accepted),
            good_lost,
            right_echoes_per_s: right_echoes_per_s / of_one,
            belief,
            blind: blind as f64 / of_one,
        }
    }
}

impl Figures {
    /// Returns the figures of one method's runs.
    pub fn of(runs: &[Run]) -> Self {
        let spread = |value: fn(&Run) -> Option<f64>| Spread::of(runs.iter().filter_map(value));
        Self {
            others_of_accepted: spread(|run| run.others_of_accepted),
            others_at_worst: spread(|run| run.others_at_worst),
            foreign_of_accepted: spread(|run| run.foreign_of_accepted),
            good_lost: spread(|run| run.good_lost),
            right_echoes_per_s: spread(|run| Some(run.right_echoes_per_s)),
            belief_right: spread(|run| Some(run.belief.right)),
            unknown: spread(|run| Some(run.belief.unknown)),
            phantom: spread(|run| Some(run.belief.phantom)),
            too_far: spread(|run| Some(run.belief.too_far)),
            faint: spread(|run| Some(run.belief.faint)),
            blind: spread(|run| Some(run.blind)),
        }
    }
}

impl Brief {
    pub(super) fn of<'r>(runs: impl Iterator<Item = &'r Run> + Clone) -> Self {
        Self {
            others_of_accepted: Spread::of(runs.clone().filter_map(|run| run.others_of_accepted)),
            belief_right: Spread::of(runs.map(|run| run.belief.right)),
        }
    }
}
