//! The shortest period for a ring, the schedule to prefer of those that have it, and what would make it shorter.

use std::error::Error;
use std::fmt;

use eeruf_core::search::{Control, Found, PeriodProblem, Preferred, SearchError, design};
use eeruf_core::{Layout, MAX_SENSORS, Micros, Requirements};
use eeruf_sim::{AnySchedule, ScheduleFile};

use crate::find_uneven::ToSpare;
use crate::found::FoundJson;
use crate::ring::RingSpec;
use crate::shortest::{Search, Shortest, shortest};

/// How many nodes it may cost to find out what one need, relaxed, would bring.
const WHAT_IF_BUDGET: u64 = 20_000;

/// A schedule for a ring file.
#[derive(Clone, Debug)]
pub struct RingDesign {
    /// The schedule.
    pub schedule: AnySchedule,
    /// What `t_delta` has to cover, motion included.
    pub t_delta: Micros,
    /// The ring, with that `t_delta`.
    pub spec: RingSpec,
    /// The shortest period, or the best found.
    pub found: Found<MAX_SENSORS>,
    /// Why it is not shorter, in words.
    pub reason: String,
    /// What is known of the choice among the schedules of that period, if the period is proven and all sensors are
    /// alike.
    pub preferred: Option<Preferred<MAX_SENSORS>>,
    /// What the schedule of a ring whose sensors are not alike has to spare, if the period is proven: of those with
    /// this period it is the one with most.
    pub to_spare: Option<ToSpare>,
    /// Whether period and schedule are the atlas's, and nothing was searched.
    pub from_atlas: bool,
    /// What would be shorter, if it was asked for.
    pub what_if: Vec<WhatIf>,
}

/// Why a robot that moves gets no schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSchedule {
    /// Longer periods ask for more separation, and that for longer periods, without end.
    TooFast,
    /// The budget or the caller ended the search before its proof, and what it had found is too slow for the speed.
    EndedEarly,
}

impl fmt::Display for NoSchedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooFast => {
                "no schedule: good readings change more from period to period, the more sensors at this speed must be \
                 kept apart; expected fewer sensors or a lower speed_m_s"
            }
            Self::EndedEarly => {
                "no schedule yet: the search ended before its proof, and what it had found is too slow for this speed; \
                 expected a larger budget or time limit"
            }
        })
    }
}

impl Error for NoSchedule {}

/// What one need, relaxed, would bring.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WhatIf {
    /// The relaxed need, in words.
    pub need: String,
    /// The shortest period with it, or the shortest found.
    pub period: Option<Micros>,
    /// Whether no schedule with it is shorter.
    pub proven: bool,
}

impl RingDesign {
    /// What one need, relaxed, would bring; nothing where the period is not proven.
    ///
    /// # Errors
    /// As for [`RingSpec::shortest`].
    pub fn what_if(&self, control: &mut impl Control) -> Result<Vec<WhatIf>, SearchError> {
        match &self.spec.uneven {
            _ if !self.found.proven => Ok(Vec::new()),
            Some(_) => self.spec.what_if_uneven(control),
            None => what_if(&self.spec.problem(), control),
        }
    }

    /// The answer as `--json` prints it.
    pub fn json(&self, seconds: f64) -> FoundJson {
        FoundJson {
            schedule: Some(ScheduleFile::from(&self.schedule)),
            reason: Some(self.reason.clone()),
            from_atlas: Some(self.from_atlas),
            spare_us: self.to_spare.map(|spare| spare.in_us()),
            spare_proven: self.to_spare.map(|spare| spare.proven),
            ..FoundJson::new(&self.found, seconds)
        }
    }
}

