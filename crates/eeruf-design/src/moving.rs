//! The shortest period of a ring that moves, whose `t_delta` depends on the schedule.
//!
//! From one firing of a sensor to its next, `dt` later, a good reading changes by up to `2 v dt / c`, and the longest
//! `dt` of a schedule is `T_p + max |d|`. So a longer period needs a larger separation, and a schedule for one period
//! need not serve at a longer one. A refutation covers a *region* of periods and of `max |d|`:
//!
//! - every schedule in it needs at least the `t_delta` of the region's shortest period and smallest `max |d|`;
//! - every schedule in it, run at the longest period, leaves each sensor the longest period less the largest `max |d|`
//!   between two firings.
//!
//! The second is a refire time, so the searches for stationary rings decide a region. All `|d|` lie a separation apart,
//! which bounds `max |d|` from below and so gives the least `t_delta` of a period.

use eeruf_core::Micros;
use eeruf_core::search::{Control, Found, Outcome, SearchError};
use eeruf_files::AnySchedule;
use eeruf_period::{PeriodProblem, ToSpare};

use crate::find::{NoDesign, RingDesign};
use crate::ring::RingSpec;
use crate::shortest::{Effort, FoundPeriod, SPARE_BUDGET, shortest};
use crate::uneven::OwnedUneven;

/// A `t_delta` so large that not even a second of silence between two firings would suffice.
const TOO_MUCH: Micros = Micros::from_millis(1000);

/// A region of schedules: least and greatest period and `max |d|`, in ticks.
#[derive(Clone, Copy, Debug)]
struct Region {
    periods: (u32, u32),
    changes: (u32, u32),
}

/// The search for one ring.
pub(crate) struct Moving<'s> {
    spec: &'s RingSpec,
    search: Effort,
    nodes: u64,
}

impl RingSpec {
    /// Returns the change that `t_delta` must cover with this schedule: jitter plus `2 v dt / c` for the longest `dt`
    /// between two firings.
    pub fn t_delta_needed(&self, schedule: &AnySchedule) -> Micros {
        self.t_delta_over(u64::from(schedule.max_refire().as_micros()))
    }

    /// The `t_delta` that covers jitter and the robot's motion over this many microseconds.
    fn t_delta_over(&self, us: u64) -> Micros {
        let change = 2 * u64::from(self.speed_mm_s.unwrap_or(0)) * us;
        let change = change.div_ceil(u64::from(self.c.mm_per_s()).max(1));
        self.t_delta.saturating_add(Micros::new(u32::try_from(change).unwrap_or(u32::MAX)))
    }

    /// The shortest period for a ring that moves.
    pub(crate) fn shortest_moving(&self, search: &Effort, control: &mut impl Control) -> Result<RingDesign, NoDesign> {
        Moving::new(self, *search).shortest(control)
    }

    /// Returns true if the schedule keeps all needs, with the `t_delta` for its own longest time between two firings.
    pub(crate) fn serves(&self, schedule: &AnySchedule) -> bool {
        schedule.verify(&self.covering(self.t_delta_needed(schedule)).problem().requirements).ok()
    }

    /// Returns the ring with a least refire time of `least` for every sensor.
    fn refiring_after(&self, least: Micros) -> Self {
        match &self.uneven {
            Some(uneven) => {
                let requirements = self.problem().requirements;
                let refire = (0..self.sensors).map(|x| requirements.refire_of(x).max(least)).collect();
                Self { uneven: Some(OwnedUneven { refire, ..uneven.clone() }), ..self.clone() }
            }
            None => Self { window: self.window.max(least), ..self.clone() },
        }
    }
}

impl<'s> Moving<'s> {
    pub(crate) fn new(spec: &'s RingSpec, search: Effort) -> Self {
        Self { spec, search, nodes: 0 }
    }

    /// The nodes visited so far.
    pub(crate) fn nodes(&self) -> u64 {
        self.nodes
    }

    /// Decides whether some schedule with this period, in ticks, serves.
    pub(crate) fn at(&mut self, period: u32, control: &mut impl Control) -> Result<Outcome<AnySchedule>, SearchError> {
        let end = period.saturating_add(1);
        Ok(match self.between(period, end, None, "", control)? {
            (Some(schedule), ..) => Outcome::Found(schedule),
            (None, Some(bound), _) if bound == self.time(end) => Outcome::Exhausted,
            (None, ..) => Outcome::BudgetSpent,
        })
    }

