//! Reads the head of a certificate: problem, schedule and claim.

use crate::error::CheckError;
use crate::problem::{MAX_NUMBER, MAX_SENSORS, Problem};
use crate::text::Lines;

/// The claim of a certificate: the schedule keeps what the problem requires, and no period below `bound` can.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The requirements.
    pub problem: Problem,
    /// The schedule's period, in ticks.
    pub period: u32,
    /// When each sensor fires in phases a and b, in ticks after the phase's start.
    pub fire: [Vec<u32>; 2],
    /// No period is below this; equal to `period` when the period is the shortest one.
    pub bound: u32,
}

pub(crate) fn claim(lines: &mut Lines<'_>) -> Result<Claim, CheckError> {
    lines.number("eeruf-certificate", 1, 1)?;
    let tick = lines.list("tick_us", 2, 1, MAX_NUMBER)?;
    let sensors = lines.number("sensors", 1, MAX_SENSORS as u32)? as usize;
    let separation = lines.list("separation", sensors, 1, MAX_NUMBER)?;
    let window = lines.list("window", sensors, 1, MAX_NUMBER)?;
    let stale_echo = lines.number("stale_echo", 0, 1)? == 1;
    let over_reals = lines.number("over_reals", 0, 1)? == 1;
    if over_reals && stale_echo && separation.iter().any(|separation| separation % 2 == 1) {
        return Err(lines.error("stale_echo over_reals needs even separations: state the problem in half ticks"));
    }
    let together = together(lines, sensors)?;
    let gaps = gaps(lines, sensors)?;
    let period = lines.number("period", 1, MAX_NUMBER)?;
    let fire_a = lines.list("fire_a", sensors, 0, period - 1)?;
    let fire_b = lines.list("fire_b", sensors, 0, period - 1)?;
    let problem = Problem { tick_us: (tick[0], tick[1]), separation, window, stale_echo, over_reals, together, gaps };
    let fire = [fire_a, fire_b];
    if let Err(what) = crate::schedule::check(&problem, period, &fire) {
        return Err(lines.error(what));
    }
    let bound = lines.number("no_period_below", 1, period)?;
    Ok(Claim { problem, period, fire, bound })
}

/// Groups of sensors that fire together: at least two, in ascending order, each sensor at most once.
fn together(lines: &mut Lines<'_>, sensors: usize) -> Result<Vec<Vec<usize>>, CheckError> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    while let Some(numbers) = lines.maybe("together")? {
        lines.expect(&numbers, numbers.len().max(2), 0, sensors as u32 - 1)?;
        let group: Vec<usize> = numbers.iter().map(|&sensor| sensor as usize).collect();
        if group.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(lines.error("expected sensors in ascending order"));
        }
        if let Some(sensor) = group.iter().find(|sensor| groups.iter().flatten().any(|other| other == *sensor)) {
            return Err(lines.error(format!("sensor {sensor} is in two groups, expected one at most")));
        }
        groups.push(group);
    }
    Ok(groups)
}

/// Pairs x < y in ascending order, with the gap after x and the gap after y.
fn gaps(lines: &mut Lines<'_>, sensors: usize) -> Result<Vec<(usize, usize, u32, u32)>, CheckError> {
    let mut gaps: Vec<(usize, usize, u32, u32)> = Vec::new();
    while let Some(numbers) = lines.maybe("gap")? {
        lines.expect(&numbers, 4, 0, MAX_NUMBER)?;
        lines.expect(&numbers[..2], 2, 0, sensors as u32 - 1)?;
        lines.expect(&numbers[2..], 2, 1, MAX_NUMBER)?;
        let (x, y) = (numbers[0] as usize, numbers[1] as usize);
        if x >= y || gaps.last().is_some_and(|last| (last.0, last.1) >= (x, y)) {
            return Err(lines.error(format!("found the pair {x} {y}, expected pairs x < y in ascending order")));
        }
        gaps.push((x, y, numbers[2], numbers[3]));
    }
    Ok(gaps)
}
