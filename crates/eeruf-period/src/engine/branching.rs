//! Case distinctions of the search and of a certificate's tree.

use crate::engine::bounds::{Bound, Refuted};
use crate::engine::problem::Merged;
use crate::engine::rules::propagate;
use crate::engine::state::State;
use crate::engine::turns::place;

/// A case distinction: one of its cases holds in every schedule. Sensors are those of the merged problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branching {
    /// Sensor x fires before y in this phase, or after it.
    Order(usize, usize, usize),
    /// `d_x >= 0`, or `d_x < 0`.
    Sign(usize),
    /// `|d_x|` is smaller than `|d_y|`, or larger.
    Rank(usize, usize),
    /// `|d_x|` is at most this many ticks, or it is more.
    Split(usize, u32),
    /// The next sensor to fire, among those that have not fired in this phase; case 0 is the first of these.
    Next,
}

impl Branching {
    /// Assumes a case by its number and propagates.
    pub(crate) fn assume(&self, case: usize, state: &mut State, merged: &Merged) -> Result<(), Refuted> {
        match *self {
            Self::Order(phase, x, y) => {
                let (x, y) = if case == 0 { (x, y) } else { (y, x) };
                state.learn_order(merged, x, y, phase)?;
            }
            Self::Sign(x) => {
                let bound = if case == 0 { 0 } else { -1 };
                state.learn_most(x, case == 0, bound)?;
            }
            Self::Rank(x, y) => {
                let (x, y) = if case == 0 { (x, y) } else { (y, x) };
                state.learn_below(x, y);
            }
            Self::Split(x, at) => {
                let at = at as Bound;
                if case == 0 {
                    state.learn_high(x, at)?;
                } else {
                    state.learn_low(x, at + 1)?;
                }
            }
            Self::Next => {
                let next = state.turns.as_ref().and_then(|turns| turns.left().nth(case)).ok_or(Refuted)?;
                place(state, next)?;
            }
        }
        propagate(state, merged)
    }

    /// The number of cases.
    pub(crate) fn cases(&self, state: &State) -> usize {
        match self {
            Self::Next => state.turns.as_ref().map_or(0, |turns| turns.left().count()),
            _ => 2,
        }
    }

    /// Returns true if it is known which case holds.
    pub(crate) fn is_decided(&self, state: &State, merged: &Merged) -> bool {
        match *self {
            Self::Order(phase, x, y) => state.is_ordered(merged, x, y, phase) || state.is_ordered(merged, y, x, phase),
            Self::Sign(x) => state.most(x, true) <= 0 || state.most(x, false) < 0,
            Self::Rank(x, y) => state.is_below(x, y) || state.is_below(y, x),
            Self::Split(x, at) => {
                let at = at as Bound;
                state.high(x) <= at || state.low[x] > at
            }
            Self::Next => self.cases(state) == 0,
        }
    }

    /// The line of a certificate, with sensors in place of those of the merged problem.
    pub(crate) fn line(&self, sensors: &[usize]) -> String {
        match *self {
            Self::Order(phase, x, y) => format!("{} {} {}\n", ["a", "b"][phase], sensors[x], sensors[y]),
            Self::Sign(x) => format!("sign {}\n", sensors[x]),
            Self::Rank(x, y) => format!("rank {} {}\n", sensors[x], sensors[y]),
            Self::Split(x, at) => format!("split {} {at}\n", sensors[x]),
            Self::Next => "next\n".to_owned(),
        }
    }
}

/// Chooses a branching, if anything is left: firing orders first, sensor by sensor in this sequence, all of phase a,
/// then all of phase b; then signs, ranks and values of d.
pub(crate) fn choose(state: &State, merged: &Merged, sequence: &[usize]) -> Option<Branching> {
    let count = merged.count();
    if !Branching::Next.is_decided(state, merged) {
        return Some(Branching::Next);
    }
    for (rank, &y) in sequence.iter().enumerate() {
        for (phase, &x) in (0..2).flat_map(|phase| sequence[..rank].iter().map(move |x| (phase, x))) {
            let (x, y) = (x.min(y), x.max(y));
            let order = Branching::Order(phase, x, y);
            if merged.gap[x][y] > 0 && !order.is_decided(state, merged) {
                return Some(order);
            }
        }
    }
    if let Some(x) = (0..count).find(|&x| !Branching::Sign(x).is_decided(state, merged)) {
        return Some(Branching::Sign(x));
    }
    let width = |x: usize| state.high(x) - state.low[x];
    let pairs = (0..count).flat_map(|y| (0..y).map(move |x| (x, y)));
    let open = pairs.filter(|&(x, y)| !Branching::Rank(x, y).is_decided(state, merged));
    if let Some((x, y)) = open.min_by_key(|&(x, y)| width(x) + width(y)) {
        return Some(Branching::Rank(x, y));
    }
    let widest = (0..count).max_by_key(|&x| width(x))?;
    let middle = Branching::Split(widest, ((state.low[widest] + state.high(widest)) / 2) as u32);
    (!middle.is_decided(state, merged)).then_some(middle)
}
