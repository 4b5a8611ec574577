//! How the caller limits, watches and stops a search.

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

/// Whether to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop; the answer is the best found so far, with its bound.
    Stop,
}

/// Asked every [`POLL`] nodes or so. `()` always goes on and costs nothing.
pub trait Control {
    /// Whether to go on, given how far the search has come.
    fn poll(&mut self, progress: &Progress) -> Flow;
}

/// The nodes between two polls.
pub const POLL: u64 = 256;

impl Control for () {
    #[inline(always)]
    fn poll(&mut self, _: &Progress) -> Flow {
        Flow::Continue
    }
}

impl<F: FnMut(&Progress) -> Flow> Control for F {
    fn poll(&mut self, progress: &Progress) -> Flow {
        self(progress)
    }
}
