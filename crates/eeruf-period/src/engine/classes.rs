//! A bound on the period by classes of `|d|`.

use crate::engine::counting::{Even, members};

/// The least slack of a period for sensors that all conflict, so that all their `|d|` find room.
///
/// Take n sensors that all conflict, in a period `T_p = n I + sigma`, with `R >= I`. Any two consecutive firings
/// are I apart, even those of one sensor. If a sensor is the p-th of them in phase a and the q-th in phase b,
/// `n + p - q` such steps lie between its firing in b and the next in a, and `n - p + q` between a and the next b, so
/// with `c = p - q`
///
/// ```text
/// T_p + d >= (n + c) I,  T_p - d >= (n - c) I,  that is  c I - sigma <= d <= c I + sigma.
/// ```
///
/// Its **class** is `|c|`. As long as `sigma < I` each class has room for as many `|d|` as fit D apart into
/// `|c| I - sigma ..= |c| I + sigma`, cut off at `least` below and at the `T_p - R` that the window leaves above. The n
/// values c are the moves of the places of a permutation. **Disjoint cliques** share the room of the classes.
///
/// **Line** (each n adjacent sensors conflict). Sensors i and i + n both conflict with the n - 1 between them, whose
/// firings leave `2 (n - 1)` gaps, in two periods end to end. A gap with u firings of sensor i and v of sensor i + n in
/// it is at least `(1 + max(u, v)) I` long; if `2 sigma < I`, together they are `2 T_p < (2 n + 1) I` long, so the sum
/// of `max(u, v)` is at most 2. As u and v sum to 2 each, `u = v` in each gap: sensor i + n takes the places of sensor
/// i. (Should i be last in both phases, i + n may instead be first in both: that moves all places of the sensors
/// between by one, in both phases alike.) So c of sensor x depends on `x mod n` alone: *one* permutation for all, and
/// each of its places needs room for `K / n` sensors, those of the first `K mod n` for one more.
///
/// **Ring**, `K >= 2 n`. This holds all round, so c depends on `x mod g`, the greatest common divisor of K and n,
/// and each c is that of a multiple of `n / g` places. Let x and y conflict, x before y in phase b and behind it in a:
/// `a_x - a_y >= (p_x - p_y) I` and `b_y - b_x >= (q_y - q_x) I`, so `e = d - c I` is no smaller for x than for y. If
/// `c_x > 0`, x overtakes such a sensor in each clique; there is one on either side, n sensors apart and so of one
/// class, and their e differ by D. Hence `e_x >= -sigma + D`, and likewise `e_x <= sigma - D` if `c_x < 0`: in terms of
/// `|d|` every class but 0 loses D at the lower end.
///
/// **Ring of `K = 2 n`.** Every sensor conflicts with all but the opposite one, and both fire in the same 2 n places of
/// two periods, each of which is as long as its two firings are apart. The time from one firing to the next is
/// `T_p + d` or `T_p - d`; of two opposite sensors these times differ by D at least, so the two places that they share
/// take D together. (If they are next to each other, because the sensor that is last in one phase is first in the next,
/// then it is I from each firing to the next, and from the first of the four to the last `I + D`.) All n pairs of
/// places, with I behind each place: `2 T_p >= 2 n I + n D`.
pub(crate) struct Classes {
    pub(crate) n: i32,
    pub(crate) kind: Kind,
}

/// The arrangement of the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Line,
    Ring,
    /// This many disjoint cliques.
    Cliques(i32),
}

/// Number of places tried before a permutation is given up, which then proves nothing.
const STEPS: u32 = 1 << 15;

impl Classes {
    pub(crate) fn of(even: &Even) -> Option<Self> {
        let k = even.count;
        // Sensors 1 to n - 1 have a gap to sensor 0, and more only round the end of a ring.
        let n = (even.rows[0] >> 1).trailing_ones() as usize + 1;
        let row = |x: usize| (0..k).filter(|&y| x != y && x.abs_diff(y) < n).fold(0, |row, y| row | 1 << y);
        let (n, kind) = if (0..k).all(|x| even.rows[x] == row(x)) {
            (n, Kind::Line)
        } else if let Some(n) = even.ring().filter(|n| k >= 2 * n) {
            (n, Kind::Ring)
        } else {
            let size = even.largest_clique().count_ones();
            (size as usize, Kind::Cliques(even.disjoint(size).len().max(1) as i32))
        };
        (n >= 2 && even.window >= even.interval).then_some(Self { n: n as i32, kind })
    }

