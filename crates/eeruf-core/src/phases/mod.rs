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

use crate::layout::Layout;
use crate::schedule::{MAX_SENSORS, Phase};
use crate::time::Micros;

pub use verify::{PhaseCriterion, PhaseRequirements, PhaseVerification, PhaseViolation, PhaseViolations};

/// Firing times of any number of phases, to be checked: a row for each phase, a number for each sensor.
///
/// ```
/// use eeruf_core::{Micros, hopping::{HoppingCode, HoppingSchedule}, phases::{Audible, PhaseTable}};
/// const TIMES: [[Micros; 4]; 6] = {
///     let Ok(code) = HoppingCode::new(4, 2, Micros::new(301)) else { panic!() };
///     let Ok(ring) = HoppingSchedule::<4>::spread(code, Micros::from_millis(60)) else { panic!() };
///     ring.table()
/// };
/// // Checked when it is compiled.
/// const SAFE: bool = {
///     let table = PhaseTable::new(Micros::from_millis(60), &TIMES);
///     match table.separation(&Audible::new(Micros::from_millis(36))) {
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

/// The audible part of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Audible {
    /// Listening time of a sensor after it has fired.
    pub window: Micros,
    /// Deaf time before that.
    pub blanking: Micros,
    /// After how long no sound is heard any more; sound that is four periods old never is.
    pub reach: Micros,
}

impl Audible {
    /// This window, no blanking, and sound that is heard for as long as the window.
    pub const fn new(window: Micros) -> Self {
        Self { window, blanking: Micros::ZERO, reach: window }
    }
}

/// The least shift of crosstalk, and where it occurs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseSeparation {
    /// The shift.
    pub value: Micros,
    /// The sensor that sends and the one that hears, from 0.
    pub sensors: (u8, u8),
    /// The two phases in which it hears.
    pub phases: (Phase, Phase),
    /// Number of periods before the sound was sent, in each: -1 if in the period after, while it still listened.
    pub ages: (i8, i8),
}

/// The shortest time between two firings, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseInterval {
    /// The interval.
    pub value: Micros,
    /// The two sensors, from 0; twice the same where a sensor fires again.
    pub sensors: (u8, u8),
    /// The phases in which they fire.
    pub phases: (Phase, Phase),
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
    /// can be heard; `None` if no path can be heard in two phases. Takes `25 (K M)^2` steps.
    pub const fn separation(&self, audible: &Audible) -> Option<PhaseSeparation> {
        let mut least: Option<PhaseSeparation> = None;
        let mut x = 0;
        while x < self.sensors() {
            let mut y = 0;
            while y < self.sensors() {
                if x != y {
                    least = self.closer(least, x, y, audible);
                }
                y += 1;
            }
            x += 1;
        }
        least
    }

    /// The same of a sensor's own sound from earlier periods: by how much a stale echo moves at least. `None` if none
    /// can be heard in two phases. Sound that is a whole cycle old does not move, and does not count.
    pub const fn stale_separation(&self, audible: &Audible) -> Option<PhaseSeparation> {
        let mut least: Option<PhaseSeparation> = None;
        let mut x = 0;
        while x < self.sensors() {
            least = self.closer(least, x, x, audible);
            x += 1;
        }
        least
    }

    /// As far as a pair goes.
    const fn closer(
        &self,
        mut least: Option<PhaseSeparation>,
        x: usize,
        y: usize,
        audible: &Audible,
    ) -> Option<PhaseSeparation> {
        let events = self.phases() * AGES.len();
        let mut one = 0;
        while one < events {
            let mut other = (one / AGES.len() + 1) * AGES.len();
            while other < events {
                let (a, b) = (self.offset(x, y, one), self.offset(x, y, other));
                if (x != y || self.is_stale(one) && self.is_stale(other)) && together(a, b, audible) {
                    let value = Micros::new(a.abs_diff(b) as u32);
                    let closer = match least {
                        Some(least) => value.as_micros() < least.value.as_micros(),
                        None => true,
                    };
                    if closer {
                        let phases = (Phase((one / AGES.len()) as u8), Phase((other / AGES.len()) as u8));
                        let ages = (AGES[one % AGES.len()], AGES[other % AGES.len()]);
                        least = Some(PhaseSeparation { value, sensors: (x as u8, y as u8), phases, ages });
                    }
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
    pub const fn min_refire(&self) -> Option<PhaseInterval> {
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

    /// The smallest interval between the firings of two neighbours, within a period and from one to the next; `None`
    /// without neighbours.
    pub const fn min_interval(&self, layout: Layout<'_>) -> Option<PhaseInterval> {
        let mut least = None;
        let mut x = 0;
        while x < self.sensors() {
            let mut y = 0;
            while y < self.sensors() {
                let mut phase = 0;
                while layout.neighbours(self.sensors(), x, y) && phase < self.phases() {
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
    const fn between(&self, x: usize, phase: usize, y: usize, next: usize) -> PhaseInterval {
        let wrapped = next % self.phases();
        let (f_x, f_y) = (self.t_fire[phase][x].as_micros(), self.t_fire[wrapped][y].as_micros());
        let periods = (next - phase) as u64 * self.period.as_micros() as u64;
        let apart = (f_y as u64 + periods).abs_diff(f_x as u64);
        let value = Micros::new(if apart > u32::MAX as u64 { u32::MAX } else { apart as u32 });
        PhaseInterval { value, sensors: (x as u8, y as u8), phases: (Phase(phase as u8), Phase(wrapped as u8)) }
    }
}

/// Returns true if some path is heard with both offsets: one that is no longer than `reach` and arrives in the window.
const fn together(a: i64, b: i64, audible: &Audible) -> bool {
    let (window, blanking) = (audible.window.as_micros() as i64, audible.blanking.as_micros() as i64);
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    // The length lies in blanking - g .. window - g for both, and in 0 .. reach.
    let (shortest, longest) = (blanking - low, window - high);
    shortest <= longest && shortest <= audible.reach.as_micros() as i64 && longest >= 0
}

const fn shorter(least: Option<PhaseInterval>, next: PhaseInterval) -> Option<PhaseInterval> {
    match least {
        Some(least) if least.value.as_micros() <= next.value.as_micros() => Some(least),
        _ => Some(next),
    }
}
