//! What the search chooses next, and which alternative it tries first.
//!
//! The alternative that comes first matters only for how soon a schedule is found: it is drawn by chance in short descents, copied from a schedule
//! for an easier problem, or the one that leaves the others most room.
//!
//! Indices: sensors are below `needs.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::MAX_SENSORS;
use super::frame::{Frame, Kind};
use super::problem::{Needs, Sensors};
use super::symmetry;
use super::tree::Tree;

impl Tree<'_, '_> {
    /// The next choice to make.
    pub(super) fn choice(&mut self) -> Frame {
        let k = self.needs.sensors;
        if self.ranks.highs().is_empty() {
            let mut frame = Frame::new(Kind::Top);
            frame.positive = symmetry::representatives(self.needs);
            return frame;
        }
        if let Some(frame) = self.place_choice() {
            return frame;
        }
        if let Some(frame) = self.order_choice() {
            return frame;
        }
        let unranked = self.needs.all() & !self.ranks.ranked;
        if unranked != 0 {
            return self.rank_choice(unranked);
        }
        let intervals = self.intervals();
        let mut frame = Frame::new(Kind::Value);
        // If all are fixed and still no schedule, there is no alternative left.
        frame.tried = 3;
        if let Some(x) = (0..k).filter(|&x| intervals.low[x] < intervals.high[x]).min_by_key(|&x| intervals.low[x]) {
            (frame.x, frame.tried) = (x as u8, 0);
            frame.positive = intervals.low[x] as u64;
            frame.negative = intervals.high[x] as u64;
        }
        frame
    }

    /// The most constrained undecided order of the first sensor in the sequence that has one.
    fn order_choice(&mut self) -> Option<Frame> {
        let interval = self.needs.interval;
        if interval == 0 {
            return None;
        }
        let mut before = 0u64;
        for &x in &self.sequence[..self.needs.sensors] {
            let x = usize::from(x);
            let mut best: Option<(i32, usize, usize)> = None;
            for y in Sensors(self.needs.conflicts[x] & before) {
                for phase in 0..2 {
                    let (u, v) = (self.node(x, phase), self.node(y, phase));
                    let (late, early) = (self.net.at_most(u, v), self.net.at_most(v, u));
                    if late > -interval && early > -interval && best.is_none_or(|(room, ..)| late + early < room) {
                        best = Some((late + early, u, v));
                    }
                }
            }
            before |= 1 << x;
            let Some((_, u, v)) = best else { continue };
            let (late, early) = (self.net.at_most(u, v), self.net.at_most(v, u));
            let pattern = self.pattern(u, v);
            let first = if let Some(random) = &mut self.random {
                // `early` and `late` are at least the interval here, or the order would be decided.
                let fair = random.below((late + early).max(1) as u32) < early.max(0) as u32;
                let follow = random.below(8) < self.follow;
                pattern.filter(|_| follow).unwrap_or(fair)
            } else {
                pattern.unwrap_or(early >= late)
            };
            let mut frame = Frame::new(Kind::Order);
            (frame.x, frame.y) = if first { (u as u8, v as u8) } else { (v as u8, u as u8) };
            return Some(frame);
        }
        None
    }

    /// Whether `u` fires before `v` by the order of the sensors one clique further along, if that is decided.
    fn pattern(&self, u: usize, v: usize) -> Option<bool> {
        let (k, shift) = (self.needs.sensors, self.shift);
        let (x, y, phase) = ((u - 1) % k, (v - 1) % k, (u - 1) / k);
        if let Some(guide) = &self.guide {
            let times = if phase == 0 { &guide.a } else { &guide.b };
            return Some(times[x] < times[y]);
        }
        if let Some(orders) = &self.orders {
            let places = if phase == 0 { &orders.a } else { &orders.b };
            return Some(places[x] < places[y]);
        }
        for shift in [shift, 2 * k - shift] {
            let (x, y) = ((x + shift) % k, (y + shift) % k);
            let (u, v) = (self.node(x, phase), self.node(y, phase));
            if self.needs.conflict(x, y) {
                if self.net.at_most(u, v) <= -self.needs.interval {
                    return Some(true);
                }
                if self.net.at_most(v, u) <= -self.needs.interval {
                    return Some(false);
                }
            }
        }
        None
    }

