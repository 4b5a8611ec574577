//! The result of one geometry of Set I under one method, and a method's figures over all geometries.

use serde::{Deserialize, Serialize};

use super::step::{Latency, NewStep, Steps};
use crate::{
    experiments::spread::{Spread, interval_95, mean},
    results::Summary,
};

/// The result of one geometry under one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The geometry's number, which seeds all random values.
    pub seed: u64,
    /// The figures of the unchanged alcove.
    pub summary: Summary,
    /// Steps of the back wall, which moves back and forth.
    #[serde(flatten)]
    pub steps: Steps,
}

/// A method's figures over all geometries; shares are fractions of 1, as in [`Summary`]. `None` if no geometry has a
/// value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Share of all readings that were accepted and wrong.
    pub wrong_of_all: Option<Spread>,
    /// The part of `wrong_of_all` that foreign or stale sound caused.
    pub crosstalk_of_all: Option<Spread>,
    /// The part of `wrong_of_all` that was confirmed, not only tentative.
    pub confirmed_wrong_of_all: Option<Spread>,
    /// Share of the accepted readings that were wrong.
    pub wrong_of_accepted: Option<Spread>,
    /// Share of all readings that would have been wrong without a filter.
    pub wrong_before_filter: Option<Spread>,
    /// Share of all readings that were not accepted.
    pub rejected: Option<Spread>,
    /// Share of the good readings that were not accepted.
    pub good_lost: Option<Spread>,
    /// Median age of the last accepted reading, in milliseconds.
    pub age_ms: Option<Spread>,
    /// The age that 99 % of the last accepted readings do not exceed, in milliseconds.
    pub age_p99_ms: Option<Spread>,
    /// Accepted readings per second, all sensors together.
    pub readings_per_s: Option<Spread>,
    /// Share of the time in which the last belief is right, as in [`BeliefShares`](crate::BeliefShares).
    pub belief_right: Option<Spread>,
    /// Share of the time in which nothing is believed.
    pub unknown: Option<Spread>,
    /// Share of the time in which foreign sound is believed.
    pub phantom: Option<Spread>,
    /// Share of the time in which one of the sensor's own later echoes, or free space, is believed although something
    /// is nearer.
    pub too_far: Option<Spread>,
    /// Share of the time in which one of the sensor's own nearer echoes is believed.
    pub faint: Option<Spread>,
    /// Right echoes accepted per second, all sensors together.
    pub right_echoes_per_s: Option<Spread>,
    /// Mean number of sensors that had fewer than 5 % of their readings accepted.
    pub starved: f64,
    /// 95 % confidence interval of `starved`, by bootstrap.
    pub starved_95: [f64; 2],
    /// Mean number of sensors that were right under 5 % of the times they fired.
    pub blind: f64,
    /// Mean number of starved sensors that read right in one phase and not in another.
    pub starved_in_part: f64,
    /// Time until the back wall is read right after it has come nearer by [`STEP_M`](super::STEP_M).
    pub nearer: Option<Latency>,
    /// Time until the wall is read right after it has moved away by the same step.
    pub farther: Option<Latency>,
    /// Latency when the wall comes nearer for the first time, in milliseconds.
    pub new_step: Option<NewStep>,
}

impl Figures {
    /// Returns the figures of one method's runs.
    pub fn of(runs: &[Run]) -> Self {
        let summaries = || runs.iter().map(|run| &run.summary);
        let spread = |value: fn(&Summary) -> Option<f64>| Spread::of(summaries().filter_map(value));
        let starved: Vec<_> = summaries().map(|summary| summary.starved as f64).collect();
        let mean_of =
            |value: fn(&Summary) -> usize| mean(&summaries().map(|summary| value(summary) as f64).collect::<Vec<_>>());
        let steps = || runs.iter().map(|run| &run.steps);
        Self {
            wrong_of_all: spread(|s| Some(s.wrong_of_all)),
            crosstalk_of_all: spread(|s| Some(s.crosstalk_of_all)),
            confirmed_wrong_of_all: spread(|s| Some(s.confirmed_wrong_of_all)),
            wrong_of_accepted: spread(|s| s.wrong_of_accepted),
            wrong_before_filter: spread(|s| Some(s.wrong_before_filter)),
            rejected: spread(|s| Some(s.rejected)),
            good_lost: spread(|s| s.good_lost),
            age_ms: spread(|s| Some(s.age_ms.median)),
            age_p99_ms: spread(|s| Some(s.age_ms.p99)),
            readings_per_s: spread(|s| Some(s.readings_per_s)),
            belief_right: spread(|s| Some(s.belief.right)),
            unknown: spread(|s| Some(s.belief.unknown)),
            phantom: spread(|s| Some(s.belief.phantom)),
            too_far: spread(|s| Some(s.belief.too_far)),
            faint: spread(|s| Some(s.belief.faint)),
            right_echoes_per_s: spread(|s| Some(s.right_echoes_per_s)),
            starved: mean(&starved),
            starved_95: interval_95(&starved, |sample| mean(sample)),
            blind: mean_of(|summary| summary.blind),
            starved_in_part: mean_of(|summary| summary.starved_in_part),
            nearer: Latency::of(steps().flat_map(|steps| &steps.nearer)),
            farther: Latency::of(steps().flat_map(|steps| &steps.farther)),
            new_step: NewStep::of(steps().flat_map(|steps| &steps.new_ms)),
        }
    }
}
