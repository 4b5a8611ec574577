//! Adaptive scheduling (end of Sec. 3.1): fire more slowly if too many readings are rejected, and faster again once few
//! are.

use core::ops::Deref;

use crate::reading::{ReadingKind, Tally};
use crate::ring::PeriodStats;
use crate::schedule::ScheduleError;
use crate::sound::SpeedOfSound;
use crate::time::Micros;
use crate::verified::VerifiedSchedule;

/// Watches the rejection rate over windows of several periods and decides when to move to another schedule of a
/// *ladder*: verified schedules for one ring, from the shortest period to the longest.
///
/// One noisy window moves one rung up, to a longer period; only several consecutive calm windows move one rung down.
/// Give it the [`PeriodStats`] of a [`Ring`](crate::Ring) that began with the shortest period, and the ring's
/// [`change_schedule`](crate::Ring::change_schedule):
///
/// ```
/// use eeruf_core::{
///     Instant, Requirements, Ring, RingConfig, RingEvent, adaptation::Adaptation, tables::TABLE_I_D,
/// };
/// # use eeruf_core::Micros;
/// let requirements = Requirements::new(Micros::new(599));
/// let rungs = [TABLE_I_D.scaled(3, 5)?, TABLE_I_D].map(|table| table.verified(&requirements).expect("met"));
/// let mut adaptation = Adaptation::new(&rungs)?;
/// let mut ring = Ring::new(&rungs[0], RingConfig::new().with_window(Micros::from_millis(36)), Instant::default())?;
/// if let Some(RingEvent::PeriodEnded(stats)) = ring.poll(ring.next_deadline()) {
///     adaptation.adapt(&stats, |schedule| ring.change_schedule(schedule))?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type Adaptation<'s, R> = OnLadder<&'s [R]>;

/// [`Adaptation`] over any pointer `L` to the rungs: with an `Arc` it owns them.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OnLadder<L> {
    rungs: L,
    rung: usize,
    /// Rejection rate, in thousandths, above which the ring fires more slowly. Default: 300; the paper gives no value.
    pub noisy_permille: u16,
    /// Largest rejection rate of a calm window, in thousandths. Default: 100.
    pub calm_permille: u16,
    /// The number of periods in a window. Default: 16; 0 counts as 1.
    pub window: u8,
    /// Number of consecutive calm windows before firing gets faster. Default: 4; 0 counts as 1.
    pub patience: u8,
    periods: u8,
    calm_windows: u8,
    tally: Tally<u16>,
    rejection_permille: Option<u16>,
}

impl<L: Deref<Target = [VerifiedSchedule<K, M, U>]>, const K: usize, const M: usize, U> OnLadder<L> {
    /// Starts on the first rung, the shortest period. Each rung is verified by itself; a ring changes only to rungs
    /// that allow its own `t_delta` and window.
    ///
    /// # Errors
    /// [`ScheduleError`] if there is no rung, if a period is not longer than the previous one, or if the number of
    /// sensors changes.
    pub fn new(rungs: L) -> Result<Self, ScheduleError> {
        Self::of(rungs, |rung| (rung.sensors(), rung.period()))
    }

    /// The maximum speed, in mm/s, at which good readings still pass on the current rung, for a ring with this
    /// `t_delta` and a speed of sound `c` (see [`Schedule::max_speed_mm_s`](crate::Schedule::max_speed_mm_s)).
    pub fn max_speed_mm_s(&self, t_delta: Micros, c: SpeedOfSound) -> u32 {
        self.rungs.get(self.rung).map_or(0, |schedule| schedule.max_speed_mm_s(t_delta, c.mm_per_s()))
    }
}

