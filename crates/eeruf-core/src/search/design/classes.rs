//! How much a period leaves to spare decides how many sensors can share a size of `|d|`: a bound for cliques, lines and rings.
//!
//! Take n sensors that all conflict, in a period `T_p = n I + sigma`, with `R >= I`. Any two firings that follow each other are I apart, also
//! those of one sensor. If a sensor is the p-th of them in phase a and the q-th in phase b, `n + p - q` such steps lie between its firing in b
//! and the next in a, and `n - p + q` between a and the next b, so with `c = p - q`
//!
//! ```text
//! T_p + d >= (n + c) I,  T_p - d >= (n - c) I,  that is  c I - sigma <= d <= c I + sigma.
//! ```
//!
//! Its **class** is `|c|`. As long as `sigma < I` each class has room for as many `|d|` as fit D apart into
//! `|c| I - sigma ..= |c| I + sigma`, cut off at `least` below and at the `T_p - R` that the window leaves above. The n values c are how far the
//! places of a permutation move. That bounds one clique; a set of **disjoint cliques** shares the room of the classes.
//!
//! **Line** (each n adjacent sensors conflict). Sensors i and i + n both conflict with the n - 1 between them, whose firings leave
//! `2 (n - 1)` gaps, in two periods end to end. A gap with u firings of sensor i and v of sensor i + n in it is at least `(1 + max(u, v)) I` long;
//! if `2 sigma < I`, together they are `2 T_p < (2 n + 1) I` long, so the sum of `max(u, v)` is at most 2. As u and v sum to 2 each, `u = v` in each gap: sensor
//! i + n takes the places of sensor i. (Should i be last in both phases, i + n may instead be first in both: that moves all places of the
//! sensors between by one, in both phases alike.) So c of sensor x depends on `x mod n` alone, and *one* permutation places `floor(K / n)` sensors
//! or one more for each of its places. For n that divides K and n = 4, that is `n I + D (L - 1)` with `L = K / n` at `R = I`.
//!
//! **Ring.** The same goes all round, so c depends on x mod the largest common divisor of n and K, and of each class there are K / n times as
//! many sensors as places. Let x and y conflict, x before y in phase b and behind it in a: `a_x - a_y >= (p_x - p_y) I` and
//! `b_y - b_x >= (q_y - q_x) I`, so `e = d - c I` is no smaller for x than for y. If `c_x > 0`, somebody in each clique is overtaken so; with
//! `K >= 2 n` there is one on either side of x, n sensors apart and so of one class, and their e differ by D. Hence `e_x >= -sigma + D`,
//! and likewise `e_x <= sigma - D` if `c_x < 0`: in terms of `|d|` every class but 0 loses D at the lower end. A sensor that keeps its place,
//! `c = 0`, while others pass it from both sides, has both: its class loses D above, on the one side that `|d|` has. Sensors that nobody
//! passes lose nothing.
//!
//! **Ring of `K = 2 n`.** Every sensor conflicts with all but the one opposite, and both fire in the same 2 n places of two periods, of which
//! each takes as long as its two firings are apart. The time from one firing to the next is `T_p + d` or `T_p - d`; of two opposite
//! sensors these times differ by D at least, so the two places that they share take D together. (If they are next to each other, because the
//! sensor that is last in one phase is first in the next, then it is I from each firing to the next, and from the first of the four
//! to the last `I + D`.) All n pairs of places, with I behind each place: `2 T_p >= 2 n I + n D`.
//!
//! Whether some permutation fits is found by trying them, place by place; there are few unless n is large, and then giving up says nothing.
//! Where `2 sigma >= I`, lines and rings take up [`changes`]; where `sigma >= I`, nothing is said.

use super::MAX_SENSORS;
use super::bounds;
use super::changes::{self, Changes};
use super::problem::{Needs, common_divisor};
use super::random::Random;
use super::symmetry;

/// The places tried before giving up.
const STEPS: u32 = 1 << 15;

/// What is known of the conflicts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Shape {
    Line,
    /// With at least twice as many sensors as conflict at once.
    Ring,
    /// So many disjoint cliques.
    Cliques(u32),
}

/// Cliques of n sensors, and how they hang together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Classes {
    shape: Shape,
    /// n.
    clique: u32,
}

