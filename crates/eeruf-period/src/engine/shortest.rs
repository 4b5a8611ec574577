//! The shortest period of a problem, even or uneven: found by bisection with short descents, and proven by a full
//! search of the period one tick shorter.

use crate::engine::construct::{Times, constructed};
use crate::engine::counting::least_period;
use crate::engine::problem::Problem;
use crate::engine::repair::Repair;
use crate::engine::search::{Decided, FiringTimes, Search};

/// The shortest period found, in ticks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shortest {
    /// The period.
    pub period: u32,
    /// Firing times with this period.
    pub fire: FiringTimes,
    /// Proven bound of the period; equal to the period if that is shortest.
    pub bound: u32,
    /// Nodes visited.
    pub nodes: u64,
    /// True if every shorter period is refuted without branching.
    pub without_cases: bool,
}

/// The progress of a search: nodes, the shortest period so far, and the bound below which there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoFar {
    /// Nodes visited.
    pub nodes: u64,
    /// The shortest period found so far.
    pub best: u32,
    /// Proven bound of the period.
    pub bound: u32,
}

/// The shortest period found within `budget` nodes while `go_on`, called every few milliseconds, returns true.
///
/// Firing one by one is always a schedule, unless sensors that fire together must keep a gap or the period exceeds
/// [`MAX_TICKS`] ticks; then the result is `None`. The answer depends on problem and budget alone.
#[must_use]
pub fn shortest(problem: &Problem, budget: u64, go_on: &mut dyn FnMut(&SoFar) -> bool) -> Option<Shortest> {
    let mut run = Run::new(problem, true)?;
    run.limit = budget;
    // The result counts even if the search was stopped.
    _ = run.search(go_on);
    let nodes = run.nodes();
    Some(Shortest { nodes, without_cases: run.found.period == run.bound_of_rules, ..run.found })
}

/// The longest period that is searched, in ticks: sums of a few such times fit into a bound. A certificate takes at
/// most [`MAX_NUMBER`](crate::engine::MAX_NUMBER).
pub const MAX_TICKS: u32 = 1 << 24;
/// Number of nodes per sensor in the first round.
const EFFORT: u64 = 16;
/// Number of rounds that start at the bound while nothing is found.
const GALLOPS: u32 = 2;
/// Number of efforts spent on repairs at one period.
const REPAIRS: u64 = 4;

/// The search for one problem.
struct Run {
    search: Search,
    found: Shortest,
    /// Number of nodes at which the search ends.
    limit: u64,
    /// True if the schedule came from a search, so that it is worth following.
    is_guide: bool,
    /// Rounds that started at the bound.
    gallops: u32,
    /// The problem in coarser ticks, and the length of those ticks.
    coarse: Option<(Box<Run>, u32)>,
    /// An even ring whose requirements are no stricter.
    even: Option<Box<Run>>,
    /// True if schedules are also looked for by repairs.
    is_mixed: bool,
    /// The problem with limits raised to the common ones; its schedules serve too.
    raised: Option<Box<Run>>,
    /// Number of nodes of finished searches.
    ended: u64,
    /// The bound that follows without branching.
    bound_of_rules: u32,
}

/// The error of a search that the caller stopped.
struct Stopped;

/// The caller's function that decides whether to go on, given the nodes so far and the best result.
type Ask<'a> = &'a mut dyn FnMut(u64, &Shortest) -> bool;

impl Run {
    /// A run that begins with a constructed schedule and the bounds from counting and the rules. `None` if sensors that
    /// fire together must keep a gap, or if numbers are too large.
    fn new(problem: &Problem, is_first: bool) -> Option<Self> {
        if problem.numbers().any(|number| number > MAX_TICKS) {
            return None;
        }
        let search = Search::new(problem);
        let fire = constructed_times(problem)?;
        let period = period_of(problem, &fire);
        if period > MAX_TICKS || !problem.is_kept_by(period, &fire) {
            return None;
        }
        let bound = least_period(search.merged()).clamp(1, period);
        let found = Shortest { period, fire, bound, nodes: 0, without_cases: false };
        let (limit, is_guide, ended) = (u64::MAX, false, 0);
        let mut run = Self {
            search,
            found,
            limit,
            is_guide,
            gallops: 0,
            coarse: None,
            even: None,
            is_mixed: is_first && problem.is_mixed(),
            raised: None,
            ended,
            bound_of_rules: bound,
        };
        run.bound_by_rules();
        if run.is_open() {
            let even = if is_first && !run.is_mixed { problem.evened() } else { None };
            run.even = even.and_then(|even| Self::new(&even, false)).map(Box::new);
            let raised = if is_first { problem.raised() } else { None };
            run.raised = raised.and_then(|raised| Self::new(&raised, false)).map(Box::new);
            let coarse = in_coarse_ticks(problem);
            run.coarse = coarse.and_then(|(coarse, ticks)| Some((Box::new(Self::new(&coarse, is_first)?), ticks)));
        }
        Some(run)
    }

