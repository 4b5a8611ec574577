//! Firings in the order of time: which sensor fires next, and the bounds that follow from its place.

use crate::engine::bounds::Refuted;
use crate::engine::counting::members;
use crate::engine::problem::Merged;
use crate::engine::sets::{Pace, cover, interval_of};
use crate::engine::state::{State, event};

/// A set of sensors, and the least time between their firings by the number of steps.
#[derive(Clone, Debug)]
struct Set {
    members: u64,
    least: Vec<i32>,
}

/// The sensors that fire first in each phase, in the order of time.
#[derive(Clone, Debug)]
pub(crate) struct Turns {
    sets: Vec<Set>,
    period: i32,
    count: usize,
    pub(crate) placed: Vec<usize>,
}

impl Turns {
    /// The state before any firing, for a schedule with this period.
    pub(crate) fn new(merged: &Merged, period: i32) -> Self {
        let count = merged.count();
        let (cliques, times) = cover(merged);
        let set = |members: u64, at_once: usize, interval: i32| {
            let interval = self::members(members).map(|x| merged.window[x]).fold(interval, i32::min);
            let pace = Pace::new(members.count_ones() as usize, at_once as i32, interval, period);
            Set { members, least: (0..=2 * members.count_ones() as i32).map(|steps| pace.least(steps)).collect() }
        };
        let intervals = || cliques.iter().filter_map(|&clique| interval_of(merged, clique));
        let all = cliques.iter().fold(0, |all, clique| all | clique);
        let mut sets: Vec<Set> =
            intervals().min().map(|least| set(all, cliques.len() / times, least)).into_iter().collect();
        let is_part = |clique: u64| cliques.iter().any(|&other| other != clique && other & clique == clique);
        let whole = cliques.iter().filter(|&&clique| clique != all && !is_part(clique));
        sets.extend(whole.filter_map(|&clique| Some(set(clique, 1, interval_of(merged, clique)?))));
        Self { sets, period, count, placed: Vec::new() }
    }

    /// The phase of the next firing. `None` if all sensors have fired twice.
    fn phase(&self) -> Option<usize> {
        (self.placed.len() < 2 * self.count).then_some(self.placed.len() / self.count)
    }

    /// Sensors that may fire next, in ascending order.
    pub(crate) fn left(&self) -> impl Iterator<Item = usize> + use<> {
        let begun = self.placed.len() / self.count * self.count;
        let fired = self.placed[begun..].iter().fold(0, |set, x| set | 1 << x);
        members(if self.phase().is_some() { u64::MAX >> (64 - self.count) & !fired } else { 0_u64 })
    }
}

/// Adds sensor x as the next to fire; of simultaneous firings, the lowest number counts as first.
pub(crate) fn place(state: &mut State, x: usize) -> Result<(), Refuted> {
    let State { turns: Some(turns), bounds, .. } = state else { return Ok(()) };
    let Some(phase) = turns.phase() else { return Ok(()) };
    let own = event(x, phase);
    for y in turns.left().filter(|&y| y != x) {
        bounds.learn(event(y, phase), own, if y < x { -1 } else { 0 })?;
    }
    for set in turns.sets.iter().filter(|set| set.members >> x & 1 == 1) {
        let size = set.members.count_ones() as usize;
        let of = |phase: usize| {
            let placed = turns.placed.iter().skip(phase * turns.count).take(turns.count);
            let placed = placed.filter(|y| set.members >> **y & 1 == 1);
            placed.enumerate().map(move |(place, &y)| (place + phase * size, event(y, phase)))
        };
        let place = of(phase).count();
        let (at, period) = (place + phase * size, turns.period);
        // The others of the set come before the end of the phase, and those of the phase before are past.
        bounds.learn(0, own, period - 1 - set.least[size - 1 - place])?;
        bounds.learn(own, 0, period - set.least[size + place])?;
        for (other, event) in of(0).chain(of(1)) {
            let (steps, since) = (at.abs_diff(other), if (at < size) == (other < size) { 0 } else { period });
            let (earlier, later) = if at < other { (own, event) } else { (event, own) };
            let most = 2 * period - set.least[2 * size - steps] - since;
            bounds.learn(later, earlier, since - set.least[steps])?;
            bounds.learn(earlier, later, most)?;
        }
    }
    turns.placed.push(x);
    Ok(())
}
