//! Results that a search returns to the user, in microseconds.

use crate::schedule::Schedule;
use crate::time::Micros;

/// The best schedule that a search found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Found<const K: usize> {
    /// The schedule; `None` if there is none, or none was found within the budget.
    pub schedule: Option<Schedule<K>>,
    /// The value that was optimised: the period, the smallest interval or `t_delta`.
    pub value: Option<Micros>,
    /// The proven bound on that value; `None` if no schedule exists.
    pub bound: Option<Micros>,
    /// True if no better schedule exists (or none at all, without a schedule).
    pub proven: bool,
    /// Nodes visited: the same on each machine.
    pub nodes: u64,
}
