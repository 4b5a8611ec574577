//! Starts of a file's chunks, from its index: reading continues there after a record with a wrong length.

/// Starts of chunks, in bytes from the file's beginning.
#[derive(Default)]
pub(crate) struct Chunks(Vec<u64>);

impl Chunks {
    pub(crate) fn add(&mut self, start: u64) {
        let place = self.0.partition_point(|&known| known < start);
        self.0.insert(place, start);
    }

    /// The first chunk that begins after a place, in a file of this size.
    pub(crate) fn after(&self, at: u64, size: u64) -> Option<u64> {
        self.0.get(self.0.partition_point(|&start| start <= at)).copied().filter(|&start| start < size)
    }

    /// Removes a place at which no chunk begins, because the index is wrong.
    pub(crate) fn forget(&mut self, start: u64) {
        self.0.retain(|&known| known != start);
    }
}
