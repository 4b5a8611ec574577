//! Assumptions of the root, as in docs/reference/certificate.md: each is a clause that VeriPB adds by its rule of
//! redundance, with the permutation as witness.

use super::known::Known;
use super::literals::{Truth, Variable, before, below};
use super::proof::{Proof, exchanged, permuted, reversed};
use crate::engine::bounds::Refuted;
use crate::engine::problem::{Merged, Problem};
use crate::engine::symmetry::{Assumptions, POSITIVE};

/// Sensors of which the first has the largest `|d|`.
type Family = Vec<usize>;

/// Adds all assumptions to the proof, then to what is known.
pub(crate) fn assume(proof: &mut Proof<'_>, known: &mut Known, problem: &Problem) -> Result<(), Refuted> {
    let merged = proof.model.merged;
    let assumptions = Assumptions::of(problem);
    let one = |sensor: usize| merged.of_sensor[sensor];
    let mut families: Vec<Family> = Vec::new();
    for family in &assumptions.families {
        let generators: Vec<Vec<usize>> = family.generators.iter().map(|image| of_ones(image, merged)).collect();
        families.push(greatest(proof, one(family.greatest), &generators));
    }
    let reverse = assumptions.reverse.map(|(x, y)| (one(x), one(y)));
    let positive = proof.model.d_from(one(POSITIVE), 0);
    if let Truth::If(positive) = positive {
        proof.strengthen(&[positive], exchanged);
    }
    if let Some((x, y)) = reverse {
        proof.strengthen(&[before(0, x, y), before(1, x, y)], reversed);
        known.state.reverse = reverse;
    }
    // From here on lemmas may be derived that the permutations would not keep.
    for family in &families {
        rank(proof, family);
        family[1..].iter().for_each(|&x| known.assume_below(x, family[0]));
    }
    if let Truth::If(positive) = positive {
        known.assume(proof, positive)?;
    }
    known.propagate(proof)
}

/// A permutation of the sensors as one of the merged ones.
fn of_ones(image: &[usize], merged: &Merged) -> Vec<usize> {
    let mut of_ones = vec![0; merged.count()];
    for (sensor, &one) in merged.of_sensor.iter().enumerate() {
        of_ones[one] = merged.of_sensor[image[sensor]];
    }
    of_ones
}

/// Of all that the permutations take `first` to, `first` has the largest `|d|`: for each other one a clause "some `|d|`
/// is above it", whose witness takes `first` to it.
fn greatest(proof: &mut Proof<'_>, first: usize, generators: &[Vec<usize>]) -> Family {
    let mut orbit: Vec<(usize, Vec<usize>)> = vec![(first, (0..proof.model.merged.count()).collect())];
    let mut next = 0;
    while next < orbit.len() {
        for image in generators {
            let product: Vec<usize> = orbit[next].1.iter().map(|&x| image[x]).collect();
            if orbit.iter().all(|(one, _)| *one != product[first]) {
                orbit.push((product[first], product));
            }
        }
        next += 1;
    }
    for (y, image) in &orbit[1..] {
        let above: Vec<_> = orbit.iter().filter(|(x, _)| x != y).map(|(x, _)| below(*y, *x)).collect();
        proof.strengthen(&above, |variable: Variable| permuted(variable, image));
    }
    orbit.into_iter().map(|(one, _)| one).collect()
}

/// Each of the family but the first has some |d| above it, so the first has the largest: one after the other is left
/// out, from the last on. Whoever had only the left out one above it has above it what that one has.
fn rank(proof: &mut Proof<'_>, family: &[usize]) {
    for &x in family {
        for &y in family.iter().filter(|&&y| y != x) {
            for &z in family.iter().filter(|&&z| z != x && z != y) {
                proof.transitive(x, y, z);
            }
        }
    }
    for end in (2..family.len()).rev() {
        for &y in &family[1..end] {
            let cases: Vec<Truth> =
                family[..end].iter().filter(|&&x| x != y).map(|&x| Truth::If(below(y, x))).collect();
            proof.propagated(&cases);
        }
    }
    for &y in &family[1..] {
        proof.propagated(&[Truth::If(below(y, family[0]))]);
    }
}
