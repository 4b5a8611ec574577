//! The shortest period over the reals: the cost of the tick.
//!
//! With the firing orders, the signs of d and the order of |d| decided, all that is required is linear in the firing
//! times and the period, so the shortest period of these orders is a fraction that `linear` finds
//! exactly. Then the tree of a certificate over the reals either refutes every shorter period, or is left with a
//! branch of other orders. If their shortest period is shorter, it is taken next. If it is not, they are excluded too,
//! but not by a rule of certificates.

use crate::engine::linear::{Row, least_of_first};
use crate::engine::orders::Orders;
use crate::engine::problem::Claim;
use crate::engine::problem::{Merged, Problem};
use crate::engine::prove::{NoProof, prove_but};
use crate::engine::search::{Decided, Search};
use crate::engine::state::event;

/// The shortest period over the reals of some orders, and whether no orders have a shorter one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverReals {
    /// The period and the firing times in ticks divided by this many, in lowest terms together.
    pub denominator: u32,
    /// The period.
    pub period: u32,
    /// The firing times.
    pub fire: [Vec<u32>; 2],
    /// True if no real period is shorter.
    pub proven: bool,
    /// The certificate of that; there is none where orders had to be excluded by their linear program, which no
    /// certificate can state.
    pub certificate: Option<String>,
}

/// The number of exchanges that the least period of some orders may take: a few for each row is usual.
const PIVOTS: usize = 20_000;
/// The number of descents that may look for a schedule with a period that some orders only approach.
const ATTEMPTS: u64 = 256;

/// The shortest period over the reals, beginning with the orders of a schedule in whole ticks. Separations, windows and
/// gaps are what they are in ticks, read as reals.
///
/// `budget` nodes are spent at most, as long as `go_on` says so; it is asked now and then, with the nodes so far.
/// `None` if the numbers become too large, or no schedule is found that has the period of these orders.
#[must_use]
pub fn shortest_over_reals(
    problem: &Problem,
    fire: &[Vec<u32>; 2],
    budget: usize,
    mut go_on: impl FnMut(usize) -> bool,
) -> Option<OverReals> {
    let merged = problem.merged();
    let mut best = least_period(&merged, &Orders::of(&merged, fire)).and_then(|least| least.attained(problem))?;
    let mut spent = 0;
    while spent < budget {
        let claim = best.claim(problem)?;
        let (mut nodes, mut excluded, mut better) = (0, 0, None);
        let proof = prove_but(
            &claim,
            budget - spent,
            |so_far| {
                nodes = so_far;
                go_on(spent + so_far)
            },
            |orders| {
                excluded += 1;
                let least = least_period(&merged, orders);
                better = least.clone().filter(|least| least.is_shorter(&best));
                least.is_some() && better.is_none()
            },
        );
        match proof {
            Ok(text) => {
                let certificate = (excluded == 0).then_some(text);
                return Some(OverReals { proven: true, certificate, ..best });
            }
            Err(NoProof::Open(_)) => match better.and_then(|better| better.attained(problem)) {
                Some(better) => best = better,
                None => break,
            },
            Err(_) => break,
        }
        spent += nodes + 1;
    }
    Some(best)
}

impl OverReals {
    fn is_shorter(&self, other: &Self) -> bool {
        u64::from(self.period) * u64::from(other.denominator) < u64::from(other.period) * u64::from(self.denominator)
    }

    /// The claim that no period is shorter.
    fn claim(&self, problem: &Problem) -> Option<Claim> {
        // With stale echoes half a separation must be whole.
        let twice = if problem.stale_echo { 2 } else { 1 };
        let times = |list: &[u32]| list.iter().map(|time| time.checked_mul(twice)).collect::<Option<Vec<_>>>();
        let period = self.period.checked_mul(twice)?;
        let problem = Problem { over_reals: true, ..in_parts(problem, self.denominator.checked_mul(twice)?)? };
        Some(Claim { problem, period, fire: [times(&self.fire[0])?, times(&self.fire[1])?], bound: period })
    }

    /// The same, or with other times if the period can only be approached with these orders: a sensor would have to
    /// fire when the next phase begins.
    fn attained(self, problem: &Problem) -> Option<Self> {
        if self.fire.iter().flatten().all(|&time| time < self.period) {
            return Some(self);
        }
        let fine = in_parts(problem, self.denominator)?;
        let mut search = Search::new(&fine);
        let effort = ATTEMPTS * search.depth();
        match search.find(self.period, effort, 0, Some(&self.fire), &mut |_| true) {
            Decided::Found(fire) => Some(Self { fire, ..self }),
            _ => None,
        }
    }
}

