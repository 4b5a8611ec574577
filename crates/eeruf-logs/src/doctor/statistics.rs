//! The tests of the doctor, each with a stated rate of false alarms.

/// Dependence of readings on the class of their firing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Dependence {
    /// The share of the readings that does.
    pub(crate) share: f64,
    /// Standard deviations of a normal variable that is as unlikely by chance.
    pub(crate) deviations: f64,
    /// Number of comparisons.
    pub(crate) count: u32,
}

/// Counts of pairs of readings, one of each class: which of the two is greater, by size of the difference.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Changes {
    counts: Vec<[u32; 2]>,
    pairs: u32,
}

impl Changes {
    pub(crate) fn new(sizes: usize) -> Self {
        Self { counts: vec![[0, 0]; sizes], pairs: 0 }
    }

    /// Counts a pair: which of the two is greater, and the size of the difference, if they differ.
    pub(crate) fn add(&mut self, difference: Option<(bool, usize)>) {
        self.pairs += 1;
        if let Some((greater, count)) =
            difference.and_then(|(greater, size)| Some((greater, self.counts.get_mut(size)?)))
        {
            count[usize::from(greater)] += 1;
        }
    }

    /// The test of Bowker, that each class is the greater one equally often. Sizes with fewer than 8 pairs are taken
    /// together.
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

/// Counts of readings for each of two classes: `[class][category]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Contingency {
    counts: [Vec<u32>; 2],
}

impl Contingency {
    pub(crate) fn new(categories: usize) -> Self {
        Self { counts: [vec![0; categories], vec![0; categories]] }
    }

    pub(crate) fn add(&mut self, class: bool, category: usize) {
        if let Some(count) = self.counts[usize::from(class)].get_mut(category) {
            *count += 1;
        }
    }

    fn totals(&self) -> [f64; 2] {
        [0, 1].map(|class| self.counts[class].iter().copied().map(f64::from).sum())
    }

    /// The share by which the classes differ is half the sum of the differences of their shares; comparisons are as
    /// many as the smaller class has.
    pub(crate) fn dependence(&self) -> Dependence {
        let count = self.totals().into_iter().fold(f64::INFINITY, f64::min) as u32;
        Dependence { share: self.distance(), deviations: self.deviations(), count }
    }

    fn distance(&self) -> f64 {
        let [a, b] = self.totals();
        if a == 0.0 || b == 0.0 {
            return 0.0;
        }
        let differences =
            self.counts[0].iter().zip(&self.counts[1]).map(|(x, y)| (f64::from(*x) / a - f64::from(*y) / b).abs());
        0.5 * differences.sum::<f64>()
    }

    /// The chi-square statistic of independence in standard deviations of a normal variable. Categories
    /// of which fewer than 5 are expected in a class are taken together.
    fn deviations(&self) -> f64 {
        let [a, b] = self.totals();
        let all = a + b;
        if a == 0.0 || b == 0.0 {
            return 0.0;
        }
        let (mut cells, mut rest) = (vec![], (0.0, 0.0));
        for (x, y) in self.counts[0].iter().zip(&self.counts[1]).map(|(x, y)| (f64::from(*x), f64::from(*y))) {
            if (x + y) * a.min(b) / all >= 5.0 { cells.push((x, y)) } else { rest = (rest.0 + x, rest.1 + y) }
        }
        if rest.0 + rest.1 > 0.0 {
            cells.push(rest);
        }
        let statistic: f64 = cells
            .iter()
            .map(|(x, y)| {
                let [for_a, for_b] = [a, b].map(|total| (x + y) * total / all);
                (x - for_a).powi(2) / for_a + (y - for_b).powi(2) / for_b
            })
            .sum();
        chi_square_deviations(statistic, cells.len().saturating_sub(1))
    }
}

/// A chi-square statistic of this many degrees of freedom as standard deviations of a normal variable that is as
/// unlikely to be exceeded, by the approximation of Wilson and Hilferty; 0 without freedom.
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
    fn classes_that_differ_are_told_from_those_that_do_not() {
        let table = |first: [u32; 2], second: [u32; 2]| {
            let mut table = Contingency::new(2);
            for (class, counts) in [(false, first), (true, second)] {
                (0..2).for_each(|category| (0..counts[category]).for_each(|_| table.add(class, category)));
            }
            table
        };
        // By hand: all expected 50, so 4 * 20^2 / 50 = 32, of one degree of freedom.
        let differ = table([70, 30], [30, 70]);
        assert!((differ.deviations() - chi_square_deviations(32.0, 1)).abs() < 1e-9);
        assert!((differ.distance() - 0.4).abs() < 1e-12 && differ.dependence().count == 100);
        assert!(table([50, 50], [50, 50]).deviations() < 0.0);
        // 3 of 100 are expected 1.5 times in a class: too few to count for themselves.
        assert_eq!(table([97, 3], [100, 0]).deviations(), table([97, 3], [100, 0]).deviations());
        assert_eq!((Contingency::new(2).deviations(), Contingency::new(2).distance()), (0.0, 0.0));
    }
}
