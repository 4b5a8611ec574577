//! How the caller limits, watches and stops a search.

use core::ops::ControlFlow;

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Progress {
    /// Nodes visited so far.
    pub nodes: u64,
    /// The period that is being decided, in ticks.
    pub period: u32,
    /// No shorter period than this can exist.
    pub bound: u32,
    /// The shortest period found so far.
    pub best: u32,
}

/// Asked every [`POLL`] nodes or so. `()` always goes on and costs nothing.
pub trait Control {
    /// Whether to go on, given how far the search has come.
    fn poll(&mut self, progress: &Progress) -> ControlFlow<()>;
}

/// The nodes between two polls.
pub const POLL: u64 = 256;

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
