//! Parts of an experiment, run by several processes or machines and joined by `eeruf lab merge`.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use eeruf_sim::Entry;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::console::print_line;
use crate::files::error::InputError;
use crate::report::json::to_json;

/// The I-th of N parts, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Shard {
    pub(crate) part: u64,
    pub(crate) of: u64,
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/').and_then(|(part, of)| Some((part.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((part, of)) if (1..=of).contains(&part) && of <= 100_000 => Ok(Self { part, of }),
            _ => Err("expected I/N, such as 2/8, with I from 1 to N and N up to 100000"),
        }
    }
}

impl Shard {
    /// Returns this part's first seed and number of seeds.
    ///
    /// # Errors
    /// There are more parts than seeds.
    pub(super) fn seeds(self, first: u64, seeds: u64) -> Result<(u64, u64), String> {
        let Self { part, of } = self;
        if of > seeds {
            return Err(format!("--shard: {part}/{of} of {seeds} seeds; expected at most {seeds} parts"));
        }
        let begin = |part: u64| seeds * part / of;
        Ok((first.saturating_add(begin(part - 1)), begin(part) - begin(part - 1)))
    }
}

/// The runs of each method by its name.
pub(crate) type Runs = BTreeMap<String, Vec<Value>>;

/// Output of a part.
#[derive(Serialize, Deserialize)]
pub(crate) struct Part {
    /// The program's version.
    pub(crate) eeruf: String,
    pub(crate) shard: Shard,
    /// The arguments of `eeruf lab experiment` that decide what is run.
    pub(crate) arguments: Vec<String>,
    pub(crate) runs: Runs,
}

impl Part {
    pub(crate) const VERSION: &'static str = env!("EERUF_VERSION");

    /// Prints a part: the runs of each method.
    pub(super) fn print<R: Serialize>(
        shard: Shard,
        arguments: Vec<String>,
        methods: &[Entry],
        runs: &[Vec<R>],
    ) -> Result<(), InputError> {
        // Types of our own always serialise.
        let plain = |runs: &Vec<R>| runs.iter().map(|run| serde_json::to_value(run).unwrap_or_default()).collect();
        let runs = methods.iter().zip(runs).map(|(method, runs)| (method.name().to_owned(), plain(runs))).collect();
        Ok(print_line(to_json(&Self { eeruf: Self::VERSION.to_owned(), shard, arguments, runs }))?)
    }
}

/// The runs of these methods, `seeds` for each, from the parts; errors name `file`.
pub(super) fn runs_of<R: DeserializeOwned>(
    methods: &[Entry],
    seeds: u64,
    file: &Path,
    runs: &Runs,
) -> Result<Vec<Vec<R>>, InputError> {
    let refused = |what: String| InputError::new(file, what);
    let of = |method: &Entry| {
        let of = runs.get(method.name()).map_or(&[][..], Vec::as_slice);
        if of.len() as u64 != seeds {
            let found = of.len();
            return Err(refused(format!("{found} runs of `{method}` in all parts; expected {seeds}")));
        }
        let read = |(place, run): (usize, &Value)| {
            let read = R::deserialize(run);
            read.map_err(|error| refused(format!("run {place} of `{method}`: {error}; expected an unchanged part")))
        };
        of.iter().enumerate().map(read).collect()
    };
    methods.iter().map(of).collect()
}
