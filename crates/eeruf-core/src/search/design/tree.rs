//! Is there a schedule with this period? A depth-first search that keeps times as intervals, so that the tick does not matter.
//!
//! It chooses, in this order: the sensor with the largest `|d|`; where it helps, the places of one clique ([`place`](super::place)); the firing
//! orders of conflicting sensors, sensor by sensor; the ranks of the other `|d|` with their signs, from whichever end has fewer candidates;
//! and, where ranks leave room and a plain reading of the matrix is no schedule yet, values ([`choose`](super::choose)). After each choice [`propagate`](super::propagate) draws conclusions. There is no recursion: a stack of
//! [`Frame`]s in lent memory, and a [`Network`] that can undo.
//!
//! Indices: sensors are below `needs.sensors` and so below `MAX_SENSORS`; what is on the stack is read and written with `get`.

use super::MAX_SENSORS;
use super::bounds;
use super::choose::sequence;
use super::classes::Orders;
use super::frame::{FRAME_WORDS, Frame, Kind};
use super::network::{Contradiction, Network};
use super::packing::Intervals;
use super::place::Places;
use super::problem::{Needs, Sensors};
use super::random::Random;
use super::ranks::Ranks;
use super::schedule::Firing;
use super::symmetry::Sorting;

/// What a search of one period came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::large_enum_variant, reason = "there is no allocator to box it with, and one exists at a time")]
pub(crate) enum Outcome {
    Found(Firing),
    Exhausted,
    Spent,
}

/// Frames that can be on the stack at once: every order or place, every rank, and some values.
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
    pub(super) sequence: [u8; MAX_SENSORS],
    pub(super) random: Option<Random>,
    /// A schedule for an easier problem: like it first.
    pub(super) guide: Option<Firing>,
    /// Orders to like first.
    pub(super) orders: Option<Orders>,
    /// In how many of 8 choices an order is copied from the sensors `shift` further along.
    pub(super) follow: u32,
    pub(super) shift: usize,
    clique: usize,
    nodes: u64,
    doomed: bool,
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
            ranks: Ranks::NONE,
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
        self.ranks.clear();
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
        self.ranks.clear();
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
