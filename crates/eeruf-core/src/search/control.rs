//! Control over a search: watching and stopping it, and the three ways in which it ends.

use core::ops::ControlFlow;

/// Progress of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Progress {
    /// Nodes visited so far.
    pub nodes: u64,
    /// The best value found so far, in ticks, if the search optimises one: the shortest period, the largest interval or
    /// separation.
    pub best: Option<u32>,
    /// The proven bound on that value, in ticks.
    pub bound: Option<u32>,
}

impl Progress {
    /// Makes the progress of a search in another crate: nodes, the best value so far and its bound.
    pub const fn new(nodes: u64, best: Option<u32>, bound: Option<u32>) -> Self {
        Self { nodes, best, bound }
    }
}

/// Watcher of a search, polled every few milliseconds or as often as the caller asks. `()` never stops it and costs
/// nothing.
pub trait Control {
    /// Returns true to continue, given the progress.
    fn poll(&mut self, progress: &Progress) -> ControlFlow<()>;
}

impl Control for () {
    #[inline(always)]
    fn poll(&mut self, _: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(&Progress) -> ControlFlow<()>> Control for F {
    fn poll(&mut self, progress: &Progress) -> ControlFlow<()> {
        self(progress)
    }
}

/// Result of a search. For searches that return their answer elsewhere, such as those for waits, `T` is `()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Outcome<T = ()> {
    /// The answer was found.
    Found(T),
    /// Every possibility was searched or excluded: a proof that no answer, or no further one, exists.
    Exhausted,
    /// The budget was spent or the caller stopped the search: neither found nor excluded.
    BudgetSpent,
}

impl<T> Outcome<T> {
    /// Returns true if something was found.
    pub const fn is_found(&self) -> bool {
        matches!(self, Self::Found(_))
    }
}
