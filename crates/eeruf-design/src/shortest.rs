//! The shortest period for what a schedule must meet: out of the atlas where it knows it, else by search.

use eeruf_core::MAX_SENSORS;
use eeruf_core::search::{Control, Found, PeriodProblem, Preferred, SearchError, ShortestPeriod, design};
use eeruf_sim::AnySchedule;

use crate::atlas;
use crate::find_uneven::{ToSpare, prefer_uneven, shortest_uneven};

/// Budget of nodes for the choice among the shortest schedules.
const PREFERENCE_BUDGET: u64 = 100_000;
/// Budget of nodes for the choice among the shortest schedules of an uneven ring.
pub(crate) const SPARE_BUDGET: u64 = 30_000;

/// The effort of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Largest number of nodes to visit before giving the best schedule so far.
    pub budget: u64,
    /// True to look for what would make the period shorter.
    pub what_if: bool,
    /// The atlas that may answer where it knows the shortest period: [`atlas::ATLAS`], a part of it, or an empty text
    /// for none.
    pub atlas: &'static str,
}

impl Default for Search {
    /// 50 million nodes, no look at what would be shorter; the atlas may answer.
    fn default() -> Self {
        Self { budget: 50_000_000, what_if: false, atlas: atlas::ATLAS }
    }
}

/// Knowledge of the shortest period.
#[derive(Clone, Debug)]
pub struct Shortest {
    /// The shortest period, or the best found.
    pub found: Found<MAX_SENSORS>,
    /// Why it is not shorter, in words.
    pub reason: String,
    /// The choice among the schedules of that period, if the period is proven and all sensors are alike.
    pub preferred: Option<Preferred<MAX_SENSORS>>,
    /// Slack of a schedule for a ring whose sensors are not alike, if the period is proven: of those with this period
    /// it has the most.
    pub to_spare: Option<ToSpare>,
    /// True if period and schedule are the atlas's, and nothing was searched.
    pub from_atlas: bool,
}

impl Shortest {
    /// The schedule that is preferred, or the first found.
    #[must_use]
    pub fn schedule(&self) -> Option<AnySchedule> {
        self.preferred.map_or(self.found.schedule, |preferred| Some(preferred.schedule))
    }
}

/// Finds the shortest period; `what_if` does not matter here.
///
/// # Errors
/// [`SearchError`] for needs that make no sense or are too large to search.
pub fn shortest(
    problem: &PeriodProblem<'_>,
    search: &Search,
    control: &mut impl Control,
) -> Result<Shortest, SearchError> {
    if let Some(known) = known(problem, search.atlas)? {
        return Ok(known);
    }
    if problem.requirements.uneven.is_some() {
        let (mut found, reason) = shortest_uneven(problem, search.budget, control)?;
        let mut to_spare = None;
        if let Some(schedule) = found.schedule.filter(|_| found.proven) {
            let (schedule, spare) = prefer_uneven(problem, &schedule, SPARE_BUDGET, control)?;
            (found.schedule, to_spare) = (Some(schedule), Some(spare));
        }
        return Ok(Shortest { found, reason, preferred: None, to_spare, from_atlas: false });
    }
    let mut memory = vec![0; design::memory_words(problem.sensors)];
    let designed: ShortestPeriod<MAX_SENSORS> = problem.shortest(search.budget, &mut memory, control)?;
    let choose = || problem.prefer(&designed, PREFERENCE_BUDGET, &mut memory, control);
    let preferred = designed.found.proven.then(choose).transpose()?;
    let reason = designed.explanation().to_string();
    Ok(Shortest { found: designed.found, reason, preferred, to_spare: None, from_atlas: false })
}

/// The atlas's entry for a problem, if it has its shortest period.
fn known(problem: &PeriodProblem<'_>, rows: &str) -> Result<Option<Shortest>, SearchError> {
    let Some((row, schedule)) = atlas::answer(rows, problem) else { return Ok(None) };
    let period = schedule.period();
    let [t_delta_proven, min_interval_proven, min_refire_proven] = row.preferred;
    let preferred = Preferred { schedule, t_delta_proven, min_interval_proven, min_refire_proven, nodes: 0 };
    let found = Found { schedule: Some(schedule), value: Some(period), bound: Some(period), proven: true, nodes: 0 };
    let reason = problem.why_shortest(period)?.in_ticks_of(problem.tick).to_string();
    Ok(Some(Shortest { found, reason, preferred: Some(preferred), to_spare: None, from_atlas: true }))
}
