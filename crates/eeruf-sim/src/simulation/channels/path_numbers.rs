//! Numbers for paths, the same for the same walls and poles between the same sensors.

use core::hash::{Hash, Hasher};
use std::collections::HashMap;
use std::hash::DefaultHasher;

use crate::{
    results::{HeardPath, SensorId},
    scene::Bounce,
    tracing::CriticalPath,
    world::Random,
};

/// Every path met so far.
#[derive(Default)]
pub(super) struct PathNumbers {
    paths: Vec<HeardPath>,
    /// For each, what only its ends and its bounces decide, whenever it was met.
    keys: Vec<u64>,
    numbers: HashMap<u64, u32>,
}

impl PathNumbers {
    /// The number of a path from one sensor to another, a new one if it was never met.
    pub(super) fn number(
        &mut self,
        [emitter, receiver]: [SensorId; 2],
        path: &CriticalPath,
        bounces: &[Bounce],
    ) -> u32 {
        let mut hasher = DefaultHasher::new();
        (emitter, receiver, bounces).hash(&mut hasher);
        let mut key = hasher.finish();
        while let Some(&number) = self.numbers.get(&key) {
            let known = &self.paths[number as usize];
            if known.emitter == emitter && known.receiver == receiver && *known.bounces == *bounces {
                // One emitter has one image in a sequence of walls, so this is the same path, perhaps from another
                // position.
                return number;
            }
            key = key.wrapping_add(1);
        }
        let number = self.paths.len() as u32;
        self.numbers.insert(key, number);
        self.keys.push(key_of([emitter, receiver], bounces));
        self.paths.push(HeardPath {
            emitter,
            receiver,
            order: path.order,
            length_m: path.length_m,
            departure_rad: path.departure_rad,
            arrival_rad: path.arrival_rad,
            bounces: bounces.into(),
        });
        number
    }

    /// What only a path's ends and bounces decide: the same in every simulation, whatever was met before.
    pub(super) fn key(&self, number: u32) -> u64 {
        self.keys[number as usize]
    }

    /// The paths, by their numbers.
    pub(super) fn paths(&self) -> &[HeardPath] {
        &self.paths
    }
}

fn key_of(ends: [SensorId; 2], bounces: &[Bounce]) -> u64 {
    let ends = ends.iter().fold(Random::new(0), |key, id| key.of(id.robot.into()).of(id.sensor.into()));
    let mut all = bounces.iter().fold(ends, |key, bounce| match *bounce {
        Bounce::Wall(wall) => key.of(0).of(wall.into()),
        Bounce::Pole(pole) => key.of(1).of(pole.into()),
        Bounce::Edge(edge) => key.of(2).of(edge.into()),
    });
    all.bits()
}