    /// The end of the ranks with fewer candidates.
    fn rank_choice(&mut self, unranked: u64) -> Frame {
        let separation = self.needs.separation;
        let intervals = self.intervals();
        let mut low = Frame::new(Kind::Low);
        let mut high = Frame::new(Kind::High);
        for x in Sensors(unranked) {
            let (d_low, d_high) = self.span(x);
            let others = unranked & !(1 << x);
            let signs = |frame: &mut Frame| {
                // d = 0 counts as positive.
                frame.positive |= u64::from(d_high >= 0) << x;
                frame.negative |= u64::from(d_low < 0) << x;
            };
            if Sensors(others).all(|y| intervals.low[x] + separation <= intervals.high[y]) {
                signs(&mut low);
            }
            if Sensors(others).all(|y| intervals.low[y] + separation <= intervals.high[x]) {
                signs(&mut high);
            }
        }
        let count = |frame: &Frame| frame.positive.count_ones() + frame.negative.count_ones();
        if count(&low) < count(&high) { low } else { high }
    }

    /// One of the remaining pairs of places.
    pub(super) fn pick_place(&mut self, frame: &Frame) -> Option<u8> {
        if let Some(orders) = &self.orders {
            if let Some(pair) = self.places.of_orders(orders, frame) {
                return Some(pair);
            }
        }
        let nth = match &mut self.random {
            Some(random) => random.below(frame.positive.count_ones().max(1)) as usize,
            None => 0,
        };
        // A pair is below 64.
        Sensors(frame.positive).nth(nth).map(|pair| pair as u8)
    }

    /// The remaining candidate for a rank that leaves the others most room, or any.
    pub(super) fn pick(&mut self, frame: &Frame) -> Option<(u8, bool)> {
        if let (Kind::Top, Some(orders)) = (frame.kind, &self.orders) {
            if let Some(x) = Sensors(frame.positive & orders.tops).next() {
                return Some((x as u8, false));
            }
        }
        if let Some(random) = &mut self.random {
            let count = frame.positive.count_ones() + frame.negative.count_ones();
            if count > 1 && (frame.kind == Kind::Top || random.below(2) == 0) {
                let nth = random.below(count) as usize;
                let positive = Sensors(frame.positive).map(|x| (x as u8, false));
                let negative = Sensors(frame.negative).map(|x| (x as u8, true));
                return positive.chain(negative).nth(nth);
            }
        }
        if let Some(guide) = &self.guide {
            let d = |x: usize| i64::from(guide.a[x]) - i64::from(guide.b[x]);
            let key = |x: usize| {
                if frame.kind == Kind::Low { d(x).abs() } else { -d(x).abs() }
            };
            let best = Sensors(frame.positive | frame.negative).min_by_key(|&x| key(x))?;
            let negative = frame.negative >> best & 1 == 1 && (d(best) < 0 || frame.positive >> best & 1 == 0);
            return Some((best as u8, negative));
        }
        if frame.kind == Kind::Top {
            return Sensors(frame.positive).next().map(|x| (x as u8, false));
        }
        let intervals = self.intervals();
        let key = |x: usize| {
            if frame.kind == Kind::Low { intervals.high[x] } else { -intervals.low[x] }
        };
        let best = Sensors(frame.positive | frame.negative).min_by_key(|&x| key(x))?;
        Some((best as u8, frame.positive >> best & 1 == 0))
    }
}

/// Sensors from `first` on, each the one with the most conflicts with those before it.
pub(super) fn sequence(needs: &Needs, first: usize) -> [u8; MAX_SENSORS] {
    let mut sequence = [0; MAX_SENSORS];
    let mut taken = 0u64;
    let mut next = first;
    for place in sequence.iter_mut().take(needs.sensors) {
        *place = next as u8;
        taken |= 1 << next;
        let left = needs.all() & !taken;
        // Of equals the lowest: `max_by_key` would take the last.
        next = Sensors(left).min_by_key(|&x| 64 - (needs.conflicts[x] & taken).count_ones()).unwrap_or(0);
    }
    sequence
}
