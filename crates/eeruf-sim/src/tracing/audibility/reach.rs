//! Range of sound, by its strength at departure.

/// Bits that number the steps within an octave of the square of an amplitude: four steps.
const STEPS_BITS: u32 = 2;
/// Number of octaves in the table; fainter sound has the range of the faintest entry.
const OCTAVES: usize = 64;

/// Upper bounds on the longest path that is heard.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Reach {
    /// Longest audible paths in metres, by steps of the squared amplitude at 1 m, strongest first; empty for no limit.
    lengths_m: Vec<f64>,
}

impl Reach {
    /// Makes the ranges for the threshold amplitude and the natural logarithm of the air's attenuation per metre.
    pub(super) fn new(floor: f64, loss_per_m: f64) -> Self {
        if !(floor > 0.0) {
            return Self::default();
        }
        let steps = OCTAVES << STEPS_BITS;
        // The step before the first one stands for 1 itself.
        Self { lengths_m: (0..=steps).map(|step| longest_m(square_at_most(step).sqrt(), floor, loss_per_m)).collect() }
    }

    /// Returns the longest audible path of sound that leaves with this square of an amplitude, at most 1.
    #[inline]
    pub(super) fn at(&self, square: f64) -> f64 {
        // The exponent and the first bits of the fraction number the steps, downwards from 1.
        let shift = 52 - STEPS_BITS;
        let below = (1f64.to_bits() >> shift).saturating_sub(square.max(0.0).to_bits() >> shift);
        self.lengths_m
            .get((below as usize).min(self.lengths_m.len().saturating_sub(1)))
            .copied()
            .unwrap_or(f64::INFINITY)
    }
}

/// Returns the largest square of this step.
fn square_at_most(step: usize) -> f64 {
    f64::from_bits(((1f64.to_bits() >> (52 - STEPS_BITS)) - step as u64 + 1) << (52 - STEPS_BITS))
}

/// Returns the longest path on which an amplitude of `sent` at 1 m stays above the floor, slightly rounded up.
fn longest_m(sent: f64, floor: f64, loss_per_m: f64) -> f64 {
    let (mut near, mut far) = (0.0, sent / floor);
    while far - near > 1e-4 * far {
        let middle = 0.5 * (near + far);
        let heard = sent * libm::exp(loss_per_m * middle) >= floor * middle;
        *(if heard { &mut near } else { &mut far }) = middle;
    }
    far * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    // All audible paths are within reach, and few others are.
    #[test]
    fn nothing_heard_is_out_of_reach() {
        let (floor, loss_per_m) = (8.19e-4, -0.189);
        let reach = Reach::new(floor, loss_per_m);
        for k in 0..4000 {
            let sent = libm::pow(0.998, f64::from(k));
            let longest = longest_m(sent, floor, loss_per_m);
            let found = reach.at(sent * sent);
            assert!(found >= longest / (1.0 + 2e-4), "{sent}");
            assert!(found <= 1.13 * longest + 1e-9, "{sent}: {found} {longest}");
        }
        assert!(reach.at(0.0) < 1e-4);
        assert_eq!(Reach::new(0.0, loss_per_m).at(0.5), f64::INFINITY);
    }
}
