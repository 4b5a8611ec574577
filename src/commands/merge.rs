//! `eeruf lab merge`: joins the parts of an experiment.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use clap::Parser;
use eeruf_files::FileError;
use serde_json::error::Category;

use super::Answer;
use super::experiment::{Part, Shard, merged};
use super::{Cli, LabVerb, Verb};
use crate::files::error::InputError;

/// Join the parts that `eeruf lab experiment --shard` printed: bit for bit the undivided run.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The parts, in any order
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let mut parts: BTreeMap<u64, (&PathBuf, Part)> = BTreeMap::new();
    for file in &args.files {
        let refused = |what: String| InputError::new(file, what);
        let text = fs::read_to_string(file).map_err(|error| FileError::reading(file, &error))?;
        let part: Part = serde_json::from_str(&text).map_err(|error| {
            let (line, why) = (error.line() as u64, error.to_string());
            let why = match error.classify() {
                Category::Eof => "JSON that ends early".to_owned(),
                Category::Data => {
                    format!("JSON of another kind: {}", why.split(" at line ").next().unwrap_or_default())
                }
                Category::Syntax | Category::Io => "no JSON".to_owned(),
            };
            let message = format!("{why}; expected what `eeruf lab experiment .. --shard I/N` prints, whole");
            FileError::new(file, message).at_line(Some(line))
        })?;
        if part.eeruf != Part::VERSION {
            let (theirs, ours) = (&part.eeruf, Part::VERSION);
            return Err(refused(format!("a part of eeruf {theirs}; expected one of {ours}, which reads it")));
        }
        let Shard { part: number, of } = part.shard;
        if let Some((known, other)) = parts.values().next() {
            let known = known.display();
            if other.shard.of != of {
                return Err(refused(format!("part {number}/{of}; expected one of {} as {known}", other.shard.of)));
            }
            if other.arguments != part.arguments {
                let (theirs, ours) = (part.arguments.join(" "), other.arguments.join(" "));
                return Err(refused(format!("a part of `{theirs}`; expected one of `{ours}` as {known}")));
            }
        }
        if let Some((known, _)) = parts.insert(number, (file, part)) {
            return Err(refused(format!("part {number}/{of}; expected each once, and {} is it too", known.display())));
        }
    }
    // There is one file at least.
    let Some((file, first)) = parts.values().next() else { return Ok(Answer::No) };
    let refused = |what: String| InputError::new(file, what);
    let missing: Vec<_> = (1..=first.shard.of).filter(|part| !parts.contains_key(part)).collect();
    if let Some(&next) = missing.first() {
        let (count, of) = (missing.len(), first.shard.of);
        let again = format!("eeruf lab experiment {} --shard {next}/{of}", first.arguments.join(" "));
        return Err(refused(format!("{count} of {of} parts are missing, the first is {next}; run `{again}`")));
    }
    let words = ["eeruf", "experiment"].into_iter().chain(first.arguments.iter().map(String::as_str));
    let json = args.json.then_some("--json");
    let whole = Cli::try_parse_from(words.chain(json)).ok().map(|cli| cli.verb);
    let Some(Verb::Old(LabVerb::Experiment(whole))) = whole else {
        let words = first.arguments.join(" ");
        return Err(refused(format!("arguments `{words}`; expected those of `eeruf lab experiment`, unchanged")));
    };
    let mut runs = BTreeMap::new();
    for (_, part) in parts.values() {
        for (method, of) in &part.runs {
            runs.entry(method.clone()).or_insert_with(Vec::new).extend(of.iter().cloned());
        }
    }
    merged(&whole, file, &runs)?;
    Ok(Answer::Yes)
}
