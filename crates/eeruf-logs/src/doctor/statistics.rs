//! The tests of the doctor, each with a stated rate of false alarms.

/// Number of a sensor's readings below which nothing is concluded.
pub(super) const FEWEST: u32 = 30;
/// Significance limit in standard deviations: chance exceeds it in 3 of 100,000 sensors.
const DEVIATIONS: f64 = 4.0;
/// Least share of affected readings for a verdict, besides significance.
pub(super) const LEAST_SHARE: f64 = 0.05;

/// Dependence of readings on the class of their firing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Dependence {
    /// The share of readings that depends on the class.
    pub(crate) share: f64,
    /// The chance probability, as standard deviations of a normal variable.
    pub(crate) deviations: f64,
    /// Number of comparisons.
    pub(crate) count: u32,
}

impl Dependence {
    /// Returns true if neither chance nor a rare event explains it.
    pub(crate) fn is_foreign(&self) -> bool {
        self.count >= FEWEST && self.deviations >= DEVIATIONS && self.share >= LEAST_SHARE
    }
}

/// Counts of pairs of readings, one of each class: which is greater, by size of the difference.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Changes {
    counts: Vec<[u32; 2]>,
    pairs: u32,
}

impl Changes {
    pub(crate) fn new(sizes: usize) -> Self {
        Self { counts: vec![[0, 0]; sizes], pairs: 0 }
    }

    /// Counts a pair: which one is greater, and the size of the difference, if they differ.
    pub(crate) fn add(&mut self, difference: Option<(bool, usize)>) {
        self.pairs += 1;
        if let Some((greater, count)) =
            difference.and_then(|(greater, size)| Some((greater, self.counts.get_mut(size)?)))
        {
            count[usize::from(greater)] += 1;
        }
    }

    /// Bowker's test that each class is the greater one equally often. Sizes with fewer than 8 pairs are combined.
    pub(crate) fn dependence(&self) -> Dependence {
        let (mut cells, mut rest) = (vec![], [0.0, 0.0]);
        for [one, other] in self.counts.iter().map(|counts| counts.map(f64::from)) {
            if one + other >= 8.0 { cells.push([one, other]) } else { rest = [rest[0] + one, rest[1] + other] }
        }
        if rest[0] + rest[1] >= 8.0 {
            cells.push(rest);
        }
        let statistic: f64 = cells.iter().map(|[one, other]| (one - other).powi(2) / (one + other)).sum();
        let share = cells.iter().map(|[one, other]| (one - other).abs()).sum::<f64>() / f64::from(self.pairs.max(1));
        Dependence { share, deviations: chi_square_deviations(statistic, cells.len()), count: self.pairs }
    }
}

/// A chi-square statistic with this many degrees of freedom, converted to standard deviations of a normal variable by
/// the approximation of Wilson and Hilferty; 0 without freedom.
pub(crate) fn chi_square_deviations(statistic: f64, freedom: usize) -> f64 {
    if freedom == 0 {
        return 0.0;
    }
    let part = 2.0 / (9.0 * freedom as f64);
    ((statistic / freedom as f64).cbrt() - (1.0 - part)) / part.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chi_square_is_worth_its_tabulated_deviations() {
        // Quantiles of 95 % (1.6449 deviations) and 99.9 % (3.0902), from tables.
        for (freedom, at_95, at_999) in [(1, 3.841, 10.828), (2, 5.991, 13.816), (5, 11.070, 20.515)] {
            assert!((chi_square_deviations(at_95, freedom) - 1.6449).abs() < 0.05, "{freedom}");
            assert!((chi_square_deviations(at_999, freedom) - 3.0902).abs() < 0.1, "{freedom}");
        }
        assert_eq!(chi_square_deviations(9.0, 0), 0.0);
    }

    #[test]
    fn changes_one_way_are_told_from_those_both_ways() {
        let changes = |counts: &[[u32; 2]], same: u32| {
            let mut changes = Changes::new(counts.len());
            for (size, counts) in counts.iter().enumerate() {
                [false, true].iter().zip(counts).for_each(|(&greater, &count)| {
                    (0..count).for_each(|_| changes.add(Some((greater, size))));
                });
            }
            (0..same).for_each(|_| changes.add(None));
            changes.dependence()
        };
        // By hand: 20^2 / 40 + 12^2 / 20 = 17.2, of two degrees of freedom; 32 of 100 pairs are one way more.
        let differ = changes(&[[30, 10], [4, 16]], 40);
        assert!((differ.deviations - chi_square_deviations(17.2, 2)).abs() < 1e-9);
        assert!((differ.share - 0.32).abs() < 1e-12 && differ.count == 100);
        assert!(changes(&[[20, 20], [10, 10]], 40).deviations < 0.0);
        // Five of each size are too few to count for themselves, and ten together are not.
        assert_eq!(changes(&[[5, 0], [0, 5]], 40).share, 0.0);
        assert_eq!(changes(&[[5, 0], [5, 0]], 40).share, 0.2);
        assert_eq!(changes(&[[7, 0]], 40), Dependence { share: 0.0, deviations: 0.0, count: 47 });
    }
}
