//! Adaptive scheduling (end of Sec. 3.1): fire more slowly where too much is rejected, and faster again when it is
//! calm.

use core::fmt;

use crate::conditions::Requirements;
use crate::reading::{ReadingKind, Tally};
use crate::ring::PeriodStats;
use crate::schedule::Schedule;
use crate::sound::SpeedOfSound;
use crate::time::Micros;
use crate::verify::Violation;

/// Schedules for one ring, from the shortest period to the longest, each verified against the same requirements.
#[derive(Clone, Copy, Debug)]
pub struct Ladder<'s, const K: usize> {
    rungs: &'s [Schedule<K>],
    t_delta: Micros,
}

impl<'s, const K: usize> Ladder<'s, K> {
    /// Verifies all rungs.
    ///
    /// # Errors
    /// [`LadderError`] if there is no rung, if a period is not longer than the one before, if the number of sensors
    /// changes, or if a rung does not meet the requirements.
    pub fn new(rungs: &'s [Schedule<K>], requirements: &Requirements<'_>) -> Result<Self, LadderError> {
        let Some(first) = rungs.first() else { return Err(LadderError::Empty) };
        let mut before: Option<&Schedule<K>> = None;
        for (rung, schedule) in rungs.iter().enumerate() {
            if schedule.sensors() != first.sensors() {
                let (sensors, expected) = (schedule.sensors(), first.sensors());
                return Err(LadderError::Sensors { rung, sensors, expected });
            }
            if let Some(before) = before {
                if schedule.period() <= before.period() {
                    return Err(LadderError::Order { rung, period: schedule.period(), before: before.period() });
                }
            }
            if let Some(violation) = schedule.verify(requirements).violations().next() {
                return Err(LadderError::Unverified { rung, violation });
            }
            before = Some(schedule);
        }
        Ok(Self { rungs, t_delta: requirements.t_delta })
    }
}

/// Watches the rejection rate over windows of some periods, and says when to change to another schedule of a
/// [`Ladder`].
///
/// One noisy window moves one rung up, to a longer period; only several calm windows running move one rung down. Feed
/// it the [`PeriodStats`] of a [`Ring`](crate::Ring) that began with the shortest period, and hand what it returns to
/// [`Ring::change_schedule`](crate::Ring::change_schedule).
#[derive(Clone, Debug)]
pub struct Adaptation<'s, const K: usize> {
    ladder: Ladder<'s, K>,
    rung: usize,
    /// Above this rejection rate, in thousandths, it fires more slowly. Default: 300, a choice of ours; the paper names
    /// none.
    pub noisy_permille: u16,
    /// Up to this rejection rate, in thousandths, a window is calm. Default: 100.
    pub calm_permille: u16,
    /// The number of periods in a window. Default: 16; 0 counts as 1.
    pub window: u8,
    /// How many calm windows running it takes to fire faster. Default: 4; 0 counts as 1.
    pub patience: u8,
    periods: u8,
    calm_windows: u8,
    tally: Tally<u16>,
    rejection_permille: Option<u16>,
}

/// What [`Adaptation`] makes of the present schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Advice {
    /// The rung in use, 0 for the shortest period.
    pub rung: usize,
    /// The rejection rate of the last whole window, in thousandths; `None` before, or if nothing was compared in it.
    pub rejection_permille: Option<u16>,
    /// The fastest motion, in mm/s, at which good readings still pass (see [`Schedule::max_speed_mm_s`]).
    pub max_speed_mm_s: u32,
}

impl<'s, const K: usize> Adaptation<'s, K> {
    /// Starts on the lowest rung, the shortest period.
    pub fn new(ladder: Ladder<'s, K>) -> Self {
        Self {
            ladder,
            rung: 0,
            noisy_permille: 300,
            calm_permille: 100,
            window: 16,
            patience: 4,
            periods: 0,
            calm_windows: 0,
            tally: Tally::default(),
            rejection_permille: None,
        }
    }

    /// Takes in one period, and returns the schedule to change to when the present one should be left.
    pub fn observe(&mut self, stats: &PeriodStats) -> Option<&'s Schedule<K>> {
        for kind in [ReadingKind::Accepted, ReadingKind::Rejected, ReadingKind::Repeated] {
            for _ in 0..stats.tally.of(kind) {
                self.tally.count(kind);
            }
        }
        self.periods = self.periods.saturating_add(1);
        if self.periods < self.window {
            return None;
        }
        self.periods = 0;
        self.rejection_permille = core::mem::take(&mut self.tally).rejection_permille();
        let rung = self.next_rung();
        if rung == self.rung {
            return None;
        }
        self.rung = rung;
        self.calm_windows = 0;
        self.ladder.rungs.get(rung)
    }

    /// The rung for the window that has just ended. A window in which nothing was compared is neither noisy nor calm.
    fn next_rung(&mut self) -> usize {
        match self.rejection_permille {
            Some(rate) if rate > self.noisy_permille => {
                self.calm_windows = 0;
                (self.rung + 1).min(self.ladder.rungs.len() - 1)
            }
            Some(rate) if rate <= self.calm_permille => {
                self.calm_windows = self.calm_windows.saturating_add(1);
                if self.calm_windows >= self.patience { self.rung.saturating_sub(1) } else { self.rung }
            }
            _ => {
                self.calm_windows = 0;
                self.rung
            }
        }
    }

    /// What the present schedule allows, where sound travels at `c`.
    pub fn advice(&self, c: SpeedOfSound) -> Advice {
        let max_speed_mm_s = match self.ladder.rungs.get(self.rung) {
            Some(schedule) => schedule.max_speed_mm_s(self.ladder.t_delta, c.mm_per_s()),
            None => 0,
        };
        Advice { rung: self.rung, rejection_permille: self.rejection_permille, max_speed_mm_s }
    }
}

