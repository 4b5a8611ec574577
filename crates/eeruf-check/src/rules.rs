//! Consequences of what is known: rules 2 to 6 of docs/reference/certificate.md, where each has its proof. Rule 1, the
//! closure of bounds, is in `bounds`.
//!
//! Each rule only ever tightens, and more the tighter its premises are. So all orders of applying them end in the same
//! state, and a checker may take whichever order is fastest.

use crate::bounds::{Bound, Refuted, sum};
use crate::problem::Merged;
use crate::state::{State, event};

/// Applies all rules until none tells anything new.
pub(crate) fn propagate(state: &mut State, merged: &Merged) -> Result<(), Refuted> {
    loop {
        // The cheap rules first: most refutations need no other.
        let cheap = orders(state, merged)? | signs(state)? | ranks(state, merged)?;
        spacing(state, merged)?;
        if !cheap && !precedence(state, merged)? {
            return Ok(());
        }
    }
}

/// Rule 2: if y cannot come `gap` after x, then x comes after y.
fn orders(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let mut news = false;
    for &(x, y) in &merged.pairs {
        for phase in 0..2 {
            for (x, y) in [(x, y), (y, x)] {
                if state.bounds.at(event(x, phase), event(y, phase)) < 2 * merged.gap[x][y] {
                    news |= state.learn_order(merged, y, x, phase)?;
                }
            }
        }
    }
    if let Some((x, y)) = state.reverse {
        for phase in 0..2 {
            if state.is_ordered(merged, y, x, phase) {
                news |= state.learn_order(merged, x, y, 1 - phase)?;
            }
        }
    }
    Ok(news)
}

/// Rule 3: bounds on d bound |d|, and a d that cannot be as large as |d| is negative.
fn signs(state: &mut State) -> Result<bool, Refuted> {
    let mut news = false;
    for x in 0..state.low.len() {
        for negative in [false, true] {
            let most = state.most(x, negative);
            // The other sign has at least this value.
            news |= state.learn_low(x, -most)?;
            let low = state.low[x];
            if most < low {
                news |= state.learn_most(x, negative, -low)?;
            }
        }
    }
    Ok(news)
}

/// Rule 4: the order of |d|, and what it says of their bounds.
fn ranks(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let count = merged.count();
    let mut news = false;
    let high: Vec<Bound> = (0..count).map(|x| state.high(x)).collect();
    for y in 0..count {
        for x in 0..count {
            if x != y && high[x] < state.low[y] + merged.apart(x, y) {
                news |= state.learn_below(x, y);
            }
            if state.is_below(x, y) {
                let further = state.below[x] & !state.below[y];
                state.below[y] |= further;
                news |= further != 0;
            }
        }
        if state.is_below(y, y) {
            return Err(Refuted);
        }
    }
    let mut above = vec![0_u64; count];
    for y in 0..count {
        members(state.below[y]).for_each(|x| above[x] |= 1 << y);
    }
    let mut values = Vec::with_capacity(count);
    for y in 0..count {
        values.clear();
        values.extend(members(state.below[y]).map(|x| (-state.low[x], merged.separation[x])));
        if let Some(bound) = beyond(&mut values, merged.separation[y]) {
            news |= state.learn_low(y, -bound)?;
        }
        values.clear();
        values.extend(members(above[y]).map(|x| (high[x], merged.separation[x])));
        if let Some(bound) = beyond(&mut values, merged.separation[y]) {
            news |= state.learn_high(y, bound)?;
        }
    }
    Ok(news)
}

/// The numbers in a set of bits, in ascending order.
fn members(mut set: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let least = set.trailing_zeros() as usize;
        set &= set.wrapping_sub(1);
        (least < 64).then_some(least)
    })
}

/// A bound on what lies below all `values`, each a value's upper bound and its separation: below any set of them by the
/// width that the set needs, together with a value of separation `own`.
fn beyond(values: &mut [(Bound, i32)], own: i32) -> Option<Bound> {
    values.sort_unstable();
    let (mut width, mut narrowest) = (own, own);
    let mut least: Option<Bound> = None;
    for &(bound, separation) in values.iter() {
        width += separation;
        narrowest = narrowest.min(separation);
        let bound = bound - 2 * (width - narrowest);
        least = Some(least.map_or(bound, |least| least.min(bound)));
    }
    least
}

/// Rule 5, Hall's condition: those whose |d| lies within an interval must have room there.
fn spacing(state: &State, merged: &Merged) -> Result<(), Refuted> {
    let count = merged.count();
    let mut values: Vec<(Bound, Bound, i32)> =
        (0..count).map(|x| (state.high(x), state.low[x], merged.separation[x])).collect();
    values.sort_unstable();
    for first in 0..count {
        let start = values[first].1;
        if values[..first].iter().any(|&(_, low, _)| low == start) {
            continue;
        }
        let (mut width, mut narrowest) = (0, i32::MAX);
        for &(high, low, separation) in &values {
            if low >= start {
                width += separation;
                narrowest = narrowest.min(separation);
                if start + 2 * (width - narrowest) > high {
                    return Err(Refuted);
                }
            }
        }
    }
    Ok(())
}

/// The events whose difference, second less first, is `d_x`, or `-d_x` if `negative`.
fn ends(x: usize, negative: bool) -> (usize, usize) {
    (event(x, usize::from(!negative)), event(x, usize::from(negative)))
}

/// Rule 6: those whose d is below `d_y` by what their firing orders force are apart among themselves, so `d_y` is as
/// far behind the last of them.
fn precedence(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let count = merged.count();
    let mut news = false;
    let mut leaders: Vec<(Bound, Bound, i32)> = Vec::with_capacity(count);
    for y in 0..count {
        for negative in [false, true] {
            let (y0, y1) = ends(y, negative);
            leaders.clear();
            for &x in &merged.neighbours[y] {
                let (x0, x1) = ends(x, negative);
                // The upper bound on x - y from the orders of the two, and on -x.
                let lead = sum(state.bounds.at(y1, x1), state.bounds.at(x0, y0));
                if lead < 0 {
                    leaders.push((state.bounds.at(x1, x0), lead, merged.separation[x]));
                }
            }
            leaders.sort_unstable();
            let mut best = Bound::MAX;
            for &(_, threshold, _) in &leaders {
                let (mut width, mut narrowest) = (0, i32::MAX);
                for &(most, lead, separation) in &leaders {
                    if lead <= threshold {
                        width += separation;
                        narrowest = narrowest.min(separation);
                        best = best.min(sum(most, threshold) - 2 * (width - narrowest));
                    }
                }
            }
            news |= state.bounds.learn(y1, y0, best)?;
        }
    }
    Ok(news)
}
