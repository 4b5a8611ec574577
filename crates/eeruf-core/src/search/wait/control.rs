//! Budget, progress and cancelling: one counter of nodes, one comparison a node.

use core::fmt;

/// What a search reports while it runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Nodes visited so far, over all searches that used this control.
    pub nodes: u64,
    /// The best value found so far, in ticks, where one is sought.
    pub value: Option<u32>,
    /// The upper bound proven so far, in ticks, where one is sought.
    pub bound: Option<u32>,
}

/// How long a search may run, and who watches it.
///
/// The budget counts nodes, so a search ends at the same place on each machine. The watcher is called every so many nodes
/// and cancels by returning `false`.
pub struct Control<'c> {
    nodes: u64,
    budget: u64,
    every: u64,
    next_poll: u64,
    polled_at: u64,
    watch: Option<&'c mut dyn FnMut(Progress) -> bool>,
    cancelled: bool,
    pub(super) value: Option<u32>,
    pub(super) bound: Option<u32>,
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Control").field("nodes", &self.nodes).field("budget", &self.budget).finish_non_exhaustive()
    }
}

impl Default for Control<'_> {
    fn default() -> Self {
        Self::unlimited()
    }
}

impl<'c> Control<'c> {
    /// No budget and nobody watching: the search runs until it is finished.
    #[must_use]
    pub const fn unlimited() -> Self {
        Self::nodes_at_most(u64::MAX)
    }

    /// A budget of so many nodes.
    #[must_use]
    pub const fn nodes_at_most(budget: u64) -> Self {
        Self {
            nodes: 0,
            budget,
            every: u64::MAX,
            next_poll: budget,
            polled_at: 0,
            watch: None,
            cancelled: false,
            value: None,
            bound: None,
        }
    }

    /// Calls `watch` every `every` nodes (at least 1); it cancels by returning `false`.
    #[must_use]
    pub fn watched(self, every: u32, watch: &'c mut dyn FnMut(Progress) -> bool) -> Self {
        let every = u64::from(every.max(1));
        Self {
            every,
            next_poll: self.budget.min(self.nodes.saturating_add(every)),
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

    /// Whether the budget is spent or the watcher cancelled.
    #[must_use]
    pub const fn spent(&self) -> bool {
        self.cancelled || self.nodes >= self.budget
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
        let progress = Progress { nodes: self.nodes, value: self.value, bound: self.bound };
        if let Some(watch) = &mut self.watch {
            self.cancelled = !watch(progress);
        }
        self.polled_at = self.nodes;
        self.next_poll = self.budget.min(self.nodes.saturating_add(self.every));
        if self.cancelled {
            return false;
        }
        self.nodes += 1;
        true
    }

    /// Runs `search` with at most `slice` further nodes of this budget.
    pub(super) fn slice<R>(&mut self, slice: u64, search: impl FnOnce(&mut Self) -> R) -> R {
        let budget = self.budget;
        self.budget = budget.min(self.nodes.saturating_add(slice));
        self.next_poll = self.next_poll.min(self.budget);
        let result = search(self);
        self.budget = budget;
        // The end of the slice was no poll: the next one is due when it was.
        self.next_poll = budget.min(self.polled_at.saturating_add(self.every));
        result
    }
}
