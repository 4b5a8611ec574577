//! Is there a schedule with this period? A depth-first search that keeps times as intervals, so that the tick does not matter.
//!
//! It chooses, in this order: the sensor with the largest `|d|`; the firing orders of conflicting sensors, sensor by sensor; the ranks of the
//! other `|d|` with their signs, from whichever end has fewer candidates; and, where ranks leave room and a plain reading of the matrix is
//! no schedule yet, values. After each choice [`propagate`](super::propagate) draws conclusions. There is no recursion: a stack of
//! [`Frame`]s in lent memory, and a [`Network`] that can undo.

use super::MAX_SENSORS;
use super::bounds;
use super::classes::Orders;
use super::frame::{FRAME_WORDS, Frame, Kind};
use super::network::{Contradiction, Network};
use super::packing::Intervals;
use super::place::Places;
use super::problem::{Needs, Sensors};
use super::random::Random;
use super::schedule::Firing;
use super::symmetry::{self, Sorting};

/// What a search of one period came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::large_enum_variant, reason = "there is no allocator to box it with, and one exists at a time")]
pub(crate) enum Outcome {
    Found(Firing),
    Exhausted,
    Spent,
}

/// Frames that can be on the stack at once: every order, every rank, and some values.
pub(crate) const fn frames(sensors: usize) -> usize {
    sensors * (sensors - 1) + 8 * sensors + 32
}

/// The rows of the undo log: for 12 sensors what fits into 64 KiB with everything else, for more sensors enough
/// that backing up hardly ever has to recompute.
const fn log_rows(sensors: usize) -> usize {
    let per_node = if sensors <= 12 { 16 } else { 64 };
    per_node * (2 * sensors + 1)
}

/// The words of memory that a search over `sensors` sensors needs.
pub(crate) const fn words(sensors: usize) -> usize {
    let nodes = 2 * sensors + 1;
    2 * nodes * nodes + frames(sensors) * FRAME_WORDS + log_rows(sensors) * (nodes + 1)
}

/// The tree over one period.
pub(crate) struct Tree<'p, 'm> {
    pub(super) needs: &'p Needs,
    /// The largest `|d|` allowed.
    pub(super) widest: i32,
    pub(super) net: Network<'m>,
    root: &'m mut [i32],
    stack: &'m mut [i32],
    depth: usize,
    /// Frames below this one can no longer be undone, only recomputed.
    base: usize,
    pub(super) ranks: Ranks,
    pub(super) places: Places,
    /// Sensors in the order in which their firing orders are chosen.
    sequence: [u8; MAX_SENSORS],
    random: Option<Random>,
    /// A schedule for an easier problem: like it first.
    guide: Option<Firing>,
    /// Orders to like first.
    orders: Option<Orders>,
    /// In how many of 8 choices an order is copied from the sensors `shift` further along.
    follow: u32,
    shift: usize,
    clique: usize,
    nodes: u64,
    doomed: bool,
}

/// The sensors whose rank of `|d|` is chosen, from both ends.
pub(super) struct Ranks {
    low: [u8; MAX_SENSORS],
    high: [u8; MAX_SENSORS],
    lows: usize,
    highs: usize,
    pub(super) ranked: u64,
    pub(super) negative: u64,
}

impl Ranks {
    /// The ranked sensors with the smallest `|d|`, ascending.
    pub(super) fn lows(&self) -> &[u8] {
        &self.low[..self.lows]
    }

    /// The ranked sensors with the largest `|d|`, descending.
    pub(super) fn highs(&self) -> &[u8] {
        &self.high[..self.highs]
    }

    fn push(&mut self, kind: Kind, sensor: u8, negative: bool) {
        if kind == Kind::Low {
            self.low[self.lows] = sensor;
            self.lows += 1;
        } else {
            self.high[self.highs] = sensor;
            self.highs += 1;
        }
        self.ranked |= 1 << sensor;
        self.negative |= u64::from(negative) << sensor;
    }

    fn pop(&mut self, kind: Kind) {
        let sensor = if kind == Kind::Low {
            self.lows -= 1;
            self.low[self.lows]
        } else {
            self.highs -= 1;
            self.high[self.highs]
        };
        self.ranked &= !(1 << sensor);
        self.negative &= !(1 << sensor);
    }
}

