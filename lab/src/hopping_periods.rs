//! Shortest periods of many phases: with the codes that a ring has, with Welch's sequence of every root, and with
//! congruences whose multipliers are dealt out freely, each by the same search for orders and lags.
//! `cargo lab hopping-periods RING.toml ..` prints a row for each ring.

use std::fs;

use eeruf_core::{Criterion, Micros, Requirements};
use eeruf_design::RingSpec;

/// Starts of the search, the first of them with a random order, and the orders that are tried from each.
const STARTS: usize = 12;
const ORDERS: usize = 5_000;

/// The waits of one sensor, in steps, phase by phase.
type Column = Vec<i64>;

/// Sensors that fire together are one unit.
struct Ring {
    units: Vec<Vec<usize>>,
    gap: Vec<Vec<i64>>,
    rest: Vec<i64>,
    step: i64,
}

/// Columns that units have by their place in the order of lags, or that are dealt out to them.
struct Code {
    columns: Vec<Column>,
    by_place: bool,
}

struct Bound {
    from: usize,
    to: usize,
    apart: i64,
    periods: i64,
}

impl Ring {
    fn of(sensors: usize, needs: &Requirements<'_>) -> Self {
        let together = |x: usize| (0..sensors).filter(move |&y| x == y || needs.fire_together(x, y));
        let mut units: Vec<Vec<usize>> = (0..sensors).map(|x| together(x).collect()).collect();
        units.sort();
        units.dedup();
        let longest = |all: &mut dyn Iterator<Item = Micros>| i64::from(all.max().unwrap_or_default().as_micros());
        let pairs = |a: &Vec<usize>, b: &Vec<usize>| -> Vec<(usize, usize)> {
            a.iter().flat_map(|&x| b.iter().map(move |&y| (x, y))).collect()
        };
        let gap = |a: &Vec<usize>, b: &Vec<usize>| {
            longest(&mut pairs(a, b).into_iter().filter(|(x, y)| x != y).map(|(x, y)| needs.gap_after(sensors, x, y)))
        };
        let gap = units.iter().map(|a| units.iter().map(|b| if a == b { 0 } else { gap(a, b) }).collect()).collect();
        let rest = |unit: &Vec<usize>| longest(&mut unit.iter().map(|&x| needs.window_of(x).max(needs.refire_of(x))));
        let rest = units.iter().map(rest).collect();
        let all = (0..sensors).flat_map(|x| (0..sensors).map(move |y| (x, y)));
        let step = longest(&mut all.filter_map(|(x, y)| needs.separation_of(x, y)));
        Self { units, gap, rest, step }
    }

