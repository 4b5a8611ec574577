//! The alternatives of a decision: which comes next, what it adds to the state, and how that is withdrawn.

use super::super::symmetry::Sorting;
use super::branching::sequence;
use super::decision::{Branch, Decision};
use super::difference_bounds::Conflict;
use super::state::State;

impl State<'_, '_> {
    /// Moves to the decision's next alternative, if there is one.
    pub(super) fn advance(&mut self, decision: &mut Decision) -> bool {
        match decision.branch {
            Branch::Order => {
                if decision.tried == 2 {
                    return false;
                }
                if decision.tried == 1 {
                    (decision.x, decision.y) = (decision.y, decision.x);
                }
                decision.tried += 1;
                true
            }
            Branch::Value => {
                decision.tried += 1;
                decision.tried <= 3
            }
            Branch::Top | Branch::Rank => {
                let Some((x, negative)) = self.pick(decision) else {
                    return false;
                };
                (decision.x, decision.y, decision.tried) = (x, u8::from(negative), 1);
                if negative {
                    decision.negative &= !(1 << x);
                } else {
                    decision.positive &= !(1 << x);
                }
                true
            }
        }
    }

    /// Adds what the decision's present alternative says.
    pub(super) fn apply(&mut self, decision: &Decision) -> Result<(), Conflict> {
        let x = usize::from(decision.x);
        match decision.branch {
            Branch::Order => self.differences.add_bound(x, usize::from(decision.y), -self.problem.interval),
            Branch::Value => {
                let (low, high) = (decision.positive as i32, decision.negative as i32);
                let middle = low + (high - low) / 2;
                let (low, high) = match decision.tried {
                    1 => (low, low),
                    2 => (low + 1, middle.max(low + 1)),
                    _ => (middle.max(low + 1) + 1, high),
                };
                self.bound_size(x, low, high)
            }
            Branch::Top | Branch::Rank => {
                self.ranks.push(decision.x, decision.y == 1);
                if decision.branch == Branch::Top {
                    self.sequence = sequence(self.problem, x);
                    let sorting = Sorting::new(self.problem, x);
                    for (x, y) in sorting.pairs() {
                        self.differences.add_bound(self.node(x, 0), self.node(y, 0), 0)?;
                    }
                    let last = self.problem.sensors as i32 - 1;
                    return self.bound_size(x, self.problem.least + last * self.problem.separation, self.widest);
                }
                self.bound_size(x, self.problem.least, self.widest)
            }
        }
    }

    /// Takes back what [`apply`](Self::apply) stored outside the difference bounds.
    pub(super) fn retract(&mut self, decision: &Decision) {
        if matches!(decision.branch, Branch::Top | Branch::Rank) {
            self.ranks.pop();
        }
    }
}