impl<'s, R> Adaptation<'s, R> {
    /// Records one period, and calls `change` when another schedule is better. If the change fails, the rung stays and
    /// the next window that calls for a change tries again. Returns true if the schedule changed.
    ///
    /// # Errors
    /// Whatever `change` returns.
    pub fn adapt<Refused>(
        &mut self,
        stats: &PeriodStats,
        change: impl FnOnce(&'s R) -> Result<(), Refused>,
    ) -> Result<bool, Refused> {
        let rungs = self.rungs;
        self.adapt_to(stats, |rung| rungs.get(rung).map_or(Ok(()), change))
    }
}

impl<L: Deref<Target = [R]>, R> OnLadder<L> {
    /// Checks the rungs and starts on the first; `needs` returns a rung's number of sensors and its period.
    fn of(rungs: L, needs: impl Fn(&R) -> (usize, Micros)) -> Result<Self, ScheduleError> {
        let Some((expected, _)) = rungs.first().map(&needs) else { return Err(ScheduleError::NoRung) };
        let mut before = None;
        for (rung, (sensors, period)) in rungs.iter().map(&needs).enumerate() {
            if sensors != expected {
                return Err(ScheduleError::RungSensors { rung, sensors, expected });
            }
            match before {
                Some(before) if period <= before => return Err(ScheduleError::RungOrder { rung, period, before }),
                _ => before = Some(period),
            }
        }
        Ok(Self {
            rungs,
            rung: 0,
            noisy_permille: 300,
            calm_permille: 100,
            window: 16,
            patience: 4,
            periods: 0,
            calm_windows: 0,
            tally: Tally::default(),
            rejection_permille: None,
        })
    }

    /// Adapts like [`adapt`](Adaptation::adapt), but passes the rung's number to `change`.
    ///
    /// # Errors
    /// Whatever `change` returns.
    pub fn adapt_to<Refused>(
        &mut self,
        stats: &PeriodStats,
        change: impl FnOnce(usize) -> Result<(), Refused>,
    ) -> Result<bool, Refused> {
        for kind in [ReadingKind::Accepted, ReadingKind::Rejected, ReadingKind::Repeated, ReadingKind::Ambiguous] {
            for _ in 0..stats.tally.of(kind) {
                self.tally.count(kind);
            }
        }
        self.periods = self.periods.saturating_add(1);
        if self.periods < self.window {
            return Ok(false);
        }
        self.periods = 0;
        self.rejection_permille = core::mem::take(&mut self.tally).rejection_permille();
        let rung = self.next_rung();
        if rung == self.rung {
            return Ok(false);
        }
        self.calm_windows = 0;
        change(rung)?;
        self.rung = rung;
        Ok(true)
    }

