//! Outcomes found on other threads, for a bisection that searches nothing itself: see
//! [`speculation`](super::super::speculation).

use std::vec::Vec;

use super::super::firing::Firing;
use super::meter::Meter;
use super::query::Probe;
use crate::search::common::{Outcome, Progress};

/// Outcomes that are known, and probes whose outcome is not known yet.
pub(crate) struct Replay {
    pub(crate) known: Vec<Known>,
    pub(crate) missing: Vec<Probe>,
    /// So many missing outcomes end a replay.
    pub(crate) most: usize,
    /// How far the bisection was at the first missing outcome.
    pub(crate) progress: Option<Progress>,
}

/// The outcome of a probe.
pub(crate) struct Known {
    pub(crate) probe: Probe,
    pub(crate) outcome: Outcome<Firing>,
    pub(crate) nodes: u64,
}

impl Replay {
    /// The outcome if it is known, and otherwise the most likely one.
    pub(super) fn outcome<C>(&mut self, probe: &Probe, meter: &mut Meter<'_, C>) -> Outcome<Firing> {
        let known = self.known.iter().find(|known| known.probe == *probe);
        let (outcome, nodes) = match known {
            Some(known) => (known.outcome, known.nodes),
            None => {
                if self.progress.is_none() {
                    self.progress = Some(meter.progress());
                }
                self.missing.push(*probe);
                meter.stopped |= self.missing.len() >= self.most;
                (Outcome::BudgetSpent, if meter.stopped { 0 } else { probe.budget })
            }
        };
        // The budget may end within the probe.
        let rest = meter.limit.saturating_sub(meter.nodes);
        meter.nodes += nodes.min(rest);
        if nodes > rest { Outcome::BudgetSpent } else { outcome }
    }
}
