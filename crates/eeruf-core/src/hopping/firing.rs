//! [`HoppingFiring`]: when the sensors of a hopping ring fire.

use super::timetable::Timetable;
use crate::schedule::Phase;
use crate::scheduler::Scheduler as _;
use crate::time::Micros;

/// When the sensors of a [`HoppingRing`](super::HoppingRing) fire, as it is now: lags move, and some periods belong to
/// one sensor alone.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingFiring<'r, const K: usize>(pub(super) &'r Timetable<K>);

impl<const K: usize> HoppingFiring<'_, K> {
    /// The lag of a sensor as it is now; `None` for one that is not there.
    pub fn t_lag(&self, sensor: usize) -> Option<Micros> {
        self.0.t_lag(sensor)
    }

    /// The phase of the present period, from 0.
    pub const fn phase(&self) -> Phase {
        Phase(self.0.phase)
    }

    /// The sensor that the present period belongs to, if it is a solo period.
    pub fn solo(&self) -> Option<u8> {
        self.0.solo()
    }

    /// No sensor fires again within this time of firing.
    pub fn min_refire(&self) -> Micros {
        self.0.min_refire()
    }
}
