//! Shares with their intervals.

/// A share of a number of trials, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Number of trials in the share.
    pub count: u32,
    /// Number of trials.
    pub of: u32,
}

impl Share {
    pub(super) const NONE: Self = Self { count: 0, of: 0 };

    pub(super) fn add(&mut self, counts: bool) {
        self.count += u32::from(counts);
        self.of += 1;
    }

    /// The share as a number; 0 without trials.
    pub fn value(&self) -> f64 {
        f64::from(self.count) / f64::from(self.of.max(1))
    }

    /// The 95 % interval by Wilson's score, which holds for small counts too.
    pub fn interval_95(&self) -> (f64, f64) {
        const Z: f64 = 1.959_964;
        let n = f64::from(self.of);
        if self.of == 0 {
            return (0.0, 1.0);
        }
        let share = self.value();
        let middle = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        ((middle - half).max(0.0), (middle + half).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_wilsons() {
        let near = |share: Share, expected: (f64, f64)| {
            let (low, high) = share.interval_95();
            assert!((low - expected.0).abs() < 5e-5 && (high - expected.1).abs() < 5e-5, "{low} {high}");
        };
        // Newcombe (1998), Table I: 81 of 263, 15 of 148, 0 of 20.
        near(Share { count: 81, of: 263 }, (0.2553, 0.3662));
        near(Share { count: 15, of: 148 }, (0.0624, 0.1605));
        near(Share { count: 0, of: 20 }, (0.0, 0.1611));
    }
}
