//! The schedule with most to spare among those of one period: larger separations, then larger gaps, then longer
//! windows, each increased by the same amount for all sensors.

use crate::engine::problem::Problem;
use crate::engine::search::{Decided, FiringTimes, Search};

/// A schedule that keeps more than the problem requires.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spare {
    /// The firing times.
    pub fire: FiringTimes,
    /// Ticks by which every separation, then every gap, then every window may grow; earlier ones have priority.
    pub more: [u32; 3],
    /// True if no schedule of this period has more to spare.
    pub proven: [bool; 3],
    /// Nodes visited.
    pub nodes: u64,
}

/// The problem with larger separations, gaps and windows.
fn harder(problem: &Problem, [separation, gap, window]: [u32; 3]) -> Problem {
    let more = |times: &[u32], by: u32| times.iter().map(|time| time + by).collect();
    let gaps = problem.gaps.iter().map(|&(x, y, after_x, after_y)| (x, y, after_x + gap, after_y + gap));
    Problem {
        separation: more(&problem.separation, separation),
        window: more(&problem.window, window),
        gaps: gaps.collect(),
        ..problem.clone()
    }
}

/// The schedule with the most slack among those with this period, beginning with a given one. It takes at most `budget`
/// nodes, a third for each need, and stops when `go_on`, called with the nodes so far, returns false.
#[must_use]
pub fn most_to_spare(
    problem: &Problem,
    period: u32,
    fire: FiringTimes,
    budget: u64,
    go_on: &mut dyn FnMut(u64) -> bool,
) -> Spare {
    let mut spare = Spare { fire, more: [0; 3], proven: [false; 3], nodes: 0 };
    for need in 0..3 {
        // Without gaps there is none to grow.
        let most = if need == 1 && problem.gaps.is_empty() { 0 } else { period };
        spare.proven[need] = grow(problem, period, &mut spare, need, most, budget / 3, go_on);
    }
    spare
}

/// Raises one need as far as possible, up to `most`. Returns true if it is proven that it can grow no further.
fn grow(
    problem: &Problem,
    period: u32,
    spare: &mut Spare,
    need: usize,
    most: u32,
    budget: u64,
    go_on: &mut dyn FnMut(u64) -> bool,
) -> bool {
    let with = |more: [u32; 3], need: usize, by: u32| {
        let mut more = more;
        more[need] += by;
        more
    };
    let mut left = budget;
    let mut step = 1;
    let mut effort = 8 * Search::new(problem).depth();
    loop {
        // The slack that these times have anyway.
        while spare.more[need] < most && harder(problem, with(spare.more, need, 1)).is_kept_by(period, &spare.fire) {
            spare.more[need] += 1;
        }
        let room = most - spare.more[need];
        if room == 0 {
            return true;
        }
        let by = step.min(room);
        let harder = harder(problem, with(spare.more, need, by));
        let mut search = Search::new(&harder);
        let before = spare.nodes;
        let mut ask = |nodes| go_on(before + nodes);
        // A full search for a step of one tick, since only that proves anything.
        let decided = if by == 1 {
            match search.find(period, (effort / 2).min(left), left, Some(&spare.fire), &mut ask) {
                Decided::Open => search.decide(period, effort.min(left), &mut ask),
                decided => decided,
            }
        } else {
            search.find(period, (effort / 2).min(left), left, Some(&spare.fire), &mut ask)
        };
        let nodes = search.nodes();
        spare.nodes += nodes;
        left = left.saturating_sub(nodes.max(1));
        match decided {
            Decided::Found(fire) => {
                spare.fire = fire;
                step *= 2;
            }
            Decided::Refuted if by == 1 => return true,
            Decided::Stopped => return false,
            Decided::Refuted | Decided::Open if by > 1 => step = 1,
            Decided::Refuted | Decided::Open => effort *= 2,
        }
        if left == 0 {
            return false;
        }
    }
}
