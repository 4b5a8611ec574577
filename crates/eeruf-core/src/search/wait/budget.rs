//! The budget of a search in nodes, and its watcher.

use core::fmt;

use crate::search::{Control, Progress};

/// The budget of a search, and its watcher.
///
/// The budget counts nodes, so a search ends at the same place on each machine. The watcher is polled every few
/// thousand nodes and can stop the search.
pub struct Budget<'c> {
    nodes: u64,
    limit: u64,
    every: u64,
    next_poll: u64,
    polled_at: u64,
    watch: Option<&'c mut dyn Control>,
    stopped: bool,
    pub(super) best: Option<u32>,
    pub(super) bound: Option<u32>,
}

impl fmt::Debug for Budget<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Budget").field("nodes", &self.nodes).field("limit", &self.limit).finish_non_exhaustive()
    }
}

impl Default for Budget<'_> {
    fn default() -> Self {
        Self::unlimited()
    }
}

impl<'c> Budget<'c> {
    /// A budget without a limit: the search runs until it ends.
    #[must_use]
    pub const fn unlimited() -> Self {
        Self::nodes_at_most(u64::MAX)
    }

    /// A budget of at most this many nodes.
    #[must_use]
    pub const fn nodes_at_most(limit: u64) -> Self {
        Self {
            nodes: 0,
            limit,
            every: u64::MAX,
            next_poll: limit,
            polled_at: 0,
            watch: None,
            stopped: false,
            best: None,
            bound: None,
        }
    }

    /// Polls `watch` every `every` nodes (at least 1).
    #[must_use]
    pub fn watched(self, every: u32, watch: &'c mut dyn Control) -> Self {
        let every = u64::from(every.max(1));
        Self {
            every,
            next_poll: self.limit.min(self.nodes.saturating_add(every)),
            polled_at: self.nodes,
            watch: Some(watch),
            ..self
        }
    }

    /// Nodes visited so far.
    #[must_use]
    pub const fn nodes(&self) -> u64 {
        self.nodes
    }

    /// Returns true if the budget is spent or the watcher stopped the search.
    #[must_use]
    pub const fn spent(&self) -> bool {
        self.stopped || self.nodes >= self.limit
    }

    /// Enters a node; `false` when the search must stop.
    #[inline]
    pub(super) fn enter(&mut self) -> bool {
        if self.nodes < self.next_poll {
            self.nodes += 1;
            return true;
        }
        self.poll()
    }

    #[cold]
    fn poll(&mut self) -> bool {
        if self.spent() {
            return false;
        }
        let progress = Progress { nodes: self.nodes, best: self.best, bound: self.bound };
        if let Some(watch) = &mut self.watch {
            self.stopped = watch.poll(&progress).is_break();
        }
        self.polled_at = self.nodes;
        self.next_poll = self.limit.min(self.nodes.saturating_add(self.every));
        if self.stopped {
            return false;
        }
        self.nodes += 1;
        true
    }

    /// Runs `search` with at most `slice` further nodes of this budget.
    pub(super) fn slice<R>(&mut self, slice: u64, search: impl FnOnce(&mut Self) -> R) -> R {
        let limit = self.limit;
        self.limit = limit.min(self.nodes.saturating_add(slice));
        self.next_poll = self.next_poll.min(self.limit);
        let result = search(self);
        self.limit = limit;
        // The end of the slice was no poll: the next one is due when it was.
        self.next_poll = limit.min(self.polled_at.saturating_add(self.every));
        result
    }
}
