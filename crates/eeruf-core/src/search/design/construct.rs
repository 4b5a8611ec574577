//! A schedule without any search: an upper bound from the first moment on.
//!
//! Sensors get colours, conflicting ones unlike ones. Phase b fires colour after colour, W apart, so that W of at least
//! I keeps it. Phase a does so in the same order, or with every g colours in reverse; each sensor takes the soonest
//! time from its colour's turn on that is I from the conflicting sensors before it and whose `|d|` is D from all `|d|`
//! before. In the same order, colour by colour, d is D times the rank, which takes a period of
//! `max(C I, R) + (K - 1) D` for C colours. In reverse the `|d|` lie around several multiples of W, D apart in each,
//! which takes less where the window allows such `|d|`. All of these are tried; the shortest is taken.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::firing::Firing;
use super::problem::CheckedProblem;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// The shortest of the constructed schedules, none of them longer than firing one by one.
pub(crate) fn constructed(problem: &CheckedProblem) -> Firing {
    let (colours, count) = fewest_colours(problem);
    let turn = |x: usize| i32::from(colours[x]);
    let mut best = Firing { a: [0; MAX_SENSORS], b: [0; MAX_SENSORS], sensors: problem.sensors };
    let mut shortest = i32::MAX;
    for reversed in 1..=count {
        let back = |turn: i32| {
            let first = turn - turn % reversed;
            first + (first + reversed).min(count) - 1 - turn
        };
        for spare in 0..3 {
            let apart = problem.interval + spare * problem.separation;
            for by_colour in [true, false] {
                let mut firing = Firing { sensors: problem.sensors, ..best };
                let mut placed = 0u64;
                for round in 0..if by_colour { count } else { 1 } {
                    for x in (0..problem.sensors).filter(|&x| !by_colour || back(turn(x)) == round) {
                        firing.b[x] = (turn(x) * apart) as u32;
                        firing.a[x] = soonest(problem, &firing, placed, x, back(turn(x)) * apart) as u32;
                        placed |= 1 << x;
                    }
                }
                let period = firing.period(problem);
                if period < shortest {
                    (best, shortest) = (firing, period);
                }
            }
        }
    }
    best
}

/// The soonest time `from` this on at which sensor `x` may fire in phase a beside those `placed`.
fn soonest(problem: &CheckedProblem, firing: &Firing, placed: u64, x: usize, from: i32) -> i32 {
    let (b, separation) = (firing.b[x] as i32, problem.separation);
    let mut a = from;
    // Each step leaves behind what was too close.
    'later: loop {
        let size = (a - b).abs();
        if size < problem.least {
            a = b + problem.least;
            continue;
        }
        for y in Members(placed) {
            let (other, fired) = (firing.size(y), firing.a[y] as i32);
            if (size - other).abs() < separation {
                a = if a < b && other >= separation { b - (other - separation) } else { b + other + separation };
                continue 'later;
            }
            if problem.conflict(x, y) && (a - fired).abs() < problem.interval {
                a = fired + problem.interval;
                continue 'later;
            }
        }
        return a;
    }
}

/// A colour for each sensor, and how many there are: each takes the first that is free, or its place in one of several
/// blocks as long as each other, whichever needs fewer. Around a ring the blocks do.
fn fewest_colours(problem: &CheckedProblem) -> ([u8; MAX_SENSORS], i32) {
    let k = problem.sensors;
    let mut colours = [0u8; MAX_SENSORS];
    for x in 0..k {
        let taken = Members(problem.conflicts[x] & ((1 << x) - 1)).fold(0u64, |taken, y| taken | 1 << colours[y]);
        colours[x] = taken.trailing_ones() as u8;
    }
    let most = |colours: &[u8; MAX_SENSORS]| colours[..k].iter().max().map_or(1, |&most| i32::from(most) + 1);
    for blocks in 1..=k {
        let mut places = [0u8; MAX_SENSORS];
        for x in 0..k {
            // Block j begins at sensor j K / blocks, rounded up.
            places[x] = (x - (x * blocks / k * k).div_ceil(blocks)) as u8;
        }
        let proper = (0..k).all(|x| Members(problem.conflicts[x]).all(|y| places[x] != places[y]));
        if proper && most(&places) < most(&colours) {
            colours = places;
        }
    }
    (colours, most(&colours))
}
