//! Changes that would shorten the period: one need of all sensors relaxed at a time.

use eeruf_core::search::{Control, SearchError};
use eeruf_core::{Layout, Micros, Requirements};
use eeruf_period::PeriodProblem;

use crate::ring::RingSpec;
use crate::uneven::OwnedUneven;

/// Budget of nodes for the search with one relaxed need.
const WHAT_IF_BUDGET: u64 = 20_000;

/// The gain from relaxing one need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WhatIf {
    /// The relaxed need, in words.
    pub need: String,
    /// The shortest period with this change, or the shortest found.
    pub period: Option<Micros>,
    /// True if no schedule with this change is shorter.
    pub proven: bool,
}

impl WhatIf {
    fn of(need: String, relaxed: &PeriodProblem<'_>, control: &mut impl Control) -> Result<Self, SearchError> {
        let found = relaxed.shortest(WHAT_IF_BUDGET, control)?;
        Ok(Self { need, period: Some(found.period()), proven: found.proven() })
    }
}

impl RingSpec {
    /// Relaxes one need after the other.
    pub(crate) fn what_if(&self, control: &mut impl Control) -> Result<Vec<WhatIf>, SearchError> {
        if self.uneven.is_some() {
            let cases = self.relaxed().into_iter();
            return cases.map(|(need, ring)| WhatIf::of(need, &ring.problem(), control)).collect();
        }
        let problem = self.problem();
        let cases = relaxed_alike(&problem).into_iter();
        cases
            .map(|(need, requirements)| WhatIf::of(need, &PeriodProblem { requirements, ..problem }, control))
            .collect()
    }

    /// The uneven ring with one need relaxed, and its name: a need of all sensors reduced by a tenth (at least a tick),
    /// or no shared lines.
    fn relaxed(&self) -> Vec<(String, Self)> {
        let Some(uneven) = &self.uneven else { return Vec::new() };
        let less = |time: Micros| less(time, self.tick);
        let all = |times: &[Micros]| times.iter().map(|time| less(*time)).collect::<Vec<_>>();
        let needed = self.problem().in_ticks();
        let mut cases = Vec::new();
        let mut add = |need: &str, relaxed: Self| {
            if relaxed.problem().in_ticks() != needed {
                cases.push((need.to_owned(), relaxed));
            }
        };
        let intervals = uneven.with_intervals(less);
        add(
            "every interval a tenth less",
            Self { min_interval: less(self.min_interval), uneven: Some(intervals), ..self.clone() },
        );
        let mut sooner = uneven.clone();
        (sooner.window, sooner.refire) = (all(&uneven.window), all(&uneven.refire));
        add(
            "every sensor listening a tenth less, and triggered again as much sooner",
            Self { window: less(self.window), uneven: Some(sooner), ..self.clone() },
        );
        // The separation is more than twice the t_delta.
        let nearer = |t_delta: Micros| {
            let separation = Micros::new(t_delta.as_micros().saturating_mul(2).saturating_add(1));
            Micros::new(less(separation).as_micros().saturating_sub(1) / 2)
        };
        let closer = uneven.with_t_deltas(nearer);
        add("every t_delta a tenth less", Self { t_delta: nearer(self.t_delta), uneven: Some(closer), ..self.clone() });
        if !uneven.shared_lines.is_empty() {
            let uneven = OwnedUneven { shared_lines: vec![], ..uneven.clone() };
            add("an echo line for each sensor", Self { uneven: Some(uneven), ..self.clone() });
        }
        cases
    }
}

/// The value reduced by a tenth, at least by a tick, in whole ticks.
fn less(time: Micros, tick: Micros) -> Micros {
    let (us, tick) = (time.as_micros(), tick.as_micros().max(1));
    Micros::new((us - us / 10).min(us.saturating_sub(1)) / tick * tick)
}

/// The needs of identical sensors with one relaxed, and its name: reduced by a tenth (at least a tick), or by one
/// neighbour.
fn relaxed_alike<'r>(problem: &PeriodProblem<'r>) -> Vec<(String, Requirements<'r>)> {
    let Requirements { t_delta, min_interval, window, layout, .. } = problem.requirements;
    // In whole ticks, since other times are rounded up to them.
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
    cases
}
