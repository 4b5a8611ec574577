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

/// The number of larger separations that are tried where firings cannot be moved apart.
const HANDLING_STEPS: u32 = 8;
/// Number of nodes it may cost to find out what one need, relaxed, would bring.
const WHAT_IF_BUDGET: u64 = 20_000;

/// A schedule for a ring file.
#[derive(Clone, Debug)]
pub struct RingDesign {
    /// The schedule.
    pub schedule: AnySchedule,
    /// The change that `t_delta` has to cover, motion included.
    pub t_delta: Micros,
    /// The ring, with that `t_delta`.
    pub spec: RingSpec,
    /// The shortest period, or the best found.
    pub found: Found<MAX_SENSORS>,
    /// The ring with a `t_delta` for which `bound` holds: the least that any schedule needs at that period, or the
    /// design's own; the ring itself if it stands.
    pub bounding: RingSpec,
    /// The bound on the period of every schedule for `bounding`: what a certificate can state.
    pub bound: Option<Micros>,
    /// Why it is not shorter, in words.
    pub reason: String,
    /// The choice among the schedules of that period, if the period is proven and all sensors are alike.
    pub preferred: Option<Preferred<MAX_SENSORS>>,
    /// Slack of a schedule for a ring whose sensors are not alike, if the period is proven: of those with this period
    /// it has the most.
    pub to_spare: Option<ToSpare>,
    /// True if period and schedule are the atlas's, and nothing was searched.
    pub from_atlas: bool,
    /// Changes that would shorten it, if they were asked for.
    pub what_if: Vec<WhatIf>,
}

/// Why a robot that moves gets no schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSchedule {
    /// Longer periods ask for more separation, and that for longer periods, without end.
    TooFast,
    /// The budget or the caller ended the search before its proof, and what it had found is too slow for the speed.
    EndedEarly,
    /// No way that was tried keeps firings of the shortest period apart by `handling_us`.
    Handling,
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
            Self::Handling => {
                "no schedule: none of the ways that were tried to keep all firings apart by handling_us meets the \
                 rest, in the shortest period without it; expected a shorter handling_us or a larger t_delta_us, \
                 which leaves more room"
            }
        })
    }
}

impl Error for NoSchedule {}

/// The gain from relaxing one need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WhatIf {
    /// The relaxed need, in words.
    pub need: String,
    /// The shortest period with it, or the shortest found.
    pub period: Option<Micros>,
    /// True if no schedule with it is shorter.
    pub proven: bool,
}

impl RingDesign {
    /// The gain from relaxing one need; nothing where the period is not proven.
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
    /// # Errors
    /// [`SearchError`] for needs that make no sense or are too large to search.
    pub fn shortest(
        &self,
        search: &Search,
        control: &mut impl Control,
    ) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
        let mut design = match self.shortest_at_once(search, control)? {
            Ok(design) => design,
            Err(none) => return Ok(Err(none)),
        };
        if self.handling > Micros::ZERO {
            design = match self.one_by_one(design, search, control)? {
                Ok(design) => design,
                Err(none) => return Ok(Err(none)),
            };
        }
        if search.what_if {
            design.what_if = design.what_if(control)?;
        }
        Ok(Ok(design))
    }

    /// As [`shortest`](Self::shortest), for a controller that fires any number of sensors at once.
    fn shortest_at_once(
        &self,
        search: &Search,
        control: &mut impl Control,
    ) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
        match self.speed_mm_s {
            None | Some(0) => self.shortest_at_rest(search, control),
            Some(_) => self.shortest_moving(search, control),
        }
    }

    /// The design for a controller that fires one sensor after the other: firings are moved apart. Where the shortest
    /// period has no room for that, the next ones are taken that have more separation.
    fn one_by_one(
        &self,
        at_once: RingDesign,
        search: &Search,
        control: &mut impl Control,
    ) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
        // What is proven without handling holds with it.
        let (bound, bounding) = (at_once.bound, at_once.bounding.clone());
        let step = Micros::new(self.handling.as_micros().div_ceil(2));
        let mut design = at_once;
        let mut wider = self.clone();
        for _ in 0..HANDLING_STEPS {
            if let Some(apart) = self.moved_apart(&design.schedule) {
                let t_delta = self.t_delta_needed(&apart).max(design.bounding.t_delta);
                (design.spec, design.t_delta) = (self.covering(t_delta), t_delta);
                // Chosen for what it had to spare before.
                if apart != design.schedule {
                    (design.schedule, design.preferred, design.to_spare) = (apart, None, None);
                }
                return Ok(Ok(design));
            }
            wider = wider.covering(wider.t_delta.saturating_add(step));
            design = match wider.shortest_at_once(&Search { atlas: "", ..*search }, control)? {
                Ok(design) => design,
                Err(none) => return Ok(Err(none)),
            };
            (design.bound, design.found.bound, design.found.proven) = (bound, bound, false);
            design.bounding = bounding.clone();
            design.reason = format!(
                "handling: firings are to be {} apart, and no shorter period with room for it was found",
                self.handling
            );
        }
        Ok(Err(NoSchedule::Handling))
    }

    fn shortest_at_rest(
        &self,
        search: &Search,
        control: &mut impl Control,
    ) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
        let shortest = shortest(&self.problem(), search, control)?;
        let Some(schedule) = shortest.schedule() else { return Ok(Err(NoSchedule::EndedEarly)) };
        Ok(Ok(self.design(schedule, shortest, self.clone())))
    }

    /// The design of a schedule that serves this ring at its own `t_delta`.
    pub(crate) fn design(&self, schedule: AnySchedule, shortest: Shortest, bounding: Self) -> RingDesign {
        let Shortest { found, reason, preferred, to_spare, from_atlas } = shortest;
        let t_delta = self.t_delta_needed(&schedule).max(bounding.t_delta);
        let spec = self.covering(t_delta);
        RingDesign {
            schedule,
            t_delta,
            spec,
            bound: found.bound,
            bounding,
            found,
            reason,
            preferred,
            to_spare,
            from_atlas,
            what_if: Vec::new(),
        }
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
