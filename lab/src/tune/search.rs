//! A search by successive halving: many pilots drive a few courses, the best of them more, and the best of those the
//! most (K. Jamieson and A. Talwalkar, "Non-stochastic best arm identification and hyperparameter optimization",
//! AISTATS 2016).

use std::io;

use eeruf_sim::Method;
use eeruf_sim::experiments::ExperimentError;
use eeruf_sim::experiments::set_two::{Ending, Pilots, SECOND_AHEAD, SECOND_BEHIND, SetTwoOptions, set_two};

use super::draw::{Candidate, candidate};
use super::log::Log;
use super::score::{Round, Score};

/// Result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tuned {
    pub(crate) number: usize,
    pub(crate) pilot: Candidate,
    /// Score in the last round.
    pub(crate) score: Score,
}

/// The search for one method.
pub(crate) struct Search<'a> {
    pub(crate) rounds: &'a [Round],
    pub(crate) options: &'a SetTwoOptions,
    pub(crate) method: Method,
}

impl Search<'_> {
    /// Returns the best pilot of the last round; the first of equals.
    pub(crate) fn run(&self, log: &mut Log) -> Result<Tuned, Trouble> {
        let mut left: Vec<usize> = (0..self.rounds.first().map_or(0, |round| round.pilots)).collect();
        let mut best = None;
        let mut first = 0;
        for (number, round) in self.rounds.iter().enumerate() {
            left.truncate(round.pilots);
            let mut scored = Vec::new();
            for &pilot in &left {
                let score = log.score((self.method, number, pilot), || self.drive(pilot, first, round.courses))?;
                scored.push((pilot, score));
            }
            // Stable, so that the first of equals stays before the others.
            scored.sort_by(|(_, a), (_, b)| b.value().total_cmp(&a.value()));
            best = scored.first().copied();
            left = scored.into_iter().map(|(pilot, _)| pilot).collect();
            first += round.courses;
        }
        let (number, score) = best.ok_or(Trouble::NoRounds)?;
        Ok(Tuned { number, pilot: candidate(number), score })
    }

    /// Returns a pilot's score on some courses.
    fn drive(&self, pilot: usize, first: u64, courses: u64) -> Result<Score, Trouble> {
        let mut score = Score { finished: [0; 3], time_s: 0.0 };
        let places = [None, Some(SECOND_BEHIND), Some(SECOND_AHEAD)];
        for (finished, second_robot) in score.finished.iter_mut().zip(places) {
            let asked = SetTwoOptions {
                seeds: courses,
                first,
                methods: vec![self.method.into()],
                second_robot,
                pilots: Pilots::Given(candidate(pilot).piloting()),
                ..self.options.clone()
            };
            let found = set_two(&asked, &|_| true).map_err(Trouble::Experiment)?;
            for run in found.runs.iter().flatten().filter(|run| run.ending == Ending::Finished) {
                *finished += 1;
                score.time_s += run.time_s;
            }
        }
        Ok(score)
    }
}

/// Reason why a search ends without a pilot.
#[derive(Debug)]
pub(crate) enum Trouble {
    NoRounds,
    Experiment(ExperimentError),
    Log(io::Error),
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        Self::Log(error)
    }
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoRounds => write!(f, "0 rounds; expected at least one"),
            Self::Experiment(error) => error.fmt(f),
            Self::Log(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Trouble {}
