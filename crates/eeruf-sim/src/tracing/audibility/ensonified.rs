//! An upper bound on the echo of one pole, which excludes receivers before the reflection is solved.

use super::{Audibility, nearest_cos};
use crate::{geometry::Point, scene::Pole};

/// A pole that the source's sound reaches, and the receivers that may hear it.
///
/// ```text
/// A^2 <= (a / 2) / (s' s (s' + s))
/// ```
pub(crate) struct EnsonifiedPole<'a> {
    pub(super) audibility: &'a Audibility,
    pub(super) pole: &'a Pole,
    /// Distance before the pole, `s'`.
    pub(super) before_m: f64,
    /// The known part of `A^2`: all except the receiver's pattern and `s' s (s' + s)`.
    pub(super) part: f64,
}

impl EnsonifiedPole<'_> {
    /// Returns true if certainly none of these receivers hears the sound.
    #[inline]
    pub(crate) fn is_inaudible(&self, receivers: &[Point]) -> bool {
        if self.part == 0.0 {
            return true;
        }
        let far2 = receivers.iter().map(|at| (self.pole.centre - at).norm_squared());
        self.is_too_faint(self.part, far2.fold(f64::INFINITY, f64::min).sqrt())
    }

    /// Returns true if a receiver may hear the sound.
    #[inline]
    pub(crate) fn may_be_heard(&self, receiver: usize, at: Point) -> bool {
        let Some(axis) = self.audibility.receivers.get(receiver) else { return true };
        let home = self.pole.centre - at;
        let far_m = home.norm();
        let heard = self.audibility.heard(nearest_cos(home, far_m, self.pole.radius_m, *axis));
        !self.is_too_faint(self.part * heard, far_m)
    }

    /// Returns true if `A^2 s' s (s' + s)` is too small at this distance from the pole's centre.
    #[inline]
    fn is_too_faint(&self, part: f64, far_m: f64) -> bool {
        let after_m = (far_m - self.pole.radius_m).max(0.0);
        let length_m = self.before_m + after_m;
        part < self.audibility.faint(length_m) * self.before_m * after_m * length_m
    }
}
