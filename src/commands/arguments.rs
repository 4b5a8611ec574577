//! Errors in the arguments, in the style of all others: `thing: value; expected X`, then the next command.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::console::Settings;

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

/// Returns what is wrong with the arguments.
pub(crate) fn describe(error: &clap::Error, words: &[String]) -> String {
    let context = |kind| error.get(kind).map(text).filter(|text| !text.is_empty());
    let thing = context(ContextKind::InvalidArg).or_else(|| context(ContextKind::InvalidSubcommand));
    let thing = thing.unwrap_or_else(|| "arguments".to_owned());
    let value = context(ContextKind::InvalidValue).unwrap_or_default();
    let among = context(ContextKind::ValidValue).or_else(|| context(ContextKind::ValidSubcommand));
    let prior = context(ContextKind::PriorArg);
    let suggested = [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::SuggestedValue]
        .into_iter()
        .find_map(context);
    let why = std::error::Error::source(error).map(ToString::to_string);
    let mut said = match (error.kind(), why) {
        (ErrorKind::ValueValidation, Some(why)) => format!("{thing}: `{value}`; {}", expected(&why)),
        (ErrorKind::InvalidValue, _) if value.is_empty() => format!("{thing}: no value; expected one"),
        (ErrorKind::InvalidValue, _) => format!("{thing}: `{value}`; expected a value of its list"),
        (ErrorKind::InvalidSubcommand, _) => format!("`{thing}`; expected a command"),
        (ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand, _) => {
            "no command; expected one".to_owned()
        }
        (ErrorKind::UnknownArgument, _) => format!("{thing}: unknown; expected an option or argument of the command"),
        (ErrorKind::MissingRequiredArgument, _) => format!("{thing}: missing; expected a value"),
        (ErrorKind::ArgumentConflict, _) => match prior {
            Some(prior) if prior == thing => format!("{thing}: given more than once; expected once"),
            Some(prior) => format!("{thing}: given with {prior}; expected one of the two"),
            None => format!("{thing}: given with others; expected alone"),
        },
        (ErrorKind::TooManyValues, _) => format!("{thing}: `{value}` is one value too many; expected fewer"),
        (ErrorKind::TooFewValues | ErrorKind::WrongNumberOfValues, _) => {
            format!("{thing}: wrong number of values; expected as many as its help says")
        }
        (ErrorKind::InvalidUtf8, _) => "arguments: not UTF-8; expected text".to_owned(),
        _ => format!("{thing}: `{value}`; expected what the help says"),
    };
    if let Some(among) = among {
        said += &format!(": {among}");
    }
    if let Some(suggested) = suggested {
        said += &format!("; did you mean {suggested}?");
    }
    said + "; see `" + &help(words) + "`"
}

/// The command whose help describes the arguments.
fn help(words: &[String]) -> String {
    let is_verb = |word: &&String| <super::Cli as clap::CommandFactory>::command().find_subcommand(word).is_some();
    words.iter().find(is_verb).map_or("eeruf --help".to_owned(), |verb| format!("eeruf {verb} --help"))
}

/// The reason in the words of a user.
fn expected(why: &str) -> String {
    if let Some(at) = why.find("expected ") {
        return why[at..].to_owned();
    }
    if let Some((_, range)) = why.split_once(" is not in ") {
        return format!("expected a number in {range}");
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
