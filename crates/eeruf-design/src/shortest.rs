//! The shortest period for a problem: from the atlas if it is there, otherwise by search.

use eeruf_core::search::{Control, Found, SearchError};
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_files::AnySchedule;
use eeruf_period::{PeriodProblem, ToSpare};

use crate::atlas;

/// Budget of nodes for the choice among the shortest schedules.
pub(crate) const SPARE_BUDGET: u64 = 30_000;

/// The effort of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Largest number of nodes to visit before giving the best schedule so far.
    pub budget: u64,
    /// True to look for changes that would make the period shorter.
    pub what_if: bool,
    /// The atlas that may answer: [`atlas::ATLAS`], a part of it, or an empty text for none.
    pub atlas: &'static str,
}

impl Default for Effort {
    /// An effort of 50 million nodes, with the atlas and without looking for changes.
    fn default() -> Self {
        Self { budget: 50_000_000, what_if: false, atlas: atlas::ATLAS }
    }
}

/// The shortest period, and the preferred schedule.
#[derive(Clone, Debug)]
pub struct FoundPeriod {
    /// The shortest period, or the best found, with the first schedule that has it.
    pub found: Found<MAX_SENSORS>,
    /// The preferred schedule.
    pub schedule: AnySchedule,
    /// Reason why the period is not shorter, in words.
    pub reason: String,
    /// Slack of the schedule, if the period is proven: no other schedule with this period has more.
    pub to_spare: Option<ToSpare>,
    /// True if period and schedule come from the atlas, and nothing was searched.
    pub from_atlas: bool,
    /// Bound of the period by the certificate of the atlas's row.
    pub certified: Option<Micros>,
}

/// Finds the shortest period; `what_if` does not matter here.
///
/// # Errors
/// [`SearchError`] for needs that are invalid or too large to search.
pub fn shortest(
    problem: &PeriodProblem<'_>,
    search: &Effort,
    control: &mut impl Control,
) -> Result<FoundPeriod, SearchError> {
    if let Some(known) = known(problem, search.atlas)? {
        return Ok(known);
    }
    let shortest = problem.shortest(search.budget, control)?;
    let found = shortest.found();
    let (mut schedule, mut to_spare) = (shortest.schedule, None);
    if found.proven {
        let (preferred, spare) = problem.prefer(&schedule, SPARE_BUDGET, control)?;
        (schedule, to_spare) = (preferred, Some(spare));
    }
    Ok(FoundPeriod { found, schedule, reason: shortest.reason, to_spare, from_atlas: false, certified: None })
}

/// The atlas's entry for a problem, if it has its shortest period.
fn known(problem: &PeriodProblem<'_>, rows: &str) -> Result<Option<FoundPeriod>, SearchError> {
    let Some((row, schedule)) = atlas::answer(rows, problem) else { return Ok(None) };
    let period = schedule.period();
    let to_spare = ToSpare { proven: row.preferred, ..problem.spare_of(&schedule) };
    let found = Found { schedule: Some(schedule), value: Some(period), bound: Some(period), proven: true, nodes: 0 };
    let reason = problem.why_shortest(&schedule)?;
    let certified = row.certified.checked_mul(problem.tick.as_micros()).map(Micros::new);
    Ok(Some(FoundPeriod { found, schedule, reason, to_spare: Some(to_spare), from_atlas: true, certified }))
}