impl<'p, 'm> Tree<'p, 'm> {
    /// Sets up the search of `period`. `memory` holds at least [`words`].
    pub(crate) fn new(needs: &'p Needs, period: i32, memory: &'m mut [i32]) -> Self {
        let k = needs.sensors;
        let nodes = 2 * k + 1;
        let (bound, memory) = memory.split_at_mut(nodes * nodes);
        let (root, memory) = memory.split_at_mut(nodes * nodes);
        let (stack, log) = memory.split_at_mut(frames(k) * FRAME_WORDS);
        let mut tree = Self {
            needs,
            widest: (period - needs.window).min(period - 1),
            net: Network::new(nodes, 1 << 28, bound, log),
            root,
            stack,
            depth: 0,
            base: 0,
            ranks: Ranks { low: [0; MAX_SENSORS], high: [0; MAX_SENSORS], lows: 0, highs: 0, ranked: 0, negative: 0 },
            places: Places::new(needs, period),
            sequence: [0; MAX_SENSORS],
            random: None,
            guide: None,
            orders: None,
            follow: 8,
            shift: 0,
            clique: bounds::cliques(needs).0 as usize,
            nodes: 0,
            doomed: false,
        };
        tree.doomed = tree.lay_out(period).is_err();
        tree.net.copy_to(tree.root);
        tree
    }

    /// The network's node of sensor `x` in phase a (0) or b (1).
    #[inline(always)]
    pub(super) fn node(&self, x: usize, phase: usize) -> usize {
        1 + x + phase * self.needs.sensors
    }

    /// What holds for every schedule.
    fn lay_out(&mut self, period: i32) -> Result<(), Contradiction> {
        let needs = self.needs;
        for x in 0..needs.sensors {
            let (a, b) = (self.node(x, 0), self.node(x, 1));
            for node in [a, b] {
                self.net.demand(0, node, 0)?;
                self.net.demand(node, 0, period - 1)?;
            }
            self.net.demand(a, b, self.widest)?;
            self.net.demand(b, a, self.widest)?;
        }
        for x in 0..needs.sensors {
            for y in Sensors(needs.conflicts[x]) {
                // From phase a to phase b and from b to the next a.
                let (a, b) = (self.node(x, 0), self.node(y, 1));
                self.net.demand(a, b, period - needs.interval)?;
                self.net.demand(b, a, period - needs.interval)?;
            }
        }
        self.propagate()
    }

    /// The nodes visited so far.
    pub(crate) fn nodes(&self) -> u64 {
        self.nodes
    }

    /// Starts over, trying alternatives in an order drawn from `random`, or first those of a schedule for an easier problem, or in the fixed
    /// order.
    pub(crate) fn restart(&mut self, random: Option<Random>, guide: Option<Firing>) {
        self.guide = guide;
        self.orders = None;
        self.net.reset(self.root);
        self.ranks.lows = 0;
        self.ranks.highs = 0;
        self.ranks.ranked = 0;
        self.ranks.negative = 0;
        self.places.clear();
        self.depth = 0;
        self.base = 0;
        self.random = random;
        (self.follow, self.shift) = (8, self.clique);
        if let Some(random) = &mut self.random {
            // Most schedules repeat their orders clique by clique, but not all.
            self.follow = [8, 8, 7, 0][random.below(4) as usize];
            self.shift += usize::from(random.below(4) == 0);
        }
    }

    /// Likes these orders first, until the next restart.
    pub(crate) fn like(&mut self, orders: Orders) {
        self.orders = Some(orders);
        self.follow = 8;
    }

    /// Goes on for at most `budget` nodes; `Spent` can be continued by calling again.
    pub(crate) fn run(&mut self, budget: u64) -> Outcome {
        if self.doomed {
            return Outcome::Exhausted;
        }
        let end = self.nodes.saturating_add(budget);
        let mut descend = self.depth == 0;
        loop {
            if descend {
                if let Some(times) = self.reading() {
                    return Outcome::Found(times);
                }
                self.choose();
            }
            if self.depth == 0 {
                return Outcome::Exhausted;
            }
            // More values than fit have been seen on no problem yet; giving up is the honest answer.
            if self.nodes >= end || self.depth > frames(self.needs.sensors) {
                return Outcome::Spent;
            }
            descend = self.next_alternative();
        }
    }

