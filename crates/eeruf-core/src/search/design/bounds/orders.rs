//! Firing orders for whose classes there is room: the search prefers them in every other descent.

use super::super::problem::CheckedProblem;
use super::super::random::Random;
use super::classes::{Classes, Shape};
use super::permutation::Room;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Outcome;

/// In which order sensors fire: of two that conflict, the one with the smaller number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orders {
    pub(crate) a: [u8; MAX_SENSORS],
    pub(crate) b: [u8; MAX_SENSORS],
    /// The sensor with the largest `|d|`, which is positive, should be one of these.
    pub(crate) tops: u64,
}

impl Classes {
    /// Orders drawn from `random` in which each n-th sensor has the same place, and for whose classes there is room.
    pub(crate) fn draw(&self, problem: &CheckedProblem, period: i32, random: &mut Random) -> Option<Orders> {
        let (k, n) = (problem.sensors, self.clique as usize);
        if matches!(self.shape, Shape::Cliques(_)) || (self.shape == Shape::Ring && k % n > 0) {
            return None;
        }
        let mut room = Room { places: [0; MAX_SENSORS], crossed: i32::MAX, values: [0; MAX_SENSORS] };
        // n is at most MAX_SENSORS; so are places, and numbers mod n.
        for class in 0..n {
            room.places[class] = self.values(problem, period, class as i32, self.passed(problem));
        }
        let (mut at, mut offsets, mut sizes) = ([0u8; MAX_SENSORS], [0u8; MAX_SENSORS], [0; MAX_SENSORS]);
        for q in 0..n {
            let other = random.below(q as u32 + 1) as usize;
            at[q] = at[other];
            at[other] = q as u8;
            offsets[q] = random.below(n as u32) as u8;
        }
        for q in 0..n {
            sizes[q] = ((k + n - 1 - usize::from(at[q])) / n) as i32;
        }
        let Outcome::Found(to) = room.permutation(&sizes[..n], &offsets, |_| true) else {
            return None;
        };
        let mut orders = Orders { a: [0; MAX_SENSORS], b: [0; MAX_SENSORS], tops: 0 };
        let mut widest = 0;
        for q in 0..n {
            let moved = i32::from(to[q]) - q as i32;
            if moved.abs() > i32::abs(widest) {
                widest = moved;
            }
        }
        for q in 0..n {
            for x in (usize::from(at[q])..k).step_by(n) {
                // Of the sensor with the largest |d|, d is positive.
                (orders.a[x], orders.b[x]) = if widest < 0 { (q as u8, to[q]) } else { (to[q], q as u8) };
                let d = i32::from(orders.a[x]) - i32::from(orders.b[x]);
                orders.tops |= u64::from(d == widest.abs()) << x;
            }
        }
        Some(orders)
    }
}
