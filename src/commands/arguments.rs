//! Errors in arguments, printed like all other errors: `thing: value; expected X`, then the next command.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::console::Settings;
use crate::files::error::InputError;

/// Returns the output options among arguments that were not parsed.
pub(crate) fn settings(words: &[String]) -> Settings {
    let has = |option: &str| words.iter().any(|word| word == option);
    let is_after_color = |when: &str| words.windows(2).any(|pair| pair[0] == "--color" && pair[1] == when);
    let is_color = |when: &str| is_after_color(when) || has(&format!("--color={when}"));
    let colour = if is_color("always") { Some(true) } else { is_color("never").then_some(false) };
    Settings { wide: has("--wide"), explain: has("--explain"), colour, ..Settings::default() }
}

/// Parses a time in seconds that may have a fraction.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected seconds above 0".to_owned())
}

/// Parses the name of a picture: SVG or PNG by its ending; without one the picture `name` in a folder.
pub(crate) fn picture(name: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    pictures().map(move |file| if is_picture(&file) { file } else { file.join(name).with_extension("svg") })
}

/// Parses the name of a folder of pictures, or of one picture, which ends in .svg or .png.
pub(crate) fn pictures() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|name| {
        let ending = name.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("jpg" | "jpeg" | "pdf" | "gif" | "eps") => {
                Err("expected a folder, or a name that ends in .svg or .png")
            }
            _ => Ok(name),
        }
    })
}

/// Returns true for the name of one picture.
pub(crate) fn is_picture(name: &Path) -> bool {
    name.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg") || ending.eq_ignore_ascii_case("png"))
}

/// Options of earlier versions, and their replacements.
const GONE: [(&str, &str); 7] = [
    ("--blanking-us", "schedules have two phases"),
    ("--fleet-number", "flow needs no numbers"),
    ("--hopping", "flow does it"),
    ("--margin-us", "schedules have two phases"),
    ("--numbered", "flow needs no numbers"),
    ("--phases", "flow does it"),
    ("--reach-us", "schedules have two phases"),
];

/// Commands of other programs, and eeruf's equivalents.
const MEANT: [(&str, &str); 9] = [
    ("simulate", "study"),
    ("run", "study"),
    ("plot", "study SCENE.toml --svg DIR"),
    ("draw", "study SCENE.toml --svg DIR"),
    ("check", "verify"),
    ("generate", "design RING.toml --program arduino"),
    ("program", "design RING.toml --program arduino"),
    ("new", "examples"),
    ("log", "logs"),
];

