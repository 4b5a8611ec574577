//! Where the chunks of a file begin, as its index says: there reading goes on after a record whose length is wrong.

/// Starts of chunks, in bytes from the file's beginning.
#[derive(Default)]
pub(crate) struct Chunks(Vec<u64>);

impl Chunks {
    pub(crate) fn add(&mut self, start: u64) {
        let place = self.0.partition_point(|&known| known < start);
        self.0.insert(place, start);
    }

    /// The first one that begins after a place, in a file of this size.
    pub(crate) fn after(&self, at: u64, size: u64) -> Option<u64> {
        self.0.get(self.0.partition_point(|&start| start <= at)).copied().filter(|&start| start < size)
    }

    /// No chunk begins there: the index is wrong.
    pub(crate) fn forget(&mut self, start: u64) {
        self.0.retain(|&known| known != start);
    }
}