impl Classes {
    /// What the conflicts allow to count, or `None` if no two sensors conflict or the window is shorter than the interval.
    pub(crate) fn new(needs: &Needs) -> Option<Self> {
        if needs.window < needs.interval {
            return None;
        }
        let first = needs.conflicts[0];
        // Sensors 1 to n - 1 conflict with sensor 0, and more only round the end of a ring.
        let n = (first >> 1).trailing_ones() as usize + 1;
        let near = |x: usize, y: usize| x != y && x.abs_diff(y) < n;
        let row = |x: usize| (0..needs.sensors).filter(|&y| near(x, y)).fold(0, |row, y| row | 1 << y);
        if n >= 2 && (0..needs.sensors).all(|x| needs.conflicts[x] == row(x)) {
            return Some(Self { shape: Shape::Line, clique: n as u32 });
        }
        if n >= 2 && needs.sensors >= 2 * n && first.count_ones() as usize == 2 * (n - 1) && symmetry::is_ring(needs) {
            return Some(Self { shape: Shape::Ring, clique: n as u32 });
        }
        let (clique, cliques) = bounds::disjoint_cliques(needs);
        (clique >= 2).then_some(Self { shape: Shape::Cliques(cliques), clique })
    }

    /// A period below which there is no schedule, with n; it may be smaller than other bounds.
    pub(crate) fn period(&self, needs: &Needs) -> i32 {
        // `ProblemError::TooLong` bounds n I.
        let clique = self.clique as i32 * needs.interval;
        let (mut no, mut yes) = (clique - 1, clique + needs.interval);
        while no + 1 < yes {
            let middle = no + (yes - no) / 2;
            if self.excludes(needs, middle) { no = middle } else { yes = middle }
        }
        yes
    }

    /// The number of sensors in each clique.
    pub(crate) fn clique(&self) -> u32 {
        self.clique
    }

    /// Whether any n adjacent sensors conflict.
    pub(crate) fn adjacent(&self) -> bool {
        !matches!(self.shape, Shape::Cliques(_))
    }

    /// Whether also round the end.
    pub(crate) fn ring(&self) -> bool {
        self.shape == Shape::Ring
    }

    /// How often sensors n apart may have different places.
    pub(crate) fn changes(&self, needs: &Needs, period: i32) -> Changes {
        let n = self.clique as i32;
        match self.shape {
            // There a class is a matter of one clique.
            Shape::Cliques(_) if period - n * needs.interval < needs.interval => Changes::None,
            Shape::Cliques(_) => Changes::Any,
            Shape::Line => changes::in_line(needs, period, n),
            Shape::Ring => changes::in_ring(needs, period, n),
        }
    }

    /// The number of sensors that were counted.
    pub(crate) fn sensors(&self, needs: &Needs) -> u32 {
        if let Shape::Cliques(cliques) = self.shape { cliques * self.clique } else { needs.sensors as u32 }
    }

