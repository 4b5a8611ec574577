//! Tests of the engine in ticks: its steps, and values that cannot come from microseconds.

extern crate std;

mod effort;

use std::vec;
use std::vec::Vec;

use super::{Budget, Objective, Problem, Search, memory_words};
use crate::layout::Layout;
use crate::requirements::Criterion;
use crate::search::Outcome;

/// A seeded pseudo-random sequence, the same on every machine (splitmix64).
struct Random(u64);

impl Random {
    /// 0 to `most`.
    fn up_to(&mut self, most: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) % (u64::from(most) + 1)) as u32
    }
}

/// Owned parts of a problem.
struct Owned {
    lag: Vec<u32>,
    conflicts: Vec<u64>,
    period: u32,
    wait_max: u32,
    separation: u32,
    interval: u32,
    criterion: Criterion,
}

impl Owned {
    /// The paper's ring: lags in groups of four, ticks of a millisecond.
    fn paper(sensors: usize, layout: Layout<'_>, separation: u32, criterion: Criterion) -> Self {
        Self {
            lag: (0..sensors).map(|i| (i % 4) as u32 * 25).collect(),
            conflicts: layout.rows(sensors)[..sensors].to_vec(),
            period: 100,
            wait_max: 24,
            separation,
            interval: 0,
            criterion,
        }
    }

    /// Sensors that need not be apart in time.
    fn alone(sensors: usize, criterion: Criterion) -> Self {
        let (lag, conflicts) = (vec![0; sensors], vec![0; sensors]);
        Self { period: 40, lag, wait_max: 9, separation: 0, interval: 0, conflicts, criterion }
    }

    fn problem(&self) -> Problem<'_> {
        Problem {
            period: self.period,
            lag: &self.lag,
            wait_max: self.wait_max,
            separation: self.separation,
            interval: self.interval,
            conflicts: &self.conflicts,
            criterion: self.criterion,
        }
    }
}

// The separation of a table is the least that (10a), (10b), or (13a), (13b) as printed, leave to any pair.
#[test]
fn table_separation_is_that_of_its_closest_pair() {
    let mut random = Random(7);
    for criterion in [Criterion::Exact, Criterion::Paper] {
        let owned = Owned::alone(3, criterion);
        let mut seen = [false; 10];
        for _ in 0..500 {
            let [a, b] = [(); 2].map(|()| [(); 3].map(|()| random.up_to(9)));
            let [p, q] = [&a, &b].map(|waits| waits.map(|wait| wait as i32));
            let sides = |x: usize, y: usize| match criterion {
                Criterion::Paper => [
                    ((p[x] - p[y]).abs() - (q[x] - q[y]).abs()).abs(),
                    ((p[x] - q[y]).abs() - (q[x] - p[y]).abs()).abs(),
                ],
                _ => [((p[x] - q[x]) - (p[y] - q[y])).abs(), ((p[x] - q[x]) + (p[y] - q[y])).abs()],
            };
            let least = [(0, 1), (0, 2), (1, 2)].iter().flat_map(|&(x, y)| sides(x, y)).min().unwrap();
            let found = Search::new(owned.problem()).separation_of(&a, &b);
            assert_eq!(found, least as u32, "{criterion:?} {a:?} {b:?}");
            seen[found as usize] = true;
        }
        assert!(seen[..3].iter().all(|&seen| seen), "{criterion:?} {seen:?}");
    }
    // One sensor is as far from the others as a wait can be.
    assert_eq!(Search::new(Owned::alone(1, Criterion::Exact).problem()).separation_of(&[3], &[5]), 9);
}

#[test]
fn values_of_foreign_waits_are_measured_without_overflow() {
    let owned = Owned::paper(6, Layout::Line(4), 1, Criterion::Paper);
    let search = Search::new(owned.problem());
    let huge = [u32::MAX; 6];
    assert_eq!(search.smallest_interval(&huge, &huge), 0);
    assert_eq!(search.separation_of(&huge, &huge), 0);
    assert_eq!(search.smallest_interval(&[], &[]), 0);
}

#[test]
fn a_count_beyond_every_number_stops_at_the_greatest() {
    let owned = Owned { period: 64, wait_max: 63, ..Owned::alone(64, Criterion::Exact) };
    let counted = Search::new(owned.problem()).count(None, &mut [0; 5000], &mut Budget::unlimited());
    assert_eq!(counted, (Outcome::Found(()), u128::MAX));
}

#[test]
fn a_single_sensor_is_never_too_close_to_anything() {
    let alone = Owned { separation: u32::MAX, interval: u32::MAX, ..Owned::alone(1, Criterion::Paper) };
    let search = Search::new(alone.problem());
    let (mut a, mut b) = ([0], [0]);
    let mut memory = [0; memory_words(1)];
    assert_eq!(search.first(&mut memory, &mut Budget::unlimited(), &mut a, &mut b), Ok(Outcome::Found(())));
    assert_eq!(search.count(None, &mut memory, &mut Budget::unlimited()).1, 100);
    for objective in [Objective::Interval, Objective::Separation] {
        let best = search.best(objective, &mut memory, &mut Budget::unlimited(), &mut a, &mut b).unwrap();
        assert_eq!((best.outcome, best.value), (Outcome::Found(()), Some(u32::MAX)));
    }
    let point = search.front_from(u32::MAX, &mut memory, &mut Budget::unlimited(), &mut a, &mut b);
    assert_eq!(point, Ok(Outcome::Found((u32::MAX, u32::MAX))));
}
