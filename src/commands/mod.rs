//! One file for each verb: its arguments, and what it does with them.
//!
//! Commands read with `files`, ask the libraries, and hand what they found to `report`; neither knows of them.

mod answer;
mod certificate;
mod design;
mod experiment;
mod methods;
mod paths;
mod replay;
mod scene;
mod search;
mod study;
mod verify;

pub(crate) use answer::Answer;
use clap::Subcommand;

use crate::files::error::InputError;

#[derive(Subcommand)]
pub(crate) enum Verb {
    Design(design::Args),
    Verify(verify::Args),
    Search(search::Args),
    Study(study::Args),
    Paths(paths::Args),
    Scene(scene::Args),
    Replay(replay::Args),
    Experiment(experiment::Args),
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
            Self::Experiment(args) => experiment::run(args),
        }
    }
}
