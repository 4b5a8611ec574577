//! Progress of an experiment on many threads, and its cancellation, which does not wait for running simulations.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Reporter of progress: it calls back with the finished share, 0 to 1; the first `false` stops all threads.
pub(super) struct Progress<'a> {
    keep_going: &'a (dyn Fn(f64) -> bool + Sync),
    all: u64,
    done: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    /// Makes a reporter for this number of simulations.
    pub(super) fn new(all: u64, keep_going: &'a (dyn Fn(f64) -> bool + Sync)) -> Self {
        Self { keep_going, all, done: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// Returns true to continue; also called in the middle of a simulation.
    pub(super) fn go_on(&self) -> bool {
        let share = self.done.load(Ordering::Relaxed) as f64 / self.all as f64;
        let going = !self.stopped() && (self.keep_going)(share);
        if !going {
            self.stopped.store(true, Ordering::Relaxed);
        }
        going
    }

    /// Counts a finished simulation.
    pub(super) fn one_done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.go_on();
    }

    /// Returns true if the callback returned `false`.
    pub(super) fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
