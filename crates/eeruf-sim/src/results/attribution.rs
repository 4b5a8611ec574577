//! Attribution of errors: the wrong readings of a simulation, counted by sensor, cause and path.

use std::collections::HashMap;

use serde::Serialize;

use super::readings::{Cause, Readings, SensorId};

/// Wrong readings of one sensor from one cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Attribution {
    /// The sensor that was fooled.
    pub receiver: SensorId,
    /// Cause of the error. With [`Cause::Nothing`] the sensor heard nothing where it should have.
    pub cause: Cause,
    /// Sensor that caused the wrong readings, if there is one.
    pub emitter: Option<SensorId>,
    /// Index into [`Readings::paths`], or [`NO_PATH`](super::NO_PATH).
    pub path: u32,
    /// Number of bounces of the path.
    pub order: Option<u32>,
    /// Number of readings that were wrong this way, believed or not.
    pub wrong: usize,
    /// Number of wrong readings that the method believed.
    pub accepted: usize,
}

impl Readings {
    /// Returns the wrong readings by receiver, cause and path, with the most often believed ones first.
    pub fn attribution(&self, tolerance_us: f64) -> Vec<Attribution> {
        let mut rows: HashMap<(SensorId, Cause, u32), Attribution> = HashMap::new();
        for reading in (0..self.len()).filter(|&reading| self.is_wrong(reading, tolerance_us)) {
            let (receiver, cause, path) = (self.id(reading), self.cause[reading], self.path[reading]);
            let row = rows.entry((receiver, cause, path)).or_insert_with(|| {
                let heard = self.path_of(reading);
                let (emitter, order) = (heard.map(|heard| heard.emitter), heard.map(|heard| heard.order));
                Attribution { receiver, cause, emitter, path, order, wrong: 0, accepted: 0 }
            });
            row.wrong += 1;
            row.accepted += usize::from(self.is_accepted(reading));
        }
        let mut rows: Vec<_> = rows.into_values().collect();
        rows.sort_by_key(|row| (core::cmp::Reverse((row.accepted, row.wrong)), row.receiver, row.cause, row.path));
        rows
    }
}
