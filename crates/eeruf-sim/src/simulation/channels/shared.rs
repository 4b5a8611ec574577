//! Paths that simulations of one scene share, whatever their robots fire by: sought where the robots are at instants a
//! step apart, and carried on from the nearest of those to each firing.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::{geometry::Pose, tracing::CrosstalkMatrix};

/// Paths found so far in one scene. Simulations that share them differ in how robots fire and listen alone.
#[derive(Debug)]
pub(crate) struct SharedPaths {
    /// From one instant to the next, in nanoseconds.
    step: u64,
    /// By instant and emitter.
    found: Mutex<HashMap<(u64, usize), Arc<Snapshot>>>,
}

/// The paths from an emitter, or from emitters that are alike, at an instant.
#[derive(Debug)]
pub(super) struct Snapshot {
    /// Poses of all sensors at the instant.
    pub(super) poses: Vec<Pose>,
    /// The listeners of each kind, and the paths to them.
    pub(super) groups: Vec<(Vec<usize>, CrosstalkMatrix)>,
}

impl SharedPaths {
    /// No paths yet, at instants this many seconds apart.
    pub(crate) fn new(step_s: f64) -> Self {
        Self { step: ((step_s * 1e9) as u64).max(1), found: Mutex::default() }
    }

    /// The instant nearest to a time, in nanoseconds.
    pub(super) fn instant(&self, now: u64) -> u64 {
        (now + self.step / 2) / self.step * self.step
    }

    pub(super) fn get(&self, at: u64, emitter: usize) -> Option<Arc<Snapshot>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).get(&(at, emitter)).cloned()
    }

    pub(super) fn put(&self, at: u64, emitter: usize, snapshot: Snapshot) -> Arc<Snapshot> {
        let snapshot = Arc::new(snapshot);
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.insert((at, emitter), Arc::clone(&snapshot));
        snapshot
    }
}
