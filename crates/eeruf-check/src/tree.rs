//! Replays a tree of branchings: each node propagates, and a node that is not refuted must branch.

use crate::bounds::{Bound, Refuted};
use crate::error::CheckError;
use crate::problem::Merged;
use crate::rules::propagate;
use crate::state::{State, step};
use crate::text::{Lines, quoted};

/// A case distinction: one of its cases holds in every schedule. Sensors are those of the merged problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branching {
    /// In this phase x fires before y, or after it.
    Order(usize, usize, usize),
    /// `d_x` is 0 or positive, or it is negative.
    Sign(usize),
    /// `|d_x|` is smaller than `|d_y|`, or larger.
    Rank(usize, usize),
    /// `|d_x|` is at most this many ticks, or more.
    Split(usize, u32),
}

/// The deepest tree.
pub(crate) const MAX_DEPTH: usize = 1000;

impl Branching {
    /// Assumes the case of this number and propagates.
    pub(crate) fn assume(&self, case: usize, state: &mut State, merged: &Merged) -> Result<(), Refuted> {
        match *self {
            Self::Order(phase, x, y) => {
                let (x, y) = if case == 0 { (x, y) } else { (y, x) };
                state.learn_order(merged, x, y, phase)?;
            }
            Self::Sign(x) => {
                let bound = if case == 0 { 0 } else { -step(merged) };
                state.learn_most(x, case == 0, bound)?;
            }
            Self::Rank(x, y) => {
                let (x, y) = if case == 0 { (x, y) } else { (y, x) };
                state.learn_below(x, y);
            }
            Self::Split(x, at) => {
                let at = 2 * at as Bound;
                if case == 0 {
                    state.learn_high(x, at)?;
                } else {
                    state.learn_low(x, at + step(merged))?;
                }
            }
        }
        propagate(state, merged)
    }

    /// Returns true if it is known which case holds.
    pub(crate) fn is_decided(&self, state: &State, merged: &Merged) -> bool {
        match *self {
            Self::Order(phase, x, y) => state.is_ordered(merged, x, y, phase) || state.is_ordered(merged, y, x, phase),
            Self::Sign(x) => state.most(x, true) <= 0 || state.most(x, false) < 0,
            Self::Rank(x, y) => state.is_below(x, y) || state.is_below(y, x),
            Self::Split(x, at) => {
                let at = 2 * at as Bound;
                state.high(x) <= at || state.low[x] > at
            }
        }
    }
}

/// Replays the tree below the root's state. Returns the number of nodes, leaves included.
pub(crate) fn replay(
    lines: &mut Lines<'_>,
    root: Result<State, Refuted>,
    merged: &Merged,
) -> Result<usize, CheckError> {
    let mut nodes = 1;
    // The open nodes: state, branching, the next case.
    let mut open: Vec<(State, Branching, usize)> = Vec::new();
    let mut reached = root;
    loop {
        if let Ok(state) = reached {
            if open.len() == MAX_DEPTH {
                return Err(lines.error(format!("the tree is deeper than {MAX_DEPTH}")));
            }
            let branching = read(lines, merged)?;
            if branching.is_decided(&state, merged) {
                return Err(lines.error("here it is known which case holds, expected an open branching"));
            }
            open.push((state, branching, 0));
        }
        let Some((mut state, branching, case)) = open.pop() else {
            return Ok(nodes);
        };
        if case == 0 {
            let next = (state.clone(), branching, 1);
            open.push(next);
        }
        nodes += 1;
        reached = branching.assume(case, &mut state, merged).map(|()| state);
    }
}

/// Reads a branching.
fn read(lines: &mut Lines<'_>, merged: &Merged) -> Result<Branching, CheckError> {
    let (word, numbers) = lines.next()?;
    let count = match word {
        "a" | "b" | "rank" | "split" => 2,
        "sign" => 1,
        _ => return Err(lines.error(format!("found {}, expected a branching: this node is not refuted", quoted(word)))),
    };
    lines.expect(&numbers, count, 0, u32::MAX)?;
    let sensors = if word == "split" { &numbers[..1] } else { &numbers[..] };
    lines.expect(sensors, sensors.len(), 0, merged.of_sensor.len() as u32 - 1)?;
    let ones: Vec<usize> = sensors.iter().map(|&sensor| merged.of_sensor[sensor as usize]).collect();
    if ones.len() == 2 && ones[0] == ones[1] {
        return Err(lines.error("expected two sensors that do not fire together"));
    }
    Ok(match word {
        "a" | "b" => {
            if merged.gap[ones[0]][ones[1]] == 0 {
                return Err(lines.error(format!("sensors {} and {} have no gap", numbers[0], numbers[1])));
            }
            Branching::Order(usize::from(word == "b"), ones[0], ones[1])
        }
        "rank" => Branching::Rank(ones[0], ones[1]),
        "sign" => Branching::Sign(ones[0]),
        _ => Branching::Split(ones[0], numbers[1]),
    })
}
