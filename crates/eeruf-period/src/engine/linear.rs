//! Linear programs in exact integers: the dual simplex method without fractions.
//!
//! The problem: variables `z >= 0`, rows `sum of coefficients z >= least`, and the first variable as small as possible.
//! Its own coefficient in what is minimised is 1 and the others' are 0, none is negative, so that the method needs no
//! first phase: it begins with all variables 0 and mends one row that fails after the other (Lemke 1954). All entries
//! have one denominator, the last pivot, and each division by the one before leaves no remainder (Edmonds 1967).

/// A row: the coefficients of the variables, and the least value of their sum.
pub(crate) type Row = (Vec<(usize, i32)>, i32);

/// The values of the variables as numerators, and their one denominator.
pub(crate) type Point = (Vec<i128>, i128);

/// A point with the smallest value of variable 0, if the rows can be met.
///
/// `None` too where numbers grow beyond 127 bits, or after `most_pivots`.
pub(crate) fn least_of_first(variables: usize, rows: &[Row], most_pivots: usize) -> Option<Point> {
    let mut tableau = Tableau::new(variables, rows);
    for _ in 0..most_pivots {
        let Some(row) = tableau.failing() else { return Some(tableau.point(variables)) };
        tableau.pivot(row)?;
    }
    None
}

/// Each variable and each row's surplus, as a sum of those that are 0 at the present point.
struct Tableau {
    /// `value[i] = (constant[i] + sum over j of entry[i][j] zero[j]) / denominator`; the last row is what is minimised.
    entries: Vec<Vec<i128>>,
    constants: Vec<i128>,
    denominator: i128,
    /// The variable or surplus of each row and each column: variables by their numbers, surpluses above.
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Tableau {
    fn new(variables: usize, rows: &[Row]) -> Self {
        let mut entries = vec![vec![0; variables]; rows.len() + 1];
        for ((coefficients, _), entries) in rows.iter().zip(&mut entries) {
            for &(variable, coefficient) in coefficients {
                entries[variable] += i128::from(coefficient);
            }
        }
        entries[rows.len()][0] = 1;
        let constants = rows.iter().map(|&(_, least)| -i128::from(least)).chain([0]).collect();
        let surpluses = (variables..variables + rows.len()).collect();
        Self { entries, constants, denominator: 1, rows: surpluses, columns: (0..variables).collect() }
    }

    /// The row that fails and has the lowest number, so that the method ends (Bland 1977).
    fn failing(&self) -> Option<usize> {
        (0..self.rows.len()).filter(|&row| self.constants[row] < 0).min_by_key(|&row| self.rows[row])
    }

    /// Makes this row 0 by letting one that is 0 grow: that with which the minimum grows least.
    fn pivot(&mut self, row: usize) -> Option<()> {
        let costs = &self.entries[self.rows.len()];
        let mut best: Option<usize> = None;
        for column in (0..self.columns.len()).filter(|&column| self.entries[row][column] > 0) {
            let is_better = match best {
                None => true,
                Some(best) => {
                    let cost = costs[column].checked_mul(self.entries[row][best])?;
                    let so_far = costs[best].checked_mul(self.entries[row][column])?;
                    (cost, self.columns[column]) < (so_far, self.columns[best])
                }
            };
            if is_better {
                best = Some(column);
            }
        }
        let column = best?;
        let pivot = self.entries[row][column];
        let mut of_row: Vec<i128> = self.entries[row].iter().map(|entry| -entry).collect();
        of_row[column] = self.denominator;
        let constant = -self.constants[row];
        for other in (0..self.entries.len()).filter(|&other| other != row) {
            let factor = self.entries[other][column];
            if factor == 0 && pivot == self.denominator {
                continue;
            }
            self.entries[other][column] = 0;
            let divisor = self.denominator;
            let eliminated = |entry: i128, of_row: i128| -> Option<i128> {
                let product = entry.checked_mul(pivot)?.checked_add(factor.checked_mul(of_row)?)?;
                Some(if divisor == 1 { product } else { product / divisor })
            };
            for (entry, &of_row) in self.entries[other].iter_mut().zip(&of_row) {
                if *entry != 0 || of_row != 0 {
                    *entry = eliminated(*entry, of_row)?;
                }
            }
            self.constants[other] = eliminated(self.constants[other], constant)?;
        }
        self.entries[row] = of_row;
        self.constants[row] = constant;
        self.denominator = pivot;
        core::mem::swap(&mut self.rows[row], &mut self.columns[column]);
        Some(())
    }

    fn point(&self, variables: usize) -> Point {
        let mut values = vec![0; variables];
        for (&which, &value) in self.rows.iter().zip(&self.constants) {
            if which < variables {
                values[which] = value;
            }
        }
        (values, self.denominator)
    }
}

#[cfg(test)]
mod tests {
    use super::{Row, least_of_first};

    #[test]
    fn a_cycle_of_differences_gives_its_length_by_its_turns() {
        // Round x -> y -> x in 7 ticks while the period passes twice: 7 / 2.
        let rows: Vec<Row> = vec![(vec![(2, 1), (1, -1), (0, 1)], 3), (vec![(1, 1), (2, -1), (0, 1)], 4)];
        let (point, denominator) = least_of_first(3, &rows, 100).expect("it can be met");
        assert_eq!(2 * point[0], 7 * denominator);
    }

    #[test]
    fn rows_that_contradict_each_other_have_no_point() {
        let rows: Vec<Row> = vec![(vec![(1, 1)], 3), (vec![(1, -1)], -2)];
        assert_eq!(least_of_first(2, &rows, 100), None);
    }

    #[test]
    fn a_variable_that_two_rows_bound_has_the_larger_bound() {
        let rows: Vec<Row> = vec![(vec![(0, 2)], 3), (vec![(0, 3), (1, -1)], 5), (vec![(1, 1)], 1)];
        let (point, denominator) = least_of_first(2, &rows, 100).expect("it can be met");
        assert_eq!((point[0], point[1]), (2 * denominator, denominator));
    }
}