    fn frame(&self, i: usize) -> Frame {
        Frame::unpack(self.stack.get(i * FRAME_WORDS..(i + 1) * FRAME_WORDS).unwrap_or(&[]))
    }

    fn store(&mut self, i: usize, frame: &Frame) {
        if let Some(words) = self.stack.get_mut(i * FRAME_WORDS..(i + 1) * FRAME_WORDS) {
            words.copy_from_slice(&frame.pack());
        }
    }

    /// Takes back the top frame's alternative and tries its next one; drops the frame if there is none. True if that one may hold.
    fn next_alternative(&mut self) -> bool {
        let top = self.depth - 1;
        let mut frame = self.frame(top);
        if frame.tried > 0 {
            self.retract(&frame);
            if top >= self.base {
                self.net.undo(frame.mark as usize);
            } else {
                self.recompute(top);
            }
        }
        if !self.advance(&mut frame) {
            self.depth = top;
            return false;
        }
        self.nodes += 1;
        frame.mark = self.net.mark() as u32;
        self.store(top, &frame);
        let holds = self.apply(&frame).and_then(|()| self.propagate()).is_ok();
        if self.net.take_overrun() {
            self.base = self.depth;
        }
        holds
    }

    /// Restores the state before frame `to` from the root.
    fn recompute(&mut self, to: usize) {
        self.net.reset(self.root);
        self.ranks.lows = 0;
        self.ranks.highs = 0;
        self.ranks.ranked = 0;
        self.ranks.negative = 0;
        self.places.clear();
        self.base = 0;
        for i in 0..to {
            let mut frame = self.frame(i);
            frame.mark = self.net.mark() as u32;
            self.store(i, &frame);
            // It held before, and conclusions depend on nothing but the choices.
            let _ = self.apply(&frame).and_then(|()| self.propagate());
            if self.net.take_overrun() {
                self.base = i + 1;
            }
        }
    }

    /// Moves to the frame's next alternative, if there is one.
    fn advance(&mut self, frame: &mut Frame) -> bool {
        match frame.kind {
            Kind::Order => {
                if frame.tried == 2 {
                    return false;
                }
                if frame.tried == 1 {
                    (frame.x, frame.y) = (frame.y, frame.x);
                }
                frame.tried += 1;
                true
            }
            Kind::Value => {
                frame.tried += 1;
                frame.tried <= 3
            }
            Kind::Place => {
                let Some(pair) = self.pick_place(frame) else {
                    return false;
                };
                frame.positive &= !(1 << pair);
                (frame.y, frame.tried) = (pair, 1);
                true
            }
            Kind::Top | Kind::Low | Kind::High => {
                let Some((x, negative)) = self.pick(frame) else {
                    return false;
                };
                (frame.x, frame.y, frame.tried) = (x, u8::from(negative), 1);
                if negative {
                    frame.negative &= !(1 << x);
                } else {
                    frame.positive &= !(1 << x);
                }
                true
            }
        }
    }

