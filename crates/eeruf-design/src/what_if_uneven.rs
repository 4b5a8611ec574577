//! Changes that would shorten the period of an uneven ring: one need of all sensors relaxed at a time.

use eeruf_core::Micros;
use eeruf_core::search::{Control, SearchError};

use crate::find::{WhatIf, less};
use crate::find_uneven::shortest_uneven;
use crate::ring::RingSpec;
use crate::ticks::in_ticks;

/// Number of nodes it may cost to find out what one need, relaxed, would bring.
const WHAT_IF_BUDGET: u64 = 20_000;

impl RingSpec {
    /// Relaxes one need after the other: of all sensors by a tenth, or a tick if that is more; and shared
    /// lines.
    pub(crate) fn what_if_uneven(&self, control: &mut impl Control) -> Result<Vec<WhatIf>, SearchError> {
        let cases = self.relaxed();
        let answer = |(need, relaxed): (String, Self)| {
            let (found, _) = shortest_uneven(&relaxed.problem(), WHAT_IF_BUDGET, control)?;
            Ok(WhatIf { need, period: found.value, proven: found.proven })
        };
        cases.into_iter().map(answer).collect()
    }

    /// The ring with one need relaxed, and which.
    fn relaxed(&self) -> Vec<(String, Self)> {
        let Some(uneven) = &self.uneven else { return Vec::new() };
        let less = |time: Micros| less(time, self.tick);
        let all = |times: &[Micros]| times.iter().map(|time| less(*time)).collect::<Vec<_>>();
        let needed = in_ticks(&self.problem());
        let mut cases = Vec::new();
        let mut add = |need: &str, relaxed: Self| {
            if in_ticks(&relaxed.problem()) != needed {
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
        let mut closer = uneven.clone();
        closer.t_delta = uneven.t_delta.iter().map(|t_delta| nearer(*t_delta)).collect();
        add("every t_delta a tenth less", Self { t_delta: nearer(self.t_delta), uneven: Some(closer), ..self.clone() });
        if let Some(uneven) = uneven.with_lines_of_their_own() {
            add("an echo line for each sensor", Self { uneven: Some(uneven), ..self.clone() });
        }
        cases
    }
}
