//! Readings of a simulation as firings of a log, as a ring's firmware would write them.

use eeruf_logs::Firing;
use eeruf_sim::Readings;

/// The firing of this reading, without what a tracker weighed.
pub(crate) fn firing_of(readings: &Readings, k: usize) -> Firing {
    Firing { weighed: None, ..eeruf::firing(readings, k) }
}