    /// Chooses the rung after a window has ended. A window in which nothing was compared is neither noisy nor calm.
    fn next_rung(&mut self) -> usize {
        match self.rejection_permille {
            Some(rate) if rate > self.noisy_permille => {
                self.calm_windows = 0;
                (self.rung + 1).min(self.rungs.len() - 1)
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

    /// The rungs, from the shortest period to the longest.
    pub const fn rungs(&self) -> &L {
        &self.rungs
    }

    /// The rung in use, 0 for the shortest period.
    pub const fn rung(&self) -> usize {
        self.rung
    }

    /// The rejection rate of the last whole window, in thousandths; `None` before, or if it compared nothing.
    pub const fn rejection_permille(&self) -> Option<u16> {
        self.rejection_permille
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::requirements::Requirements;
    use crate::schedule::{Phase, Schedule};
    use crate::tables::TABLE_I_D;
    use std::string::ToString;

    const REQUIREMENTS: Requirements<'static> = Requirements::new(Micros::new(599));

    fn rungs() -> [VerifiedSchedule<12>; 3] {
        let verified = |schedule: Schedule<12>| schedule.verified(&REQUIREMENTS).unwrap();
        [TABLE_I_D.scaled(3, 5).unwrap(), TABLE_I_D.scaled(4, 5).unwrap(), TABLE_I_D].map(verified)
    }

    fn period(accepted: u8, rejected: u8) -> PeriodStats {
        let mut tally = Tally::default();
        (0..accepted).for_each(|_| tally.count(ReadingKind::Accepted));
        (0..rejected).for_each(|_| tally.count(ReadingKind::Rejected));
        PeriodStats { period: 0, phase: Phase::A, tally, max_late: Micros::ZERO, sum_late: Micros::ZERO }
    }

    /// Periods after which the schedule changes, with the new period in ms.
    fn changes(
        adaptation: &mut Adaptation<'_, VerifiedSchedule<12>>,
        stats: PeriodStats,
        periods: usize,
    ) -> std::vec::Vec<(usize, u32)> {
        let mut changes = std::vec![];
        for n in 1..=periods {
            let change = |schedule: &VerifiedSchedule<12>| {
                changes.push((n, schedule.period().as_micros() / 1000));
                Ok::<(), ()>(())
            };
            adaptation.adapt(&stats, change).unwrap();
        }
        changes
    }

    #[test]
    fn a_noisy_window_slows_down_and_four_calm_ones_speed_up() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        assert_eq!(changes(&mut adaptation, period(6, 6), 64), [(16, 80), (32, 100)]);
        assert_eq!(changes(&mut adaptation, period(9, 3), 160), []);
        assert_eq!(changes(&mut adaptation, period(12, 0), 160), [(64, 80), (128, 60)]);
        assert_eq!((adaptation.rung(), adaptation.rejection_permille()), (0, Some(0)));
        assert_eq!(adaptation.max_speed_mm_s(REQUIREMENTS.t_delta, SpeedOfSound::AT_20_CELSIUS), 1381);
    }

    // A window is noisy above `noisy_permille`, and calm up to `calm_permille`.
    #[test]
    fn noisy_and_calm_are_beyond_their_limits() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        assert_eq!(changes(&mut adaptation, period(70, 30), 160), []);
        assert_eq!(changes(&mut adaptation, period(69, 31), 32), [(16, 80), (32, 100)]);
        assert_eq!(changes(&mut adaptation, period(89, 11), 160), []);
        assert_eq!(changes(&mut adaptation, period(90, 10), 160), [(64, 80), (128, 60)]);
    }

    #[test]
    fn silence_is_neither_noisy_nor_calm() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        changes(&mut adaptation, period(0, 12), 32);
        assert_eq!(changes(&mut adaptation, period(0, 0), 1000), []);
        assert_eq!(adaptation.rung(), 2);
    }

    // If the ring refuses a change, the rung stays and the change is requested again.
    #[test]
    fn refused_change_leaves_rung_and_is_asked_again() {
        let rungs = rungs();
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        for window in 0..3 {
            for n in 1..=16 {
                let refused = adaptation.adapt(&period(6, 6), |_| Err(window));
                assert_eq!(refused, if n < 16 { Ok(false) } else { Err(window) });
                assert_eq!(adaptation.rung(), 0);
            }
        }
        assert_eq!(changes(&mut adaptation, period(6, 6), 16), [(16, 80)]);
    }

    #[test]
    fn a_ladder_takes_schedules_only_in_order() {
        let error = |rungs: &[VerifiedSchedule<12>]| Adaptation::new(rungs).unwrap_err().to_string();
        let [fast, middle, _] = rungs();
        assert_eq!(error(&[]), "a ladder without schedules; expected at least one");
        assert_eq!(error(&[middle, fast]), "rung 2 has a period of 60 ms; expected more than the 80 ms before it");
        assert_eq!(error(&[fast, fast]), "rung 2 has a period of 60 ms; expected more than the 60 ms before it");
        let (lags, waits) = ([0, 20, 40].map(Micros::from_millis), [1, 3, 6].map(Micros::from_millis));
        let few = Schedule::from_slices(Micros::from_millis(100), &lags, [&[Micros::ZERO; 3], &waits]).unwrap();
        let few = few.verified(&REQUIREMENTS).unwrap();
        assert_eq!(error(&[fast, few]), "rung 2 has 3 sensors; expected 12 as in the first");
    }
}
