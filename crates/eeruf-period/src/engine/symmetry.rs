//! Assumptions at the root that hold for one of each family of symmetric schedules; docs/reference/certificate.md has
//! the proofs.

use crate::engine::bounds::Refuted;
use crate::engine::problem::{Merged, Problem};
use crate::engine::rules::propagate;
use crate::engine::state::{State, event};
use crate::engine::turns::Turns;

/// A family of sensors that permutations of the problem map to each other, one of which may be assumed to have the
/// greatest |d|.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    pub(crate) generators: Vec<Vec<usize>>,
    pub(crate) greatest: usize,
    /// The images of `greatest`, itself included, in ascending order.
    orbit: Vec<usize>,
}

/// The assumptions for one problem: turns, reflections and exchanges of two sensors that it allows, the exchange of the
/// phases, and the reversal of time.
#[derive(Clone, Debug)]
pub(crate) struct Assumptions {
    pub(crate) families: Vec<Family>,
    /// Two sensors, the first of which fires before the second in at least one phase.
    pub(crate) reverse: Option<(usize, usize)>,
}

/// The sensor whose d may be assumed not negative.
pub(crate) const POSITIVE: usize = 0;

impl Assumptions {
    pub(crate) fn of(problem: &Problem) -> Self {
        let sensors = problem.sensors();
        let turned = |by: usize| (0..sensors).map(|x| (x + by) % sensors).collect::<Vec<usize>>();
        let reflected = |about: usize| (0..sensors).map(|x| (about + sensors - x) % sensors).collect::<Vec<usize>>();
        let exchanged = |x: usize, y: usize| {
            let mut image = turned(0);
            image.swap(x, y);
            image
        };
        let mut candidates: Vec<Vec<usize>> = (1..sensors).map(turned).collect();
        candidates.extend((0..sensors).map(reflected));
        candidates.extend((0..sensors).flat_map(|y| (0..y).map(move |x| exchanged(x, y))));
        let table = gaps(problem);
        candidates.retain(|image| is_symmetry(problem, image, &table));
        let mut families: Vec<Family> = Vec::new();
        for greatest in 0..sensors {
            let mut generators: Vec<Vec<usize>> = Vec::new();
            let mut found = vec![greatest];
            for image in candidates.iter().filter(|image| leaves(image, &families)) {
                generators.push(image.clone());
                let wider = orbit(greatest, &generators);
                if wider == found {
                    generators.pop();
                } else {
                    found = wider;
                }
            }
            if !generators.is_empty() {
                families.push(Family { generators, greatest, orbit: found });
            }
        }
        let is_even = problem.gaps.iter().all(|(_, _, after_x, after_y)| after_x == after_y);
        let reverse = problem.gaps.first().filter(|_| is_even).map(|&(x, y, ..)| (x, y));
        Self { families, reverse }
    }

    /// The state of the root for periods below `bound`, propagated.
    pub(crate) fn root(&self, merged: &Merged, bound: u32) -> Result<State, Refuted> {
        let mut root = State::new(merged, bound as i32)?;
        for family in &self.families {
            for &sensor in &family.orbit {
                let (x, y) = (merged.of_sensor[sensor], merged.of_sensor[family.greatest]);
                if x != y {
                    root.learn_below(x, y);
                }
            }
        }
        root.learn_most(merged.of_sensor[POSITIVE], true, 0)?;
        root.reverse = self.reverse.map(|(x, y)| (merged.of_sensor[x], merged.of_sensor[y]));
        propagate(&mut root, merged)?;
        Ok(root)
    }

    /// The state of the root for branchings in the order of time: in phase a the first sensor of each family fires
    /// before the rest of the family, and in phase b the first sensor of all fires no later than the rest of its own.
    pub(crate) fn root_in_time(&self, merged: &Merged, bound: u32) -> Result<State, Refuted> {
        let mut root = State::new(merged, bound as i32)?;
        for (number, family) in self.families.iter().enumerate() {
            let first = merged.of_sensor[family.greatest];
            for &sensor in &family.orbit {
                for phase in if number == 0 { 0..2 } else { 0..1 } {
                    root.bounds.learn(event(merged.of_sensor[sensor], phase), event(first, 0), 0)?;
                }
            }
        }
        root.turns = Some(Turns::new(merged, bound as i32 - 1));
        propagate(&mut root, merged)?;
        Ok(root)
    }

    /// The lines of a certificate.
    pub(crate) fn lines(&self, in_time: bool) -> String {
        let mut text = String::new();
        for family in &self.families {
            for image in &family.generators {
                let row: String = image.iter().map(|sensor| format!(" {sensor}")).collect();
                text += &format!("permutation{row}\n");
            }
            text += &format!("{} {}\n", if in_time { "first" } else { "greatest" }, family.greatest);
        }
        if in_time {
            return text;
        }
        text += &format!("exchange {POSITIVE}\n");
        match self.reverse {
            Some((x, y)) => text + &format!("reverse {x} {y}\n"),
            None => text,
        }
    }
}

/// The gaps of each pair of sensors, row by row.
fn gaps(problem: &Problem) -> Vec<(u32, u32)> {
    let sensors = problem.sensors();
    let mut table = vec![(0, 0); sensors * sensors];
    for &(x, y, after_x, after_y) in &problem.gaps {
        table[x * sensors + y] = (after_x, after_y);
        table[y * sensors + x] = (after_y, after_x);
    }
    table
}

/// Returns true if the permutation `image` maps the problem, with this table of gaps, to itself.
fn is_symmetry(problem: &Problem, image: &[usize], table: &[(u32, u32)]) -> bool {
    let sensors = problem.sensors();
    let alike = |x: usize| {
        problem.separation[x] == problem.separation[image[x]] && problem.window[x] == problem.window[image[x]]
    };
    let same_gap = |x: usize, y: usize| table[x * sensors + y] == table[image[x] * sensors + image[y]];
    let taken = |set: &[usize]| sorted(set.iter().map(|&sensor| image[sensor]));
    (0..sensors).all(|x| alike(x) && (0..sensors).all(|y| same_gap(x, y)))
        && problem.together.iter().all(|group| problem.together.contains(&taken(group)))
}

/// Returns true if the permutation `image` preserves earlier assumptions.
fn leaves(image: &[usize], earlier: &[Family]) -> bool {
    let taken = |set: &[usize]| sorted(set.iter().map(|&sensor| image[sensor]));
    earlier.iter().all(|known| image[known.greatest] == known.greatest && taken(&known.orbit) == known.orbit)
}

fn sorted(sensors: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sensors: Vec<usize> = sensors.collect();
    sensors.sort_unstable();
    sensors
}

/// The orbit of a sensor under the generators, in ascending order.
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