impl RingSpec {
    /// Finds the shortest period, and the preferred schedule with it; or why there is none.
    ///
    /// If `t_delta` must cover motion, it depends on the period, and the period on it: longer periods need a larger
    /// `t_delta`, which needs longer periods. Starting from a robot that stands, this climbs to the first pair that
    /// agrees.
    ///
    /// # Errors
    /// [`SearchError`] for needs that make no sense or are too large to search.
    pub fn shortest(
        &self,
        search: &Search,
        control: &mut impl Control,
    ) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
        let mut t_delta = self.t_delta;
        // The bound and the reason of the first step without a proof. From there on t_delta is that of a schedule that
        // may be longer than necessary, so what is proven with it is not proven of the ring.
        let mut unproven: Option<(Option<Micros>, String)> = None;
        loop {
            let spec = self.covering(t_delta);
            let problem = spec.problem();
            let asked = Search { atlas: if unproven.is_none() { search.atlas } else { "" }, ..*search };
            let shortest = shortest(&problem, &asked, control)?;
            let chosen = shortest.schedule();
            let Shortest { mut found, mut reason, mut preferred, mut to_spare, from_atlas } = shortest;
            if !found.proven && unproven.is_none() {
                unproven = Some((found.bound, reason.clone()));
            } else if let Some((bound, why)) = &unproven {
                (found.proven, found.bound, reason, preferred) = (false, *bound, why.clone(), None);
                to_spare = None;
            }
            let none = if found.proven { NoSchedule::TooFast } else { NoSchedule::EndedEarly };
            let Some(schedule) = chosen else {
                return Ok(Err(none));
            };
            let needed = self.t_delta_needed(&schedule);
            if schedule.verify(&self.covering(needed).problem().requirements).ok() {
                let t_delta = needed.max(t_delta);
                let spec = self.covering(t_delta);
                let mut design = RingDesign {
                    schedule,
                    t_delta,
                    spec,
                    found,
                    reason,
                    preferred,
                    to_spare,
                    from_atlas,
                    what_if: Vec::new(),
                };
                if search.what_if {
                    design.what_if = design.what_if(control)?;
                }
                return Ok(Ok(design));
            }
            // Past this point a second of silence would not be enough either.
            if needed > Micros::from_millis(1000) {
                return Ok(Err(none));
            }
            t_delta = needed;
        }
    }

    /// What `t_delta` must cover with this schedule: jitter, and `2 v dt / c` for the longest `dt` between two firings.
    pub fn t_delta_needed(&self, schedule: &AnySchedule) -> Micros {
        let speed = u64::from(self.speed_mm_s.unwrap_or(0));
        let change = 2 * speed * u64::from(schedule.max_refire().as_micros());
        let change = change.div_ceil(u64::from(self.c.mm_per_s()).max(1));
        self.t_delta.saturating_add(Micros::new(u32::try_from(change).unwrap_or(u32::MAX)))
    }
}

/// A tenth less, or a tick if that is more, in whole ticks.
pub(crate) fn less(time: Micros, tick: Micros) -> Micros {
    let (us, tick) = (time.as_micros(), tick.as_micros().max(1));
    Micros::new((us - us / 10).min(us.saturating_sub(1)) / tick * tick)
}

/// Relaxes one need after the other by a tenth, or by one tick if that is more, or by one neighbour.
fn what_if(problem: &PeriodProblem<'_>, control: &mut impl Control) -> Result<Vec<WhatIf>, SearchError> {
    let mut memory = vec![0; design::memory_words(problem.sensors)];
    let Requirements { t_delta, min_interval, window, layout, .. } = problem.requirements;
    // In whole ticks, as others are rounded up to them.
    let less = |time: Micros| less(time, problem.tick);
    let (shorter, listening) = (less(min_interval), less(window));
    let separation = less(problem.requirements.separation()).as_micros();
    let nearer = Micros::new(separation.saturating_sub(1) / 2);
    let mut cases = Vec::new();
    if shorter < min_interval {
        let relaxed = Requirements { min_interval: shorter, ..problem.requirements };
        cases.push((format!("{shorter} instead of {min_interval} between neighbours"), relaxed));
    }
    if nearer < t_delta {
        cases.push((
            format!("t_delta of {nearer} instead of {t_delta}"),
            Requirements { t_delta: nearer, ..problem.requirements },
        ));
    }
    if Micros::ZERO < listening && listening < window {
        let relaxed = Requirements { window: listening, ..problem.requirements };
        cases.push((format!("listening for {listening} instead of {window}"), relaxed));
    }
    let fewer = match layout {
        Layout::Line(n) if n > 1 => Some((n, Layout::Line(n - 1))),
        Layout::Ring(n) if n > 1 => Some((n, Layout::Ring(n - 1))),
        _ => None,
    };
    if let Some((n, layout)) = fewer {
        cases.push((
            format!("any {} instead of {n} adjacent sensors apart", n - 1),
            Requirements { layout, ..problem.requirements },
        ));
    }
    let answer = |(need, requirements)| {
        let relaxed = PeriodProblem { requirements, ..*problem };
        let found = relaxed.shortest::<MAX_SENSORS>(WHAT_IF_BUDGET, &mut memory, control)?.found;
        Ok(WhatIf { need, period: found.value, proven: found.proven })
    };
    cases.into_iter().map(answer).collect()
}