    fn shortest(mut self, control: &mut impl Control) -> Result<RingDesign, NoDesign> {
        let spec = self.spec;
        // No schedule is shorter than one for the least t_delta of any period, nor than one for the least t_delta of
        // that period, and so on.
        let mut bounding = spec.covering(self.least_t_delta(0));
        if bounding.t_delta > TOO_MUCH {
            return Err(NoDesign::TooFast);
        }
        let mut lower = self.standing(&bounding, self.search.atlas, control)?;
        while let Some(period) = lower.found.value.filter(|_| lower.found.proven) {
            let t_delta = self.least_t_delta(self.ticks(period));
            if t_delta > TOO_MUCH {
                return Err(NoDesign::TooFast);
            }
            let next = spec.covering(t_delta);
            let same = next.problem().in_ticks() == bounding.problem().in_ticks();
            bounding = next;
            if same {
                break;
            }
            lower = self.standing(&bounding, self.search.atlas, control)?;
        }
        if spec.serves(&lower.schedule) {
            lower.found.nodes = self.nodes;
            return Ok(spec.design(lower.schedule, lower, bounding));
        }
        // The preferred schedule may fire less evenly than the first that was found.
        if let Some(schedule) = lower.found.schedule.filter(|schedule| spec.serves(schedule)) {
            lower.found.nodes = self.nodes;
            return Ok(spec.design(schedule, FoundPeriod { to_spare: None, ..lower }, bounding));
        }
        let bound = lower.found.bound;
        let upper = self.climb(&lower, control)?;
        let (best, bound, reason) = if lower.found.proven {
            let least = bound.map_or(1, |bound| self.ticks(bound));
            // Without any schedule so far, one twice as long as the bound would do.
            let end = upper.map_or(least.saturating_mul(2), |schedule| self.ticks(schedule.period()));
            self.between(least, end, upper, &lower.reason, control)?
        } else {
            (upper, bound, lower.reason.clone())
        };
        let Some(schedule) = best else { return Err(NoDesign::EndedEarly) };
        let value = Some(schedule.period());
        let proven = bound == value;
        let needs = spec.covering(spec.t_delta_needed(&schedule).max(bounding.t_delta));
        let (mut schedule, mut to_spare) = (schedule, None);
        let mut certifiable = (bounding, lower.found.bound);
        if proven {
            // Most schedules are the shortest for their own t_delta too. That can be certified, and the preferred one
            // among equally short ones is known.
            let own = self.standing(&needs, "", control)?;
            if own.found.proven && own.found.value == value {
                certifiable = (needs.clone(), value);
                let as_even = |other: &AnySchedule| spec.t_delta_needed(other) <= needs.t_delta;
                if as_even(&own.schedule) {
                    (schedule, to_spare) = (own.schedule, own.to_spare);
                }
            }
            if to_spare.is_none() {
                let (preferred, spare) = self.with_most_to_spare(schedule, &needs, control)?;
                (schedule, to_spare) = (preferred, Some(spare));
            }
        }
        let (bounding, certified) = certifiable;
        let found = Found { schedule: Some(schedule), value, bound, proven, nodes: self.nodes };
        let shortest = FoundPeriod { found, schedule, reason, to_spare, from_atlas: false, certified: None };
        let design = spec.design(schedule, shortest, bounding);
        Ok(RingDesign { bound: certified, t_delta: needs.t_delta, spec: needs, ..design })
    }

    /// Returns the schedule with most to spare among those with the period of this one and no larger `t_delta`.
    pub(crate) fn with_most_to_spare(
        &self,
        schedule: AnySchedule,
        needs: &RingSpec,
        control: &mut impl Control,
    ) -> Result<(AnySchedule, ToSpare), SearchError> {
        let (preferred, spare) = needs.problem().prefer(&schedule, SPARE_BUDGET, control)?;
        if self.spec.t_delta_needed(&preferred) <= needs.t_delta {
            return Ok((preferred, spare));
        }
        // That schedule fires less evenly; among those that fire as evenly as this one, the best found counts.
        let capped = needs.refiring_after(schedule.min_refire());
        let (preferred, spare) = capped.problem().prefer(&schedule, SPARE_BUDGET, control)?;
        Ok((preferred, ToSpare { proven: [false; 3], ..spare }))
    }

    fn ticks(&self, time: Micros) -> u32 {
        time.as_micros() / self.spec.tick.as_micros().max(1)
    }

    fn time(&self, ticks: u32) -> Micros {
        Micros::new(ticks.saturating_mul(self.spec.tick.as_micros()))
    }

    /// The `t_delta` of a schedule with this period and `max |d|`.
    fn t_delta_at(&self, period: u32, change: u32) -> Micros {
        self.spec.t_delta_over((u64::from(period) + u64::from(change)) * u64::from(self.spec.tick.as_micros()))
    }

    /// The least `max |d|` of any schedule with this `t_delta`: all `|d|` lie a separation apart.
    fn least_change(&self, t_delta: Micros) -> u32 {
        let ticks = self.spec.covering(t_delta).problem().in_ticks();
        let is_first =
            |sensor: usize| ticks.together.iter().all(|group| group[0] == sensor || !group.contains(&sensor));
        // A group needs the largest separation of its sensors; one of them bounds that from below.
        let separations = || (0..ticks.sensors()).filter(|&x| is_first(x)).map(|x| ticks.separation[x]);
        let least = separations().min().unwrap_or(0);
        let apart = separations().fold(0, u32::saturating_add) - least;
        apart + if ticks.stale_echo { least.div_ceil(2) } else { 0 }
    }

