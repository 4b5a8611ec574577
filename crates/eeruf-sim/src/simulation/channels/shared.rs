//! Paths that simulations of one scene share under any firing method: found for the robots' poses at instants a step
//! apart, and adapted from the nearest instant to each firing.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::{geometry::Pose, tracing::CrosstalkMatrix};

/// Paths found so far in one scene. Simulations that share them may differ only in the robots' firing and listening.
#[derive(Debug)]
pub(crate) struct SharedPaths {
    /// Time from one instant to the next, in nanoseconds.
    step: u64,
    /// Snapshots by instant and emitter.
    found: Mutex<HashMap<(u64, usize), Arc<Snapshot>>>,
}

/// The paths from an emitter, or from emitters of one kind, at an instant.
#[derive(Debug)]
pub(super) struct Snapshot {
    /// Poses of all sensors at the instant.
    pub(super) poses: Vec<Pose>,
    /// The listeners of each kind, and the paths to them.
    pub(super) groups: Vec<(Vec<usize>, CrosstalkMatrix)>,
}

impl SharedPaths {
    /// Returns an empty set, for instants this many seconds apart.
    pub(crate) fn new(step_s: f64) -> Self {
        Self { step: ((step_s * 1e9) as u64).max(1), found: Mutex::default() }
    }

    /// Returns the instant nearest to a time, in nanoseconds.
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::SharedPaths;
    use crate::*;

    /// Returns each reading and its reference for a robot in a room that drives and then turns.
    fn read(shared: Option<&Arc<SharedPaths>>) -> Vec<[f64; 2]> {
        let corners = [[-2.5, -2.0], [2.5, -2.0], [2.5, 2.0], [-2.5, 2.0], [-2.5, -2.0]];
        let scene = Scene::new(Wall::polyline(&corners).collect(), vec![Pole::new(1.2, 1.0, 0.06)], Air::default());
        let robot = Robot::ring(Pose::identity(), 8, 0.785, 0.2, Transducer::HC_SR04);
        let world = World::new(scene.unwrap(), vec![robot], Noise::default()).unwrap();
        let world = world.with_physics(Physics::DEFAULT).unwrap();
        let options = Options::default();
        let mut simulation = Simulation::new(Arc::new(world), Method::Sequential, &options, Stop::default()).unwrap();
        if let Some(shared) = shared {
            simulation.share(Arc::clone(shared));
        }
        let mut read = vec![];
        for (v_m_s, w_rad_s) in [(0.5, 0.0), (0.0, 0.8)] {
            simulation.set_velocity(0, v_m_s, w_rad_s).unwrap();
            let readings = simulation.step(2.0, |_| true).unwrap();
            read.extend(readings.reference_us.iter().zip(&readings.earliest_us).map(|(one, other)| [*one, *other]));
        }
        read
    }

    // The tolerance of 30 us is 5 mm. In 60 ms the robot drives 30 mm, which changes a reading by 175 us.
    #[test]
    fn shared_paths_are_carried_on_to_each_firing() {
        let exact = read(None);
        let shared = Arc::new(SharedPaths::new(0.12));
        let carried = read(Some(&shared));
        assert_eq!(exact.len(), carried.len());
        for index in 0..2 {
            let pairs: Vec<_> = exact.iter().zip(&carried).map(|(one, other)| [one[index], other[index]]).collect();
            let agrees = |[one, other]: &[f64; 2]| (one - other).abs() < 30.0 || (one.is_nan() && other.is_nan());
            let agree = pairs.iter().filter(|pair| agrees(pair)).count();
            let heard = pairs.iter().filter(|[one, other]| !one.is_nan() && !other.is_nan()).count();
            assert!(heard > 40 && agree * 100 > pairs.len() * 95, "{agree}, {heard} of {}: {pairs:?}", pairs.len());
        }
        // The next simulation uses the paths that were found.
        let known = shared.found.lock().unwrap().len();
        assert!(known > 40, "{known}");
        let bits = |read: Vec<[f64; 2]>| read.into_iter().map(|pair| pair.map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(read(Some(&shared))), bits(carried));
        assert_eq!(shared.found.lock().unwrap().len(), known);
    }
}
