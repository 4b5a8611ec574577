//! [`PhaseTable`]: the conditions for firing times of any number of phases, of which the paper's two are the case
//! `M = 2`.
//!
//! Sound of sensor x that is j periods old reads `L + g` in phase m of sensor y, where
//!
//! ```text
//! g = f_x[m - j] - j T_p - f_y[m]
//! ```
//!
//! A filter that lets readings of any two phases support each other needs `|g - g'| >= D` for any two phases and any
//! two ages in which the path can be heard. With two phases and one age this is (13a) and (13b):
//! `docs/explanation/theory.md`, sections 4 and 9.

mod verify;

use crate::requirements::{Least, Requirements, shorter};
use crate::schedule::{MAX_SENSORS, Phase};
use crate::time::Micros;
use crate::verify::closer;

/// Firing times of any number of phases, to be checked: a row for each phase, a number for each sensor.
///
/// ```
/// use eeruf_core::{Micros, Requirements, hopping::{HoppingCode, HoppingSchedule}, phases::PhaseTable};
/// const TIMES: [[Micros; 4]; 6] = {
///     let Ok(code) = HoppingCode::new(4, 2, Micros::new(301)) else { panic!() };
///     let Ok(ring) = HoppingSchedule::<4>::spread(code, Micros::from_millis(60)) else { panic!() };
///     ring.table()
/// };
/// // Checked when it is compiled.
/// const SAFE: bool = {
///     let table = PhaseTable::new(Micros::from_millis(60), &TIMES);
///     match table.separation(&Requirements { window: Micros::from_millis(36), ..Requirements::new(Micros::ZERO) }) {
///         Some(least) => least.value.as_micros() >= 301,
///         None => true,
///     }
/// };
/// assert!(SAFE);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseTable<'a, const K: usize> {
    sensors: u8,
    period: Micros,
    t_fire: &'a [[Micros; K]],
}

/// The ages that can matter: a sensor listens into the next period, and a path is at most three periods old.
const AGES: [i8; 5] = [-1, 0, 1, 2, 3];

impl<'a, const K: usize> PhaseTable<'a, K> {
    /// A table of `K` sensors, at most 64, with this period. Firing times may lie anywhere, also beyond the period.
    pub const fn new(period: Micros, t_fire: &'a [[Micros; K]]) -> Self {
        let sensors = if K < MAX_SENSORS { K } else { MAX_SENSORS };
        Self { sensors: sensors as u8, period, t_fire }
    }

    /// The same of the first sensors alone; what is beyond them does not count. There are no more than before.
    pub const fn with_sensors(self, sensors: usize) -> Self {
        let sensors = if sensors < self.sensors() { sensors } else { self.sensors() };
        Self { sensors: sensors as u8, ..self }
    }

    /// Number of sensors it has.
    pub const fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// `T_p`.
    pub const fn period(&self) -> Micros {
        self.period
    }

    /// Number of phases it has.
    pub const fn phases(&self) -> usize {
        self.t_fire.len()
    }

    /// The least by which a path from one sensor to another moves from one phase to another, over all ages in which it
    /// can be heard by what the requirements say of windows, blanking and audible sound; `None` if no path can be heard
    /// in two phases. Two that must fire together do not count. Takes `25 (K M)^2` steps.
    pub const fn separation(&self, requirements: &Requirements<'_>) -> Option<Least> {
        let (mut least, mut x): (Option<Least>, usize) = (None, 0);
        while x < self.sensors() {
            let mut y = 0;
            while y < self.sensors() {
                if x != y && !requirements.fire_together(x, y) {
                    least = closer(least, self.separation_of(x, y, requirements));
                }
                y += 1;
            }
            x += 1;
        }
        least
    }

    /// The same of a sensor's own sound from earlier periods, however long its path: by how much a stale echo moves at
    /// least. Sound that is a whole cycle old does not move, and does not count.
    pub const fn stale_separation(&self, requirements: &Requirements<'_>) -> Option<Least> {
        let (mut least, mut x): (Option<Least>, usize) = (None, 0);
        while x < self.sensors() {
            least = closer(least, self.separation_of(x, x, requirements));
            x += 1;
        }
        least
    }

