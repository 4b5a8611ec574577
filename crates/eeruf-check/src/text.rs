//! The lines of a certificate: a word, then numbers, with one space between.

use crate::error::CheckError;
use crate::problem::MAX_NUMBER;

/// The lines not yet read.
pub(crate) struct Lines<'t> {
    rest: core::iter::Peekable<core::str::Split<'t, char>>,
    /// The number of the next line, from 1.
    pub(crate) number: usize,
}

impl<'t> Lines<'t> {
    pub(crate) fn new(text: &'t str) -> Self {
        Self { rest: text.split('\n').peekable(), number: 1 }
    }

    /// An error in the line that was read last.
    pub(crate) fn error(&self, what: impl Into<String>) -> CheckError {
        CheckError { line: (self.number - 1).max(1), what: what.into() }
    }

    /// Reads a line if it begins with `word`: its numbers.
    pub(crate) fn maybe(&mut self, word: &str) -> Result<Option<Vec<u32>>, CheckError> {
        match self.rest.peek() {
            Some(line) if line.split(' ').next() == Some(word) => self.next().map(|(_, numbers)| Some(numbers)),
            _ => Ok(None),
        }
    }

    /// Reads the line that must begin with `word`: its numbers.
    pub(crate) fn numbers(&mut self, word: &str) -> Result<Vec<u32>, CheckError> {
        let found = self.rest.peek().copied().unwrap_or_default();
        match self.maybe(word)? {
            Some(numbers) => Ok(numbers),
            None => {
                self.number += 1;
                Err(self.error(format!("found {}, expected a line {word}", quoted(found))))
            }
        }
    }

    /// Reads the line that must begin with `word`: its one number, which must be between `least` and `most`.
    pub(crate) fn number(&mut self, word: &str, least: u32, most: u32) -> Result<u32, CheckError> {
        let numbers = self.list(word, 1, least, most)?;
        Ok(numbers[0])
    }

    /// Reads the line that must begin with `word`: this many numbers, each between `least` and `most`.
    pub(crate) fn list(&mut self, word: &str, count: usize, least: u32, most: u32) -> Result<Vec<u32>, CheckError> {
        let numbers = self.numbers(word)?;
        self.expect(&numbers, count, least, most)?;
        Ok(numbers)
    }

    /// Returns true if the line read last has this many numbers, each between `least` and `most`.
    pub(crate) fn expect(&self, numbers: &[u32], count: usize, least: u32, most: u32) -> Result<(), CheckError> {
        if numbers.len() != count {
            return Err(self.error(format!("found {} numbers, expected {count}", numbers.len())));
        }
        match numbers.iter().find(|&&number| number < least || number > most) {
            Some(number) => Err(self.error(format!("found {number}, expected {least} to {most}"))),
            None => Ok(()),
        }
    }

    /// The word and numbers of the next line.
    pub(crate) fn next(&mut self) -> Result<(&'t str, Vec<u32>), CheckError> {
        let line = self.rest.next();
        self.number += 1;
        let Some(line) = line else {
            return Err(self.error("the text ends here, expected more lines"));
        };
        let mut parts = line.split(' ');
        let word = parts.next().unwrap_or_default();
        let mut numbers = Vec::new();
        for part in parts {
            let digits = part.len() <= 7 && part.bytes().all(|byte| byte.is_ascii_digit());
            let plain = digits && (part.len() == 1 || !part.starts_with('0'));
            match part.parse() {
                Ok(number) if plain && number <= MAX_NUMBER => numbers.push(number),
                _ => return Err(self.error(format!("found {}, expected a number up to {MAX_NUMBER}", quoted(part)))),
            }
        }
        Ok((word, numbers))
    }

    /// Reads the last line, with nothing after it.
    pub(crate) fn end(&mut self) -> Result<(), CheckError> {
        self.list("end", 0, 0, 0)?;
        if self.rest.next() == Some("") && self.rest.next().is_none() {
            return Ok(());
        }
        Err(self.error("expected nothing after the line end"))
    }
}

/// The first part of what was found, in quotes.
pub(crate) fn quoted(found: &str) -> String {
    let short: String = found.chars().take(40).collect();
    format!("{short:?}")
}
