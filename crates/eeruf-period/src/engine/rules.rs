//! Propagation: rules 2 to 6 of docs/reference/certificate.md, where each has its proof. Rule 1, the closure of bounds,
//! is in `bounds`.
//!
//! Each rule only tightens bounds, and is monotone. So all orders of applying them end in the same state, and engine
//! and checker refute the same nodes of a certificate's tree.

use crate::engine::bounds::{Bound, Refuted};
use crate::engine::counting::members;
use crate::engine::problem::{MAX_SENSORS, Merged};
use crate::engine::state::{State, event, firing};

/// Applies all rules until none concludes anything new.
pub(crate) fn propagate(state: &mut State, merged: &Merged) -> Result<(), Refuted> {
    loop {
        // The cheap rules first: most refutations need no other.
        let mut news = orders(state, merged)? | signs(state)?;
        if !state.has_seen_sizes() {
            let of_sizes = ranks(state, merged)? | spacing(state, merged)?;
            if !of_sizes {
                state.see_sizes();
            }
            news |= of_sizes;
        }
        if !news {
            let version = state.bounds.version();
            if state.seen.precedence == version {
                return Ok(());
            }
            if state.goes_further && behind(state, merged)? {
                continue;
            }
            if !precedence(state, merged)? {
                state.seen.precedence = version;
                return Ok(());
            }
        }
    }
}

