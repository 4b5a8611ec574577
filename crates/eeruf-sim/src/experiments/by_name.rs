//! Maps from methods' names in JSON to their values.

use serde::{Serialize, Serializer, ser::SerializeMap};

use crate::simulation::Entry;

/// Serialises pairs as a map, in their order.
pub(super) fn by_name<S: Serializer, T: Serialize>(entries: &[(String, T)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(entries.len()))?;
    for (name, entry) in entries {
        map.serialize_entry(name, entry)?;
    }
    map.end()
}

/// Returns pairs of methods' names and values.
pub(super) fn named<T>(methods: &[Entry], of: impl IntoIterator<Item = T>) -> Vec<(String, T)> {
    methods.iter().map(|entry| entry.name().to_owned()).zip(of).collect()
}

/// Regroups the runs of each scene by method.
pub(super) fn transposed<T>(methods: usize, scenes: Vec<Vec<T>>) -> Vec<Vec<T>> {
    let mut runs: Vec<Vec<T>> = (0..methods).map(|_| Vec::with_capacity(scenes.len())).collect();
    for scene in scenes {
        for (of, run) in runs.iter_mut().zip(scene) {
            of.push(run);
        }
    }
    runs
}
