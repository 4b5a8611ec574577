//! [`Uneven`]: needs of sensors that differ within a ring.

use crate::requirements_error::RequirementsError;
use crate::schedule::MAX_SENSORS;
use crate::time::Micros;

/// Needs of single sensors and pairs that differ; otherwise the common [`Requirements`](crate::Requirements) hold.
/// Sensors are counted from 0.
///
/// ```
/// use eeruf_core::{Layout, Micros, Requirements, Schedule, Uneven, conditions::ViolationKind};
/// // Two modules that look far and two that look near; the first and the third share an echo line.
/// const MODULES: Uneven<'static> = Uneven {
///     window: &[Micros::from_millis(30), Micros::from_millis(30), Micros::from_millis(12), Micros::from_millis(12)],
///     shared_lines: &[0b0101],
///     ..Uneven::NONE
/// };
/// let ring = Requirements { layout: Layout::Line(1), uneven: Some(MODULES), ..Requirements::new(Micros::new(999)) };
/// let ms = |ms: [u32; 4]| ms.map(Micros::from_millis);
/// let schedule = Schedule::from_firing(Micros::from_millis(60), [ms([0, 0, 31, 0]), ms([0, 2, 35, 6])])?;
/// assert!(schedule.verify(&ring).ok());
/// // If the third sensor fires 29 ms after the first, that one still listens on their line.
/// let schedule = Schedule::from_firing(Micros::from_millis(60), [ms([0, 0, 29, 0]), ms([0, 2, 33, 6])])?;
/// let kinds: Vec<_> = schedule.verify(&ring).violations().map(|violation| violation.kind).collect();
/// assert_eq!(kinds, [ViolationKind::SharedLine]);
/// # Ok::<(), eeruf_core::ScheduleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Uneven<'a> {
    /// `T_delta` of each sensor; empty if all have the common one. Two sensors need the separation of the
    /// larger value, since crosstalk passes both ways.
    pub t_delta: &'a [Micros],
    /// `T_wind` of each sensor; empty if all have the common one.
    pub window: &'a [Micros],
    /// Least time between two triggers of each sensor, if longer than its window; empty if no sensor needs it.
    pub refire: &'a [Micros],
    /// Pairs of sensors with the least time between their firings, which overrides layout and common interval; 0 for
    /// none.
    pub intervals: &'a [(u8, u8, Micros)],
    /// Sets of sensors that share an echo line, bit x for sensor x: none fires while another of them listens.
    pub shared_lines: &'a [u64],
    /// Sets of sensors that fire together, bit x for sensor x: at the same instant in every phase. They are declared
    /// not to hear each other, so they need no separation; all other requirements hold.
    pub together: &'a [u64],
}

impl Uneven<'_> {
    /// No differences: all sensors are alike.
    pub const NONE: Self =
        Self { t_delta: &[], window: &[], refire: &[], intervals: &[], shared_lines: &[], together: &[] };

    /// Checks that the needs are valid for this many sensors.
    ///
    /// # Errors
    /// The first invalid need: see [`RequirementsError`].
    pub fn check(&self, sensors: usize) -> Result<(), RequirementsError> {
        for (what, each) in [("t_delta", self.t_delta), ("window", self.window), ("refire", self.refire)] {
            if !each.is_empty() && each.len() != sensors {
                return Err(RequirementsError::Length { what, given: each.len(), sensors });
            }
        }
        for (at, &(x, y, _)) in self.intervals.iter().enumerate() {
            let pair = (usize::from(x), usize::from(y));
            if x == y || pair.0.max(pair.1) >= sensors {
                return Err(RequirementsError::Pair { pair, sensors });
            }
            if self.intervals.iter().take(at).any(|&(p, q, _)| (p, q) == (x, y) || (q, p) == (x, y)) {
                return Err(RequirementsError::PairTwice { pair });
            }
        }
        let there = if sensors >= MAX_SENSORS { u64::MAX } else { (1 << sensors) - 1 };
        for (what, sets) in [("shared_lines", self.shared_lines), ("together", self.together)] {
            let mut seen = 0;
            for &set in sets {
                if set & !there != 0 || set.count_ones() < 2 {
                    return Err(RequirementsError::Set { what, set, sensors });
                }
                if what == "together" && seen & set != 0 {
                    return Err(RequirementsError::TwoGroups { sensor: (seen & set).trailing_zeros() as u8 });
                }
                seen |= set;
            }
        }
        Ok(())
    }

    /// Returns true if one of the sets holds both sensors.
    pub(crate) const fn in_one(sets: &[u64], x: usize, y: usize) -> bool {
        let mut at = 0;
        while at < sets.len() {
            if x < MAX_SENSORS && y < MAX_SENSORS && sets[at] >> x & 1 == 1 && sets[at] >> y & 1 == 1 {
                return true;
            }
            at += 1;
        }
        false
    }
}
