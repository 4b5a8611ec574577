//! A simulated survey compared with the true paths.

use serde::Serialize;

use super::SurveyReport;
use crate::files::survey::TruePath;
use crate::report::table::markdown;

/// Tolerance for the length of one path, in microseconds: a faint echo is heard up to a burst late.
const SAME_US: f64 = 400.0;

/// Accuracy of a survey.
#[derive(Clone, Copy, Default, Serialize)]
pub(crate) struct Compared {
    /// Ordered pairs with a path within `until_us`, and the number that the survey found.
    pub(crate) pairs: usize,
    pub(crate) pairs_found: usize,
    /// Number of pairs with a path 6 dB or more above the threshold of hearing.
    pub(crate) loud_pairs: usize,
    pub(crate) loud_pairs_found: usize,
    /// Number of pairs wrongly reported as hearing each other: they do not, even 6 dB louder.
    pub(crate) pairs_wrong: usize,
    /// Number of paths between different sensors that the survey found, and the number of them that no sound takes,
    /// even 6 dB louder.
    pub(crate) paths: usize,
    pub(crate) paths_wrong: usize,
}

pub(super) fn compare(found: &SurveyReport<'_>, truth: &[TruePath]) -> Compared {
    let until_us = f64::from(found.until_us);
    let of = |x, y| truth.iter().filter(move |path| (path.sender, path.receiver) == (x, y));
    let is_true = |x, y, travel_us: f64| of(x, y).any(|path| (path.travel_us - travel_us).abs() <= SAME_US);
    let mut compared = Compared::default();
    for (x, y) in found.pairs() {
        let near = || found.surveyed.between(x, y).filter(|path| path.travel_us <= until_us);
        let is_found = near().next().is_some();
        let levels = of(x, y).filter(|path| path.travel_us <= until_us).map(|path| path.level_db);
        let level_db = levels.fold(f64::NEG_INFINITY, f64::max);
        let (is_pair, is_loud) = (level_db >= 0.0, level_db >= 6.0);
        compared.pairs += usize::from(is_pair);
        compared.pairs_found += usize::from(is_pair && is_found);
        compared.loud_pairs += usize::from(is_loud);
        compared.loud_pairs_found += usize::from(is_loud && is_found);
        compared.pairs_wrong += usize::from(is_found && of(x, y).next().is_none());
        compared.paths += found.surveyed.between(x, y).count();
        let wrong = found.surveyed.between(x, y).filter(|path| !is_true(x, y, path.travel_us));
        compared.paths_wrong += wrong.count();
    }
    compared
}

/// Several simulated surveys, one after the other.
#[derive(Default)]
pub(crate) struct Scenes {
    rows: Vec<(String, Compared)>,
    physics: Vec<String>,
}

impl Scenes {
    pub(crate) fn push(&mut self, found: &SurveyReport<'_>) {
        let Some((truth, physics)) = found.truth else { return };
        self.rows.push((found.file.display().to_string(), compare(found, truth)));
        if self.physics.iter().all(|known| known != physics) {
            self.physics.push(physics.to_owned());
        }
    }

    pub(crate) fn describe(&self) -> String {
        let header = [
            "scene",
            "ordered pairs",
            "found",
            "by 6 dB and more",
            "found",
            "pairs wrong",
            "paths found",
            "no sound takes",
        ];
        let mut total = Compared::default();
        for (_, of) in &self.rows {
            total.pairs += of.pairs;
            total.pairs_found += of.pairs_found;
            total.loud_pairs += of.loud_pairs;
            total.loud_pairs_found += of.loud_pairs_found;
            total.pairs_wrong += of.pairs_wrong;
            total.paths += of.paths;
            total.paths_wrong += of.paths_wrong;
        }
        let row = |(name, of): (&str, &Compared)| {
            let numbers = [of.pairs, of.pairs_found, of.loud_pairs, of.loud_pairs_found, of.pairs_wrong];
            let numbers = numbers.into_iter().chain([of.paths, of.paths_wrong]);
            core::iter::once(name.to_owned()).chain(numbers.map(|number| number.to_string())).collect()
        };
        let rows = self.rows.iter().map(|(name, of)| (name.as_str(), of)).chain([("all", &total)]);
        format!("physics: {}\n{}\n", self.physics.join(", "), markdown(&header, rows.map(row)))
    }
}