    /// Whether there is no schedule with this period because too few `|d|` fit into each class.
    pub(crate) fn excludes(&self, needs: &Needs, period: i32) -> bool {
        let n = self.clique as i32;
        let spare = period - n * needs.interval;
        if spare < 0 {
            return true;
        }
        match self.changes(needs, period) {
            Changes::None => {}
            Changes::One if !changes::one_fits(needs, self, period) => {}
            Changes::Two { rigid } if !changes::two_fit(needs, self, period, rigid) => {}
            _ => return false,
        }
        let passed = self.passed(needs);
        let sensors = needs.sensors as i32;
        if self.shape == Shape::Ring && sensors == 2 * n && 2 * spare < needs.interval.min(n * needs.separation) {
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
            let values = self.values(needs, period, class, passed);
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
                    let crossed = i64::from(self.values_within(needs, period, 0, 0, passed)) * i64::from(per);
                    room.crossed = (crossed / i64::from(sensors)).min(i64::from(n)) as i32;
                }
                let none = [0; MAX_SENSORS];
                let search = room.permutation(&[1; MAX_SENSORS][..n as usize], &none, |moved| match shape {
                    Shape::Line => {
                        // Some places have a sensor more than the others.
                        let more: i32 = (0..n as usize)
                            .map(|class| moved[class].min(room.values[class] - sensors * moved[class]))
                            .sum();
                        more >= needs.sensors as i32 % n
                    }
                    Shape::Ring => {
                        // Places that differ by a common divisor of n and K are of one class.
                        let alike = n / common_divisor(n, sensors);
                        moved.iter().all(|moved| moved % alike == 0)
                    }
                    Shape::Cliques(_) => true,
                });
                matches!(search, Search::None)
            }
        }
    }

    /// Whether some permutation has no more places in each class than these.
    pub(super) fn permutes(&self, places: &[i32; MAX_SENSORS]) -> bool {
        let n = self.clique as usize;
        let room = Room { places: *places, crossed: i32::MAX, values: [0; MAX_SENSORS] };
        // A clique has at most MAX_SENSORS sensors.
        !matches!(room.permutation(&[1; MAX_SENSORS][..n], &[0; MAX_SENSORS], |_| true), Search::None)
    }

    /// What a sensor of a ring needs at the lower end of its class, as others pass it on both sides.
    pub(super) fn passed(&self, needs: &Needs) -> i32 {
        if self.ring() { needs.separation } else { 0 }
    }

    /// Orders drawn by chance in which each n-th sensor has the same place, and for whose classes there is room.
    pub(crate) fn draw(&self, needs: &Needs, period: i32, random: &mut Random) -> Option<Orders> {
        let (k, n) = (needs.sensors, self.clique as usize);
        if matches!(self.shape, Shape::Cliques(_)) || (self.shape == Shape::Ring && k % n > 0) {
            return None;
        }
        let mut room = Room { places: [0; MAX_SENSORS], crossed: i32::MAX, values: [0; MAX_SENSORS] };
        // n is at most MAX_SENSORS; so are places, and numbers mod n.
        for class in 0..n {
            room.places[class] = self.values(needs, period, class as i32, self.passed(needs));
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
        let Search::Found(to) = room.permutation(&sizes[..n], &offsets, |_| true) else {
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

    /// How many `|d|` fit into a class, if in all but class 0 the first `passed` ticks are lost.
    pub(super) fn values(&self, needs: &Needs, period: i32, class: i32, passed: i32) -> i32 {
        self.values_within(needs, period, class, if class > 0 { passed } else { 0 }, 0)
    }

    /// How many `|d|` fit into a class of which `below` and `above` are lost.
    fn values_within(&self, needs: &Needs, period: i32, class: i32, below: i32, above: i32) -> i32 {
        let spare = period - self.clique as i32 * needs.interval;
        let middle = class * needs.interval;
        let low = (middle - spare + below).max(needs.least);
        let high = (middle + spare - above).min(period - needs.window);
        if low <= high { (high - low) / needs.separation + 1 } else { 0 }
    }
}

/// What fits into the classes.
struct Room {
    /// How many places of the permutation may be in each class.
    places: [i32; MAX_SENSORS],
    /// How many of those in class 0 may be passed by others.
    crossed: i32,
    /// How many `|d|` fit into each class.
    values: [i32; MAX_SENSORS],
}

impl Room {
    /// A permutation of the places for which there is room and that `suits`, given how much of each class it takes; place q takes `sizes[q]`
    /// and is tried at `offsets[q]` first.
    ///
    /// Places are below n, the length of both, which is at most `MAX_SENSORS`, and so are distances: all indices are in range.
    fn permutation(&self, sizes: &[i32], offsets: &[u8], suits: impl Fn(&[i32]) -> bool) -> Search {
        let n = sizes.len();
        let mut to = [0u8; MAX_SENSORS];
        // The alternatives of each place that were tried.
        let mut tried = [0usize; MAX_SENSORS];
        let mut moved = [0i32; MAX_SENSORS];
        let (mut used, mut crossed, mut from) = (0u64, 0, 0);
        for _ in 0..STEPS {
            if from == n {
                if suits(&moved[..n]) {
                    return Search::Found(to);
                }
            } else {
                let passed = used != !(u64::MAX << from);
                let next = (tried[from]..n).map(|i| (i, (i + usize::from(offsets[from])) % n)).find(|&(_, p)| {
                    let class = p.abs_diff(from);
                    used >> p & 1 == 0
                        && moved[class] + sizes[from] <= self.places[class]
                        && (class > 0 || !passed || crossed < self.crossed)
                });
                if let Some((i, p)) = next {
                    moved[p.abs_diff(from)] += sizes[from];
                    crossed += i32::from(p == from && passed);
                    used |= 1 << p;
                    // A place is below 64.
                    to[from] = p as u8;
                    tried[from] = i + 1;
                    from += 1;
                    if from < n {
                        tried[from] = 0;
                    }
                    continue;
                }
            }
            if from == 0 {
                return Search::None;
            }
            from -= 1;
            let p = usize::from(to[from]);
            used &= !(1 << p);
            moved[p.abs_diff(from)] -= sizes[from];
            crossed -= i32::from(p == from && used != !(u64::MAX << from));
        }
        Search::GivenUp
    }
}

/// What came of looking for a permutation.
enum Search {
    Found([u8; MAX_SENSORS]),
    None,
    GivenUp,
}

/// In which order sensors fire: of two that conflict, the one with the smaller number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orders {
    pub(crate) a: [u8; MAX_SENSORS],
    pub(crate) b: [u8; MAX_SENSORS],
    /// The sensor with the largest `|d|`, which is positive, should be one of these.
    pub(crate) tops: u64,
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec;

    use super::super::Problem;
    use super::super::place::Places;
    use super::super::tree::{Outcome, Tree};
    use super::*;

    fn rows(sensors: usize, n: usize, layout: &str) -> [u64; MAX_SENSORS] {
        let mut rows = [0; MAX_SENSORS];
        for x in 0..sensors {
            for y in 0..sensors {
                let apart = x.abs_diff(y);
                let conflict = match layout {
                    "line" => apart < n,
                    "ring" => apart.min(sensors - apart) < n,
                    _ => x / n == y / n,
                };
                rows[x] |= u64::from(x != y && conflict) << y;
            }
        }
        rows
    }

    /// Goes through the tree without placing a clique first, which rests on the same argument.
    fn search(needs: &Needs, period: i32, budget: u64, memory: &mut [i32]) -> Outcome {
        let mut tree = Tree::new(needs, period, memory);
        tree.places = Places::none();
        tree.restart(None, None);
        tree.run(budget)
    }

    #[test]
    fn no_schedule_is_found_below_the_bound_of_classes() {
        let mut memory = [0; super::super::memory_words(10)];
        let (mut proven, mut met) = (0, 0);
        for layout in ["line", "ring", "blocks"] {
            for (sensors, n) in
                [(4, 2), (5, 2), (6, 2), (5, 3), (6, 3), (7, 3), (8, 3), (9, 3), (8, 4), (9, 4), (10, 4), (5, 5)]
            {
                for (separation, interval, window) in
                    [(1, 7, 7), (1, 15, 30), (2, 8, 20), (2, 15, 15), (3, 16, 32), (2, 15, 45)]
                {
                    for stale_echo in [false, true] {
                        let rows = rows(sensors, n, layout);
                        let conflicts = &rows[..sensors];
                        let problem = Problem { sensors, conflicts, separation, interval, window, stale_echo };
                        let needs = problem.needs().unwrap();
                        let bound = Classes::new(&needs).unwrap().period(&needs);
                        match search(&needs, bound - 1, 4_000, &mut memory) {
                            Outcome::Found(_) => panic!("{layout} {n}: {problem:?} below {bound}"),
                            Outcome::Exhausted => proven += 1,
                            Outcome::Spent => {}
                        }
                        let outcome = search(&needs, bound, 1_000, &mut memory);
                        met += i32::from(matches!(outcome, Outcome::Found(_)));
                    }
                }
            }
        }
        assert!(proven > 350 && met > 200, "{proven} proven, {met} met");
    }

    #[test]
    fn no_schedule_is_found_below_a_bound_beyond_half_an_interval_to_spare() {
        let mut memory = vec![0; super::super::memory_words(14)];
        let mut random = Random::new(1);
        // By how the places may change: not, once in a line, twice in a ring.
        let mut proven = [0; 3];
        for _ in 0..4000 {
            let layout = ["line", "ring", "ring"][random.below(3) as usize];
            let n = 2 + random.below(4) as usize;
            let sensors =
                if layout == "ring" { n * 2 + n * random.below(2) as usize } else { n + 1 + random.below(9) as usize };
            let (interval, separation) = (4 + random.below(30), 1 + random.below(6));
            let reach = if random.below(2) == 0 { 4 } else { n as u32 * interval };
            let window = interval + random.below(reach);
            let rows = rows(sensors, n, layout);
            let conflicts = &rows[..sensors.min(14)];
            let problem = Problem { sensors, conflicts, separation, interval, window, stale_echo: false };
            let Ok(needs) = problem.needs() else { continue };
            let Some(classes) = Classes::new(&needs) else { continue };
            let period = classes.period(&needs) - 1;
            if 2 * (period - classes.clique() as i32 * needs.interval) < needs.interval {
                continue;
            }
            let kind = match classes.changes(&needs, period) {
                Changes::None => 0,
                Changes::One => 1,
                Changes::Two { .. } => 2,
                Changes::Any => panic!("{problem:?}: a bound without an argument"),
            };
            match search(&needs, period, 4_000, &mut memory) {
                Outcome::Found(_) => panic!("{layout} {n}: {problem:?} at {period}"),
                Outcome::Exhausted => proven[kind] += 1,
                Outcome::Spent => {}
            }
        }
        assert!(proven.iter().all(|&proven| proven > 4), "{proven:?}");
    }
}
