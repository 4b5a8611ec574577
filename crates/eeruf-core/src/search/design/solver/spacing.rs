//! The separation alone: K values `|d|`, each in an interval of its own, pairwise at least D apart, by Hall intervals.
//!
//! Values in `[s, e]` need `s + D (c - 1) <= e` if there are c of them: Hall's condition, for tasks of length D.
//! `[s, e]` is a *Hall interval* (Puget 1998; Lopez-Ortiz, Quimper, Tromp, van Beek 2003) where they fill it so that no
//! further value fits: every other value that may not lie below s must lie at least D behind the last of them, and
//! likewise from the other side.
//!
//! Indices: `count` is the number of sensors, at most `MAX_SENSORS`; the numbers that are sorted are those below it.

use super::difference_bounds::Conflict;
use crate::schedule::MAX_SENSORS;

/// The intervals of all `|d|`.
pub(crate) struct Intervals {
    pub(crate) low: [i32; MAX_SENSORS],
    pub(crate) high: [i32; MAX_SENSORS],
}

impl Intervals {
    /// No intervals yet.
    pub(crate) const NONE: Self = Self { low: [-1; MAX_SENSORS], high: [-1; MAX_SENSORS] };

    /// Tightens the intervals of the first `count` sensors until Hall's condition gives nothing new.
    ///
    /// # Errors
    /// Some interval is left empty, or too many values share one.
    pub(crate) fn enforce(&mut self, count: usize, separation: i32) -> Result<(), Conflict> {
        loop {
            let up = self.sweep(count, separation)?;
            self.mirror(count);
            let down = self.sweep(count, separation);
            self.mirror(count);
            if !(up | down?) {
                return Ok(());
            }
        }
    }

    /// Tightens by the grid of ranks. With K values D apart in `least..=widest`, the one of rank r lies in
    /// `least + D r ..= least + D r + slack`; if slack is below D, no value lies between these ranges.
    ///
    /// # Errors
    /// Some interval is left empty.
    pub(crate) fn round(&mut self, count: usize, separation: i32, least: i32, widest: i32) -> Result<(), Conflict> {
        let slack = widest - least - separation * (count as i32 - 1);
        if slack >= separation - 1 {
            return Ok(());
        }
        for i in 0..count {
            let below = (self.low[i] - least) % separation;
            if below > slack {
                self.low[i] += separation - below;
            }
            let above = (self.high[i] - least) % separation;
            if above > slack {
                self.high[i] -= above - slack;
            }
            if self.low[i] > self.high[i] {
                return Err(Conflict);
            }
        }
        Ok(())
    }

    /// Exchanges low and high ends, so that one sweep serves both directions.
    fn mirror(&mut self, count: usize) {
        for i in 0..count {
            (self.low[i], self.high[i]) = (-self.high[i], -self.low[i]);
        }
    }

    /// Hall's condition for all intervals that begin and end at an end of some value's interval; raises low ends.
    fn sweep(&mut self, count: usize, separation: i32) -> Result<bool, Conflict> {
        let mut by_high = [0u8; MAX_SENSORS];
        let mut by_low = [0u8; MAX_SENSORS];
        let by_high = sorted(&mut by_high[..count], &self.high);
        let by_low = sorted(&mut by_low[..count], &self.low);
        let mut changed = false;
        for (rank, &last) in by_high.iter().enumerate() {
            let end = self.high[usize::from(last)];
            // Only the last of equal ends sees the whole set.
            if by_high.get(rank + 1).is_some_and(|&next| self.high[usize::from(next)] == end) {
                continue;
            }
            // The values that end by `end`, from the highest low end down.
            let mut inside = 0;
            let mut full = false;
            for &i in by_low.iter().rev() {
                let i = usize::from(i);
                if self.high[i] > end {
                    continue;
                }
                let low = self.low[i];
                if low + separation * inside > end {
                    return Err(Conflict);
                }
                inside += 1;
                if low + separation * inside > end {
                    full = true;
                    for &j in by_high {
                        let j = usize::from(j);
                        if self.high[j] > end && self.low[j] >= low && self.low[j] < low + separation * inside {
                            self.low[j] = low + separation * inside;
                            if self.low[j] > self.high[j] {
                                return Err(Conflict);
                            }
                            changed = true;
                        }
                    }
                }
            }
            if full && changed {
                // The order of low ends is stale; the caller comes back.
                return Ok(true);
            }
        }
        Ok(changed)
    }
}

/// The numbers of the first sensors, sorted by `key`: insertion, as they are few and change little.
fn sorted<'a>(numbers: &'a mut [u8], key: &[i32; MAX_SENSORS]) -> &'a [u8] {
    for i in 0..numbers.len() {
        let mut at = i;
        while at > 0 && key[usize::from(numbers[at - 1])] > key[i] {
            numbers[at] = numbers[at - 1];
            at -= 1;
        }
        // Sensors are at most 64.
        numbers[at] = i as u8;
    }
    numbers
}
