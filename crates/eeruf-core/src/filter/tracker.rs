//! [`Tracker`]: compares the echoes of one firing with those of the firing before, and classifies the reading.

use super::agreement::Agreement;
use super::echoes::{NO_ECHO, echo_time, shift};
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::time::Micros;

/// The age of a sensor none of whose readings was ever accepted.
const NEVER: u16 = u16::MAX;

/// The echoes of one sensor's last firing: eight bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Tracker<const E: usize> {
    /// The echoes of the firing before, earliest first; [`NO_ECHO`] stands for silence where its run is not zero.
    known: [u32; E],
    /// The number of consecutive readings that each of them was in, at most as many as must agree; 0 for no echo.
    runs: [u8; E],
    /// For the owner: the ring keeps its flags in this byte, which would otherwise be padding.
    pub(crate) flags: u8,
    /// Firings since the last accepted reading.
    age: u16,
}

impl<const E: usize> Tracker<E> {
    pub(crate) const fn new(flags: u8) -> Self {
        Self { known: [NO_ECHO; E], runs: [0; E], flags, age: NEVER }
    }

    pub(crate) fn forget(&mut self) {
        self.known = [NO_ECHO; E];
        self.runs = [0; E];
    }

    /// The firing of the known echoes was this much later than they were measured from; negative for earlier.
    pub(crate) fn shift(&mut self, later_us: i32) {
        if !shift(&mut self.known, later_us) {
            self.forget();
        }
    }

    /// A firing that says nothing about the echo time: all runs end, and the age grows.
    pub(crate) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>) -> Verdict {
        self.forget();
        self.verdict(kind, t_echo, None, None)
    }

    /// Compares the echoes of one firing, earliest first, with those of the firing before. `explanation` is asked about
    /// each pair of near-identical echoes, the earlier firing's first: a pair that foreign sound explains does not
    /// count, and its echo starts a new run.
    pub(crate) fn push(
        &mut self,
        agreement: Agreement,
        echoes: &[u32; E],
        expected_change_us: i32,
        mut explanation: impl FnMut(u32, u32) -> Option<Explanation>,
    ) -> Verdict {
        let before = core::mem::replace(&mut self.known, *echoes);
        let runs = core::mem::replace(&mut self.runs, [0; E]);
        let earliest = echoes.first().copied().unwrap_or(NO_ECHO);
        let earliest_before = before.first().copied().and_then(echo_time);
        let most = agreement.consecutive();

        // Silence counts as an echo of its own, later than all others.
        let silent = earliest == NO_ECHO;
        let heard = echoes.iter().copied().enumerate().take_while(|&(place, echo)| echo != NO_ECHO || place == 0);
        // The earliest that is confirmed, or else the earliest that repeats.
        let mut best = (1, earliest, earliest_before);
        let mut ambiguous = None;
        for ((_, echo), now) in heard.zip(&mut self.runs) {
            *now = 1;
            for (&previous, run) in before.iter().zip(runs).take_while(|&(_, run)| run != 0) {
                if !agreement.near_identical(echo, previous, expected_change_us) {
                    continue;
                }
                if echo != NO_ECHO {
                    if let Some(explained_by) = explanation(previous, echo) {
                        ambiguous = ambiguous.or(Some((echo, previous, explained_by)));
                        continue;
                    }
                }
                *now = (*now).max(run.saturating_add(1).min(most));
                if best.0 == 1 || (*now == most && best.0 != most) {
                    best = (*now, echo, echo_time(previous));
                }
            }
        }
        let kind = match (best.0, ambiguous) {
            (run, _) if run == most && silent => ReadingKind::Clear,
            (run, _) if run == most => ReadingKind::Accepted,
            _ if silent => ReadingKind::NoEcho,
            (1, Some((echo, previous, by))) => {
                return self.verdict(ReadingKind::Ambiguous, echo_time(echo), echo_time(previous), Some(by));
            }
            _ if earliest_before.is_none() => ReadingKind::First,
            (1, None) => ReadingKind::Rejected,
            _ => ReadingKind::Repeated,
        };
        self.verdict(kind, echo_time(best.1), best.2, None)
    }

    fn verdict(
        &mut self,
        kind: ReadingKind,
        t_echo: Option<Micros>,
        previous: Option<Micros>,
        explained_by: Option<Explanation>,
    ) -> Verdict {
        self.age = match kind {
            ReadingKind::Accepted => 0,
            _ if self.age >= NEVER - 1 => self.age,
            _ => self.age + 1,
        };
        Verdict { kind, t_echo, previous, age: self.age(), explained_by }
    }

    pub(crate) fn age(&self) -> Option<u16> {
        (self.age != NEVER).then_some(self.age)
    }
}
