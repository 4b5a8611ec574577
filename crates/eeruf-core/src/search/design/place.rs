//! The places of one clique: which sensor fires as the how-manieth in phase a and in phase b.
//!
//! In a line or ring any n adjacent sensors conflict. The search first places the n sensors from the one with the largest `|d|` on: the sensor
//! in place q of phase b and p of phase a has d within `(p - q) I +- sigma`, see [`classes`](super::classes). This decides all their orders, and
//! tells how large each `|d|` is before the orders do. As `2 sigma < I` is asked for, d of each n-th sensor is confined in the same way.

use super::classes::{Classes, Orders};
use super::frame::{Frame, Kind};
use super::network::Contradiction;
use super::problem::{Needs, Sensors};
use super::tree::Tree;

/// A frame has one bit for each pair of places.
const MAX_PLACES: usize = 8;

/// What is placed so far.
///
/// Indices: the number of sensors to place is at most `MAX_PLACES`, and so are places; [`Places::new`] sees to it.
pub(super) struct Places {
    /// n, or 0 if nothing is to be placed.
    count: usize,
    /// The period without n intervals.
    spare: i32,
    ring: bool,
    sensors: [u8; MAX_PLACES],
    /// Which of them are placed, in the order in which they were, with (q, p) of each.
    placed: usize,
    at: [(u8, u8, u8); MAX_PLACES],
    /// How many `|d|` fit into each class.
    room: [i32; MAX_PLACES],
}

impl Places {
    /// Nothing to place.
    pub(super) const fn none() -> Self {
        Self {
            count: 0,
            spare: 0,
            ring: false,
            sensors: [0; MAX_PLACES],
            placed: 0,
            at: [(0, 0, 0); MAX_PLACES],
            room: [0; MAX_PLACES],
        }
    }

    pub(super) fn new(needs: &Needs, period: i32) -> Self {
        let mut places = Self::none();
        let Some(classes) = Classes::new(needs).filter(Classes::adjacent) else {
            return places;
        };
        let n = classes.clique() as usize;
        let spare = period - n as i32 * needs.interval;
        if n > MAX_PLACES || spare < 0 {
            return places;
        }
        // Beyond, the order of the sensors changes now and then, and deciding it pair by pair is as good.
        if 2 * spare >= needs.interval || (classes.ring() && needs.sensors % n > 0) {
            return places;
        }
        (places.count, places.spare, places.ring) = (n, spare, classes.ring());
        for class in 0..n {
            places.room[class] = classes.values(needs, period, class as i32, classes.passed(needs));
        }
        places
    }

    /// Begins anew with the adjacent sensors that include `top`.
    pub(super) fn begin(&mut self, needs: &Needs, top: usize) {
        self.placed = 0;
        let first = if self.ring { top } else { top.min(needs.sensors - self.count) };
        for i in 0..self.count {
            // `top` first, then the others from `first` on.
            let x = if i == 0 {
                top
            } else {
                let x = first + i - 1;
                if x >= top { x + 1 } else { x }
            };
            // Sensors are below 64.
            self.sensors[i] = (x % needs.sensors) as u8;
        }
    }

    pub(super) fn clear(&mut self) {
        self.placed = 0;
    }

    pub(super) fn pop(&mut self) {
        self.placed -= 1;
    }

    /// The sensors that share the class of `x`.
    fn alike(&self, needs: &Needs, x: usize) -> u64 {
        (x % self.count..needs.sensors).step_by(self.count).fold(0, |set, y| set | 1 << y)
    }

    /// The pair of places in `orders`, if it is among the frame's.
    pub(super) fn of_orders(&self, orders: &Orders, frame: &Frame) -> Option<u8> {
        let x = usize::from(frame.x);
        let before = |order: &[u8]| {
            let window = self.sensors[..self.count].iter();
            window.filter(|&&y| order[usize::from(y)] < order[x]).count()
        };
        let pair = MAX_PLACES * before(&orders.b) + before(&orders.a);
        (frame.positive >> pair & 1 == 1).then_some(pair as u8)
    }
}

