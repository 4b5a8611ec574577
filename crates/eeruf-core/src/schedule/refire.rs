//! Time until a sensor of a [`Schedule`](super::Schedule) fires again, and the robot speed that it allows.

use super::{Phase, Schedule};
use crate::time::Micros;

impl<const K: usize, const M: usize> Schedule<K, M> {
    /// Time from a sensor's firing in a phase to its next one, `T_p - d` or `T_p + d` with two phases: the `dt` over
    /// which a good reading changes by `2 v dt / c`. `None` for a sensor or phase out of range.
    pub const fn refire_after(&self, phase: Phase, sensor: usize) -> Option<Micros> {
        if sensor < self.sensors as usize && (phase.0 as usize) < M {
            Some(self.refire(phase.0 as usize, sensor))
        } else {
            None
        }
    }

    /// The shortest time between two firings of one sensor: `T_p - max |d|` with two phases. No listening window may be
    /// longer.
    pub const fn min_refire(&self) -> Micros {
        self.min_refire
    }

    pub(super) const fn shortest_refire(&self) -> Micros {
        let mut least = Micros::MAX;
        let mut x = 0;
        while x < self.sensors as usize {
            let mut phase = 0;
            while phase < M {
                let refire = self.refire(phase, x);
                if refire.as_micros() < least.as_micros() {
                    least = refire;
                }
                phase += 1;
            }
            x += 1;
        }
        least
    }

    /// The longest time between two firings of one sensor: `T_p + max |d|` with two phases.
    pub const fn max_refire(&self) -> Micros {
        let mut most = Micros::ZERO;
        let mut x = 0;
        while x < self.sensors as usize {
            let mut phase = 0;
            while phase < M {
                let refire = self.refire(phase, x);
                if refire.as_micros() > most.as_micros() {
                    most = refire;
                }
                phase += 1;
            }
            x += 1;
        }
        most
    }

    /// The maximum speed, in mm/s, at which a good reading changes by no more than `t_delta` from one firing to the
    /// next, for a speed of sound of `c` mm/s. The change is `2 v dt / c` (Sec. 3.1), with `dt` up to
    /// [`max_refire`](Self::max_refire).
    pub const fn max_speed_mm_s(&self, t_delta: Micros, c_mm_s: u32) -> u32 {
        let speed = t_delta.as_micros() as u64 * c_mm_s as u64 / (2 * self.max_refire().as_micros() as u64);
        if speed > u32::MAX as u64 { u32::MAX } else { speed as u32 }
    }

    /// Time from a sensor's firing in a phase to its next one.
    pub(crate) const fn refire(&self, phase: usize, sensor: usize) -> Micros {
        let next = self.fire_at((phase + 1) % M, sensor).as_micros() + self.period.as_micros();
        Micros::new(next - self.fire_at(phase, sensor).as_micros())
    }
}
