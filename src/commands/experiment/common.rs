//! Arguments and progress of all sets.

use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use clap::{ArgMatches, FromArgMatches, Id};
use eeruf_core::search::Progress;
use eeruf_sim::experiments::{ExperimentError, FIRST};
use eeruf_sim::{Entry, GainProfile, Physics, Room};
use serde::Serialize;

use super::super::arguments::{is_picture, pictures};
use super::shard::{Part, Shard};
use crate::console::note;
use crate::files::error::InputError;
use crate::report::draw::Picture;
use crate::report::watch::Watch;

/// Budget of nodes for the search for `eeruf_best`; the proof takes far fewer.
pub(crate) const BUDGET: u64 = 300_000;

/// The words that decide what is run, also those that nobody typed: each option with its value, in alphabetical order.
pub(super) struct Words(Vec<String>);

/// Options of the output, which decide nothing.
const OF_OUTPUT: [&str; 6] = ["shard", "color", "quiet", "wide", "explain", "deny_warnings"];

impl FromArgMatches for Words {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        // Groups of options have names like types.
        let is_option = |id: &&str| id.starts_with(|c: char| c.is_ascii_lowercase()) && !OF_OUTPUT.contains(id);
        let options: BTreeSet<&str> = matches.ids().map(Id::as_str).filter(is_option).collect();
        let words = options.into_iter().flat_map(|id| {
            let values = matches.get_raw(id).into_iter().flatten().map(|value| value.to_string_lossy());
            let (option, value) = (format!("--{}", id.replace('_', "-")), values.collect::<Vec<_>>().join(","));
            match value.as_str() {
                "true" => vec![option],
                "false" => vec![],
                _ => vec![option, value],
            }
        });
        Ok(Self(words.collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for Words {
    fn augment_args(command: clap::Command) -> clap::Command {
        command
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        command
    }
}

/// Arguments of both sets.
#[derive(clap::Args)]
pub(crate) struct Common {
    /// The first field, since reading an option takes it away.
    #[command(flatten)]
    words: Words,
    /// Number of geometries, courses or placings; by default that of the paper
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub(crate) seeds: Option<u64>,
    /// The number of the first geometry or course; parameters were tuned on numbers below 2000
    #[arg(long, value_name = "SEED", default_value_t = FIRST)]
    pub(crate) first: u64,
    /// Simulated effects: default or plain (see docs/explanation/physics.md)
    #[arg(long, value_name = "PRESET", default_value = "default")]
    pub(crate) physics: Physics,
    /// Floor and ceiling: flat for none, or room, 2.6 m high with sensors at 0.3 m
    #[arg(long, value_name = "HEIGHT", default_value = "flat")]
    height: Height,
    /// Growth of the receivers' gain: constant, square_root, linear, stepped or polaroid_6500
    #[arg(long, value_name = "GAIN", default_value = "constant", value_parser = gain)]
    pub(crate) gain: GainProfile,
    /// Run the I-th of N parts, and print what `eeruf lab merge` makes the whole of; by default all
    #[arg(long, value_name = "I/N", conflicts_with_all = ["json", "svg", "png"])]
    pub(crate) shard: Option<Shard>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Draw SVG pictures into this folder, or into one file if the name ends in .svg or .png
    #[arg(long, value_name = "DIR|FILE", value_parser = pictures())]
    svg: Option<PathBuf>,
    /// Draw the same pictures as PNG
    #[arg(long, value_name = "DIR|FILE", value_parser = pictures())]
    png: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Height {
    Flat,
    Room,
}

fn gain(name: &str) -> Result<GainProfile, String> {
    let names = GainProfile::NAMES.map(|(name, _)| name).join(", ");
    let found = GainProfile::NAMES.iter().find(|(known, _)| *known == name);
    found.map(|(_, gain)| *gain).ok_or_else(|| format!("expected one of {names}"))
}

impl Common {
    /// Floor and ceiling, if rings hear them.
    pub(crate) fn room(&self) -> Option<Room> {
        matches!(self.height, Height::Room).then_some(Room::DEFAULT)
    }

    /// Returns true if a picture goes into a single file instead of a folder.
    pub(crate) fn draws_one(&self) -> bool {
        self.svg.iter().chain(&self.png).any(|name| is_picture(name))
    }

    /// Draws a picture in each requested form.
    pub(crate) fn draw(&self, name: &str, picture: impl Fn() -> Picture) -> Result<(), InputError> {
        for (folder, ending) in [(&self.svg, "svg"), (&self.png, "png")] {
            if let Some(folder) = folder {
                let is_one = is_picture(folder);
                picture().save(&if is_one { folder.clone() } else { folder.join(name).with_extension(ending) })?;
            }
        }
        Ok(())
    }
}

/// Progress of the search for `eeruf_best`.
pub(crate) fn designing(progress: &Progress) -> String {
    format!("designing eeruf_best, {} nodes", progress.nodes)
}

/// Makes an error named after the experiment, since it has no file.
pub(crate) fn bad(set: &'static str) -> impl Fn(&dyn fmt::Display) -> InputError {
    move |error| InputError::new(set, error)
}

/// Watches a run of several threads.
pub(crate) fn watched(what: String) -> impl Fn(f64) -> bool + Sync {
    let watch = Watch::new();
    move |done| watch.go_on(|| format!("{what}, {:.0} % done", 100.0 * done))
}

/// A function called occasionally with the finished share, 0 to 1.
pub(crate) type Watched<'a> = &'a (dyn Fn(f64) -> bool + Sync);

/// The number of seeds done, and the runs of each method.
type Done<R> = (u64, Vec<Vec<R>>);

impl Common {
    /// Runs an experiment in blocks of seeds until all are done or Ctrl-C stops it; `run` gets a block's first seed and
    /// length. Returns the number of seeds done and the runs of each method; `None` if it printed the part of a shard.
    ///
    /// # Errors
    /// The first error of `run`, or Ctrl-C before a block was done.
    pub(crate) fn in_blocks<R: Serialize>(
        &self,
        (set, of): (&'static str, &str),
        methods: &[Entry],
        (mut first, mut seeds): (u64, u64),
        run: impl Fn(u64, u64, Watched<'_>) -> Result<Vec<Vec<R>>, ExperimentError>,
    ) -> Result<Option<Done<R>>, InputError> {
        let bad = bad(set);
        if let Some(shard) = self.shard {
            (first, seeds) = shard.seeds(first, seeds).map_err(|error| bad(&error))?;
        }
        let watched = watched(format!("{seeds} {of} by {} methods", methods.len()));
        if let Some(shard) = self.shard {
            let runs = run(first, seeds, &watched).map_err(|error| bad(&error))?;
            let words = [&[set.to_owned()], &self.words.0[..]].concat();
            return Part::print(shard, words, methods, &runs).map(|()| None);
        }
        // Enough work for all cores, and little to lose by Ctrl-C.
        let block = 4 * std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
        let (mut done, mut all) = (0, Vec::<Vec<R>>::new());
        while done < seeds {
            let count = block.min(seeds - done);
            let share = |of_block: f64| watched((done as f64 + of_block * count as f64) / seeds as f64);
            match run(first.saturating_add(done), count, &share) {
                Ok(runs) if all.is_empty() => all = runs,
                Ok(runs) => all.iter_mut().zip(runs).for_each(|(all, runs)| all.extend(runs)),
                Err(ExperimentError::Stopped) if done > 0 => {
                    drop(watched);
                    note(format!("eeruf: stopped after {done} of {seeds} seeds, from {first} on"));
                    break;
                }
                Err(error) => return Err(bad(&error)),
            }
            done += count;
        }
        Ok(Some((done, all)))
    }
}