    /// The least `t_delta` that any schedule with this period needs.
    fn least_t_delta(&self, period: u32) -> Micros {
        let mut t_delta = self.t_delta_at(period, 0);
        while t_delta <= TOO_MUCH {
            let further = self.t_delta_at(period, self.least_change(t_delta));
            if further == t_delta {
                break;
            }
            t_delta = further;
        }
        t_delta
    }

    fn left(&self) -> u64 {
        self.search.budget.saturating_sub(self.nodes).max(1)
    }

    /// The shortest period for a `t_delta` that does not depend on the schedule.
    fn standing(
        &mut self,
        spec: &RingSpec,
        atlas: &'static str,
        control: &mut impl Control,
    ) -> Result<FoundPeriod, SearchError> {
        let shortest = shortest(&spec.problem(), &Effort { budget: self.left(), atlas, ..self.search }, control)?;
        self.nodes += shortest.found.nodes;
        Ok(shortest)
    }

    /// Searches for a schedule that serves: each search uses the `t_delta` that the schedule found before it needs.
    fn climb(&mut self, lower: &FoundPeriod, control: &mut impl Control) -> Result<Option<AnySchedule>, SearchError> {
        let mut schedule = lower.schedule;
        while !self.spec.serves(&schedule) {
            let t_delta = self.spec.t_delta_needed(&schedule);
            if t_delta > TOO_MUCH {
                return Ok(None);
            }
            schedule = self.standing(&self.spec.covering(t_delta), "", control)?.schedule;
        }
        Ok(Some(schedule))
    }

    /// Looks for schedules with periods from `least` to below `end`, or below that of `best` if given. Returns the
    /// shortest, the bound below which there is none, and the reason.
    fn between(
        &mut self,
        least: u32,
        mut end: u32,
        mut best: Option<AnySchedule>,
        lower_reason: &str,
        control: &mut impl Control,
    ) -> Result<(Option<AnySchedule>, Option<Micros>, String), SearchError> {
        let window = self.spec.problem().in_ticks().window.into_iter().min().unwrap_or(0);
        // The region with the shortest periods is at the top.
        let mut open = vec![Region { periods: (least, u32::MAX), changes: (0, u32::MAX) }];
        while let Some(Region { periods: (first, last), changes: (low, high) }) = open.pop() {
            let last = last.min(end - 1);
            let high = high.min(last.saturating_sub(window));
            if first > last || low > high {
                continue;
            }
            let needs = self.spec.covering(self.t_delta_at(first, low).max(self.least_t_delta(first)));
            let capped = needs.refiring_after(self.time(last - high));
            let decided = self.decide(&capped.problem(), last, best.as_ref(), control)?;
            let schedule = match decided {
                Outcome::Exhausted => continue,
                Outcome::BudgetSpent => {
                    let bound = Some(self.time(first));
                    let why = "the search, which ended early: the t_delta depends on the schedule, and which of them \
                               serve is not decided; a larger budget may settle that";
                    return Ok((best, bound, why.to_owned()));
                }
                Outcome::Found(schedule) => schedule,
            };
            if self.spec.serves(&schedule) {
                (best, end) = (Some(schedule), last);
                open.push(Region { periods: (first, last), changes: (low, high) });
            } else if first < last {
                let middle = first + (last - first) / 2;
                open.push(Region { periods: (middle + 1, last), changes: (low, high) });
                open.push(Region { periods: (first, middle), changes: (low, high) });
            } else {
                // In a region with one value the schedule would have served.
                let middle = low + (high - low) / 2;
                open.push(Region { periods: (first, last), changes: (middle + 1, high) });
                open.push(Region { periods: (first, last), changes: (low, middle) });
            }
        }
        let bound = Some(self.time(end));
        let why = if end == least {
            lower_reason.to_owned()
        } else {
            format!(
                "motion: each schedule of {} and less leaves a sensor so long between two firings that good readings \
                 change by more than it can tell apart (every order was searched)",
                self.time(end.saturating_sub(1))
            )
        };
        Ok((best, bound, why))
    }

    /// Decides whether a schedule with this period meets the needs.
    fn decide(
        &mut self,
        problem: &PeriodProblem<'_>,
        period: u32,
        guide: Option<&AnySchedule>,
        control: &mut impl Control,
    ) -> Result<Outcome<AnySchedule>, SearchError> {
        let budget = self.search.budget.saturating_sub(self.nodes);
        if budget == 0 {
            return Ok(Outcome::BudgetSpent);
        }
        let (outcome, nodes) = problem.decide(self.time(period), guide, budget, control)?;
        self.nodes += nodes;
        Ok(outcome)
    }
}