    /// One of the remaining pairs of places.
    fn pick_place(&mut self, frame: &Frame) -> Option<u8> {
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
    fn pick(&mut self, frame: &Frame) -> Option<(u8, bool)> {
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

    /// Takes back what [`apply`](Self::apply) noted outside the network.
    fn retract(&mut self, frame: &Frame) {
        if matches!(frame.kind, Kind::Top | Kind::Low | Kind::High) {
            self.ranks.pop(frame.kind);
        }
        if frame.kind == Kind::Place {
            self.places.pop();
        }
    }

    /// Demands what the frame's present alternative says.
    fn apply(&mut self, frame: &Frame) -> Result<(), Contradiction> {
        let x = usize::from(frame.x);
        match frame.kind {
            Kind::Place => self.place(frame),
            Kind::Order => self.net.demand(x, usize::from(frame.y), -self.needs.interval),
            Kind::Value => {
                let (low, high) = (frame.positive as i32, frame.negative as i32);
                let middle = low + (high - low) / 2;
                let (low, high) = match frame.tried {
                    1 => (low, low),
                    2 => (low + 1, middle.max(low + 1)),
                    _ => (middle.max(low + 1) + 1, high),
                };
                self.demand_size(x, low, high)
            }
            Kind::Top | Kind::Low | Kind::High => {
                self.ranks.push(frame.kind, frame.x, frame.y == 1);
                if frame.kind == Kind::Top {
                    self.places.begin(self.needs, x);
                    self.sequence = sequence(self.needs, x);
                    let sorting = Sorting::new(self.needs, x);
                    for (x, y) in sorting.pairs() {
                        self.net.demand(self.node(x, 0), self.node(y, 0), 0)?;
                    }
                    let last = self.needs.sensors as i32 - 1;
                    return self.demand_size(x, self.needs.least + last * self.needs.separation, self.widest);
                }
                self.demand_size(x, self.needs.least, self.widest)
            }
        }
    }

    /// Pushes the next choice to make.
    fn choose(&mut self) {
        let frame = self.choice();
        self.store(self.depth, &frame);
        self.depth += 1;
    }

    fn choice(&mut self) -> Frame {
        let k = self.needs.sensors;
        if self.ranks.highs == 0 {
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

    /// The earliest or the latest times that the matrix allows, if all orders are decided and the separation happens to hold.
    fn reading(&self) -> Option<Firing> {
        let (k, interval) = (self.needs.sensors, self.needs.interval);
        let undecided = |u: usize, v: usize| self.net.at_most(u, v) > -interval && self.net.at_most(v, u) > -interval;
        for x in 0..k {
            for y in Sensors(self.needs.conflicts[x] & ((1 << x) - 1)) {
                for phase in 0..2 {
                    if undecided(self.node(x, phase), self.node(y, phase)) && interval > 0 {
                        return None;
                    }
                }
            }
        }
        let earliest = |u: usize| -self.net.at_most(0, u);
        let latest = |u: usize| self.net.at_most(u, 0);
        self.times(earliest).or_else(|| self.times(latest))
    }

    /// These times, if all `|d|` are far enough from each other and from 0.
    fn times(&self, time: impl Fn(usize) -> i32) -> Option<Firing> {
        let k = self.needs.sensors;
        let mut times = Firing { a: [0; MAX_SENSORS], b: [0; MAX_SENSORS], sensors: k };
        let mut sizes = [0; MAX_SENSORS];
        for x in 0..k {
            let (a, b) = (time(self.node(x, 0)), time(self.node(x, 1)));
            // Times are in 0..period.
            (times.a[x], times.b[x]) = (a as u32, b as u32);
            sizes[x] = (a - b).abs();
            if sizes[x] < self.needs.least {
                return None;
            }
        }
        let sizes = &mut sizes[..k];
        sizes.sort_unstable();
        sizes.windows(2).all(|pair| pair[1] - pair[0] >= self.needs.separation).then_some(times)
    }

    /// The interval of d of sensor `x`.
    #[inline(always)]
    pub(super) fn span(&self, x: usize) -> (i32, i32) {
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        (-self.net.at_most(b, a), self.net.at_most(a, b))
    }

    /// The intervals of all `|d|` by the network and the ranks.
    pub(super) fn intervals(&self) -> Intervals {
        let mut intervals = Intervals { low: [0; MAX_SENSORS], high: [0; MAX_SENSORS] };
        for x in 0..self.needs.sensors {
            let (low, high) = self.span(x);
            // Above 0, below 0, or on both sides of it.
            intervals.low[x] = low.max(-high).max(self.needs.least);
            intervals.high[x] = high.max(-low).min(self.widest);
        }
        let unranked = self.needs.all() & !self.ranks.ranked;
        if let Some(&last) = self.ranks.lows().last() {
            let floor = intervals.low[usize::from(last)] + self.needs.separation;
            for x in Sensors(unranked) {
                intervals.low[x] = intervals.low[x].max(floor);
            }
        }
        if let Some(&last) = self.ranks.highs().last() {
            let ceiling = intervals.high[usize::from(last)] - self.needs.separation;
            for x in Sensors(unranked) {
                intervals.high[x] = intervals.high[x].min(ceiling);
            }
        }
        intervals
    }
}

/// Sensors from `first` on, each the one with the most conflicts with those before it.
fn sequence(needs: &Needs, first: usize) -> [u8; MAX_SENSORS] {
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
