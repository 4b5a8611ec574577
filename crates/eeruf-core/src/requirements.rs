//! Requirements on a schedule so that crosstalk never passes the filter: Eqs. (13a), (13b) and constraint 3.1 c.
//!
//! The paper prints, for all sensors `x != y` (x causes crosstalk, y suffers it),
//!
//! ```text
//! |T_x,a - T_y,a| - |T_x,b - T_y,b| > 2 T_delta      (13a)
//! |T_x,a - T_y,b| - |T_x,b - T_y,a| > 2 T_delta      (13b)
//! ```
//!
//! where `T` are the waits of phases a and b. Taken literally, the paper's own tables violate this: the left side
//! reaches -22 ms on Tables I-b and I-d. Its absolute value has exactly the 2 ms that the paper claims:
//! [`Criterion::Paper`]. The derivation from (10a), (10b) needs only a weaker condition, [`Criterion::Exact`]: with
//! `d_i = T_i,a - T_i,b`,
//!
//! ```text
//! |d_x - d_y| > 2 T_delta   and   |d_x + d_y| > 2 T_delta
//! ```
//!
//! The first is how far crosstalk from x to y moves between consecutive readings if it arrives an even number of
//! periods after it was sent, the second for an odd number. Since `||p| - |q|| = min(|p - q|, |p + q|)`, both criteria
//! are packings on a line, which sorting checks: Exact holds if and only if the `|d_i|` are pairwise separated, and
//! Paper if and only if the sums `T_i,a + T_i,b` are separated as well.
//!
//! Times are whole microseconds and *near-identical* means `difference <= T_delta`, so `> 2 T_delta` is
//! `>= 2 T_delta + 1 us`.

use core::fmt;

use crate::layout::Layout;
use crate::schedule::{Phase, Schedule};
use crate::time::Micros;
use crate::uneven::Uneven;

/// The interpretation of Eqs. (13a), (13b).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Criterion {
    /// As printed, with an outer absolute value. Stronger than needed.
    Paper,
    /// The form that suffices to reject every crosstalk reading; the lags cancel, so firing times serve as well as
    /// waits.
    #[default]
    Exact,
    /// [`Exact`](Self::Exact), but crosstalk must move by `T_delta` plus this margin instead of `2 T_delta + 1 us`. The
    /// margin must cover jitter, lateness and changes of the path.
    Margin(Micros),
}

impl Criterion {
    /// The separation that a `t_delta` needs.
    pub(crate) const fn separation(self, t_delta: Micros) -> Micros {
        match self {
            Self::Paper | Self::Exact => t_delta.saturating_add(t_delta).saturating_add(Micros::new(1)),
            // Crosstalk must move by more than `T_delta` in any case.
            Self::Margin(Micros::ZERO) => t_delta.saturating_add(Micros::new(1)),
            Self::Margin(margin) => t_delta.saturating_add(margin),
        }
    }

    /// The largest `t_delta` that a separation allows, if any.
    pub(crate) const fn max_t_delta(self, separation: Micros) -> Option<Micros> {
        let us = separation.as_micros();
        let most = match self {
            Self::Paper | Self::Exact => match us.checked_sub(1) {
                Some(twice) => Some(twice / 2),
                None => None,
            },
            Self::Margin(Micros::ZERO) => us.checked_sub(1),
            Self::Margin(margin) => us.checked_sub(margin.as_micros()),
        };
        match most {
            Some(most) => Some(Micros::new(most)),
            None => None,
        }
    }
}

/// The requirements that a schedule is checked against.
///
/// ```
/// use eeruf_core::{Layout, Micros, Requirements, tables::TABLE_I_D};
/// let paper = Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) };
/// assert!(TABLE_I_D.verify(&paper).ok());
/// assert!(!TABLE_I_D.verify(&Requirements { min_interval: Micros::from_millis(18), ..paper }).ok());
/// let in_blocks = Requirements { layout: Layout::Blocks(4), min_interval: Micros::from_millis(19), ..paper };
/// assert!(TABLE_I_D.verify(&in_blocks).ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Requirements<'a> {
    /// `T_delta`: the greatest difference between near-identical consecutive readings (Eq. 11).
    pub t_delta: Micros,
    /// The interpretation of (13a), (13b).
    pub criterion: Criterion,
    /// The least time between the firings of two neighbours, in each phase and across each period's end; 15 ms in the
    /// paper (Sec. 3.1 c).
    pub min_interval: Micros,
    /// Pairs of neighbours.
    pub layout: Layout<'a>,
    /// `T_wind`: how long a sensor listens. It must not fire again within this time.
    pub window: Micros,
    /// Deaf time of a sensor after it has fired. Schedules with two phases reject sound of any age and ignore it.
    pub blanking: Micros,
    /// R: how long sound is audible. A schedule with two phases rejects sound of any age, but a ring that fires late
    /// looks back by at most this: no longer than one period (two with `stale_echo`), which is also what `None` means.
    pub audible: Option<Micros>,
    /// True to also reject a sensor's own echo from an earlier period, however long its path: `2 |d| > 2 T_delta` for
    /// each sensor with two phases.
    pub stale_echo: bool,
    /// Needs of single sensors and pairs, if they are not all alike.
    pub uneven: Option<Uneven<'a>>,
}

