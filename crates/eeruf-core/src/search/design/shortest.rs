//! The shortest period, why it is not shorter, and what would have to give way.

use core::fmt;

use super::bounds;
use super::control::Control;
use super::hunt::{Axis, Border, Hunt, Question};
use super::problem::{Needs, Problem, ProblemError};
use super::reason::Reason;
use super::schedule::{self, Firing};
use super::tree::Outcome;
use super::{MAX_TICKS, check_memory};

/// The shortest period found, with its proof or lower bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Shortest {
    /// Firing times that serve at `period`.
    pub firing: Firing,
    /// The shortest period found, in ticks.
    pub period: u32,
    /// No schedule has a shorter period than this, in ticks.
    pub bound: u32,
    /// Nodes visited.
    pub nodes: u64,
    /// Why it is not shorter.
    pub reason: Reason,
}

impl Shortest {
    /// Whether no shorter period exists.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.bound == self.period
    }
}

/// What a search of one period came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::large_enum_variant, reason = "there is no allocator to box it with, and one exists at a time")]
pub enum Answer {
    /// A schedule.
    Found(Firing),
    /// There is none: all were searched, or counting excludes them.
    Exhausted,
    /// Neither found nor excluded within the budget.
    BudgetSpent,
}

/// An [`Answer`] and what it cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decision {
    /// What came out.
    pub answer: Answer,
    /// Nodes visited.
    pub nodes: u64,
}

/// Whether there is a schedule with a period of `period` ticks, within `budget` nodes.
///
/// # Errors
/// If the problem makes no sense, the period is 0 or too long, or the memory is smaller than [`memory_words`](super::memory_words).
pub fn decide<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Decision, ProblemError> {
    let needs = problem.needs()?;
    let memory = check_memory(memory, needs.sensors)?;
    let period = check_period(period)?;
    if period < bounds::largest(&needs).period() as i32 {
        return Ok(Decision { answer: Answer::Exhausted, nodes: 0 });
    }
    let mut hunt = Hunt::new(memory, control, budget);
    let answer = match hunt.settle(&Question { needs, period }, budget) {
        Outcome::Found(firing) => Answer::Found(firing),
        Outcome::Exhausted => Answer::Exhausted,
        Outcome::Spent => Answer::BudgetSpent,
    };
    Ok(Decision { answer, nodes: hunt.meter.nodes })
}

pub(crate) fn check_period(period: u32) -> Result<i32, ProblemError> {
    if period == 0 || period > MAX_TICKS { Err(ProblemError::Period(period)) } else { Ok(period as i32) }
}

/// The shortest period, within `budget` nodes.
///
/// If the budget ends first, the shortest found so far comes back with the bound proven so far. There is always a schedule: firing one by
/// one. The answer depends on nothing but the problem and the budget.
///
/// # Errors
/// If the problem makes no sense, or the memory is smaller than [`memory_words`](super::memory_words).
pub fn shortest<C: Control>(
    problem: &Problem<'_>,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Shortest, ProblemError> {
    let needs = problem.needs()?;
    let memory = check_memory(memory, needs.sensors)?;
    let mut hunt = Hunt::new(memory, control, budget);
    Ok(shortest_period(&needs, &mut hunt))
}

/// In fine ticks the same problem is solved in coarse ones first, if all times are multiples of one: a schedule in coarse ticks is one in fine
/// ticks as well, and hardly ever is there a better one. That is then all that remains to be proven.
pub(crate) fn shortest_period<C: Control>(needs: &Needs, hunt: &mut Hunt<'_, C>) -> Shortest {
    let counted = bounds::largest(needs);
    let firing = schedule::one_by_one(needs);
    let mut border = Border { no: counted.period() as i32 - 1, yes: firing.period(needs), firing, guide: false };
    let question = Question { needs: *needs, period: border.yes };
    match needs.in_coarse_ticks() {
        None => hunt.narrow(&question, Axis::Period, &mut border),
        Some((coarse, ticks)) => {
            // A bound between two coarse ticks may be met, and then coarse ticks have no part in it.
            let least = border.no + 1;
            let between = least % ticks > 0;
            if !(between && hunt.finds(&question, Axis::Period, least, 64 * needs.sensors as u64, &mut border)) {
                let budget = hunt.narrow_in_coarse_ticks(&coarse, ticks, &mut border);
                // As it is ticks that were multiplied, the times may serve at a shorter period still.
                border.yes = border.firing.period(needs).max(border.no + 1);
                hunt.close(&question, Axis::Period, budget, &mut border);
            }
        }
    }
    let (period, bound) = (border.yes as u32, border.no as u32 + 1);
    let reason = if bound < period {
        Reason::BudgetSpent { bound }
    } else if period == counted.period() {
        Reason::Bound(counted)
    } else {
        Reason::Exhausted { period: period - 1, counted }
    };
    Shortest { firing: border.firing, period, bound, nodes: hunt.meter.nodes, reason }
}

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
        let decision = decide(&relaxed, period - 1, budget, memory, control)?;
        nodes += decision.nodes;
        Ok(match decision.answer {
            Answer::Found(_) => Effect::Shorter,
            Answer::Exhausted => Effect::None,
            Answer::BudgetSpent => Effect::Unknown,
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