    /// The number of sensors for which the classes must have room.
    pub(crate) fn sensors(&self, even: &Even) -> i32 {
        if let Kind::Cliques(cliques) = self.kind { self.n * cliques } else { even.count as i32 }
    }

    /// A period below which there is no schedule; it may be smaller than other bounds.
    pub(crate) fn period(&self, even: &Even) -> i32 {
        let Some(mut yes) = even.interval.checked_mul(self.n + 1) else { return 0 };
        let mut no = yes - even.interval - 1;
        while no + 1 < yes {
            let middle = no + (yes - no) / 2;
            if self.excludes(even, middle) { no = middle } else { yes = middle }
        }
        yes
    }

    /// Returns true if too few |d| fit into the classes at this period, which is at least n I and less than (n + 1) I.
    pub(crate) fn excludes(&self, even: &Even, period: i32) -> bool {
        let (n, count, separation) = (self.n, even.count as i32, even.separation);
        let spare = period - n * even.interval;
        let is_ring = self.kind == Kind::Ring;
        let is_one = matches!(self.kind, Kind::Cliques(1)) || n == count;
        let is_alike = is_one || self.kind == Kind::Line || is_ring;
        let is_alike = is_alike && (is_one || 2 * spare < even.interval);
        let mut rooms = Vec::new();
        for class in 0..n {
            let passed = if is_ring && is_alike && class > 0 { separation } else { 0 };
            let middle = class * even.interval;
            let (low, high) = ((middle - spare + passed).max(even.least), period - even.window);
            let high = high.min(middle + spare);
            rooms.push(if low <= high { (high - low) / separation + 1 } else { 0 });
        }
        let sensors = if let Kind::Cliques(cliques) = self.kind { n * cliques } else { count / n * n };
        let moves = match self.kind {
            Kind::Ring => Moves::of_ring(n, count),
            Kind::Line => Moves { each: count / n, more: count % n, alike: 1 },
            Kind::Cliques(_) => Moves { each: 1, more: 0, alike: 1 },
        };
        let is_opposite = is_ring && is_alike && count == 2 * n && 2 * spare < n * separation;
        rooms.iter().map(|&room| room.min(sensors)).sum::<i32>() < sensors
            || is_opposite
            || is_alike && !moves.find_room(&rooms)
    }
}

/// The number of sensors that share a place's move: `each`, or one more for `more` of the places; in a ring `alike`
/// places move alike.
struct Moves {
    each: i32,
    more: i32,
    alike: i32,
}

impl Moves {
    /// The moves of a ring: sensor x moves as far as x + n, and so as far as x + g, where g is the greatest common
    /// divisor of n and the number of sensors.
    fn of_ring(n: i32, count: i32) -> Self {
        let (mut divisor, mut rest) = (n, count);
        while rest > 0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        Self { each: count / divisor, more: 0, alike: n / divisor }
    }

    /// Returns true if some permutation moves no more sensors by each distance than there is room for, or if finding
    /// out takes too long.
    fn find_room(&self, rooms: &[i32]) -> bool {
        let n = rooms.len();
        let all = u64::MAX >> (64 - n);
        let mut left: Vec<i32> = rooms.iter().map(|room| room / self.each * self.alike).collect();
        // The target of each place, and the targets that are still to be tried.
        let (mut to, mut open) = (vec![0; n], vec![all; n]);
        let (mut free, mut from) = (all, 0);
        for _ in 0..STEPS {
            if from == n && self.suits(rooms, &to) {
                return true;
            }
            let next = if from == n { None } else { members(open[from] & free).find(|p| left[p.abs_diff(from)] > 0) };
            if let Some(p) = next {
                left[p.abs_diff(from)] -= 1;
                free &= !(1 << p);
                open[from] &= u64::MAX << p << 1;
                (to[from], from) = (p, from + 1);
                continue;
            }
            if from < n {
                open[from] = all;
            }
            if from == 0 {
                return false;
            }
            from -= 1;
            left[to[from].abs_diff(from)] += 1;
            free |= 1 << to[from];
        }
        true
    }

    /// Returns true if enough places move alike, and enough classes have room for one more sensor.
    fn suits(&self, rooms: &[i32], to: &[usize]) -> bool {
        let n = rooms.len();
        let moved = |by: i32| (0..n).filter(|&from| to[from] as i32 - from as i32 == by).count() as i32;
        let mut more = 0;
        for (class, room) in (0..).zip(rooms) {
            let [up, down] = [moved(class), if class > 0 { moved(-class) } else { 0 }];
            if up % self.alike != 0 || down % self.alike != 0 {
                return false;
            }
            more += (up + down).min(room - (up + down) / self.alike * self.each);
        }
        more >= self.more
    }
}