impl Requirements<'_> {
    /// Requirements with criterion Exact at this `t_delta`, any four adjacent sensors of a line as neighbours, and
    /// nothing else.
    pub const fn new(t_delta: Micros) -> Self {
        Self {
            t_delta,
            criterion: Criterion::Exact,
            min_interval: Micros::ZERO,
            layout: Layout::Line(4),
            window: Micros::ZERO,
            blanking: Micros::ZERO,
            audible: None,
            stale_echo: false,
            uneven: None,
        }
    }

    /// The separation that the common `t_delta` needs: `2 t_delta + 1 us`, or `t_delta` and the margin.
    pub const fn separation(&self) -> Micros {
        self.criterion.separation(self.t_delta)
    }
}

/// The least shift of crosstalk from one reading to another, or the least interval between two firings, and where it
/// occurs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Least {
    /// The shift, with two phases the smaller left side of (13a) and (13b); or the interval.
    pub value: Micros,
    /// The sensors, from 0: for a shift the sender and the receiver (with two phases, the smaller number first); for an
    /// interval in ascending order within a period, and in firing order across its end.
    pub sensors: (u8, u8),
    /// The two phases in which the sound is heard (both `a` with two phases), or in which the two sensors fire.
    pub phases: (Phase, Phase),
}

impl Least {
    /// The separation of two sensors with two phases.
    pub(crate) const fn of_two_phases(value: Micros, x: usize, y: usize) -> Self {
        let sensors = if x < y { (x as u8, y as u8) } else { (y as u8, x as u8) };
        Self { value, sensors, phases: (Phase::A, Phase::A) }
    }

    /// The interval between a firing of x and one of y.
    pub(crate) const fn interval(value: Micros, x: usize, y: usize, phases: (usize, usize)) -> Self {
        let phases = (Phase(phases.0 as u8), Phase(phases.1 as u8));
        Self { value, sensors: (x as u8, y as u8), phases }
    }
}

impl<const K: usize, const M: usize> Schedule<K, M> {
    /// The smallest interval between two neighbours' firings, over all phases and period boundaries; `None` without
    /// neighbours. Takes `M K^2` steps.
    pub const fn min_interval(&self, layout: Layout<'_>) -> Option<Least> {
        let mut least: Option<Least> = None;
        let mut phase = 0;
        while phase < M {
            let mut x = 0;
            while x < self.sensors() {
                let mut y = 0;
                while y < self.sensors() {
                    if layout.neighbours(self.sensors(), x, y) {
                        if x < y {
                            least = shorter(least, self.interval_within(x, y, phase));
                        }
                        least = shorter(least, self.interval_across(x, y, phase));
                    }
                    y += 1;
                }
                x += 1;
            }
            phase += 1;
        }
        least
    }

    /// The interval between the firings of `x` and `y` in one period.
    pub(crate) const fn interval_within(&self, x: usize, y: usize, phase: usize) -> Least {
        Least::interval(self.fire_at(phase, x).abs_diff(self.fire_at(phase, y)), x, y, (phase, phase))
    }

    /// The interval from the firing of `x` in one period to that of `y` in the next.
    pub(crate) const fn interval_across(&self, x: usize, y: usize, phase: usize) -> Least {
        let next = (phase + 1) % M;
        let t_fire = self.fire_at(next, y).as_micros() + self.period().as_micros();
        Least::interval(Micros::new(t_fire - self.fire_at(phase, x).as_micros()), x, y, (phase, next))
    }
}

