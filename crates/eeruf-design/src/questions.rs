//! Further questions: whether a schedule fits into a given period, and the cost of each need.

use eeruf_core::Micros;
use eeruf_core::search::{Control, Outcome, SearchError};
use eeruf_files::AnySchedule;

use crate::find::NoDesign;
use crate::moving::Moving;
use crate::ring::RingSpec;
use crate::shortest::Effort;

/// The `t_delta` that fits into a period, with its schedule.
#[derive(Clone, Debug)]
pub struct Fit {
    /// A schedule of that period: one that meets the ring's needs, or else the one with the largest `t_delta`.
    pub schedule: Option<AnySchedule>,
    /// The ring with the `t_delta` that the schedule needs.
    pub spec: RingSpec,
    /// The largest `t_delta` found; if sensors have their own, each grows by the same amount, and this is the largest.
    pub t_delta: Option<Micros>,
    /// Proven bound of `t_delta` with that period; `None` if none meets the other needs, or if it is unknown.
    pub bound: Option<Micros>,
    /// True if a schedule of that period meets the ring's needs; `None` if that is not decided.
    pub fits: Option<bool>,
    /// True if no schedule of that period has a larger `t_delta`.
    pub proven: bool,
    /// Nodes visited.
    pub nodes: u64,
}

/// A need that a curve varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// `t_delta`, without the part for motion.
    TDelta,
    /// Listening time.
    Range,
    /// The least time between the firings of neighbours.
    Interval,
}

/// A point of a curve: the shortest period for one value of a need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurvePoint {
    /// The need in tenths of the ring's own.
    pub tenths: u32,
    /// The value; the largest if sensors have their own.
    pub value: Micros,
    /// The shortest period found; `None` if there is no schedule, as for a robot that is too fast.
    pub period: Option<Micros>,
    /// Proven bound of the period.
    pub bound: Option<Micros>,
    /// True if no schedule is shorter, or if there is none.
    pub proven: bool,
}

/// The number of points of a curve: from a tenth of the ring's own need to twice as much.
pub const CURVE_POINTS: u32 = 20;
/// The nodes that each point of a curve may cost by default.
pub const CURVE_BUDGET: u64 = 20_000;

impl RingSpec {
    /// Decides whether a schedule of this period meets the ring's needs, and finds the largest `t_delta` that fits.
    ///
    /// # Errors
    /// [`SearchError`] for a period that is not a whole number of ticks, and as for [`shortest`](Self::shortest).
    pub fn fit(&self, period: Micros, budget: u64, control: &mut impl Control) -> Result<Fit, SearchError> {
        let ticks = self.problem().in_whole_ticks(period)?;
        let search = Effort { budget, what_if: false, atlas: "" };
        let mut fit =
            Fit { schedule: None, spec: self.clone(), t_delta: None, bound: None, fits: None, proven: false, nodes: 0 };
        let mut moving = Moving::new(self, search);
        match moving.at(ticks, control)? {
            Outcome::Found(schedule) => (fit.schedule, fit.fits) = (Some(schedule), Some(true)),
            Outcome::Exhausted => fit.fits = Some(false),
            Outcome::BudgetSpent => {}
        }
        fit.nodes = moving.nodes();
        if let Some(schedule) = fit.schedule {
            let needs = self.covering(self.t_delta_needed(&schedule));
            let (schedule, spare) = moving.with_most_to_spare(schedule, &needs, control)?;
            fit.nodes += spare.nodes;
            fit.schedule = Some(schedule);
            fit.t_delta = match self.uneven {
                Some(_) => Some(needs.t_delta.saturating_add(spare.t_delta)),
                // Rounding needs up to ticks leaves slack besides whole ticks.
                None => schedule.verify(&needs.problem().requirements).max_t_delta(),
            };
            if spare.proven[0] {
                (fit.bound, fit.proven) = (fit.t_delta, true);
            }
            fit.spec = needs;
        } else if self.uneven.is_none() {
            let left = budget.saturating_sub(fit.nodes);
            let largest = self.problem().largest_t_delta(period, left, control)?;
            (fit.schedule, fit.t_delta, fit.bound) = (largest.schedule, largest.value, largest.bound);
            (fit.proven, fit.nodes) = (largest.proven, fit.nodes + largest.nodes);
        }
        if self.handling > Micros::ZERO && fit.fits == Some(true) {
            fit.schedule = fit.schedule.and_then(|schedule| self.moved_apart(&schedule));
            fit.t_delta = fit.schedule.and_then(|apart| apart.verify(&self.problem().requirements).max_t_delta());
            // The largest among the attempts, without a proof.
            fit.proven = false;
            if fit.schedule.is_none() {
                fit.fits = None;
            }
        }
        Ok(fit)
    }

    /// Finds the shortest period for 20 values of a need, from a tenth of the ring's own to twice as much; each within
    /// `search.budget` nodes.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest).
    pub fn curve(
        &self,
        need: Need,
        search: &Effort,
        control: &mut impl Control,
    ) -> Result<Vec<CurvePoint>, SearchError> {
        let search = Effort { what_if: false, ..*search };
        let mut points: Vec<CurvePoint> = Vec::new();
        for tenths in 1..=CURVE_POINTS {
            let (spec, value) = self.with(need, tenths);
            let mut point = CurvePoint { tenths, value, period: None, bound: None, proven: false };
            match spec.shortest(&search, control) {
                Ok(design) => {
                    let found = design.found;
                    (point.period, point.bound, point.proven) = (found.value, found.bound, found.proven);
                }
                Err(NoDesign::Search(error)) => return Err(error),
                Err(none) => point.proven = none == NoDesign::TooFast,
            }
            // A period for more of a need is never shorter.
            let before = points.last().and_then(|last| last.bound);
            point.bound = point.bound.max(before);
            point.proven |= point.period.is_some() && point.period == point.bound;
            points.push(point);
        }
        Ok(points)
    }

    /// The ring with one need set to some tenths of its value, and that value.
    fn with(&self, need: Need, tenths: u32) -> (Self, Micros) {
        let part = |time: Micros| {
            let us = u64::from(time.as_micros()) * u64::from(tenths);
            Micros::new(u32::try_from(us.div_ceil(10)).unwrap_or(u32::MAX))
        };
        let mut spec = self.clone();
        let value = match need {
            Need::TDelta => {
                spec.t_delta = part(self.t_delta);
                spec.t_delta
            }
            Need::Interval => {
                spec.min_interval = part(self.min_interval);
                spec.min_interval
            }
            Need::Range => {
                spec.listening = part(self.listening);
                spec.window = spec.listening.max(self.retrigger);
                spec.listening
            }
        };
        spec.uneven = self.uneven.as_ref().map(|uneven| match need {
            Need::TDelta => uneven.with_t_deltas(part),
            Need::Interval => uneven.with_intervals(part),
            Need::Range => uneven.with_windows(part),
        });
        (spec, value)
    }
}