/// Returns the error in the arguments: the suggestion where there is one, else what is expected.
pub(crate) fn describe(error: &clap::Error, words: &[String]) -> InputError {
    let context = |kind| error.get(kind).map(text).filter(|text| !text.is_empty());
    let shown = context(ContextKind::InvalidArg).unwrap_or_else(|| "arguments".to_owned());
    // `--svg <DIR>`, `<LOG>` or `[FILE]...`.
    let (name, kind) = shown.split_once(' ').unwrap_or((&shown, ""));
    let thing = bare(name);
    let gone = GONE.iter().find(|(name, _)| error.kind() == ErrorKind::UnknownArgument && *name == thing);
    if let Some((name, why)) = gone {
        return InputError::new(name, format!("gone; {why}"));
    }
    let value = context(ContextKind::InvalidValue).unwrap_or_default();
    let among = context(ContextKind::ValidValue).or_else(|| context(ContextKind::ValidSubcommand));
    let (command, path) = asked(words);
    let suggested = [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::SuggestedValue]
        .into_iter()
        .find_map(context)
        .map(|suggested| bare(suggested.split(", ").next().unwrap_or_default()));
    let why = std::error::Error::source(error).map(ToString::to_string);
    let suggest = |of: String| format!("did you mean `{of}`?");
    let commands = || {
        let shown = command.get_subcommands().filter(|below| !below.is_hide_set() && below.get_name() != "help");
        format!("expected {}", shown.map(clap::Command::get_name).collect::<Vec<_>>().join(", "))
    };
    let (thing, found) = match (error.kind(), why) {
        (ErrorKind::ValueValidation, Some(why)) => {
            let expected = expected(&why);
            let known = expected.strip_prefix("expected ").unwrap_or("").split(", ");
            let meant = eeruf_files::meant(&value.to_lowercase(), known).map(str::to_owned);
            (thing, format!("`{value}`; {}", meant.map_or(expected, suggest)))
        }
        (ErrorKind::InvalidValue, _) if value.is_empty() => (thing, format!("no value; expected {}", bare(kind))),
        (ErrorKind::InvalidValue, _) => {
            let among = among.unwrap_or_default();
            (thing, format!("`{value}`; {}", suggested.map_or(format!("expected {among}"), suggest)))
        }
        (ErrorKind::InvalidSubcommand, _) => {
            let word = context(ContextKind::InvalidSubcommand).unwrap_or_default();
            let known = MEANT.iter().find(|(other, _)| *other == word).map(|(_, meant)| format!("eeruf {meant}"));
            let meant = known.or(suggested).map_or_else(commands, suggest);
            (word, format!("no command; {meant}"))
        }
        (ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand, _) => {
            ("command".to_owned(), format!("missing; {}", commands()))
        }
        (ErrorKind::UnknownArgument, _) => unknown(thing, suggested, words, &command),
        (ErrorKind::MissingRequiredArgument, _) => {
            let usage = if kind.is_empty() { thing.clone() } else { format!("{thing} {}", bare(kind)) };
            let others = if thing.starts_with('-') { " .." } else { "" };
            (thing, format!("missing; expected `{path}{others} {usage}`"))
        }
        (ErrorKind::ArgumentConflict, _) => {
            let found = match context(ContextKind::PriorArg) {
                Some(prior) if prior == shown => "given more than once; expected once".to_owned(),
                Some(prior) => format!("given with {}; expected one of the two", prior.split(' ').next().unwrap_or("")),
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
    InputError::new(thing, format!("{found}; see `{path} --help`"))
}

/// Returns a name without the marks of a usage line.
fn bare(name: &str) -> String {
    name.trim_matches(|c| "<>[]'.".contains(c)).to_owned()
}

/// Returns the unknown option or argument, and a suggestion.
fn unknown(thing: String, suggested: Option<String>, words: &[String], command: &clap::Command) -> (String, String) {
    let has = |command: &clap::Command, long: &str| command.get_arguments().any(|arg| arg.get_long() == Some(long));
    // A negative number looks like an option; the error is about the word before it.
    if let Some(option) = thing.parse::<f64>().ok().and_then(|_| before(words, &thing)) {
        return (option, format!("`{thing}`; expected no negative number"));
    }
    // `-svg` is taken for `-s -v -g`.
    let single = words.iter().find(|word| word.starts_with(&thing) && has(command, word.trim_start_matches('-')));
    if let Some(single) = single.filter(|_| thing.starts_with('-') && !thing.starts_with("--")) {
        return (single.clone(), format!("unknown; did you mean `-{single}`?"));
    }
    if !thing.starts_with('-') {
        let list = before(words, &thing).map(|_| ()).or_else(|| {
            let at = words.iter().rposition(|word| *word == thing)?;
            words.get(at.checked_sub(2)?).filter(|word| word.starts_with("--")).map(|_| ())
        });
        let expected = match list {
            Some(()) => "expected commas between the values of an option, as in `--method sequential,flow`",
            None => "expected one file: run the command for each",
        };
        return (thing, format!("one argument too many; {expected}"));
    }
    let program = super::program();
    let of_other = program.get_subcommands().find(|other| has(other, thing.trim_start_matches('-')));
    let expected = match (suggested, of_other) {
        _ if has(command, thing.trim_start_matches('-')) => "expected it after the command".to_owned(),
        (_, Some(other)) => format!("expected an option of this command; `eeruf {}` has it", other.get_name()),
        (Some(suggested), _) => format!("did you mean `{suggested}`?"),
        (None, None) => "expected an option of the command".to_owned(),
    };
    (thing, format!("unknown; {expected}"))
}

/// Returns the option before a word, if there is one.
fn before(words: &[String], word: &str) -> Option<String> {
    let pair = words.windows(2).find(|pair| pair[1] == word)?;
    pair[0].starts_with("--").then(|| pair[0].clone())
}

/// Returns the requested command, and its name with its parents' names.
fn asked(words: &[String]) -> (clap::Command, String) {
    let (mut command, mut path) = (super::program(), "eeruf".to_owned());
    for word in words.iter().skip(1) {
        if let Some(below) = command.find_subcommand(word) {
            path = format!("{path} {word}");
            command = below.clone();
        }
    }
    (command, path)
}

/// Returns an error's expectation in a user's words.
fn expected(why: &str) -> String {
    if let Some(at) = why.find("expected ") {
        return why[at..].to_owned();
    }
    if let Some((_, range)) = why.split_once(" is not in ") {
        return format!("expected a number from {}", range.replace("..=", " to "));
    }
    if why.contains("invalid digit") || why.contains("cannot parse") {
        return "expected a whole number from 0 on, in digits".to_owned();
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
