//! Warnings about input that is legal but implausible.

use std::path::Path;

use clap::ArgMatches;
use clap::parser::ValueSource;
use eeruf_files::{doubt, doubted_keys, doubts_in};
use eeruf_logs::FiringLog;

use super::error::InputError;
use crate::console;

/// Warns about every implausible value of a TOML file.
///
/// # Errors
/// The first warning, if warnings are denied.
pub(crate) fn warn_of(file: &Path, text: &str) -> Result<(), InputError> {
    doubts_in(text).into_iter().try_for_each(|found| warn(found.in_file(file).into()))
}

/// Reads a log of firings, and warns about implausible times in it.
///
/// # Errors
/// The log cannot be read; or the first of the warnings, if they are denied.
pub(crate) fn read_firings(file: &Path) -> Result<FiringLog, InputError> {
    let log = FiringLog::read(file)?;
    log.doubts().into_iter().try_for_each(|doubt| warn(InputError::new(file, doubt)))?;
    Ok(log)
}

/// Prints a warning, or returns it as an error if warnings are denied.
pub(crate) fn warn(warning: InputError) -> Result<(), InputError> {
    if console::settings().deny_warnings {
        return Err(warning);
    }
    console::warning(warning);
    Ok(())
}

/// Warns about implausible values of options, which mean the same as keys of these names in files.
///
/// # Errors
/// The first warning, if warnings are denied.
pub(crate) fn warn_of_options(matches: &ArgMatches) -> Result<(), InputError> {
    for key in doubted_keys() {
        let is_given = matches.try_contains_id(key).is_ok_and(|is_given| is_given)
            && matches.value_source(key) == Some(ValueSource::CommandLine);
        let values = if is_given { matches.get_raw(key) } else { None };
        for value in values.into_iter().flatten() {
            let number = value.to_str().and_then(|value| value.parse().ok());
            if let Some(message) = number.and_then(|number| doubt(key, number)) {
                warn(InputError::new(format!("--{}", key.replace('_', "-")), message))?;
            }
        }
    }
    matches.subcommand().map_or(Ok(()), |(_, matches)| warn_of_options(matches))
}
