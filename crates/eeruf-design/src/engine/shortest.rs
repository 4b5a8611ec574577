//! The shortest period of a problem, even or uneven: found by bisection with short descents, and proven by a full
//! search of the period one tick shorter.

use crate::engine::problem::Problem;
use crate::engine::search::{Decided, FiringTimes, Search};

/// The shortest period found, in ticks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shortest {
    /// The period.
    pub period: u32,
    /// Firing times with this period.
    pub fire: FiringTimes,
    /// No schedule has a shorter period than this; equal to the period where that is proven.
    pub bound: u32,
    /// Nodes visited.
    pub nodes: u64,
    /// True if every shorter period is refuted without distinguishing cases.
    pub without_cases: bool,
}

/// The progress of a search: nodes, the shortest period so far, and the bound below which there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoFar {
    /// Nodes visited.
    pub nodes: u64,
    /// The shortest period found so far.
    pub best: u32,
    /// No period is below this.
    pub bound: u32,
}

/// The shortest period, within `budget` nodes and as long as `go_on` says so: it is asked every few milliseconds.
///
/// There is always a schedule, firing one by one, unless sensors that fire together must keep a gap or the period is
/// beyond [`MAX_NUMBER`](crate::engine::MAX_NUMBER) ticks: then `None`. The answer depends on problem and budget alone.
#[must_use]
pub fn shortest(problem: &Problem, budget: u64, go_on: &mut dyn FnMut(&SoFar) -> bool) -> Option<Shortest> {
    let fire = one_by_one(problem)?;
    let mut found = Shortest { period: period_of(problem, &fire), fire, bound: 1, nodes: 0, without_cases: false };
    if found.period > crate::engine::MAX_NUMBER || !crate::engine::schedule::keeps(problem, found.period, &found.fire) {
        return None;
    }
    if let Some((coarse, ticks)) = in_coarse_ticks(problem) {
        // What coarse ticks find serves in fine ones too. Where fine ones gain anything it is little.
        let fire = one_by_one(&coarse)?;
        let start = Shortest { period: period_of(&coarse, &fire), fire, ..found };
        let mut run = Run { search: Search::new(&coarse), problem: &coarse, found: start, budget: budget / 2 };
        run.search(&mut |so_far| go_on(&SoFar { nodes: so_far.nodes, best: so_far.best * ticks, bound: 1 }));
        let nodes = run.found.nodes;
        let fire: FiringTimes = run.found.fire.map(|times| times.into_iter().map(|time| time * ticks).collect());
        found = Shortest { period: period_of(problem, &fire), fire, bound: 1, nodes, without_cases: false };
    }
    let nodes = found.nodes;
    let mut run = Run { search: Search::new(problem), problem, found, budget: budget.saturating_sub(nodes) };
    run.search(&mut |so_far| go_on(&SoFar { nodes: nodes + so_far.nodes, ..*so_far }));
    run.found.nodes += nodes;
    Some(run.found)
}

/// The search for one problem.
struct Run<'p> {
    search: Search<'p>,
    problem: &'p Problem,
    found: Shortest,
    budget: u64,
}

impl Run<'_> {
    /// Bisects, then proves.
    fn search(&mut self, go_on: &mut dyn FnMut(&SoFar) -> bool) {
        self.found.bound = one_after_the_other(self.problem).clamp(1, self.found.period);
        self.bound_by_rules(go_on);
        let effort = 8 * self.search.depth();
        // Periods from here on have not been looked at in vain.
        let mut low = self.found.bound;
        while low < self.found.period && self.search.nodes() < self.budget {
            let middle = low + (self.found.period - low) / 2;
            match self.find(middle, effort, go_on) {
                Decided::Found(_) => {}
                Decided::Stopped => return self.end(),
                Decided::Open | Decided::Refuted => low = middle + 1,
            }
        }
        let mut effort = effort;
        while self.found.bound < self.found.period && self.search.nodes() < self.budget {
            effort *= 2;
            let left = self.budget - self.search.nodes();
            match self.decide(self.found.period - 1, effort.min(left), go_on) {
                Decided::Refuted => self.found.bound = self.found.period,
                Decided::Found(fire) => self.improve(fire),
                Decided::Stopped => return self.end(),
                Decided::Open => {}
            }
            // Ever shorter periods, as long as that succeeds.
            let mut step = 1;
            while self.found.bound < self.found.period {
                let shorter = self.found.period.saturating_sub(step).max(self.found.bound);
                match self.find(shorter, effort / 2, go_on) {
                    Decided::Found(_) => step *= 2,
                    Decided::Refuted => {
                        self.found.bound = shorter + 1;
                        break;
                    }
                    Decided::Open => break,
                    Decided::Stopped => return self.end(),
                }
            }
        }
        self.end();
    }

    fn end(&mut self) {
        self.found.nodes = self.search.nodes();
    }

    /// The highest bound that follows without distinguishing cases: longer periods are no harder, so by bisection.
    fn bound_by_rules(&mut self, go_on: &mut dyn FnMut(&SoFar) -> bool) {
        let mut open = self.found.period;
        while self.found.bound < open {
            let middle = self.found.bound + (open - self.found.bound) / 2;
            match self.decide(middle, 1, go_on) {
                Decided::Refuted => self.found.bound = middle + 1,
                _ => open = middle,
            }
        }
        self.found.without_cases = self.found.bound == self.found.period;
    }

    fn decide(&mut self, period: u32, budget: u64, go_on: &mut dyn FnMut(&SoFar) -> bool) -> Decided {
        let (best, bound) = (self.found.period, self.found.bound);
        self.search.decide(period, budget, &mut |nodes| go_on(&SoFar { nodes, best, bound }))
    }

    fn find(&mut self, period: u32, budget: u64, go_on: &mut dyn FnMut(&SoFar) -> bool) -> Decided {
        let (best, bound) = (self.found.period, self.found.bound);
        let (seed, guide) = (self.search.nodes(), self.found.fire.clone());
        let mut ask = |nodes: u64| go_on(&SoFar { nodes, best, bound });
        let decided = self.search.find(period, budget, seed, &guide, &mut ask);
        if let Decided::Found(fire) = &decided {
            self.improve(fire.clone());
        }
        decided
    }

    /// Takes the times at the shortest period at which they serve.
    fn improve(&mut self, fire: FiringTimes) {
        self.found.period = period_of(self.problem, &fire).max(self.found.bound);
        self.found.fire = fire;
        self.found.without_cases = self.found.bound == self.found.period;
    }
}

