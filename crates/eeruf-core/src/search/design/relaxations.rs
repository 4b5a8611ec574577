//! Which of the needs to relax: what one tick less of each would do to the period.

use core::fmt;

use super::decide::decide;
use super::problem::{Problem, check_period};
use crate::search::common::{Control, Outcome, ProblemError};

/// What one tick less of one need would do to the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// A shorter period is possible.
    Shorter,
    /// The period stays.
    None,
    /// Neither found within the budget.
    Unknown,
}

/// Which of the needs is the one to relax: see [`relaxations`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Relaxations {
    /// A separation one tick smaller.
    pub separation: Effect,
    /// An interval one tick shorter.
    pub interval: Effect,
    /// A window one tick shorter.
    pub window: Effect,
    /// Nodes visited.
    pub nodes: u64,
}

impl fmt::Display for Relaxations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = [("separation", self.separation), ("interval", self.interval), ("window", self.window)];
        let mut first = true;
        for (effect, words) in [
            (Effect::Shorter, "one tick less of it allows a shorter period"),
            (Effect::None, "one tick less of it changes nothing"),
            (Effect::Unknown, "what one tick less of it does was not found out"),
        ] {
            for (need, _) in all.iter().filter(|(_, is)| *is == effect) {
                write!(f, "{}{need}: {words}", if first { "" } else { "; " })?;
                first = false;
            }
        }
        Ok(())
    }
}

/// For each need, whether one tick less of it allows a period below `period`, with `budget` nodes each.
///
/// # Errors
/// As for [`decide`].
pub fn relaxations<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Relaxations, ProblemError> {
    let mut nodes = 0;
    let mut effect = |relaxed: Problem<'_>, possible: bool| {
        if !possible || period <= 1 {
            return Ok(Effect::None);
        }
        let decided = decide(&relaxed, period - 1, budget, memory, control)?;
        nodes += decided.nodes;
        Ok(match decided.outcome {
            Outcome::Found(_) => Effect::Shorter,
            Outcome::Exhausted => Effect::None,
            Outcome::BudgetSpent => Effect::Unknown,
        })
    };
    check_period(period)?;
    problem.check()?;
    let less = |value: u32| value.saturating_sub(1);
    let separation =
        effect(Problem { separation: less(problem.separation).max(1), ..*problem }, problem.separation > 1)?;
    let interval = effect(Problem { interval: less(problem.interval), ..*problem }, problem.interval > 0)?;
    let window = effect(Problem { window: less(problem.window), ..*problem }, problem.window > 0)?;
    Ok(Relaxations { separation, interval, window, nodes })
}
