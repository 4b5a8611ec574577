//! Numbers of paths: paths over the same walls and poles between the same sensors have one number.

use core::hash::{BuildHasherDefault, Hasher};
use std::collections::HashMap;

use crate::{
    results::{HeardPath, SensorId},
    scene::Bounce,
    tracing::CriticalPath,
    world::Random,
};

/// Every path met so far.
#[derive(Clone, Default)]
pub(super) struct PathNumbers {
    paths: Vec<HeardPath>,
    /// For each path, the key that depends only on its ends and bounces.
    keys: Vec<u64>,
    numbers: HashMap<u64, u32, BuildHasherDefault<AsItIs>>,
}

impl PathNumbers {
    /// Returns the number of a path from one sensor to another, a new one if the path is new.
    pub(super) fn number(
        &mut self,
        [emitter, receiver]: [SensorId; 2],
        path: &CriticalPath,
        bounces: &[Bounce],
    ) -> u32 {
        let own = key_of([emitter, receiver], bounces);
        let mut key = own;
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
        self.keys.push(own);
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

    /// Returns a key that depends only on a path's ends and bounces, and so is equal in every simulation.
    pub(super) fn key(&self, number: u32) -> u64 {
        self.keys[number as usize]
    }

    /// Returns the paths, by their numbers.
    pub(super) fn paths(&self) -> &[HeardPath] {
        &self.paths
    }
}

fn key_of(ends: [SensorId; 2], bounces: &[Bounce]) -> u64 {
    let [from, to] = ends.map(|id| u64::from(id.robot) << 8 | u64::from(id.sensor));
    let start = Random::new(from << 32 | to);
    let mut all = bounces.iter().fold(start, |key, bounce| {
        let (kind, index) = match *bounce {
            Bounce::Wall(wall) => (0, wall),
            Bounce::Pole(pole) => (1, pole),
            Bounce::Edge(edge) => (2, edge),
            Bounce::Floor => (3, 0),
            Bounce::Ceiling => (4, 0),
        };
        key.of(kind << 32 | u64::from(index))
    });
    all.bits()
}

/// A hasher that does not change keys, since they are already well mixed.
#[derive(Default)]
struct AsItIs(u64);

impl Hasher for AsItIs {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        // Keys are whole numbers, which are hashed by the other function.
        self.0 = bytes.iter().fold(self.0, |key, byte| key.rotate_left(8) ^ u64::from(*byte));
    }

    fn write_u64(&mut self, key: u64) {
        self.0 = key;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_have_keys_of_their_own_whenever_they_are_met() {
        let id = |robot, sensor| SensorId { robot, sensor };
        let (wall, pole, edge) = (Bounce::Wall(1), Bounce::Pole(1), Bounce::Edge(1));
        let ways: [&[Bounce]; 7] = [&[], &[wall], &[pole], &[edge], &[wall, pole], &[pole, wall], &[wall, wall]];
        let ends = [[id(0, 0), id(0, 1)], [id(0, 1), id(0, 0)], [id(1, 0), id(0, 0)], [id(0, 0), id(1, 0)]];
        let mut keys: Vec<u64> = ends.iter().flat_map(|ends| ways.map(|way| key_of(*ends, way))).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), ends.len() * ways.len());
    }
}
