//! Candidates of the search for pilots: the same for every method.

use eeruf_sim::experiments::set_two::Piloting;
use eeruf_sim::{Random, Vfh};

/// Parameters that the search may change; all others are as published. Numbers have few digits, so that they print
/// exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) smoothing: usize,
    pub(crate) threshold: f64,
    pub(crate) wide: usize,
    pub(crate) density_max: f64,
    pub(crate) turn_max_deg_s: f64,
    pub(crate) turn_gain: f64,
    pub(crate) range_m: f64,
    pub(crate) growth: bool,
}

impl Candidate {
    /// Returns the parameters in the simulator's form.
    pub(crate) fn piloting(&self) -> Piloting {
        let vfh = Vfh {
            smoothing: self.smoothing,
            threshold: self.threshold,
            wide: self.wide,
            density_max: self.density_max,
            turn_max_rad_s: self.turn_max_deg_s.to_radians(),
            ..Vfh::default()
        };
        Piloting { vfh, turn_gain: self.turn_gain, range_m: self.range_m, growth: self.growth }
    }
}

/// Seed of the candidates.
const SEED: u64 = 1991;

/// Returns the candidate of a number: the published pilot without and with the growth rate operator, then drawn ones.
/// The pilot that all methods once shared is excluded, since it was found by the score of one method.
pub(crate) fn candidate(number: usize) -> Candidate {
    let published = Candidate {
        smoothing: 5,
        threshold: 0.35,
        wide: 18,
        density_max: 3.0,
        turn_max_deg_s: 120.0,
        turn_gain: 3.0,
        range_m: 2.0,
        growth: number == 1,
    };
    if number < 2 {
        return published;
    }
    let mut random = Random::new(SEED).of(number as u64);
    Candidate {
        smoothing: random.between(1.0, 7.0) as usize,
        threshold: two_digits(log_between(&mut random, 0.01, 1.0)),
        wide: random.between(8.0, 25.0) as usize,
        density_max: two_digits(log_between(&mut random, 0.1, 4.0)),
        turn_max_deg_s: (random.between(9.0, 40.0).round()) * 10.0,
        turn_gain: (random.between(1.5, 5.0) * 10.0).round() / 10.0,
        range_m: (random.between(1.0, 3.5) * 20.0).round() / 20.0,
        growth: random.between(0.0, 1.0) < 0.5,
    }
}

fn log_between(random: &mut Random, low: f64, high: f64) -> f64 {
    libm::exp(random.between(libm::log(low), libm::log(high)))
}

/// Rounds to two significant digits.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_lie_in_their_ranges_and_print_in_few_digits() {
        for number in 0..500 {
            let of = candidate(number);
            assert!((1..=6).contains(&of.smoothing) && (8..=24).contains(&of.wide), "{of:?}");
            assert!((0.01..=1.0).contains(&of.threshold) && (0.1..=4.0).contains(&of.density_max), "{of:?}");
            assert!((90.0..=400.0).contains(&of.turn_max_deg_s) && (1.0..=3.5).contains(&of.range_m), "{of:?}");
            for value in [of.threshold, of.density_max, of.turn_max_deg_s, of.turn_gain, of.range_m] {
                assert!(value.to_string().len() <= 5, "{value}");
            }
        }
    }
}
