//! Errors in the arguments, as the same report as all others: `thing: value; expected X`, then the next command.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::console::Settings;
use crate::files::error::InputError;

/// The options of output among arguments that were not parsed.
pub(crate) fn settings(words: &[String]) -> Settings {
    let has = |option: &str| words.iter().any(|word| word == option);
    let is_after_color = |when: &str| words.windows(2).any(|pair| pair[0] == "--color" && pair[1] == when);
    let is_color = |when: &str| is_after_color(when) || has(&format!("--color={when}"));
    let colour = if is_color("always") { Some(true) } else { is_color("never").then_some(false) };
    Settings { wide: has("--wide"), colour, ..Settings::default() }
}

/// Parses a time in seconds that may have a fraction.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected seconds above 0".to_owned())
}

/// Parses the name of a picture: SVG or PNG by its ending, SVG without one.
pub(crate) fn picture() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|file| {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            None | Some("svg" | "png") => Ok(file),
            Some(_) => Err("expected a name that ends in .svg or .png"),
        }
    })
}

/// Parses the name of a folder of pictures.
pub(crate) fn picture_folder() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|folder| {
        let ending = folder.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_picture = ending.is_some_and(|ending| ["svg", "png", "jpg", "jpeg", "pdf"].contains(&&*ending));
        if is_picture { Err("expected the name of a folder, for several pictures") } else { Ok(folder) }
    })
}

/// Options of earlier versions, and what does their work.
const GONE: [(&str, &str); 7] = [
    ("--blanking-us", "schedules have two phases"),
    ("--fleet-number", "flow needs no numbers"),
    ("--hopping", "flow does it"),
    ("--margin-us", "schedules have two phases"),
    ("--numbered", "flow needs no numbers"),
    ("--phases", "flow does it"),
    ("--reach-us", "schedules have two phases"),
];

/// Returns the error in the arguments.
pub(crate) fn describe(error: &clap::Error, words: &[String]) -> InputError {
    let context = |kind| error.get(kind).map(text).filter(|text| !text.is_empty());
    let thing = context(ContextKind::InvalidArg).unwrap_or_else(|| "arguments".to_owned());
    let gone = GONE.iter().find(|(name, _)| error.kind() == ErrorKind::UnknownArgument && *name == thing);
    if let Some((name, why)) = gone {
        return InputError::new(name, format!("gone; {why}"));
    }
    let value = context(ContextKind::InvalidValue).unwrap_or_default();
    let among = context(ContextKind::ValidValue).or_else(|| context(ContextKind::ValidSubcommand));
    let suggested = [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::SuggestedValue]
        .into_iter()
        .find_map(context);
    let why = std::error::Error::source(error).map(ToString::to_string);
    // A negative number looks like an option; the word before it is the one to blame.
    let negative = || thing.parse::<f64>().ok().and_then(|_| before(words, &thing)).map(|option| (option, &thing));
    let (thing, found) = match (error.kind(), why) {
        (ErrorKind::ValueValidation, Some(why)) => (thing, format!("`{value}`; {}", expected(&why))),
        (ErrorKind::InvalidValue, _) if value.is_empty() => (thing, "no value; expected one".to_owned()),
        (ErrorKind::InvalidValue, _) => (thing, format!("`{value}`; expected a value of its list")),
        (ErrorKind::InvalidSubcommand, _) => {
            let word = context(ContextKind::InvalidSubcommand).unwrap_or_default();
            ("command".to_owned(), format!("`{word}`; expected one that exists"))
        }
        (ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand, _) => {
            ("command".to_owned(), "missing; expected one".to_owned())
        }
        (ErrorKind::UnknownArgument, _) => match negative() {
            Some((option, value)) => (option, format!("`{value}`; expected no negative number")),
            None => (thing, "unknown; expected an option or argument of the command".to_owned()),
        },
        (ErrorKind::MissingRequiredArgument, _) => (thing, "missing; expected a value".to_owned()),
        (ErrorKind::ArgumentConflict, _) => {
            let found = match context(ContextKind::PriorArg) {
                Some(prior) if prior == thing => "given more than once; expected once".to_owned(),
                Some(prior) => format!("given with {prior}; expected one of the two"),
                None => "given with others; expected alone".to_owned(),
            };
            (thing, found)
        }
        (ErrorKind::TooManyValues, _) => (thing, format!("`{value}` is one value too many; expected fewer")),
        (ErrorKind::TooFewValues | ErrorKind::WrongNumberOfValues, _) => {
            let count = |kind| context(kind).unwrap_or_else(|| "another number of".to_owned());
            let (actual, needed) = (count(ContextKind::ActualNumValues), count(ContextKind::ExpectedNumValues));
            (thing, format!("{actual} values; expected {needed}"))
        }
        (ErrorKind::InvalidUtf8, _) => (thing, "not UTF-8; expected text".to_owned()),
        _ => (thing, format!("`{value}`; expected what the help says")),
    };
    let among = among.map_or(String::new(), |among| format!(": {among}"));
    let suggested = suggested.map_or(String::new(), |suggested| format!("; did you mean {suggested}?"));
    InputError::new(thing, format!("{found}{among}{suggested}; see `{}`", help(words)))
}

/// The option before a word, if one is there.
fn before(words: &[String], word: &str) -> Option<String> {
    let pair = words.windows(2).find(|pair| pair[1] == word)?;
    pair[0].starts_with("--").then(|| pair[0].clone())
}

/// The command whose help describes the arguments.
fn help(words: &[String]) -> String {
    let program = <super::Cli as clap::CommandFactory>::command();
    let (mut command, mut path) = (&program, "eeruf".to_owned());
    for word in words.iter().skip(1) {
        if let Some(below) = command.find_subcommand(word) {
            command = below;
            path = format!("{path} {word}");
        }
    }
    path + " --help"
}

/// The reason in the words of a user.
fn expected(why: &str) -> String {
    if let Some(at) = why.find("expected ") {
        return why[at..].to_owned();
    }
    if let Some((_, range)) = why.split_once(" is not in ") {
        return format!("expected a number from {}", range.replace("..=", " to "));
    }
    if why.contains("invalid digit") || why.contains("cannot parse") {
        return "expected a whole number from 0 on".to_owned();
    }
    if why.contains("too large") {
        return "expected a smaller number".to_owned();
    }
    if why.contains("float") {
        return "expected a number".to_owned();
    }
    format!("expected another value: {why}")
}

fn text(value: &ContextValue) -> String {
    match value {
        ContextValue::String(text) => text.clone(),
        ContextValue::Strings(texts) => texts.join(", "),
        ContextValue::StyledStr(text) => text.to_string(),
        ContextValue::StyledStrs(texts) => texts.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        ContextValue::Number(number) => number.to_string(),
        _ => String::new(),
    }
}