    fn columns<'c>(&self, code: &'c Code, order: &[usize], dealt: &[usize]) -> Vec<&'c Column> {
        let mut columns = vec![&code.columns[0]; order.len()];
        let mut place = 0;
        for &unit in order {
            columns[unit] = &code.columns[if code.by_place { place } else { dealt[unit] }];
            place += self.units[unit].len();
        }
        columns
    }

    /// The shortest period of an order; `high` unless it is shorter or as short.
    fn shortest(&self, code: &Code, order: &[usize], dealt: &[usize], high: i64) -> i64 {
        let columns = self.columns(code, order, dealt);
        let phases = columns[0].len();
        let most = |difference: &dyn Fn(usize) -> i64| (0..phases).map(difference).max().unwrap_or(0) * self.step;
        let mut bounds = vec![];
        for (to, from) in (0..order.len()).flat_map(|y| (0..y).map(move |x| (y, x))) {
            let (x, y) = (order[from], order[to]);
            let (a, b) = (columns[x], columns[y]);
            if self.gap[x][y].max(self.gap[y][x]) > 0 {
                let within = self.gap[x][y] + most(&|m| a[m] - b[m]);
                let across = self.gap[y][x] + most(&|m| b[m] - a[(m + 1) % phases]);
                bounds.push(Bound { from: x, to: y, apart: within, periods: 0 });
                bounds.push(Bound { from: y, to: x, apart: across, periods: 1 });
            }
            if code.by_place && to == from + 1 {
                bounds.push(Bound { from: x, to: y, apart: 1, periods: 0 });
            }
        }
        let width = code.columns.iter().flatten().max().copied().unwrap_or(0) * self.step;
        let drops = |unit: usize| self.rest[unit] + most(&|m| columns[unit][m] - columns[unit][(m + 1) % phases]);
        let rests = (0..order.len()).map(drops).max().unwrap_or(0);
        let (mut low, mut high) = (rests.max(2 * width + self.step), high);
        if low > high || !has_lags(&bounds, order.len(), high - width - 1, high) {
            return high + 1;
        }
        while low < high {
            let middle = i64::midpoint(low, high);
            if has_lags(&bounds, order.len(), middle - width - 1, middle) { high = middle } else { low = middle + 1 }
        }
        high
    }

    /// Neighbours in the order of the first free turn of each unit.
    fn by_turns(&self) -> Vec<usize> {
        let mut turns: Vec<usize> = vec![];
        for unit in 0..self.units.len() {
            let taken: Vec<usize> =
                (0..unit).filter(|&other| self.gap[other][unit] > 0).map(|other| turns[other]).collect();
            turns.push((0..).find(|turn| !taken.contains(turn)).unwrap_or(0));
        }
        let mut order: Vec<usize> = (0..turns.len()).collect();
        order.sort_by_key(|&unit| (turns[unit], unit));
        order
    }

    /// The shortest period that is found with a code, in milliseconds.
    fn search(&self, code: &Code) -> f64 {
        let units = self.units.len();
        let mut random = 0x9e37_79b9_7f4a_7c15_u64;
        let mut below = |bound: usize| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            (random >> 11) as usize % bound
        };
        let mut best = i64::MAX;
        for start in 0..STARTS {
            let mut order = self.by_turns();
            if start == 0 {
                (1..units).rev().for_each(|at| order.swap(at, below(at + 1)));
            }
            let mut dealt: Vec<usize> = (0..units).map(|unit| (unit + start) % code.columns.len()).collect();
            let mut period = 1 << 28;
            for _ in 0..ORDERS {
                let before = (order.clone(), dealt.clone());
                if !code.by_place && below(2) == 0 {
                    let (unit, column) = (below(units), below(code.columns.len()));
                    if let Some(other) = dealt.iter().position(|&has| has == column) {
                        dealt[other] = dealt[unit];
                    }
                    dealt[unit] = column;
                } else {
                    for _ in 0..=below(2) {
                        let unit = order.remove(below(units));
                        order.insert(below(units), unit);
                    }
                }
                let other = self.shortest(code, &order, &dealt, period);
                if other <= period { period = other } else { (order, dealt) = before }
            }
            best = best.min(period);
        }
        best as f64 / 1e3
    }
}

/// Bellman-Ford: true if there are lags of at most `room` for this period.
fn has_lags(bounds: &[Bound], units: usize, room: i64, period: i64) -> bool {
    let mut lags = vec![0; units];
    for _ in 0..=units {
        let mut changed = false;
        for bound in bounds {
            let later = lags[bound.from] + bound.apart - bound.periods * period;
            if later > room {
                return false;
            }
            if later > lags[bound.to] {
                (lags[bound.to], changed) = (later, true);
            }
        }
        if !changed {
            return true;
        }
    }
    false
}

fn is_prime(number: i64) -> bool {
    number > 1 && (2..number).all(|divisor| number % divisor != 0)
}

/// Powers of a primitive root of a prime, less one; `None` for other numbers.
fn welch(prime: i64, root: i64) -> Option<Column> {
    let powers: Vec<i64> =
        std::iter::successors(Some(1), |power| Some(power * root % prime)).take(prime as usize - 1).collect();
    let is_primitive = !powers.iter().skip(1).any(|&power| power == 1);
    is_primitive.then(|| powers.iter().map(|power| power - 1).collect())
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    println!("| ring | as designed | Welch, any root | any multipliers |\n|---|---:|---:|---:|");
    for file in arguments {
        let spec = RingSpec::from_text(&fs::read_to_string(file)?)?;
        let designed = spec.hopping(4, Criterion::Exact)?.schedule.period();
        let ring = Ring::of(spec.sensors, &spec.phase_requirements(Criterion::Exact));
        let sensors = spec.sensors as i64;
        let prime = (sensors + 2..).find(|&number| is_prime(number)).unwrap_or(2);
        let roots = (2..prime).filter_map(|root| welch(prime, root));
        let by_root = roots.map(|waits| {
            let shifted = |place: usize| [&waits[waits.len() - place..], &waits[..waits.len() - place]].concat();
            ring.search(&Code { columns: (0..spec.sensors).map(shifted).collect(), by_place: true })
        });
        let welch = by_root.fold(f64::INFINITY, f64::min);
        let prime = (sensors..).find(|&number| is_prime(number)).unwrap_or(2);
        let columns = (0..prime).map(|a| (0..prime).map(|m| a * m % prime).collect()).collect();
        let free = ring.search(&Code { columns, by_place: false });
        println!("| {file} | {:.1} | {welch:.1} | {free:.1} |", f64::from(designed.as_micros()) / 1e3);
    }
    Ok(())
}
