//! Probabilities of accidents.

/// The natural logarithm of the factorial of `n`.
fn ln_factorial(n: f64) -> f64 {
    // Stirling's series, good to 1e-10 from 10 on; below, the product.
    if n < 10.0 {
        return (2..=n as u32).map(|k| f64::from(k).ln()).sum();
    }
    let tail = 1.0 / (12.0 * n) - 1.0 / (360.0 * n.powi(3)) + 1.0 / (1260.0 * n.powi(5));
    (n + 0.5) * n.ln() - n + 0.5 * (2.0 * core::f64::consts::PI).ln() + tail
}

/// The logarithm of the probability of at least `k` successes in `n` trials, each with the probability `p`.
pub(crate) fn ln_at_least(k: u32, n: u32, p: f64) -> f64 {
    if k == 0 || p >= 1.0 {
        return 0.0;
    }
    if p <= 0.0 || k > n {
        return f64::NEG_INFINITY;
    }
    let term = |j: u32| {
        let (j, n) = (f64::from(j), f64::from(n));
        ln_factorial(n) - ln_factorial(j) - ln_factorial(n - j) + j * p.ln() + (n - j) * (-p).ln_1p()
    };
    let terms: Vec<_> = (k..=n).map(term).collect();
    let largest = terms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (largest + terms.iter().map(|term| (term - largest).exp()).sum::<f64>().ln()).min(0.0)
}

/// The median; 0 without values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Groups of sorted values, each at most `span` wide from its first: ranges of places.
pub(crate) fn groups(sorted: &[i64], span: i64) -> Vec<core::ops::Range<usize>> {
    let mut groups: Vec<core::ops::Range<usize>> = Vec::new();
    for (place, &value) in sorted.iter().enumerate() {
        match groups.last_mut() {
            Some(group) if value - sorted[group.start] <= span => group.end = place + 1,
            _ => groups.push(place..place + 1),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_binomial_tail_is_the_sum_longhand() {
        let choose = |n: u32, k: u32| (0..k).fold(1.0, |product, i| product * f64::from(n - i) / f64::from(i + 1));
        for (k, n, p) in [(3_u32, 11_u32, 0.02_f64), (11, 11, 0.1), (1, 40, 0.003), (20, 40, 0.5)] {
            let longhand: f64 = (k..=n).map(|j| choose(n, j) * p.powi(j as i32) * (1.0 - p).powi((n - j) as i32)).sum();
            assert!((ln_at_least(k, n, p) - longhand.ln()).abs() < 1e-8, "{k} of {n} at {p}");
        }
        assert_eq!((ln_at_least(0, 5, 0.1), ln_at_least(6, 5, 0.1)), (0.0, f64::NEG_INFINITY));
    }

    #[test]
    fn values_close_to_the_first_of_their_group_belong_to_it() {
        assert_eq!(groups(&[0, 50, 100, 101, 300], 100), [0..3, 3..4, 4..5]);
    }
}
