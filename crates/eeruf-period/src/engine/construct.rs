//! A schedule without any search: an upper bound from the first moment on.
//!
//! Sensors get colours, different ones if there is a gap between them. Phase b fires colour after colour, W apart, or
//! later if gaps require it. Phase a does so in the same order, or with every g colours in reverse; each sensor takes
//! the earliest time from its colour's turn on that keeps its gaps to earlier sensors and its `|d|` apart from theirs.
//! In the same order, colour by colour, d is a separation times the rank; in reverse the `|d|` lie around several
//! multiples of W, which takes less time if the windows allow such `|d|`. All patterns are tried.

use crate::engine::problem::Merged;

/// Firing times of each sensor of the merged problem, in phases a and b.
pub(crate) type Times = Vec<[i32; 2]>;

/// A pattern of construction: the distance of colours in phase b, the number of colours reversed in phase a, and true
/// for colour by colour.
struct Pattern<'m> {
    merged: &'m Merged,
    turns: &'m [usize],
    colours: usize,
    apart: i32,
    reversed: usize,
    by_colour: bool,
}

/// The constructed schedule with the shortest period according to `period`.
pub(crate) fn constructed(merged: &Merged, period: impl Fn(&Times) -> u32) -> Times {
    let turns = fewest_colours(merged);
    let colours = turns.iter().max().map_or(1, |most| most + 1);
    let gaps = || merged.gap.iter().flatten().copied().filter(|&gap| gap > 0);
    let mut gaps = [gaps().min().unwrap_or(0), gaps().max().unwrap_or(0)].to_vec();
    gaps.dedup();
    let separation = merged.separation.iter().copied().max().unwrap_or(0);
    let mut best: Option<(u32, Times)> = None;
    for reversed in 1..=colours {
        for apart in gaps.iter().flat_map(|gap| (0..3).map(move |spare| gap + spare * separation)) {
            for by_colour in [true, false] {
                let times = Pattern { merged, turns: &turns, colours, apart, reversed, by_colour }.times();
                let period = period(&times);
                if best.as_ref().is_none_or(|(least, _)| period < *least) {
                    best = Some((period, times));
                }
            }
        }
    }
    best.map_or_else(Vec::new, |(_, times)| times)
}

impl Pattern<'_> {
    fn times(&self) -> Times {
        let count = self.merged.count();
        let back = |turn: usize| {
            let first = turn - turn % self.reversed;
            first + (first + self.reversed).min(self.colours) - 1 - turn
        };
        let mut times = vec![[0, 0]; count];
        let mut placed: Vec<usize> = Vec::with_capacity(count);
        for turn in 0..self.colours {
            for x in (0..count).filter(|&x| self.turns[x] == turn) {
                times[x][1] = self.soonest(&times, 1, &placed, x, turn as i32 * self.apart);
                placed.push(x);
            }
        }
        placed.clear();
        for round in 0..if self.by_colour { self.colours } else { 1 } {
            for x in (0..count).filter(|&x| !self.by_colour || back(self.turns[x]) == round) {
                times[x][0] = self.soonest(&times, 0, &placed, x, back(self.turns[x]) as i32 * self.apart);
                placed.push(x);
            }
        }
        times
    }

    /// The earliest time from this one on at which sensor `x` may fire beside those `placed`; in phase a also apart
    /// from all |d|.
    fn soonest(&self, times: &Times, phase: usize, placed: &[usize], x: usize, from: i32) -> i32 {
        let merged = self.merged;
        let b = times[x][1];
        let least = if merged.stale_echo { (merged.separation[x] + 1) / 2 } else { 0 };
        let mut time = from;
        // Each step moves past one conflict.
        'later: loop {
            let size = (time - b).abs();
            if phase == 0 && size < least {
                time = b + least;
                continue;
            }
            for &y in placed {
                let (other, fired) = ((times[y][0] - times[y][1]).abs(), times[y][phase]);
                let separation = merged.separation[x].max(merged.separation[y]);
                if phase == 0 && (size - other).abs() < separation {
                    let before = time < b && other >= separation;
                    time = if before { b - (other - separation) } else { b + other + separation };
                    continue 'later;
                }
                if time < fired + merged.gap[y][x] && fired < time + merged.gap[x][y] {
                    time = fired + merged.gap[y][x];
                    continue 'later;
                }
            }
            return time;
        }
    }
}

/// A colour for each sensor, from whichever of two methods needs fewer: the first free colour, or the place in one of
/// several blocks of equal length. The latter wins in a ring.
fn fewest_colours(merged: &Merged) -> Vec<usize> {
    let count = merged.count();
    let most = |colours: &[usize]| colours.iter().copied().max().unwrap_or(0);
    let mut colours: Vec<usize> = Vec::with_capacity(count);
    for x in 0..count {
        let taken: Vec<usize> = merged.neighbours[x].iter().filter(|&&y| y < x).map(|&y| colours[y]).collect();
        colours.push((0..).find(|colour| !taken.contains(colour)).unwrap_or(x));
    }
    for blocks in 1..=count {
        // Block j begins at sensor j K / blocks, rounded up.
        let places: Vec<usize> = (0..count).map(|x| x - (x * blocks / count * count).div_ceil(blocks)).collect();
        let is_proper = merged.pairs.iter().all(|&(x, y)| places[x] != places[y]);
        if is_proper && most(&places) < most(&colours) {
            colours = places;
        }
    }
    colours
}
