//! Decides by brute force over firing times whether a schedule exists; its only shortcut is to drop pairs of times that
//! no longer fit.

/// The longest period that is judged.
pub(crate) const MOST_TICKS: u32 = 40;
/// Possible times of one sensor: `MOST_TICKS` rows, one for each time in phase a, with a bit for each time in phase b.
type Times = [u64; MOST_TICKS as usize];
/// Number of steps after which the brute force leaves a question open; few may stay open.
const MOST_STEPS: u64 = 200_000;

/// The needs of a problem at a period, all signed so that they can be written as in the definition.
#[derive(Clone, Debug)]
pub(crate) struct Needs {
    pub(crate) conflicts: Vec<u64>,
    pub(crate) separation: i32,
    pub(crate) interval: i32,
    pub(crate) window: i32,
    pub(crate) stale_echo: bool,
    pub(crate) period: i32,
}

impl Needs {
    fn conflict(&self, x: usize, y: usize) -> bool {
        self.conflicts[x] >> y & 1 == 1
    }

    /// Returns true if a sensor alone may fire at these times.
    fn alone(&self, (a, b): (i32, i32)) -> bool {
        let size = (a - b).abs();
        self.period - size >= self.window && (!self.stale_echo || 2 * size >= self.separation)
    }

    /// Returns true if the crosstalk between two sensors moves enough.
    fn separated(&self, (ax, bx): (i32, i32), (ay, by): (i32, i32)) -> bool {
        ((ax - bx).abs() - (ay - by).abs()).abs() >= self.separation
    }

    /// Returns true if two firings, `s` of one sensor and `t` of the other, are far enough apart. With `other` their
    /// phases differ, and one comes a period after the other, whichever is first.
    fn apart(&self, s: i32, t: i32, other: bool) -> bool {
        if other {
            self.period + t - s >= self.interval && self.period + s - t >= self.interval
        } else {
            (s - t).abs() >= self.interval
        }
    }

    /// Returns true if two conflicting sensors fire far enough apart in both phases and across the ends of both.
    fn all_apart(&self, (ax, bx): (i32, i32), (ay, by): (i32, i32)) -> bool {
        self.apart(ax, ay, false) && self.apart(bx, by, false) && self.apart(ax, by, true) && self.apart(bx, ay, true)
    }

    /// Returns true if these firing times meet the needs, pair by pair.
    pub(crate) fn met_by(&self, times: &[(i32, i32)]) -> bool {
        let within = |time: i32| (0..self.period).contains(&time);
        (0..times.len()).all(|x| {
            within(times[x].0)
                && within(times[x].1)
                && self.alone(times[x])
                && (0..x).all(|y| {
                    self.separated(times[x], times[y]) && (!self.conflict(x, y) || self.all_apart(times[x], times[y]))
                })
        })
    }
}

/// Returns true if a schedule exists; `None` if that takes too many steps.
pub(crate) fn brute_force(needs: &Needs) -> Option<bool> {
    assert!((1..=MOST_TICKS as i32).contains(&needs.period));
    let sensors = needs.conflicts.len();
    let mut open = vec![[0; MOST_TICKS as usize]; sensors];
    for (x, open) in open.iter_mut().enumerate() {
        for a in 0..needs.period {
            for b in 0..needs.period {
                // A sensor without conflicts needs nothing but some |d|, so it may as well fire at 0 in phase b.
                if needs.alone((a, b)) && (needs.conflicts[x] != 0 || b == 0) {
                    open[a as usize] |= 1 << b;
                }
            }
        }
    }
    let mut search = BruteForce { needs, set: vec![None; sensors], steps: 0 };
    // All that conflict can be moved to earlier times together, and the phases exchanged: one of them may as well fire
    // at 0 in b.
    let conflicting: Vec<usize> = (0..sensors).filter(|&x| needs.conflicts[x] != 0).collect();
    let mut found = Some(false);
    if conflicting.is_empty() {
        found = search.assign(&open);
    }
    for &first in &conflicting {
        if found != Some(false) {
            break;
        }
        let mut open = open.clone();
        for row in &mut open[first] {
            *row &= 1;
        }
        found = search.assign(&open);
    }
    if found == Some(true) {
        let times: Vec<_> = search.set.iter().map(|times| times.expect("every sensor is set")).collect();
        assert!(needs.met_by(&times), "the brute force itself is wrong: {needs:?} {times:?}");
    }
    found
}

