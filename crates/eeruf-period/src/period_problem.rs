//! The question in microseconds, and its answers.

use eeruf_core::search::{Control, Found, Outcome, Progress, SearchError};
use eeruf_core::{Criterion, MAX_PERIOD, MAX_SENSORS, Micros, Phase, Requirements, Schedule, Uneven};

use crate::engine::search::{Decided, FiringTimes, Search};
use crate::engine::shortest::MAX_TICKS;
use crate::engine::shortest::{Shortest, SoFar, shortest};
use crate::engine::spare::{Spare, most_to_spare};
use crate::engine::{Claim, Problem};
use crate::reason::reason;

/// Needs of a ring whose firing times are free: every sensor fires once per period, at any tick.
///
/// ```
/// use eeruf_core::{Micros, Requirements};
/// use eeruf_period::PeriodProblem;
///
/// let requirements = Requirements {
///     min_interval: Micros::from_millis(15),
///     window: Micros::from_millis(30),
///     ..Requirements::new(Micros::new(999))
/// };
/// let problem = PeriodProblem { sensors: 12, requirements, tick: Micros::from_millis(1) };
/// let shortest = problem.shortest(u64::MAX, &mut ())?;
/// assert_eq!(shortest.period(), Micros::from_millis(65));
/// assert!(shortest.proven() && shortest.schedule.verify(&requirements).ok());
/// # Ok::<(), eeruf_core::search::SearchError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PeriodProblem<'a> {
    /// The number of sensors, 1 to 64.
    pub sensors: usize,
    /// Requirements on the schedule, under [`Criterion::Exact`].
    pub requirements: Requirements<'a>,
    /// Unit of time: all firing times and the period are multiples of it.
    pub tick: Micros,
}

/// The shortest period for a ring, or the best found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShortestPeriod {
    /// A schedule with the shortest period found.
    pub schedule: Schedule<MAX_SENSORS>,
    /// Proven bound of the period.
    pub bound: Micros,
    /// Nodes visited: the same on each machine.
    pub nodes: u64,
    /// Reason why the period is not shorter, in words that say which need to relax.
    pub reason: String,
}

impl ShortestPeriod {
    /// The period.
    #[must_use]
    pub const fn period(&self) -> Micros {
        self.schedule.period()
    }

    /// True if no schedule has a shorter period.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.bound == self.period()
    }

    /// Returns the result in the form of any search.
    #[must_use]
    pub fn found(&self) -> Found<MAX_SENSORS> {
        Found {
            schedule: Some(self.schedule),
            value: Some(self.period()),
            bound: Some(self.bound),
            proven: self.proven(),
            nodes: self.nodes,
        }
    }
}

/// Slack of a schedule beyond its needs, the same for all sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToSpare {
    /// Possible growth of every `t_delta`.
    pub t_delta: Micros,
    /// Possible growth of every interval, and time between firings on a shared line, once every `t_delta` has grown.
    pub interval: Micros,
    /// Possible growth of every refire time, once both of these have grown.
    pub refire: Micros,
    /// True if no schedule of this period has more to spare.
    pub proven: [bool; 3],
    /// Nodes visited for the choice.
    pub nodes: u64,
}

