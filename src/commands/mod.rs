//! One file for each verb: its arguments, and what it does with them.
//!
//! Commands read with `files`, ask the libraries, and hand what they found to `report`; neither knows of them.

mod answer;
mod atlas;
mod certificate;
mod completions;
mod dataset;
mod design;
mod diagnose;
mod examples;
mod experiment;
mod hopping;
mod licenses;
mod man;
mod methods;
mod paths;
mod replay;
mod replay_hopping;
mod scene;
mod search;
mod study;
mod survey;
mod verify;

pub(crate) use answer::Answer;
use clap::{Parser, Subcommand};

use crate::files::error::InputError;

/// Fire all ultrasonic sensors of a robot five to ten times faster than one by one, without believing each other's
/// echoes.
///
/// Sensors are printed from 1, as in the paper, and counted from 0 in files and in --json.
#[derive(Parser)]
#[command(name = "eeruf", version = env!("EERUF_VERSION"), max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Subcommand)]
pub(crate) enum Verb {
    Design(design::Args),
    Verify(verify::Args),
    Search(search::Args),
    Study(study::Args),
    Paths(paths::Args),
    Scene(scene::Args),
    Replay(replay::Args),
    Diagnose(diagnose::Args),
    Survey(survey::Args),
    Experiment(experiment::Args),
    Dataset(dataset::Args),
    Atlas(atlas::Args),
    Examples(examples::Args),
    Completions(completions::Args),
    Man(man::Args),
    Licenses(licenses::Args),
}

impl Verb {
    pub(crate) fn run(&self) -> Result<Answer, InputError> {
        match self {
            Self::Design(args) => design::run(args),
            Self::Verify(args) => verify::run(args),
            Self::Search(args) => search::run(args),
            Self::Study(args) => study::run(args),
            Self::Paths(args) => paths::run(args),
            Self::Scene(args) => scene::run(args),
            Self::Replay(args) => replay::run(args),
            Self::Diagnose(args) => diagnose::run(args),
            Self::Survey(args) => survey::run(args),
            Self::Experiment(args) => experiment::run(args),
            Self::Dataset(args) => dataset::run(args),
            Self::Atlas(args) => atlas::run(args),
            Self::Examples(args) => examples::run(args),
            Self::Completions(args) => completions::run(args),
            Self::Man(args) => man::run(args),
            Self::Licenses(args) => licenses::run(args),
        }
    }
}