    /// Finds and proves the shortest period in rounds of growing effort, as far as budget and caller allow.
    fn search(&mut self, go_on: &mut dyn FnMut(&SoFar) -> bool) -> Result<(), Stopped> {
        let mut ask = |nodes: u64, found: &Shortest| go_on(&SoFar { nodes, best: found.period, bound: found.bound });
        let mut effort = EFFORT * self.sensors();
        // A bound between two coarse ticks may be met, and then coarse ticks cannot meet it.
        if let Some((_, ticks)) = &self.coarse
            && !self.found.bound.is_multiple_of(*ticks)
        {
            self.finds(self.found.bound, 4 * effort, &mut ask)?;
        }
        while self.is_open() {
            let in_coarse_ticks = self.coarse.is_some();
            self.round(effort, &mut ask)?;
            effort *= 2;
            if in_coarse_ticks && self.coarse.is_none() {
                // A period that is a fine tick shorter is left, and no easier to refute.
                effort = (EFFORT * self.sensors()).max(self.ended / 4);
            }
        }
        Ok(())
    }

    /// One round: the open part of the coarse problem and of the even ring, then the problem itself.
    fn round(&mut self, effort: u64, ask: Ask<'_>) -> Result<(), Stopped> {
        // If only few limits differ, the helper searches find the schedules.
        if self.is_mixed {
            self.repair(REPAIRS * effort, ask)?;
        }
        if let Some((mut coarse, ticks)) = self.coarse.take() {
            let before = self.nodes();
            // At most half of all nodes go into this.
            coarse.limit = (self.limit / 2).saturating_sub(before);
            let found = self.found.clone();
            let best = coarse.found.period;
            let round = coarse.round(effort, &mut |nodes, _| ask(before + nodes, &found));
            // A schedule in coarse ticks serves in fine ones too, which gain little or nothing.
            if coarse.found.period < best {
                let times = |times: &Vec<u32>| times.iter().map(|time| time * ticks).collect();
                self.offer(coarse.found.fire.each_ref().map(times), coarse.is_guide);
            }
            if coarse.is_open() {
                self.coarse = Some((coarse, ticks));
            } else {
                self.ended += coarse.nodes();
            }
            return round;
        }
        if let Some(mut even) = self.even.take() {
            let before = self.nodes();
            even.limit = self.limit.saturating_sub(before) / 2;
            let found = self.found.clone();
            let best = even.found.period;
            let round = even.round(effort, &mut |nodes, _| ask(before + nodes, &found));
            self.found.bound = self.found.bound.max(even.found.bound.min(self.found.period));
            if even.found.period < best {
                for image in images(self.search.problem(), &even.found.fire) {
                    self.offer(image, true);
                }
            }
            // Periods that the even ring has are not refuted by it.
            if even.is_open() && even.found.period > self.found.bound {
                self.even = Some(even);
            } else {
                self.ended += even.nodes();
            }
            round?;
        }
        if let Some(mut raised) = self.raised.take_if(|raised| raised.nodes() <= self.search.nodes()) {
            let before = self.nodes();
            raised.limit = self.limit.saturating_sub(before) / 2;
            let (found, best) = (self.found.clone(), raised.found.period);
            let round = raised.round(effort, &mut |nodes, _| ask(before + nodes, &found));
            if raised.found.period < best {
                self.offer(raised.found.fire.clone(), true);
            }
            if raised.is_open() {
                self.raised = Some(raised);
            } else {
                self.ended += raised.nodes();
            }
            round?;
        }
        if self.is_guide || self.gallops == GALLOPS {
            return self.bisect(effort, ask);
        }
        self.gallops += 1;
        self.gallop(effort, ask)
    }