/// Why schedules do not make a [`Ladder`]. Rungs are counted from 0 in code and printed from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LadderError {
    /// There is no rung.
    Empty,
    /// A rung is not slower than the one before.
    Order {
        /// The rung.
        rung: usize,
        /// Its period.
        period: Micros,
        /// The period of the rung before.
        before: Micros,
    },
    /// A rung has another number of sensors than the first.
    Sensors {
        /// The rung.
        rung: usize,
        /// How many sensors it has.
        sensors: usize,
        /// How many the first has.
        expected: usize,
    },
    /// A rung does not meet the requirements.
    Unverified {
        /// The rung.
        rung: usize,
        /// The first thing wrong with it.
        violation: Violation,
    },
}

impl fmt::Display for LadderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Empty => write!(f, "a ladder without schedules; expected at least one"),
            Self::Order { rung, period, before } => {
                write!(f, "rung {} has a period of {period}; expected more than the {before} before it", rung + 1)
            }
            Self::Sensors { rung, sensors, expected } => {
                write!(f, "rung {} has {sensors} sensors; expected {expected} as in the first", rung + 1)
            }
            Self::Unverified { rung, violation } => write!(f, "rung {}: {violation}", rung + 1),
        }
    }
}

impl core::error::Error for LadderError {}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::schedule::Phase;
    use crate::tables::TABLE_I_D;
    use std::string::ToString;

    const REQUIREMENTS: Requirements<'static> = Requirements::new(Micros::new(599));

    fn rungs() -> [Schedule<12>; 3] {
        [TABLE_I_D.scaled(3, 5).unwrap(), TABLE_I_D.scaled(4, 5).unwrap(), TABLE_I_D]
    }

    fn period(accepted: u8, rejected: u8) -> PeriodStats {
        let mut tally = Tally::default();
        (0..accepted).for_each(|_| tally.count(ReadingKind::Accepted));
        (0..rejected).for_each(|_| tally.count(ReadingKind::Rejected));
        PeriodStats { period: 0, phase: Phase::A, tally, max_late: Micros::ZERO }
    }

    /// The periods after which the schedule changes, and its new period in ms.
    fn changes(adaptation: &mut Adaptation<'_, 12>, stats: PeriodStats, periods: usize) -> std::vec::Vec<(usize, u32)> {
        (1..=periods)
            .filter_map(|n| adaptation.observe(&stats).map(|schedule| (n, schedule.period().as_micros() / 1000)))
            .collect()
    }

    #[test]
    fn a_noisy_window_slows_down_and_four_calm_ones_speed_up() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(Ladder::new(&rungs, &REQUIREMENTS).unwrap());
        assert_eq!(changes(&mut adaptation, period(6, 6), 64), [(16, 80), (32, 100)]);
        assert_eq!(changes(&mut adaptation, period(9, 3), 160), []);
        assert_eq!(changes(&mut adaptation, period(12, 0), 160), [(64, 80), (128, 60)]);
        let advice = adaptation.advice(SpeedOfSound::AT_20_CELSIUS);
        assert_eq!(advice, Advice { rung: 0, rejection_permille: Some(0), max_speed_mm_s: 1381 });
    }

    #[test]
    fn silence_is_neither_noisy_nor_calm() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(Ladder::new(&rungs, &REQUIREMENTS).unwrap());
        changes(&mut adaptation, period(0, 12), 32);
        assert_eq!(changes(&mut adaptation, period(0, 0), 1000), []);
        assert_eq!(adaptation.advice(SpeedOfSound::AT_20_CELSIUS).rung, 2);
    }

    #[test]
    fn a_ladder_takes_only_verified_schedules_in_order() {
        let error = |rungs: &[Schedule<12>], t_delta| {
            Ladder::new(rungs, &Requirements::new(Micros::new(t_delta))).unwrap_err().to_string()
        };
        let [fast, middle, slow] = rungs();
        assert_eq!(error(&[], 599), "a ladder without schedules; expected at least one");
        assert_eq!(error(&[middle, fast], 599), "rung 2 has a period of 60 ms; expected more than the 80 ms before it");
        assert_eq!(
            error(&[fast, slow], 600),
            "rung 1: crosstalk between sensors 1 and 5 moves by 1.2 ms from one reading to the next; \
             to be rejected it needs at least 1.201 ms (Eq. (13a))"
        );
    }
}
