//! Progress of an experiment on many threads, and whether it goes on: one that is stopped should not wait for the
//! simulations under way.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Asks with the share that is done, 0 to 1; the first `false` stops all threads.
pub(super) struct Progress<'a> {
    keep_going: &'a (dyn Fn(f64) -> bool + Sync),
    all: u64,
    done: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    /// For this number of simulations.
    pub(super) fn new(all: u64, keep_going: &'a (dyn Fn(f64) -> bool + Sync)) -> Self {
        Self { keep_going, all, done: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// True to go on; to be asked in the middle of a simulation as well.
    pub(super) fn go_on(&self) -> bool {
        let share = self.done.load(Ordering::Relaxed) as f64 / self.all as f64;
        let going = !self.stopped() && (self.keep_going)(share);
        if !going {
            self.stopped.store(true, Ordering::Relaxed);
        }
        going
    }

    /// One simulation has ended.
    pub(super) fn one_done(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.go_on();
    }

    /// Returns true if an answer was `false`.
    pub(super) fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
