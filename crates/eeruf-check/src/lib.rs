//! Checks a certificate that the period of a firing schedule is the shortest one.
//!
//! A certificate holds the problem, a schedule, and a tree of case distinctions that refutes every shorter period.
//! docs/reference/certificate.md in the repository has the format and the proof of each rule. This crate depends on
//! nothing, does nothing else, and shares nothing with the programs that find schedules and write certificates.
//!
//! | file | content |
//! |---|---|
//! | `text`, `read` | the lines of a certificate; its head: problem, schedule, claim |
//! | `schedule` | the schedule, checked longhand |
//! | `bounds`, `state` | what is known at a node |
//! | `rules` | what follows from it |
//! | `symmetry` | what the root may assume |
//! | `tree` | the case distinctions |
#![forbid(unsafe_code)]

mod bounds;
mod error;
mod problem;
mod read;
mod rules;
mod schedule;
mod state;
mod symmetry;
mod text;
mod tree;

use core::fmt;

pub use error::CheckError;
pub use problem::{MAX_NUMBER, MAX_SENSORS, Problem};
pub use read::Claim;

/// The content of a certificate that passed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Certified {
    /// The claim, which is true.
    pub claim: Claim,
    /// The nodes of the tree, leaves included.
    pub nodes: usize,
}

/// Checks the text of a certificate.
///
/// # Errors
///
/// The first line that is not as it must be.
pub fn check(text: &str) -> Result<Certified, CheckError> {
    let mut lines = text::Lines::new(text);
    let claim = read::claim(&mut lines)?;
    let merged = claim.problem.merged();
    let root = symmetry::root(&mut lines, &claim.problem, &merged, claim.bound)?;
    let nodes = tree::replay(&mut lines, root, &merged)?;
    lines.end()?;
    Ok(Certified { claim, nodes })
}

/// Reads a claim without its proof: the head of a certificate, up to the line `no_period_below`.
///
/// # Errors
///
/// The first line that is not as it must be; the schedule is checked as well.
pub fn read_claim(text: &str) -> Result<Claim, CheckError> {
    read::claim(&mut text::Lines::new(text))
}

impl Certified {
    /// A number of ticks in microseconds.
    fn micros(&self, ticks: u32) -> String {
        let (numerator, denominator) = self.claim.problem.tick_us;
        fraction(u64::from(ticks) * u64::from(numerator), u64::from(denominator))
    }
}

impl fmt::Display for Certified {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (period, bound) = (self.claim.period, self.claim.bound);
        let (numerator, denominator) = self.claim.problem.tick_us;
        let reals = if self.claim.problem.over_reals { " over the reals" } else { "" };
        if bound == period {
            write!(f, "{} us is the shortest period{reals}", self.micros(period))?;
        } else {
            write!(f, "no period below {} us{reals}; schedule of {} us", self.micros(bound), self.micros(period))?;
        }
        write!(f, " (tick {} us)", fraction(u64::from(numerator), u64::from(denominator)))
    }
}

/// A fraction in lowest terms.
fn fraction(numerator: u64, denominator: u64) -> String {
    let (mut divisor, mut rest) = (numerator, denominator);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    if divisor == denominator {
        (numerator / divisor).to_string()
    } else {
        format!("{}/{}", numerator / divisor, denominator / divisor)
    }
}

/// The listing of the crate's README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