/// Rule 2: if y cannot come `gap` after x, then x comes after y. Only changed rows of the matrix are looked at.
fn orders(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let mut news = false;
    while let Some(changed) = state.bounds.take_changed() {
        let Some((x, phase)) = firing(changed) else { continue };
        for &y in &merged.neighbours[x] {
            if state.bounds.at(event(x, phase), event(y, phase)) < merged.gap[x][y] {
                news |= state.learn_order(merged, y, x, phase)?;
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

/// Rule 4: the order of |d|, and its consequences for their bounds.
fn ranks(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let count = merged.count();
    let mut news = false;
    let mut high = [0; MAX_SENSORS];
    for (x, high) in high[..count].iter_mut().enumerate() {
        *high = state.high(x);
    }
    for y in 0..count {
        let mut below = state.below[y];
        for x in 0..count {
            if high[x] < state.low[y] + merged.apart(x, y) {
                below |= u64::from(x != y) << x;
            }
            if below >> x & 1 == 1 {
                below |= state.below[x];
            }
        }
        news |= below != state.below[y];
        state.below[y] = below;
        if state.is_below(y, y) {
            return Err(Refuted);
        }
    }
    let mut above = [0_u64; MAX_SENSORS];
    for y in 0..count {
        members(state.below[y]).for_each(|x| above[x] |= 1 << y);
    }
    let (mut by_low, mut by_high) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
    // Copies of the present bounds, since bounds that rise below would no longer be in order.
    let mut low = [0; MAX_SENSORS];
    low[..count].copy_from_slice(&state.low);
    let by_low = ascending(&mut by_low, count, |x| -low[x]);
    let by_high = ascending(&mut by_high, count, |x| high[x]);
    for y in 0..count {
        let below = by_low.iter().filter(|&&x| state.below[y] >> x & 1 == 1);
        let below = below.map(|&x| (-low[usize::from(x)], merged.separation[usize::from(x)]));
        if let Some(bound) = beyond(below, merged.separation[y]) {
            news |= state.learn_low(y, -bound)?;
        }
        let above = by_high.iter().filter(|&&x| above[y] >> x & 1 == 1);
        let above = above.map(|&x| (high[usize::from(x)], merged.separation[usize::from(x)]));
        if let Some(bound) = beyond(above, merged.separation[y]) {
            news |= state.learn_high(y, bound)?;
        }
    }
    Ok(news)
}

/// The numbers below `count`, sorted by `key`; by insertion, as they are few.
fn ascending(numbers: &mut [u8; MAX_SENSORS], count: usize, key: impl Fn(usize) -> Bound) -> &[u8] {
    for i in 0..count {
        let (own, mut at) = (key(i), i);
        while at > 0 && key(usize::from(numbers[at - 1])) > own {
            numbers[at] = numbers[at - 1];
            at -= 1;
        }
        numbers[at] = i as u8;
    }
    &numbers[..count]
}

/// The greatest bound that lies below all `values`: below any set of them by the width of the set and a value of
/// separation `own`. Each of `values` is an upper bound and a separation, in ascending order.
fn beyond(values: impl Iterator<Item = (Bound, i32)>, own: i32) -> Option<Bound> {
    let (mut width, mut narrowest) = (own, own);
    let mut least: Option<Bound> = None;
    for (bound, separation) in values {
        width += separation;
        narrowest = narrowest.min(separation);
        let bound = bound - (width - narrowest);
        least = Some(least.map_or(bound, |least| least.min(bound)));
    }
    least
}

/// Rule 5, Hall's condition: the sensors whose |d| lies within an interval must have room there.
///
/// With `goes_further`, if they leave no room for another sensor, its |d| is above all of them if it cannot lie below
/// the interval, and below all of them if it cannot lie above it (*Hall intervals*, Puget 1998).
fn spacing(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let count = merged.count();
    let mut news = false;
    let mut highs = [0; MAX_SENSORS];
    for (x, high) in highs[..count].iter_mut().enumerate() {
        *high = state.high(x);
    }
    let mut by_high = [0; MAX_SENSORS];
    let by_high = ascending(&mut by_high, count, |x| highs[x]);
    let smallest = merged.least_apart;
    for first in 0..count {
        let start = state.low[first];
        if state.low[..first].contains(&start) {
            continue;
        }
        let (mut within, mut width, mut narrowest) = (0_u64, 0, i32::MAX);
        for (rank, &x) in by_high.iter().enumerate() {
            let x = usize::from(x);
            if state.low[x] < start {
                continue;
            }
            within |= 1 << x;
            width += merged.separation[x];
            narrowest = narrowest.min(merged.separation[x]);
            let high = highs[x];
            if start + width - narrowest > high {
                return Err(Refuted);
            }
            let is_full = |own: i32| start + width + own - narrowest.min(own) > high;
            if !state.goes_further || !is_full(smallest) {
                continue;
            }
            // Only the last of equal ends sees the whole set.
            if by_high.get(rank + 1).is_some_and(|&next| highs[usize::from(next)] == high) {
                continue;
            }
            for y in (0..count).filter(|&y| within >> y & 1 == 0 && is_full(merged.separation[y])) {
                if state.low[y] >= start {
                    news |= within & !state.below[y] != 0;
                    state.below[y] |= within;
                } else if highs[y] <= high {
                    members(within).for_each(|x| news |= state.learn_below(y, x));
                }
            }
        }
    }
    Ok(news)
}

/// The two events whose difference, second less first, is `d_x`, or `-d_x` if `negative`.
fn ends(x: usize, negative: bool) -> (usize, usize) {
    (event(x, usize::from(!negative)), event(x, usize::from(negative)))
}

/// For two sensors of known signs with `|d_x|` below `|d_y|`: the later event of y follows that of x by the separation
/// less the distance of the earlier events, and vice versa. Used only in searches, not for certificates.
fn behind(state: &mut State, merged: &Merged) -> Result<bool, Refuted> {
    let sign = |state: &State, x: usize| {
        if state.most(x, true) <= 0 { Some(false) } else { (state.most(x, false) <= 0).then_some(true) }
    };
    let mut news = false;
    for y in 0..merged.count() {
        let Some((y0, y1)) = sign(state, y).map(|negative| ends(y, negative)) else { continue };
        for x in members(state.below[y]) {
            let Some((x0, x1)) = sign(state, x).map(|negative| ends(x, negative)) else { continue };
            let apart = merged.apart(x, y);
            news |= state.bounds.learn(y1, x1, state.bounds.at(y0, x0) - apart)?;
            news |= state.bounds.learn(x0, y0, state.bounds.at(x1, y1) - apart)?;
        }
    }
    Ok(news)
}

/// Rule 6: the sensors whose firing orders force their d below `d_y` are apart among themselves, so `d_y` lies above
/// the last of them.
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
                let lead = state.bounds.at(y1, x1) + state.bounds.at(x0, y0);
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
                        best = best.min(most + threshold - (width - narrowest));
                    }
                }
            }
            news |= state.bounds.learn(y1, y0, best)?;
        }
    }
    Ok(news)
}