    /// Shortens the best schedule by repairs, in steps that are halved when they find nothing.
    fn repair(&mut self, effort: u64, ask: Ask<'_>) -> Result<(), Stopped> {
        let mut step = ((self.found.period - self.found.bound) / 8).max(1);
        while step > 0 && self.is_open() {
            let (before, effort) = (self.nodes() - self.search.nodes(), self.affordable(effort));
            let Self { search, found, .. } = self;
            let mut repair = Repair::new(search.merged(), found.period - step, &found.fire, search.nodes());
            match search.repair(&mut repair, effort, &mut |nodes| ask(before + nodes, found)) {
                Decided::Found(fire) => self.offer(fire, true),
                Decided::Stopped => return Err(Stopped),
                Decided::Refuted | Decided::Open => step /= 2,
            }
            step = step.min(self.found.period - self.found.bound);
        }
        Ok(())
    }

    /// Accepts these times if they serve at a shorter period.
    fn offer(&mut self, fire: FiringTimes, is_guide: bool) {
        let period = period_of(self.search.problem(), &fire);
        if period < self.found.period || is_guide && !self.is_guide && period == self.found.period {
            self.improve(fire);
            self.is_guide = is_guide;
        }
    }

    /// The nodes of this search and of its helper searches.
    fn nodes(&self) -> u64 {
        let coarse = self.coarse.as_ref().map_or(0, |(coarse, _)| coarse.nodes());
        self.ended
            + self.search.nodes()
            + coarse
            + self.raised.as_ref().map_or(0, |raised| raised.nodes())
            + self.even.as_ref().map_or(0, |even| even.nodes())
    }

    fn sensors(&self) -> u64 {
        self.search.merged().count() as u64
    }

    fn is_open(&self) -> bool {
        self.found.bound < self.found.period && self.nodes() < self.limit
    }

    /// Starts at the bound, which is often attained, and goes up in growing steps until a schedule is found: an
    /// exponential search.
    fn gallop(&mut self, effort: u64, ask: Ask<'_>) -> Result<(), Stopped> {
        let mut step = ((self.found.period - self.found.bound + 1) >> 8).max(1);
        let mut period = self.found.bound;
        for effort in [4 * effort, effort, effort, effort, effort, effort] {
            if period >= self.found.period || !self.is_open() || self.finds(period, effort, ask)? {
                return Ok(());
            }
            period = period.max(self.found.bound - 1) + step;
            step *= 2;
        }
        if self.is_open() { self.decide(self.found.period - 1, effort, ask).map(drop) } else { Ok(()) }
    }

    /// Tries to refute the period just below the best, which would prove the best, and to find a better one by
    /// bisection.
    fn bisect(&mut self, effort: u64, ask: Ask<'_>) -> Result<(), Stopped> {
        let far = |found: &Shortest| found.period - found.bound > found.period / 32;
        while self.is_open() && far(&self.found) && self.finds(self.found.period - 1, 4 * effort, ask)? {}
        if !self.is_open() {
            return Ok(());
        }
        let shorter = self.found.period - 1;
        if !self.decide(shorter, 16 * effort, ask)? {
            self.decide_in_time(shorter, 16 * effort, ask)?;
        }
        // The shortest period leaves the least to guess, so it comes first; then bisection.
        let (mut unknown, mut period) = (self.found.bound - 1, self.found.bound);
        while unknown + 1 < self.found.period && self.is_open() {
            if !self.finds(period, effort, ask)? {
                unknown = period;
            }
            period = unknown + (self.found.period - unknown) / 2;
        }
        Ok(())
    }

    /// The highest bound that follows without branching: by bisection, since longer periods are no harder.
    fn bound_by_rules(&mut self) {
        let (mut open, mut middle) = (self.found.period, self.found.bound);
        // Usually counting has already given this bound.
        while self.found.bound < open {
            if self.search.is_refuted(middle) {
                self.found.bound = middle + 1;
            } else {
                open = middle;
            }
            middle = self.found.bound + (open - self.found.bound) / 2;
        }
        self.bound_of_rules = self.found.bound;
    }

