//! The result of a query for paths: flat arrays that are reused from query to query.

use crate::scene::Bounce;

/// Paths as arrays of equal length, sorted by receiver, then by length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Paths {
    /// Index of the receiver.
    pub receiver: Vec<u32>,
    /// Length in metres.
    pub length_m: Vec<f64>,
    /// Number of bounces, including those at poles, floor and ceiling.
    pub order: Vec<u32>,
    /// Direction in which the path leaves the source, in (-pi, pi].
    pub departure_rad: Vec<f64>,
    /// Direction in which the receiver sees the path, in (-pi, pi].
    pub arrival_rad: Vec<f64>,
    /// Amplitude relative to 1 m in free air, without the transducers' patterns.
    pub amplitude: Vec<f64>,
    /// Elevations of departure and arrival; empty in a flat scene.
    pub(super) elevations_rad: Vec<[f64; 2]>,
    /// End of each path's range in `bounces`.
    pub(super) ends: Vec<u32>,
    pub(super) bounces: Vec<Bounce>,
}

impl Paths {
    /// Returns the number of paths.
    pub fn len(&self) -> usize {
        self.length_m.len()
    }

    /// Returns true if there are no paths.
    pub fn is_empty(&self) -> bool {
        self.length_m.is_empty()
    }

    /// Returns the bounces of a path from source to receiver; empty for a path that does not exist.
    pub fn bounces(&self, path: usize) -> &[Bounce] {
        let end_of = |path: usize| self.ends.get(path).map_or(0, |end| *end as usize);
        let start = if path == 0 { 0 } else { end_of(path - 1) };
        self.bounces.get(start..end_of(path)).unwrap_or(&[])
    }

    /// Returns the elevations of a path's departure and arrival in radians, upwards positive; 0 in a flat scene.
    pub fn elevations_rad(&self, path: usize) -> [f64; 2] {
        self.elevations_rad.get(path).copied().unwrap_or_default()
    }

    #[inline]
    pub(super) fn push(&mut self, receiver: u32, order: u32, [departure_rad, arrival_rad]: [f64; 2]) {
        self.receiver.push(receiver);
        self.order.push(order);
        self.departure_rad.push(departure_rad);
        self.arrival_rad.push(arrival_rad);
    }

    /// Returns the indices of one receiver's paths.
    pub fn of(&self, receiver: u32) -> core::ops::Range<usize> {
        self.receiver.partition_point(|&r| r < receiver)..self.receiver.partition_point(|&r| r <= receiver)
    }

    pub(super) fn reserve(&mut self, more: usize) {
        self.receiver.reserve(more);
        self.length_m.reserve(more);
        self.order.reserve(more);
        self.departure_rad.reserve(more);
        self.arrival_rad.reserve(more);
        self.amplitude.reserve(more);
        self.ends.reserve(more);
    }

    /// Removes the paths and keeps the memory.
    pub fn clear(&mut self) {
        self.receiver.clear();
        self.length_m.clear();
        self.order.clear();
        self.departure_rad.clear();
        self.arrival_rad.clear();
        self.amplitude.clear();
        self.elevations_rad.clear();
        self.ends.clear();
        self.bounces.clear();
    }
}