    /// As far as a path from x to y goes.
    const fn separation_of(&self, x: usize, y: usize, requirements: &Requirements<'_>) -> Option<Least> {
        let reach = match requirements.audible {
            _ if x == y => Micros::MAX,
            Some(audible) => audible,
            None => requirements.window,
        };
        let heard = Heard {
            window: requirements.window_of(y).as_micros() as i64,
            blanking: requirements.blanking.as_micros() as i64,
            reach: reach.as_micros() as i64,
        };
        let mut least: Option<Least> = None;
        let events = self.phases() * AGES.len();
        let mut one = 0;
        while one < events {
            let mut other = (one / AGES.len() + 1) * AGES.len();
            while other < events {
                let (a, b) = (self.offset(x, y, one), self.offset(x, y, other));
                if (x != y || self.is_stale(one) && self.is_stale(other)) && heard.together(a, b) {
                    let value = Micros::new(a.abs_diff(b) as u32);
                    let phases = (Phase((one / AGES.len()) as u8), Phase((other / AGES.len()) as u8));
                    let ages = (AGES[one % AGES.len()], AGES[other % AGES.len()]);
                    least = closer(least, Some(Least { value, sensors: (x as u8, y as u8), phases, ages }));
                }
                other += 1;
            }
            one += 1;
        }
        least
    }

    /// Returns true if a sensor's own sound of this age is a stale echo, which ought to move.
    const fn is_stale(&self, event: usize) -> bool {
        AGES[event % AGES.len()] as i64 % self.phases() as i64 != 0
    }

    /// `g` of a path from x to y, for a phase and age.
    const fn offset(&self, x: usize, y: usize, event: usize) -> i64 {
        let (phase, age) = (event / AGES.len(), AGES[event % AGES.len()]);
        let sent = (phase as i64 - age as i64).rem_euclid(self.phases() as i64) as usize;
        let (f_x, f_y) = (self.t_fire[sent][x].as_micros(), self.t_fire[phase][y].as_micros());
        f_x as i64 - age as i64 * self.period.as_micros() as i64 - f_y as i64
    }

    /// The shortest time between two firings of one sensor, over all phases and the end of the cycle; `None` without
    /// phases or sensors.
    pub const fn min_refire(&self) -> Option<Least> {
        let mut least = None;
        let mut x = 0;
        while x < self.sensors() {
            let mut phase = 0;
            while phase < self.phases() {
                least = shorter(least, self.between(x, phase, x, phase + 1));
                phase += 1;
            }
            x += 1;
        }
        least
    }

    /// The smallest interval between the firings of two that need one, within a period and from one to the next; `None`
    /// without any.
    pub const fn min_interval(&self, requirements: &Requirements<'_>) -> Option<Least> {
        let mut least = None;
        let mut x = 0;
        while x < self.sensors() {
            let mut y = 0;
            while y < self.sensors() {
                let mut phase = 0;
                while requirements.interval_of(self.sensors(), x, y).is_some() && phase < self.phases() {
                    least = shorter(least, self.between(x, phase, y, phase));
                    least = shorter(least, self.between(x, phase, y, phase + 1));
                    phase += 1;
                }
                y += 1;
            }
            x += 1;
        }
        least
    }

    /// Between a firing of x and one of y, of the same period or the next.
    const fn between(&self, x: usize, phase: usize, y: usize, next: usize) -> Least {
        let apart = self.after(x, phase, y, next).unsigned_abs();
        let value = Micros::new(if apart > u32::MAX as u64 { u32::MAX } else { apart as u32 });
        Least::interval(value, x, y, (phase, next % self.phases()))
    }

    /// Time from a firing of x to one of y, of the same period or the next, in microseconds; negative if y's is before.
    const fn after(&self, x: usize, phase: usize, y: usize, next: usize) -> i64 {
        let (f_x, f_y) = (self.t_fire[phase][x].as_micros(), self.t_fire[next % self.phases()][y].as_micros());
        f_y as i64 + (next - phase) as i64 * self.period.as_micros() as i64 - f_x as i64
    }
}

/// The audible part of a path, in microseconds.
struct Heard {
    window: i64,
    blanking: i64,
    reach: i64,
}

impl Heard {
    /// Returns true if some path is heard with both offsets: one that is no longer than `reach` and arrives in the
    /// window.
    const fn together(&self, a: i64, b: i64) -> bool {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        // The length lies in blanking - g .. window - g for both, and in 0 .. reach.
        let (shortest, longest) = (self.blanking - low, self.window - high);
        shortest <= longest && shortest <= self.reach && longest >= 0
    }
}