    /// Searches a period completely. Returns true if it is decided.
    fn decide(&mut self, period: u32, effort: u64, ask: Ask<'_>) -> Result<bool, Stopped> {
        let (before, effort) = (self.nodes() - self.search.nodes(), self.affordable(effort));
        let Self { search, found, .. } = self;
        let nodes = search.nodes();
        let decided = search.decide(period, effort, &mut |nodes| ask(before + nodes, found));
        if decided == Decided::Refuted && search.nodes() == nodes {
            self.bound_of_rules = self.bound_of_rules.max(period + 1);
        }
        self.take(period, decided)
    }

    /// Decides by branchings in the order of time, which refute more if density leaves little room.
    fn decide_in_time(&mut self, period: u32, effort: u64, ask: Ask<'_>) -> Result<bool, Stopped> {
        let (before, effort) = (self.nodes() - self.search.nodes(), self.affordable(effort));
        let Self { search, found, .. } = self;
        let decided = search.decide_in_time(period, effort, &mut |nodes| ask(before + nodes, found));
        self.take(period, decided)
    }

    /// Returns true if a short search finds a schedule with this period or a shorter one.
    fn finds(&mut self, period: u32, effort: u64, ask: Ask<'_>) -> Result<bool, Stopped> {
        let (before, effort) = (self.nodes() - self.search.nodes(), self.affordable(effort));
        let Self { search, found, .. } = self;
        let guide = self.is_guide.then_some(&found.fire);
        let decided = search.find(period, effort, effort << 20, guide, &mut |nodes| ask(before + nodes, found));
        // Once a schedule is worth following, only the bound is worth raising: refuting longer periods costs more.
        let is_worth_it = period == self.found.bound;
        if !self.take(period, decided)? && self.is_open() && is_worth_it {
            self.decide(period, effort, ask)?;
        }
        Ok(self.found.period <= period)
    }

    fn affordable(&self, effort: u64) -> u64 {
        effort.min(self.limit.saturating_sub(self.nodes()))
    }

    /// Records the outcome for a period. Returns true if it is decided.
    fn take(&mut self, period: u32, decided: Decided) -> Result<bool, Stopped> {
        match decided {
            Decided::Found(fire) => {
                self.improve(fire);
                self.is_guide = true;
            }
            Decided::Refuted => self.found.bound = self.found.bound.max(period + 1),
            Decided::Open => return Ok(false),
            Decided::Stopped => return Err(Stopped),
        }
        Ok(true)
    }

    /// Records these times, with the shortest period at which they are a valid schedule.
    fn improve(&mut self, fire: FiringTimes) {
        self.found.period = period_of(self.search.problem(), &fire).max(self.found.bound);
        self.found.fire = fire;
    }
}

/// The images of these times under turning, reflecting and exchanging the phases, the identity first: if sensors
/// differ, some serve at a shorter period.
fn images(problem: &Problem, [a, b]: &FiringTimes) -> Vec<FiringTimes> {
    let sensors = problem.sensors();
    let turned = (0..sensors).map(|by| (0..sensors).map(|x| (x + by) % sensors).collect::<Vec<_>>());
    let reflected = (0..sensors).map(|about| (0..sensors).map(|x| (about + sensors - x) % sensors).collect());
    let images = turned.chain(reflected).map(|image| [a, b].map(|times| image.iter().map(|&x| times[x]).collect()));
    let images = images.flat_map(|[a, b]: FiringTimes| [[a.clone(), b.clone()], [b, a]]);
    images.filter(|fire| problem.is_kept_by(period_of(problem, fire), fire)).collect()
}

/// The constructed schedule. `None` if sensors that fire together must keep a gap.
fn constructed_times(problem: &Problem) -> Option<FiringTimes> {
    let merged = problem.merged();
    if problem.gaps.iter().any(|&(x, y, ..)| merged.of_sensor[x] == merged.of_sensor[y]) {
        return None;
    }
    let of = |times: &Times| {
        [0, 1].map(|phase: usize| merged.of_sensor.iter().map(|&one| times[one][phase] as u32).collect())
    };
    Some(of(&constructed(&merged, |times| period_of(problem, &of(times)))))
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

/// The problem in coarser ticks, and their length in fine ticks, if all its times are multiples of that.
fn in_coarse_ticks(problem: &Problem) -> Option<(Problem, u32)> {
    let divisor = |a: u32, b: u32| {
        let (mut a, mut b) = (a, b);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let ticks = problem.numbers().fold(0, divisor);
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
