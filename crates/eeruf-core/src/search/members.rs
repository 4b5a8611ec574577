//! The members of a bit set.

/// Iterator over the members of a set of numbers below 64, given as bits, lowest first.
///
/// Not [`SensorSet`](crate::sensor_set::SensorSet), which is two words for targets without 64-bit registers: the
/// searches compute with whole rows of bits.
#[derive(Clone, Copy)]
pub(crate) struct Members(pub(crate) u64);

impl Iterator for Members {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let member = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(member)
    }
}