struct BruteForce<'a> {
    needs: &'a Needs,
    set: Vec<Option<(i32, i32)>>,
    steps: u64,
}

impl BruteForce<'_> {
    fn assign(&mut self, open: &[Times]) -> Option<bool> {
        let count = |times: &Times| times.iter().map(|row| row.count_ones()).sum::<u32>();
        let left: Vec<usize> = (0..open.len()).filter(|&x| self.set[x].is_none()).collect();
        let Some(&next) = left.iter().min_by_key(|&&x| count(&open[x])) else { return Some(true) };
        if !self.has_room(&left, open) {
            return Some(false);
        }
        for a in 0..self.needs.period {
            for b in (0..self.needs.period).filter(|b| open[next][a as usize] >> b & 1 == 1) {
                self.steps += 1;
                if self.steps > MOST_STEPS {
                    return None;
                }
                self.set[next] = Some((a, b));
                let open: Vec<Times> = (0..open.len()).map(|x| self.remaining(x, open[x], next, (a, b))).collect();
                if left.iter().all(|&x| x == next || count(&open[x]) > 0) && self.assign(&open)? {
                    return Some(true);
                }
                self.set[next] = None;
            }
        }
        Some(false)
    }

    /// Times left to sensor `x` when `other` fires at these times.
    fn remaining(&self, x: usize, open: Times, other: usize, (a, b): (i32, i32)) -> Times {
        let needs = self.needs;
        if self.set[x].is_some() {
            return open;
        }
        let bits = |keeps: &dyn Fn(i32) -> bool| (0..needs.period).filter(|&t| keeps(t)).map(|t| 1 << t).sum::<u64>();
        // Two sensors of which each conflicts with the same others can be exchanged: the lower one has the smaller |d|.
        let ordered = |size: i32| !self.twins(x, other) || (size < (a - b).abs()) == (x < other);
        let sizes = bits(&|size| needs.separated((size, 0), (a, b)) && ordered(size));
        let conflict = needs.conflict(x, other);
        let in_a = bits(&|s| !conflict || (needs.apart(s, a, false) && needs.apart(s, b, true)));
        let in_b = bits(&|t| !conflict || (needs.apart(t, b, false) && needs.apart(t, a, true)));
        let mut rows = [0; MOST_TICKS as usize];
        for (s, row) in rows.iter_mut().enumerate().filter(|(s, _)| in_a >> s & 1 == 1) {
            // From time s on, and from s backwards.
            *row = open[s] & in_b & (sizes << s | sizes.reverse_bits() >> (63 - s));
        }
        rows
    }

    fn twins(&self, x: usize, y: usize) -> bool {
        self.needs.conflicts[x] & !(1 << y) == self.needs.conflicts[y] & !(1 << x)
    }

    /// Returns true if the remaining sensors have enough separated |d|, and those that all conflict with one another
    /// enough times in each phase.
    fn has_room(&self, left: &[usize], open: &[Times]) -> bool {
        let sizes = |s: usize, row: u64| row >> s | row.reverse_bits() >> (63 - s);
        let in_a = |s: usize, row: u64| u64::from(row != 0) << s;
        let any = |sensors: &[usize], of: &dyn Fn(usize, u64) -> u64| {
            sensors.iter().flat_map(|&x| open[x].iter().enumerate()).fold(0, |any, (s, &row)| any | of(s, row))
        };
        most(any(left, &sizes), self.needs.separation) >= left.len()
            && left.iter().all(|&x| {
                let mut clique = vec![x];
                for &y in left {
                    if clique.iter().all(|&z| self.needs.conflict(y, z)) {
                        clique.push(y);
                    }
                }
                let interval = self.needs.interval;
                most(any(&clique, &in_a), interval) >= clique.len()
                    && most(any(&clique, &|_, row| row), interval) >= clique.len()
            })
    }
}

/// Greatest number of these values that can be chosen at least `apart` from each other: in ascending order, each as
/// early as possible.
fn most(numbers: u64, apart: i32) -> usize {
    if apart == 0 {
        return usize::MAX;
    }
    let (mut chosen, mut next) = (0, 0);
    while next < 64 && numbers >> next != 0 {
        next += (numbers >> next).trailing_zeros() as i32 + apart;
        chosen += 1;
    }
    chosen
}