impl Tree<'_, '_> {
    /// The sensor with the fewest pairs of places left, if not all are placed.
    pub(super) fn place_choice(&self) -> Option<Frame> {
        let places = &self.places;
        if places.placed == places.count {
            return None;
        }
        let at = &places.at[..places.placed];
        let mut room = places.room;
        for &(x, q, p) in at {
            room[usize::from(p.abs_diff(q))] -= places.alike(self.needs, usize::from(x)).count_ones() as i32;
        }
        let open = |&&x: &&u8| at.iter().all(|&(y, ..)| y != x);
        // The first is the one with the largest |d|.
        let window = if at.is_empty() { &places.sensors[..1] } else { &places.sensors[..places.count] };
        let frames = window.iter().filter(open).map(|&x| {
            let mut frame = Frame::new(Kind::Place);
            (frame.x, frame.positive) = (x, self.pairs(x, &room));
            frame
        });
        frames.min_by_key(|frame| frame.positive.count_ones())
    }

    /// The pairs of places that sensor `x` can have, as far as a look at the matrix tells.
    fn pairs(&self, x: u8, room: &[i32; MAX_PLACES]) -> u64 {
        let places = &self.places;
        let (at, interval) = (&places.at[..places.placed], self.needs.interval);
        let (mut free_q, mut free_p) = (0xffu8, 0xffu8);
        for &(y, q, p) in at {
            free_q &= !(1 << q);
            free_p &= !(1 << p);
            for (phase, place, free) in [(0, p, &mut free_p), (1, q, &mut free_q)] {
                let (u, v) = (self.node(usize::from(x), phase), self.node(usize::from(y), phase));
                // Places below the other's are out if x cannot fire before y, and likewise above.
                if self.net.at_most(v, u) < interval {
                    *free &= !((1u8 << place) - 1);
                }
                if self.net.at_most(u, v) < interval {
                    *free &= (1u8 << place) - 1;
                }
            }
        }
        let size = places.alike(self.needs, usize::from(x)).count_ones() as i32;
        let (low, high) = self.span(usize::from(x));
        let mut pairs = 0;
        for q in (0..places.count).filter(|q| free_q >> q & 1 == 1) {
            for p in (0..places.count).filter(|p| free_p >> p & 1 == 1) {
                let middle = (p as i32 - q as i32) * interval;
                if room[p.abs_diff(q)] >= size && middle - places.spare <= high && middle + places.spare >= low {
                    pairs |= 1 << (MAX_PLACES * q + p);
                }
            }
        }
        pairs
    }

    /// Places sensor `frame.x` at the pair of places `frame.y`.
    pub(super) fn place(&mut self, frame: &Frame) -> Result<(), Contradiction> {
        let (x, q, p) = (usize::from(frame.x), frame.y / MAX_PLACES as u8, frame.y % MAX_PLACES as u8);
        let i = self.places.placed;
        self.places.at[i] = (frame.x, q, p);
        self.places.placed += 1;
        let interval = self.needs.interval;
        for j in 0..i {
            let (y, other_q, other_p) = self.places.at[j];
            for (phase, place, other) in [(0, p, other_p), (1, q, other_q)] {
                let (u, v) = (self.node(x, phase), self.node(usize::from(y), phase));
                let (u, v) = if place < other { (u, v) } else { (v, u) };
                self.net.demand(u, v, -interval)?;
            }
        }
        let moved = i32::from(p) - i32::from(q);
        let (low, high) = (moved * interval - self.places.spare, moved * interval + self.places.spare);
        // On a ring somebody is overtaken on either side.
        let other = if self.places.ring { self.needs.separation } else { 0 };
        let low = if moved > 0 { low + other } else { low };
        let high = if moved < 0 { high - other } else { high };
        for x in Sensors(self.places.alike(self.needs, x)) {
            let (a, b) = (self.node(x, 0), self.node(x, 1));
            self.net.demand(a, b, high)?;
            self.net.demand(b, a, -low)?;
        }
        Ok(())
    }
}
