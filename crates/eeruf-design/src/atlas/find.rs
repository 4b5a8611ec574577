//! The atlas of this crate, and the lookup of a ring in it.

use eeruf_files::AnySchedule;
use eeruf_period::PeriodProblem;

use super::rings::Ring;
use super::row::Row;

/// The atlas of this crate: a line for each ring.
#[cfg(feature = "atlas")]
pub const ATLAS: &str = include_str!("atlas.txt");
/// An empty atlas, without the feature `atlas`.
#[cfg(not(feature = "atlas"))]
pub const ATLAS: &str = "";

/// The proven row of a problem's ring in an atlas such as [`ATLAS`], and its schedule in the problem's ticks, which
/// keeps the requirements.
///
/// A schedule of the atlas that the verifier refuses counts as absent.
#[must_use]
pub fn answer(atlas: &str, problem: &PeriodProblem<'_>) -> Option<(Row, AnySchedule)> {
    let begins = format!("{} ", Ring::of(problem)?);
    let line = atlas.lines().find(|line| line.starts_with(&begins))?;
    let row: Row = line.parse().ok()?;
    let schedule = row.schedule(problem.tick)?;
    (row.bound == row.period && schedule.verify(&problem.requirements).ok()).then_some((row, schedule))
}