/// Firing one by one, sensors that fire together as one: `b` a largest gap after the other, `a` as far again behind as
/// the separation asks for. `None` if sensors that fire together must keep a gap.
fn one_by_one(problem: &Problem) -> Option<FiringTimes> {
    let merged = problem.merged();
    if problem.gaps.iter().any(|&(x, y, ..)| merged.of_sensor[x] == merged.of_sensor[y]) {
        return None;
    }
    let gap = merged.gap.iter().flatten().copied().max().unwrap_or(0) as u32;
    let separation = merged.separation.iter().copied().max().unwrap_or(0) as u32;
    let least = if problem.stale_echo { separation.div_ceil(2) } else { 0 };
    let b = |one: usize| one as u32 * gap;
    let a = |one: usize| b(one) + least + one as u32 * separation;
    let of = |time: &dyn Fn(usize) -> u32| merged.of_sensor.iter().map(|&one| time(one)).collect();
    Some([of(&a), of(&b)])
}

/// The least period of sensors of which each has a gap to each other, the best of a few such sets.
///
/// In two periods each of them fires twice. After each firing of x the next one of the set comes no sooner than the
/// smallest gap after x, or, if it is x again, than its window. So two periods take at least twice the sum of these.
/// A tree would have to try all orders for it, so a certificate of it may be too long to be written.
fn one_after_the_other(problem: &Problem) -> u32 {
    let merged = problem.merged();
    let count = merged.count();
    let has_gaps = |x: usize, y: usize| merged.gap[x][y] > 0 && merged.gap[y][x] > 0;
    let from = |first: usize| {
        let mut set = vec![first];
        for y in (1..count).map(|step| (first + step) % count) {
            if set.iter().all(|&x| has_gaps(x, y)) {
                set.push(y);
            }
        }
        let least = |x: usize| {
            let gaps = set.iter().filter(|&&y| y != x).map(|&y| merged.gap[x][y]);
            gaps.fold(merged.window[x], i32::min) as u32
        };
        set.iter().map(|&x| least(x)).sum()
    };
    (0..count).map(from).max().unwrap_or(0)
}

/// The shortest period at which these very times serve.
fn period_of(problem: &Problem, [a, b]: &FiringTimes) -> u32 {
    let mut period = a.iter().chain(b).max().map_or(1, |latest| latest + 1);
    for (x, window) in problem.window.iter().enumerate() {
        period = period.max(window + a[x].abs_diff(b[x]));
    }
    for &(x, y, after_x, after_y) in &problem.gaps {
        for (x, y, gap) in [(x, y, after_x), (y, x, after_y)] {
            period = period.max((a[x] + gap).saturating_sub(b[y])).max((b[x] + gap).saturating_sub(a[y]));
        }
    }
    period
}

/// The problem in coarser ticks, and how many fine ones they are, if all its times are multiples of that.
fn in_coarse_ticks(problem: &Problem) -> Option<(Problem, u32)> {
    let divisor = |a: u32, b: u32| {
        let (mut a, mut b) = (a, b);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let gaps = problem.gaps.iter().flat_map(|&(.., after_x, after_y)| [after_x, after_y]);
    let times = problem.separation.iter().chain(&problem.window).copied().chain(gaps);
    let ticks = times.fold(0, divisor);
    if ticks < 2 {
        return None;
    }
    let coarse = |times: &[u32]| times.iter().map(|time| time / ticks).collect();
    let gaps = problem.gaps.iter().map(|&(x, y, after_x, after_y)| (x, y, after_x / ticks, after_y / ticks));
    let coarse = Problem {
        separation: coarse(&problem.separation),
        window: coarse(&problem.window),
        gaps: gaps.collect(),
        ..problem.clone()
    };
    Some((coarse, ticks))
}