/// The shorter of two intervals; `next` if there is no other.
pub(crate) const fn shorter(least: Option<Least>, next: Least) -> Option<Least> {
    match least {
        Some(least) if least.value.as_micros() <= next.value.as_micros() => Some(least),
        _ => Some(next),
    }
}

impl<const K: usize> Schedule<K> {
    /// `d_i = T_i,a - T_i,b` in microseconds: how much earlier, relative to its period, a sensor fires in phase b.
    ///
    /// Zero for a sensor out of range.
    pub const fn shift_us(&self, sensor: usize) -> i32 {
        match (self.t_fire(Phase::A, sensor), self.t_fire(Phase::B, sensor)) {
            // Both are below 2^28, so the difference is exact.
            (Some(a), Some(b)) => a.as_micros() as i32 - b.as_micros() as i32,
            _ => 0,
        }
    }

    /// The smallest left side of (13a) and (13b) over all pairs, with its pair; `None` for a single sensor. Sorts
    /// instead of comparing all pairs.
    pub const fn separation(&self, criterion: Criterion) -> Option<Least> {
        let by_shift = closest(&self.shift_sizes(), self.sensors());
        match criterion {
            Criterion::Exact | Criterion::Margin(_) => by_shift,
            Criterion::Paper => match (by_shift, closest(&self.wait_sums(), self.sensors())) {
                (Some(d), Some(s)) if s.value.as_micros() < d.value.as_micros() => Some(s),
                _ => by_shift,
            },
        }
    }

    const fn shift_sizes(&self) -> [u32; K] {
        let mut sizes = [0; K];
        let mut x = 0;
        while x < self.sensors() {
            sizes[x] = self.shift_us(x).unsigned_abs();
            x += 1;
        }
        sizes
    }

    const fn wait_sums(&self) -> [u32; K] {
        let mut sums = [0; K];
        let mut x = 0;
        while x < self.sensors() {
            sums[x] = self.wait_us(0, x) as u32 + self.wait_us(1, x) as u32;
            x += 1;
        }
        sums
    }

    /// Wait of a sensor in a phase, both in range. A wait is below the period, so it fits an `i32`.
    const fn wait_us(&self, phase: usize, sensor: usize) -> i32 {
        self.fire_at(phase, sensor).as_micros() as i32 - self.t_lag()[sensor].as_micros() as i32
    }

    /// The left sides of (13a) and (13b) for one pair, written out.
    pub(crate) const fn left_sides(&self, criterion: Criterion, x: usize, y: usize) -> (Micros, Micros) {
        let (even, odd) = match criterion {
            Criterion::Exact | Criterion::Margin(_) => {
                let (dx, dy) = (self.shift_us(x), self.shift_us(y));
                (dx - dy, dx + dy)
            }
            Criterion::Paper => {
                let (xa, xb) = (self.wait_us(0, x), self.wait_us(1, x));
                let (ya, yb) = (self.wait_us(0, y), self.wait_us(1, y));
                ((xa - ya).abs() - (xb - yb).abs(), (xa - yb).abs() - (xb - ya).abs())
            }
        };
        (Micros::new(even.unsigned_abs()), Micros::new(odd.unsigned_abs()))
    }
}

/// The two values that lie closest together, by insertion sort.
const fn closest<const K: usize>(values: &[u32; K], sensors: usize) -> Option<Least> {
    let mut order = [0; K];
    let mut x = 0;
    while x < sensors {
        let mut at = x;
        while at > 0 && values[order[at - 1]] > values[x] {
            order[at] = order[at - 1];
            at -= 1;
        }
        order[at] = x;
        x += 1;
    }
    let mut least: Option<Least> = None;
    let mut at = 1;
    while at < sensors {
        let (x, y) = (order[at - 1], order[at]);
        let value = Micros::new(values[y] - values[x]);
        let smaller = match least {
            Some(least) => value.as_micros() < least.value.as_micros(),
            None => true,
        };
        if smaller {
            least = Some(Least::of_two_phases(value, x, y));
        }
        at += 1;
    }
    least
}

impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Paper => "paper",
            Self::Exact => "exact",
            Self::Margin(_) => "margin",
        })
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::Criterion;
    use std::string::ToString;

    #[test]
    fn criteria_have_the_names_that_files_use() {
        assert_eq!([Criterion::Paper, Criterion::Exact].map(|criterion| criterion.to_string()), ["paper", "exact"]);
    }
}
