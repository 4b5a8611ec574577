//! Finds the smallest feasible level of an objective, and proves that the level below is infeasible.
//!
//! What is feasible at a level is feasible at any larger one, so that bisection is exact. Levels may take long to
//! decide, so budgets grow from round to round.

use super::super::bounds;
use super::super::construct::constructed;
use super::super::problem::CheckedProblem;
use super::{Bisection, Bracket, Objective, Probe, Query};
use crate::search::common::{Control, Outcome};

impl<C: Control> Bisection<'_, C> {
    /// Narrows the bracket until no level is left between, or the budget is spent.
    pub(crate) fn minimize(&mut self, bracket: &mut Bracket<'_>) {
        let budget = self.gallop(bracket);
        self.bisect(budget, bracket);
    }

    /// Narrows a bracket on the period in coarse ticks, each of which is `ticks` of the bracket's, and leaves the best
    /// firing times found. Returns a budget for the queries in fine ticks. At most half of all nodes that are left go
    /// into this.
    pub(crate) fn minimize_in_coarse_ticks(
        &mut self,
        coarse: &CheckedProblem,
        ticks: i32,
        bracket: &mut Bracket<'_>,
    ) -> u64 {
        let (limit, start) = (self.meter.limit, self.meter.nodes);
        self.meter.limit = start + limit.saturating_sub(start) / 2;
        (self.meter.ticks, self.meter.bound) = (ticks as u32, bracket.infeasible as u32 + 1);
        let firing = constructed(coarse);
        let feasible = firing.period(coarse);
        let query = Query { problem: *coarse, period: feasible };
        // No coarse period below the fine bound, rounded up.
        let infeasible = bracket.infeasible / ticks;
        let mut found =
            Bracket { query: &query, objective: Objective::Period, infeasible, feasible, firing, searched: false };
        self.minimize(&mut found);
        (bracket.firing, bracket.searched) = (found.firing.in_fine_ticks(ticks as u32), found.searched);
        (self.meter.limit, self.meter.ticks) = (limit, 1);
        (16 * coarse.sensors as u64).max((self.meter.nodes - start) / 4)
    }

    /// Starts just above the infeasible level, as bounds are often met, and goes up in growing steps until something is
    /// found; a few times with growing budgets, since a far easier level is not far easier to find. Returns the last
    /// budget.
    fn gallop(&mut self, bracket: &mut Bracket<'_>) -> u64 {
        let mut budget = 16 * bracket.query.problem.sensors as u64;
        let first = ((bracket.feasible - bracket.infeasible) >> 8).max(1);
        for _ in 0..6 {
            let (mut step, mut level) = (first, bracket.infeasible + 1);
            for budget in [4 * budget, budget, budget, budget, budget, budget] {
                if level >= bracket.feasible || !self.meter.may_go_on() || self.finds(level, budget, bracket) {
                    return budget;
                }
                level = level.max(bracket.infeasible) + step;
                step *= 2;
            }
            budget *= 2;
        }
        budget
    }

    /// Closes the bracket. The level just below the best decides all: it is feasible, or nothing better is. In turns
    /// with growing budgets this tries to prove that it is infeasible, and to find something better by bisection. When
    /// the budget is nearly spent on that, the rest goes into the bound.
    pub(crate) fn bisect(&mut self, budget: u64, bracket: &mut Bracket<'_>) {
        let mut budget = budget;
        loop {
            let rest = self.meter.limit.saturating_sub(self.meter.nodes);
            if bracket.infeasible + 1 >= bracket.feasible || !self.meter.may_go_on() {
                return;
            }
            let most = rest - rest / 4;
            let outcome = self.probe_level(bracket.feasible - 1, (4 * budget).min(most), true, bracket);
            if outcome == Outcome::BudgetSpent && most <= 4 * budget {
                break;
            }
            // The tightest level leaves the least to guess, so it comes first; then bisection.
            let mut unknown = bracket.infeasible;
            let mut level = bracket.infeasible + 1;
            while unknown + 1 < bracket.feasible && self.meter.may_go_on() {
                if !self.finds(level, budget, bracket) {
                    unknown = level;
                }
                level = unknown + (bracket.feasible - unknown) / 2;
            }
            budget *= 4;
        }
        self.raise_bound(bracket);
    }

    /// Proves as many levels infeasible as the rest of the budget allows.
    fn raise_bound(&mut self, bracket: &mut Bracket<'_>) {
        let mut unknown = bracket.feasible - 1;
        let budget = self.meter.limit.saturating_sub(self.meter.nodes) / 8;
        while bracket.infeasible + 1 < unknown && self.meter.may_go_on() {
            let level = bracket.infeasible + (unknown - bracket.infeasible) / 2;
            if self.probe_level(level, budget, true, bracket) != Outcome::Exhausted {
                unknown = level.min(bracket.feasible - 1);
            }
        }
    }

    /// Returns true if a schedule is found at the level with few nodes.
    pub(crate) fn finds(&mut self, level: i32, budget: u64, bracket: &mut Bracket<'_>) -> bool {
        self.probe_level(level, budget, false, bracket).is_found()
    }

    /// Decides one level and moves the bracket accordingly.
    fn probe_level(&mut self, level: i32, budget: u64, thorough: bool, bracket: &mut Bracket<'_>) -> Outcome {
        if !self.meter.may_go_on() {
            return Outcome::BudgetSpent;
        }
        let objective = bracket.objective;
        let query = bracket.query.at(objective, level);
        // Along the period the bracket already starts at the bound.
        let excluded =
            objective != Objective::Period && bounds::strongest(&query.problem).period() as i32 > query.period;
        let outcome = if excluded {
            Outcome::Exhausted
        } else {
            let guide = (bracket.searched || !thorough).then_some(bracket.firing);
            self.probe(&Probe { query, budget, guide, thorough })
        };
        match &outcome {
            Outcome::Found(firing) => {
                bracket.firing = *firing;
                bracket.searched = true;
                bracket.feasible = query.level_of(objective, firing).max(bracket.infeasible + 1).min(level);
            }
            Outcome::Exhausted => bracket.infeasible = bracket.infeasible.max(level),
            Outcome::BudgetSpent => {}
        }
        if objective == Objective::Period {
            self.meter.best = bracket.feasible as u32 * self.meter.ticks;
            // That there is no schedule in coarse ticks does not exclude one in fine ticks.
            if self.meter.ticks == 1 {
                self.meter.bound = bracket.infeasible as u32 + 1;
            }
        }
        match outcome {
            Outcome::Found(_) => Outcome::Found(()),
            Outcome::Exhausted => Outcome::Exhausted,
            Outcome::BudgetSpent => Outcome::BudgetSpent,
        }
    }
}
