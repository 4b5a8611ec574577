//! Pseudo-random numbers, the same on every machine.

pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below a limit; 0 if the limit is 0 or 1.
    pub(crate) fn below<T: Copy + TryInto<u64> + TryFrom<u64> + Default>(&mut self, limit: T) -> T {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let limit = limit.try_into().unwrap_or(0).max(1);
        T::try_from((self.0 >> 33) % limit).unwrap_or_default()
    }
}
