//! Assumptions of the root, which symmetric pairs or families of schedules allow; docs/reference/certificate.md has the
//! proofs.

use crate::bounds::Refuted;
use crate::error::CheckError;
use crate::problem::{Merged, Problem};
use crate::rules::propagate;
use crate::state::State;
use crate::text::Lines;

/// Reads the assumptions and gives the root's state, propagated.
pub(crate) fn root(
    lines: &mut Lines<'_>,
    problem: &Problem,
    merged: &Merged,
    bound: u32,
) -> Result<Result<State, Refuted>, CheckError> {
    let mut root = State::new(merged, bound as i32);
    let learn = |root: &mut Result<State, Refuted>, x: usize, y: usize| {
        if let Ok(state) = root {
            state.learn_below(x, y);
        }
    };
    // Families of |d|: each greatest one so far, and the sensors among which it is the greatest.
    let mut earlier: Vec<(usize, Vec<usize>)> = Vec::new();
    loop {
        let mut generators: Vec<Vec<usize>> = Vec::new();
        while let Some(numbers) = lines.maybe("permutation")? {
            lines.expect(&numbers, problem.sensors(), 0, problem.sensors() as u32 - 1)?;
            let image: Vec<usize> = numbers.iter().map(|&sensor| sensor as usize).collect();
            verify(problem, &image, &earlier).map_err(|what| lines.error(what))?;
            generators.push(image);
        }
        if generators.is_empty() {
            break;
        }
        let greatest = lines.number("greatest", 0, problem.sensors() as u32 - 1)? as usize;
        let orbit = orbit(greatest, &generators);
        for &sensor in &orbit {
            let (x, y) = (merged.of_sensor[sensor], merged.of_sensor[greatest]);
            if x != y {
                learn(&mut root, x, y);
            }
        }
        earlier.push((greatest, orbit));
    }
    if let Some(numbers) = lines.maybe("exchange")? {
        lines.expect(&numbers, 1, 0, problem.sensors() as u32 - 1)?;
        let x = merged.of_sensor[numbers[0] as usize];
        root = root.and_then(|mut state| state.learn_most(x, true, 0).map(|_| state));
    }
    if let Some(numbers) = lines.maybe("reverse")? {
        lines.expect(&numbers, 2, 0, problem.sensors() as u32 - 1)?;
        let [x, y] = [numbers[0], numbers[1]].map(|sensor| merged.of_sensor[sensor as usize]);
        if merged.gap[x][y] == 0 {
            return Err(lines.error(format!("sensors {} and {} have no gap", numbers[0], numbers[1])));
        }
        if let Some((x, y, after_x, after_y)) = problem.gaps.iter().find(|(_, _, after_x, after_y)| after_x != after_y)
        {
            return Err(lines.error(format!(
                "sensors {x} and {y} have the gaps {after_x} and {after_y}, expected all gaps the same both ways"
            )));
        }
        root = root.map(|mut state| {
            state.reverse = Some((x, y));
            state
        });
    }
    Ok(root.and_then(|mut state| propagate(&mut state, merged).map(|()| state)))
}

/// Returns true if `image` takes the problem to itself, and leaves what was assumed earlier as it is.
fn verify(problem: &Problem, image: &[usize], earlier: &[(usize, Vec<usize>)]) -> Result<(), String> {
    let sensors = problem.sensors();
    if let Some(missing) = (0..sensors).find(|sensor| !image.contains(sensor)) {
        return Err(format!("expected a permutation, nothing is taken to sensor {missing}"));
    }
    for x in 0..sensors {
        let same =
            problem.separation[x] == problem.separation[image[x]] && problem.window[x] == problem.window[image[x]];
        if !same {
            return Err(format!("sensor {x} is taken to {}, which has another separation or window", image[x]));
        }
    }
    for group in &problem.together {
        let taken: Vec<usize> = sorted(group.iter().map(|&sensor| image[sensor]));
        if !problem.together.contains(&taken) {
            return Err(format!("sensors {group:?} fire together, those they are taken to do not"));
        }
    }
    let mut table = vec![(0, 0); sensors * sensors];
    for &(x, y, after_x, after_y) in &problem.gaps {
        table[x * sensors + y] = (after_x, after_y);
        table[y * sensors + x] = (after_y, after_x);
    }
    for x in 0..sensors {
        for y in 0..sensors {
            if table[x * sensors + y] != table[image[x] * sensors + image[y]] {
                return Err(format!("sensors {x} and {y} are taken to {} and {} with other gaps", image[x], image[y]));
            }
        }
    }
    for (greatest, orbit) in earlier {
        let taken = sorted(orbit.iter().map(|&sensor| image[sensor]));
        if image[*greatest] != *greatest || taken != *orbit {
            return Err(format!("expected sensor {greatest} and {orbit:?}, among which it is greatest, to stay"));
        }
    }
    Ok(())
}

fn sorted(sensors: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sensors: Vec<usize> = sensors.collect();
    sensors.sort_unstable();
    sensors
}

/// All that the generators take the sensor to, again and again, in ascending order.
fn orbit(sensor: usize, generators: &[Vec<usize>]) -> Vec<usize> {
    let mut orbit = vec![sensor];
    let mut next = 0;
    while next < orbit.len() {
        for image in generators {
            let taken = image[orbit[next]];
            if !orbit.contains(&taken) {
                orbit.push(taken);
            }
        }
        next += 1;
    }
    sorted(orbit.into_iter())
}