impl PeriodProblem<'_> {
    /// The shortest period, proven unless `budget` nodes are spent first; then the shortest found.
    ///
    /// There is always a schedule, since firing one by one meets all needs except those of sensors that fire together.
    ///
    /// # Errors
    /// [`SearchError`] for needs that are invalid or too large to search.
    pub fn shortest(&self, budget: u64, control: &mut impl Control) -> Result<ShortestPeriod, SearchError> {
        let ticks = self.checked()?;
        let mut go_on = |so_far: &SoFar| {
            control.poll(&Progress::new(so_far.nodes, Some(so_far.best), Some(so_far.bound))).is_continue()
        };
        let too_long = || SearchError::TooManyTicks { period: one_by_one(&ticks), most: MAX_TICKS };
        let answer = shortest(&ticks, budget, &mut go_on).ok_or_else(too_long)?;
        Ok(ShortestPeriod {
            schedule: self.schedule(answer.period, &answer.fire)?,
            bound: self.time(answer.bound),
            nodes: answer.nodes,
            reason: self.reason_of(&ticks, &answer),
        })
    }

    /// Returns the reason why no schedule is shorter than this one, which is proven shortest.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest).
    pub fn why_shortest(&self, schedule: &Schedule<MAX_SENSORS>) -> Result<String, SearchError> {
        let ticks = self.checked()?;
        let Claim { period, fire, .. } = self.claim(schedule, None);
        let known = Shortest { period, fire, bound: period, nodes: 0, without_cases: false };
        Ok(self.reason_of(&ticks, &known))
    }

    /// Decides whether some schedule has this period, within `budget` nodes, and counts the nodes visited. Short
    /// descents follow `guide`, a schedule with another period.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest), and if the period is not a whole number of ticks.
    pub fn decide(
        &self,
        period: Micros,
        guide: Option<&Schedule<MAX_SENSORS>>,
        budget: u64,
        control: &mut impl Control,
    ) -> Result<(Outcome<Schedule<MAX_SENSORS>>, u64), SearchError> {
        let (ticks, period) = (self.checked()?, self.in_whole_ticks(period)?);
        let guide = guide.map(|schedule| self.claim(schedule, None).fire);
        let mut search = Search::new(&ticks);
        let mut go_on = |nodes| control.poll(&Progress::new(nodes, None, Some(period))).is_continue();
        let mut effort = 8 * search.depth();
        let outcome = loop {
            let left = budget.saturating_sub(search.nodes());
            let mut decided = search.decide(period, effort.min(left), &mut go_on);
            if decided == Decided::Open {
                let left = budget.saturating_sub(search.nodes());
                decided = search.find(period, (effort / 2).min(left), effort, guide.as_ref(), &mut go_on);
            }
            match decided {
                Decided::Found(fire) => break Outcome::Found(self.schedule(period, &fire)?),
                Decided::Refuted => break Outcome::Exhausted,
                Decided::Stopped => break Outcome::BudgetSpent,
                Decided::Open if search.nodes() >= budget => break Outcome::BudgetSpent,
                Decided::Open => effort *= 2,
            }
        };
        Ok((outcome, search.nodes()))
    }

    /// Finds, among the schedules with the period of this one, the one with most to spare: the largest `t_delta`; of
    /// these, the largest intervals; of these, the longest times before a sensor fires again. Each need grows by the
    /// same amount for all sensors; earlier needs have priority. If `budget` ends before the proof, the result is the
    /// best found.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest).
    pub fn prefer(
        &self,
        schedule: &Schedule<MAX_SENSORS>,
        budget: u64,
        control: &mut impl Control,
    ) -> Result<(Schedule<MAX_SENSORS>, ToSpare), SearchError> {
        let claim = self.claim(schedule, Some(schedule.period()));
        let period = claim.period;
        let mut go_on = |nodes| control.poll(&Progress::new(nodes, Some(period), Some(period))).is_continue();
        let spare = most_to_spare(&claim.problem, period, claim.fire, budget, &mut go_on);
        Ok((self.schedule(period, &spare.fire)?, self.slack(&spare)))
    }

    /// The largest `t_delta` at a given period; the requirements' own is ignored. The schedule is the
    /// [preferred](Self::prefer) one.
    ///
    /// # Errors
    /// As for [`decide`](Self::decide).
    pub fn largest_t_delta(
        &self,
        period: Micros,
        budget: u64,
        control: &mut impl Control,
    ) -> Result<Found<MAX_SENSORS>, SearchError> {
        let uneven = self.requirements.uneven.map(|uneven| Uneven { t_delta: &[], ..uneven });
        let requirements = Requirements { t_delta: Micros::ZERO, uneven, ..self.requirements };
        let least = PeriodProblem { requirements, ..*self };
        let (outcome, nodes) = least.decide(period, None, budget, control)?;
        let none = Found { schedule: None, value: None, bound: None, proven: false, nodes };
        let schedule = match outcome {
            Outcome::Found(schedule) => schedule,
            Outcome::Exhausted => return Ok(Found { proven: true, ..none }),
            Outcome::BudgetSpent => return Ok(Found { bound: Some(period), ..none }),
        };
        let (schedule, spare) = least.prefer(&schedule, budget.saturating_sub(nodes), control)?;
        let value = schedule.verify(&requirements).max_t_delta();
        let [proven, ..] = spare.proven;
        let bound = if proven { value } else { Some(period) };
        Ok(Found { schedule: Some(schedule), value, bound, proven, nodes: nodes + spare.nodes })
    }

    /// The slack of this schedule, without a search for one that has more.
    #[must_use]
    pub fn spare_of(&self, schedule: &Schedule<MAX_SENSORS>) -> ToSpare {
        let claim = self.claim(schedule, None);
        self.slack(&most_to_spare(&claim.problem, claim.period, claim.fire, 0, &mut |_| true))
    }

    /// The problem in whole ticks: the separation of a sensor is the smallest number of ticks above twice its
    /// `t_delta`; windows and gaps are rounded up. A tick of 0 counts as a microsecond.
    #[must_use]
    pub fn in_ticks(&self) -> Problem {
        let Self { sensors, requirements, .. } = *self;
        let tick_us = self.tick_us();
        let ticks = |time: Micros| time.as_micros().div_ceil(tick_us);
        let separation = |sensor| {
            let twice = 2 * u64::from(requirements.t_delta_of(sensor).as_micros());
            u32::try_from(twice / u64::from(tick_us) + 1).unwrap_or(u32::MAX)
        };
        let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
        let refire = |x| ticks(requirements.window_of(x).max(requirements.refire_of(x))).max(1);
        let gap = |x, y| ticks(requirements.gap_after(sensors, x, y));
        let gaps = pairs.map(|(x, y)| (x, y, gap(x, y), gap(y, x)));
        let together = requirements.uneven.map_or(&[][..], |uneven| uneven.together);
        let members = |set: &u64| (0..sensors).filter(|sensor| set >> sensor & 1 == 1).collect();
        Problem {
            tick_us: (tick_us, 1),
            separation: (0..sensors).map(separation).collect(),
            // A certificate's window is the time until a sensor may fire again; listening times are in the gaps.
            window: (0..sensors).map(refire).collect(),
            stale_echo: requirements.stale_echo,
            together: together.iter().map(members).collect(),
            gaps: gaps.filter(|&(.., after_x, after_y)| after_x > 0 || after_y > 0).collect(),
        }
    }

    /// The claim of a certificate that the schedule keeps the needs, and that no period is below `bound`.
    #[must_use]
    pub fn claim(&self, schedule: &Schedule<MAX_SENSORS>, bound: Option<Micros>) -> Claim {
        let ticks = |time: Micros| time.as_micros() / self.tick_us();
        let fire = [Phase::A, Phase::B].map(|phase| {
            (0..self.sensors).map(|sensor| ticks(schedule.t_fire(phase, sensor).unwrap_or_default())).collect()
        });
        let period = ticks(schedule.period());
        // There is no bound below one tick.
        Claim { problem: self.in_ticks(), period, fire, bound: ticks(bound.unwrap_or_default()).max(1) }
    }

    /// The problem in ticks, if it is valid and one of its schedules can be stated.
    fn checked(&self) -> Result<Problem, SearchError> {
        if self.requirements.criterion == Criterion::Paper {
            return Err(SearchError::PaperCriterion);
        }
        if self.tick == Micros::ZERO {
            return Err(SearchError::NoTick);
        }
        if !(1..=MAX_SENSORS).contains(&self.sensors) {
            return Err(SearchError::Sensors(self.sensors));
        }
        self.requirements.layout.check(self.sensors)?;
        let most = u64::from(MAX_PERIOD.as_micros());
        let finest = one_by_one(&PeriodProblem { tick: Micros::new(1), ..*self }.in_ticks());
        if finest > most {
            return Err(SearchError::TooLong { period_us: finest });
        }
        let ticks = self.in_ticks();
        let period_us = one_by_one(&ticks).saturating_mul(u64::from(self.tick_us()));
        if period_us > most {
            return Err(SearchError::CoarseTick { tick: self.tick, period_us });
        }
        Ok(ticks)
    }

    /// A period in ticks.
    ///
    /// # Errors
    /// [`SearchError`] if the period is not a whole number of ticks, is zero, or is too long to search.
    pub fn in_whole_ticks(&self, period: Micros) -> Result<u32, SearchError> {
        if self.tick == Micros::ZERO {
            return Err(SearchError::NoTick);
        }
        if !period.as_micros().is_multiple_of(self.tick_us()) {
            return Err(SearchError::OffGrid { what: "the period", time: period, tick: self.tick });
        }
        let ticks = period.as_micros() / self.tick_us();
        if (1..=MAX_TICKS).contains(&ticks) {
            Ok(ticks)
        } else {
            Err(SearchError::Period { period: ticks, most: MAX_TICKS })
        }
    }

    fn tick_us(&self) -> u32 {
        self.tick.as_micros().max(1)
    }

    fn time(&self, ticks: u32) -> Micros {
        Micros::new(ticks.saturating_mul(self.tick_us()))
    }

    /// A schedule from firing times in ticks.
    fn schedule(&self, period: u32, fire: &FiringTimes) -> Result<Schedule<MAX_SENSORS>, SearchError> {
        let [a, b] = fire.each_ref().map(|times| times.iter().map(|&ticks| self.time(ticks)).collect::<Vec<_>>());
        let lags = vec![Micros::ZERO; self.sensors];
        Schedule::from_slices(self.time(period), &lags, [&a, &b]).map_err(SearchError::Schedule)
    }

    fn slack(&self, spare: &Spare) -> ToSpare {
        let [separation, interval, refire] = spare.more.map(|ticks| self.time(ticks));
        // The separation covers twice the t_delta.
        let t_delta = Micros::new(separation.as_micros() / 2);
        ToSpare { t_delta, interval, refire, proven: spare.proven, nodes: spare.nodes }
    }

    fn reason_of(&self, ticks: &Problem, answer: &Shortest) -> String {
        reason(ticks, answer, &|ticks| self.time(ticks))
    }
}

/// A period, in ticks, at which firing one by one meets all needs.
fn one_by_one(problem: &Problem) -> u64 {
    let longest = |times: &[u32]| times.iter().map(|&time| u64::from(time)).max().unwrap_or(0);
    let gap = problem.gaps.iter().map(|&(.., x, y)| u64::from(x.max(y))).max().unwrap_or(0);
    longest(&problem.window) + problem.sensors() as u64 * (gap + longest(&problem.separation))
}
