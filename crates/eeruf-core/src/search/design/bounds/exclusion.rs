//! Periods that the classes exclude: too few `|d|` fit. The argument is in [`classes`](super::classes).

use super::super::problem::{CheckedProblem, common_divisor};
use super::changes::{self, Changes};
use super::classes::{Classes, Shape};
use super::permutation::Room;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Outcome;

impl Classes {
    /// A period below which there is no schedule, with n; it may be smaller than other bounds.
    pub(crate) fn period(&self, problem: &CheckedProblem) -> i32 {
        // `ProblemError::TooLong` bounds n I.
        let clique = self.clique as i32 * problem.interval;
        let (mut no, mut yes) = (clique - 1, clique + problem.interval);
        while no + 1 < yes {
            let middle = no + (yes - no) / 2;
            if self.excludes(problem, middle) { no = middle } else { yes = middle }
        }
        yes
    }

    /// How often sensors n apart may have different places.
    pub(crate) fn changes(&self, problem: &CheckedProblem, period: i32) -> Changes {
        let n = self.clique as i32;
        match self.shape {
            // There a class is a matter of one clique.
            Shape::Cliques(_) if period - n * problem.interval < problem.interval => Changes::None,
            Shape::Cliques(_) => Changes::Any,
            Shape::Line => changes::in_line(problem, period, n),
            Shape::Ring => changes::in_ring(problem, period, n),
        }
    }

    /// The number of sensors that were counted.
    pub(crate) fn sensors(&self, problem: &CheckedProblem) -> u32 {
        if let Shape::Cliques(cliques) = self.shape { cliques * self.clique } else { problem.sensors as u32 }
    }

    /// Whether there is no schedule with this period because too few `|d|` fit into each class.
    pub(crate) fn excludes(&self, problem: &CheckedProblem, period: i32) -> bool {
        let n = self.clique as i32;
        let spare = period - n * problem.interval;
        if spare < 0 {
            return true;
        }
        match self.changes(problem, period) {
            Changes::None => {}
            Changes::One if !changes::one_fits(problem, self, period) => {}
            Changes::Two { rigid } if !changes::two_fit(problem, self, period, rigid) => {}
            _ => return false,
        }
        let passed = self.passed(problem);
        let sensors = problem.sensors as i32;
        if self.shape == Shape::Ring && sensors == 2 * n && 2 * spare < problem.interval.min(n * problem.separation) {
            return true;
        }
        let mut room = Room { places: [0; MAX_SENSORS], crossed: n, values: [0; MAX_SENSORS] };
        // The sensors of one class that share a place of the permutation: at least `sensors / per`.
        let (sensors, per) = match self.shape {
            Shape::Line => (sensors / n, 1),
            Shape::Ring => (sensors, n),
            Shape::Cliques(_) => (1, 1),
        };
        let mut sum = 0;
        for class in 0..n {
            let values = self.values(problem, period, class, passed);
            // A move by at least m has n - m places to start from, in each direction.
            let most = if class > 0 { 2 * (n - class) } else { n };
            let places = if let Shape::Cliques(cliques) = self.shape {
                values.min(most.saturating_mul(cliques as i32))
            } else {
                // In i64, as values times n may be large.
                (i64::from(values) * i64::from(per) / i64::from(sensors)).min(i64::from(most)) as i32
            };
            sum += places;
            // Class is below n, which is at most MAX_SENSORS.
            (room.places[class as usize], room.values[class as usize]) = (places, values);
        }
        match self.shape {
            Shape::Cliques(cliques) if cliques > 1 => sum < n * cliques as i32,
            _ if sum < n => true,
            shape => {
                if passed > 0 {
                    let crossed = i64::from(self.values_within(problem, period, 0, 0, passed)) * i64::from(per);
                    room.crossed = (crossed / i64::from(sensors)).min(i64::from(n)) as i32;
                }
                let none = [0; MAX_SENSORS];
                let found = room.permutation(&[1; MAX_SENSORS][..n as usize], &none, |moved| match shape {
                    Shape::Line => {
                        // Some places have a sensor more than the others.
                        let more: i32 = (0..n as usize)
                            .map(|class| moved[class].min(room.values[class] - sensors * moved[class]))
                            .sum();
                        more >= problem.sensors as i32 % n
                    }
                    Shape::Ring => {
                        // Places that differ by a common divisor of n and K are of one class.
                        let alike = n / common_divisor(n, sensors);
                        moved.iter().all(|moved| moved % alike == 0)
                    }
                    Shape::Cliques(_) => true,
                });
                matches!(found, Outcome::Exhausted)
            }
        }
    }
}
