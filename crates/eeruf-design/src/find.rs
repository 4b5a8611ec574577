//! The shortest period for a ring, the preferred schedule among those that have it, and changes that would make it
//! shorter.

use std::error::Error;
use std::fmt;

use eeruf_core::search::{Control, Found, SearchError};
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_files::{AnySchedule, ScheduleFile};
use eeruf_period::{ToSpare, engine::prove::NoProof};

use crate::certificate::{Stated, certify};
use crate::found::FoundJson;
use crate::ring::RingSpec;
use crate::shortest::{Effort, FoundPeriod, shortest};
use crate::what_if::WhatIf;

/// Number of larger separations that are tried if firings cannot be moved apart.
const HANDLING_STEPS: u32 = 8;
/// Budget of nodes, times the square of the number of sensors, for the certificate of an answer, so that it takes
/// no longer than the search.
const CERTIFICATE_BUDGET: usize = 4_000 * 16 * 16;

/// A schedule for a ring file.
#[derive(Clone, Debug)]
pub struct RingDesign {
    /// The schedule.
    pub schedule: AnySchedule,
    /// The change that `t_delta` has to cover, including motion.
    pub t_delta: Micros,
    /// The ring, with the design's `t_delta`.
    pub spec: RingSpec,
    /// The shortest period, or the best found.
    pub found: Found<MAX_SENSORS>,
    /// The ring with a `t_delta` for which `bound` holds: the least that any schedule needs at that period, or the
    /// design's own; for a stationary robot, the ring itself.
    pub bounding: RingSpec,
    /// The bound on the period of every schedule for `bounding`: what a certificate can state.
    pub bound: Option<Micros>,
    /// Reason why the period is not shorter, in words.
    pub reason: String,
    /// Slack of the schedule, if the period is proven: no other schedule with this period has more.
    pub to_spare: Option<ToSpare>,
    /// True if period and schedule come from the atlas, without a search.
    pub from_atlas: bool,
    /// Bound of the period by the certificate of the atlas's row; see [`certified`](Self::certified).
    pub(crate) known_certified: Option<Micros>,
    /// Changes that would shorten the period, if requested.
    pub what_if: Vec<WhatIf>,
}

/// Reason why a ring gets no design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoDesign {
    /// The needs are invalid, or too large to search.
    Search(SearchError),
    /// Longer periods need more separation, which needs longer periods, without end.
    TooFast,
    /// The budget or the caller ended the search before its proof, and the best schedule is too slow for the speed.
    EndedEarly,
    /// No attempt kept the firings of the shortest period apart by `handling_us`.
    Handling,
}

impl fmt::Display for NoDesign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Search(error) => return error.fmt(f),
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

impl Error for NoDesign {}

impl From<SearchError> for NoDesign {
    fn from(error: SearchError) -> Self {
        Self::Search(error)
    }
}

impl RingDesign {
    /// The gains from relaxing one need at a time; empty if the period is not proven.
    ///
    /// # Errors
    /// As for [`RingSpec::shortest`].
    pub fn what_if(&self, control: &mut impl Control) -> Result<Vec<WhatIf>, SearchError> {
        if self.found.proven { self.spec.what_if(control) } else { Ok(Vec::new()) }
    }

    /// The text of the design's [certificate](certify).
    ///
    /// # Errors
    /// As for [`certify`].
    pub fn prove(&self, budget: usize, go_on: impl FnMut(usize) -> bool) -> Result<String, NoProof> {
        certify(&self.bounding.problem(), &self.schedule, self.bound, budget, go_on)
    }

    /// The bound that a certificate of a few thousand nodes proves, if the period is proven: the period itself if so
    /// small a proof suffices.
    pub fn certified(&self) -> Option<Micros> {
        let proof = || {
            let budget = CERTIFICATE_BUDGET / self.spec.sensors.max(16).pow(2);
            let stated = Stated::read(&self.prove(budget, |_| true).ok()?)?;
            u32::try_from(stated.micros(stated.bound)).ok().map(Micros::new)
        };
        self.found.proven.then(|| self.known_certified.or_else(proof)).flatten()
    }

    /// The answer as `--json` prints it.
    pub fn json(&self, seconds: f64) -> FoundJson {
        FoundJson {
            schedule: Some(ScheduleFile::from(&self.schedule)),
            reason: Some(self.reason.clone()),
            from_atlas: Some(self.from_atlas),
            certified_us: self.certified().map(Micros::as_micros),
            ..FoundJson::new(&self.found, seconds)
        }
    }
}

impl RingSpec {
    /// Finds the shortest period, and the preferred schedule with it.
    ///
    /// # Errors
    /// The reason why there is no design.
    pub fn shortest(&self, search: &Effort, control: &mut impl Control) -> Result<RingDesign, NoDesign> {
        let mut design = self.shortest_at_once(search, control)?;
        if self.handling > Micros::ZERO {
            design = self.one_by_one(design, search, control)?;
        }
        if search.what_if {
            design.what_if = design.what_if(control)?;
        }
        Ok(design)
    }

    /// The design for a controller that fires any number of sensors at once; see [`shortest`](Self::shortest).
    fn shortest_at_once(&self, search: &Effort, control: &mut impl Control) -> Result<RingDesign, NoDesign> {
        match self.speed_mm_s {
            None | Some(0) => self.shortest_at_rest(search, control),
            Some(_) => self.shortest_moving(search, control),
        }
    }

    /// The design for a controller that fires one sensor after the other: firings are moved apart. If the shortest
    /// period has no room for that, longer ones with more separation are tried.
    fn one_by_one(
        &self,
        at_once: RingDesign,
        search: &Effort,
        control: &mut impl Control,
    ) -> Result<RingDesign, NoDesign> {
        // Bounds that are proven without handling hold with it.
        let (bound, bounding) = (at_once.bound, at_once.bounding.clone());
        let step = Micros::new(self.handling.as_micros().div_ceil(2));
        let mut design = at_once;
        let mut wider = self.clone();
        for _ in 0..HANDLING_STEPS {
            if let Some(apart) = self.moved_apart(&design.schedule) {
                let t_delta = self.t_delta_needed(&apart).max(design.bounding.t_delta);
                (design.spec, design.t_delta) = (self.covering(t_delta), t_delta);
                // The slack was that of the schedule before the move.
                if apart != design.schedule {
                    (design.schedule, design.to_spare) = (apart, None);
                }
                return Ok(design);
            }
            wider = wider.covering(wider.t_delta.saturating_add(step));
            design = wider.shortest_at_once(&Effort { atlas: "", ..*search }, control)?;
            (design.bound, design.found.bound, design.found.proven) = (bound, bound, false);
            design.bounding = bounding.clone();
            design.reason = format!(
                "handling: firings are to be {} apart, and no shorter period with room for it was found",
                self.handling
            );
        }
        Err(NoDesign::Handling)
    }

    fn shortest_at_rest(&self, search: &Effort, control: &mut impl Control) -> Result<RingDesign, NoDesign> {
        let shortest = shortest(&self.problem(), search, control)?;
        Ok(self.design(shortest.schedule, shortest, self.clone()))
    }

    /// The design with a schedule that serves this ring at its own `t_delta`.
    pub(crate) fn design(&self, schedule: AnySchedule, shortest: FoundPeriod, bounding: Self) -> RingDesign {
        let FoundPeriod { found, reason, to_spare, from_atlas, certified, .. } = shortest;
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
            to_spare,
            from_atlas,
            known_certified: certified,
            what_if: Vec::new(),
        }
    }
}