/// The problem in such parts of a tick.
fn in_parts(problem: &Problem, parts: u32) -> Option<Problem> {
    let times = |list: &[u32]| list.iter().map(|time| time.checked_mul(parts)).collect::<Option<Vec<_>>>();
    let gap = |&(x, y, after_x, after_y): &(usize, usize, u32, u32)| {
        Some((x, y, after_x.checked_mul(parts)?, after_y.checked_mul(parts)?))
    };
    Some(Problem {
        tick_us: (problem.tick_us.0, problem.tick_us.1.checked_mul(parts)?),
        separation: times(&problem.separation)?,
        window: times(&problem.window)?,
        gaps: problem.gaps.iter().map(gap).collect::<Option<_>>()?,
        ..problem.clone()
    })
}

/// The shortest period over the reals of all schedules with these orders, with such a schedule.
fn least_period(merged: &Merged, orders: &Orders) -> Option<OverReals> {
    let (events, rows) = (1 + 2 * merged.count(), rows(merged, orders));
    let (mut point, mut denominator) = least_of_first(events, &rows, PIVOTS)?;
    if point[1..].contains(&point[PERIOD]) {
        // All firings lie before the end of the period: with the period as it is now, the latest as early as possible.
        let divisor = greatest_common_divisor(point[PERIOD], denominator);
        let (period, parts) = (point[PERIOD] / divisor, i32::try_from(denominator / divisor).ok()?);
        let fixed = i32::try_from(period).ok()?;
        let with_period_fixed = |(coefficients, least): &Row| -> Option<Row> {
            let (of_period, others) = coefficients.iter().partition::<Vec<_>, _>(|&&(event, _)| event == PERIOD);
            let of_period: i32 = of_period.iter().map(|&(_, times)| times).sum();
            let others = others.into_iter().map(|(event, times)| (event, times * parts)).collect();
            Some((others, least.checked_mul(parts)?.checked_sub(of_period.checked_mul(fixed)?)?))
        };
        let mut rows = rows.iter().map(with_period_fixed).collect::<Option<Vec<Row>>>()?;
        rows.extend((1..events).map(|event| (vec![(0, 1), (event, -1)], 0)));
        (point, denominator) = least_of_first(events, &rows, PIVOTS)?;
        // Both the period and the times in parts of the same size.
        point[PERIOD] = period * denominator;
        point[1..].iter_mut().for_each(|time| *time *= i128::from(parts));
        denominator *= i128::from(parts);
    }
    let divisor = point.iter().fold(denominator, |divisor, &value| greatest_common_divisor(divisor, value));
    let value = |variable: usize| u32::try_from(point[variable] / divisor).ok();
    let fire = [0, 1].map(|phase| merged.of_sensor.iter().map(|&one| value(event(one, phase))).collect());
    let [Some(a), Some(b)] = fire else { return None };
    let denominator = u32::try_from(denominator / divisor).ok()?;
    Some(OverReals { denominator, period: value(PERIOD)?, fire: [a, b], proven: false, certificate: None })
}

fn greatest_common_divisor(mut a: i128, mut b: i128) -> i128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.abs()
}

/// The variable that is the period; the others are the events of a node.
const PERIOD: usize = 0;

/// All that is required with these orders, as rows of a linear program.
fn rows(merged: &Merged, orders: &Orders) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for &(x, y) in &merged.pairs {
        for phase in 0..2 {
            let firing = &orders.firing[phase];
            // At the same instant the one after which no time need pass is first.
            let key = |first: usize, second: usize| (firing[first], merged.gap[first][second]);
            let (first, second) = if key(x, y) <= key(y, x) { (x, y) } else { (y, x) };
            let gap = merged.gap[first][second];
            rows.push((vec![(event(second, phase), 1), (event(first, phase), -1)], gap));
            for (x, y) in [(x, y), (y, x)] {
                let later = (event(y, 1 - phase), 1);
                rows.push((vec![later, (PERIOD, 1), (event(x, phase), -1)], merged.gap[x][y]));
            }
        }
    }
    // |d_x|, once or -1 times.
    let size = |x: usize, times: i32| {
        let times = if orders.negative[x] { -times } else { times };
        [(event(x, 0), times), (event(x, 1), -times)]
    };
    let mut smaller: Option<usize> = None;
    for &x in &orders.ranks {
        let least = if merged.stale_echo { merged.separation[x] } else { 0 };
        rows.push((size(x, 2).to_vec(), least));
        if let Some(smaller) = smaller {
            let apart = merged.separation[x].max(merged.separation[smaller]);
            rows.push(([size(x, 1), size(smaller, -1)].concat(), apart));
        }
        smaller = Some(x);
        let mut window = size(x, -1).to_vec();
        window.push((PERIOD, 1));
        rows.push((window, merged.window[x]));
        rows.extend([0, 1].map(|phase| (vec![(PERIOD, 1), (event(x, phase), -1)], 0)));
    }
    rows
}
