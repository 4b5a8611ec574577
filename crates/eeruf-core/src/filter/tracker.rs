//! [`Tracker`]: compares the echoes of one firing with those of the previous firing, and classifies the reading.

use super::agreement::{Consecutive, Tolerance};
use super::echoes::{NO_ECHO, echo_time, shift};
use crate::judging::Explained;
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::time::Micros;

/// The age of a sensor that has never had a reading accepted.
const NEVER: u16 = u16::MAX;

/// The echoes of one sensor's last firing; eight bytes for a sensor that reports one echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Tracker<const E: usize> {
    /// The echoes of the previous firing, earliest first; [`NO_ECHO`] means silence if its run is not zero.
    known: [Micros; E],
    /// For each known echo, the number of consecutive readings that contained it, capped at the number that must agree;
    /// 0 for none.
    runs: [u8; E],
    /// Firings since the last accepted reading.
    age: u16,
}

impl<const E: usize> Tracker<E> {
    pub(crate) const NEW: Self = Self { known: [NO_ECHO; E], runs: [0; E], age: NEVER };

    pub(crate) fn forget(&mut self) {
        self.known = [NO_ECHO; E];
        self.runs = [0; E];
    }

    /// Moves the origin of the known echoes by this much; negative for earlier.
    pub(crate) fn shift(&mut self, later_us: i32) {
        if !shift(&mut self.known, later_us) {
            self.forget();
        }
    }

    /// Records a firing without information about the echo time: all runs end, and the age grows.
    pub(crate) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>) -> Verdict {
        self.forget();
        self.verdict(kind, t_echo, None, None)
    }

    /// Compares the echoes of one firing, earliest first, with those of the previous firing. `explanation` is asked
    /// about each pair of near-identical echoes, the earlier firing's first: a pair that foreign sound explains does
    /// not count, and its echo starts a new run.
    pub(crate) fn push(
        &mut self,
        tolerance: Tolerance,
        echoes: &[Micros],
        expected_change_us: i32,
        mut explanation: impl FnMut(Micros, Micros) -> Explained,
    ) -> Verdict {
        let latest = core::array::from_fn(|place| echoes.get(place).copied().unwrap_or(NO_ECHO));
        let before = core::mem::replace(&mut self.known, latest);
        let runs = core::mem::replace(&mut self.runs, [0; E]);
        let most = tolerance.consecutive();
        let earliest = latest.first().copied().unwrap_or(NO_ECHO);
        let silent = earliest == NO_ECHO;
        // Prefer the earliest confirmed echo, then the earliest that repeats, then the first that foreign sound
        // explains, then the earliest.
        let (mut best_run, mut best, mut matched) = (1, earliest, before.first().copied().unwrap_or(NO_ECHO));
        let mut explained_by = None;
        for (place, (&echo, now)) in latest.iter().zip(&mut self.runs).enumerate() {
            // Silence counts as an echo of its own, later than all others.
            if echo == NO_ECHO && place > 0 {
                break;
            }
            *now = 1;
            for (&previous, &run) in before.iter().zip(&runs) {
                if run == 0 {
                    break;
                }
                if !tolerance.near_identical(echo, previous, expected_change_us) {
                    continue;
                }
                if echo != NO_ECHO {
                    if let Explained::By(by) = explanation(previous, echo) {
                        if best_run == 1 && explained_by.is_none() {
                            (best, matched, explained_by) = (echo, previous, Some(by));
                        }
                        continue;
                    }
                }
                *now = (*now).max(run.saturating_add(1).min(most));
                if best_run == 1 || (*now == most && best_run != most) {
                    (best_run, best, matched, explained_by) = (*now, echo, previous, None);
                }
            }
        }
        let kind = if best_run == most {
            if silent { ReadingKind::Clear } else { ReadingKind::Accepted }
        } else if silent {
            ReadingKind::NoEcho
        } else if explained_by.is_some() {
            ReadingKind::Ambiguous
        } else if matched == NO_ECHO {
            ReadingKind::First
        } else if best_run == 1 {
            ReadingKind::Rejected
        } else {
            ReadingKind::Repeated
        };
        self.verdict(kind, echo_time(best), echo_time(matched), explained_by)
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

    /// Returns true if the required number of consecutive firings heard nothing.
    pub(crate) fn is_clear(&self, consecutive: Consecutive) -> bool {
        self.is_silent() && self.runs.first() == Some(&consecutive.get())
    }

    /// Returns true if the last firing heard nothing, or nothing is known.
    pub(crate) fn is_silent(&self) -> bool {
        self.known.first() == Some(&NO_ECHO)
    }

    pub(crate) fn age(&self) -> Option<u16> {
        (self.age != NEVER).then_some(self.age)
    }
}
