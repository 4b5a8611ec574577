//! Random wait-time problems small enough for nested loops to answer: existence, counts, the best values and the front.

use crate::common::naive::{self, Layout, Problem};
use crate::common::{Owned, holds, separation, ticks, waits};
use eeruf_core::search::{Budget, Found, FrontTable, MEMORY_WORDS, Outcome, WaitSearch};
use eeruf_core::{Criterion, Schedule};
use proptest::prelude::*;

/// A random line, ring, blocks or graph; lags in groups or at random.
fn tiny() -> impl Strategy<Value = Owned> {
    (
        1_usize..=4,
        0_u32..=5,
        1_u32..=3,
        0_u32..=9,
        any::<bool>(),
        0..4_u8,
        1_usize..=4,
        any::<u16>(),
        prop::option::of(1_usize..=4),
    )
        .prop_flat_map(|(sensors, wait_max, separation, interval, paper, layout, neighbours, edges, group)| {
            let period = wait_max + 1..wait_max + 30;
            let lags = prop::collection::vec(any::<u32>(), sensors);
            (period, lags).prop_map(move |(period, lags)| {
                let lag = lags
                    .iter()
                    .enumerate()
                    .map(|(i, &lag)| match group {
                        Some(group) => ((i % group) as u32 * period / group as u32).min(period - 1 - wait_max),
                        None => lag % (period - wait_max),
                    })
                    .collect();
                let conflicts = match layout {
                    0 => naive::conflicts(Layout::Line, sensors, neighbours),
                    1 => naive::conflicts(Layout::Ring, sensors, neighbours),
                    2 => naive::conflicts(Layout::Blocks, sensors, neighbours),
                    _ => naive::conflicts_where(sensors, |x, y| edges >> (x * (x - 1) / 2 + y) & 1 == 1),
                };
                let criterion = if paper { Criterion::Paper } else { Criterion::Exact };
                Owned { period, lag, wait_max, separation, interval, conflicts, criterion }
            })
        })
}

/// The interval and separation of every table of a problem without requirements, reduced to those on the front,
/// greatest interval first.
fn naive_front(tiny: &Owned) -> Vec<(u32, u32)> {
    let problem = tiny.problem();
    let mut points: Vec<(u32, u32)> = Vec::new();
    naive::for_each(&tiny.problem(), &mut |a, b| {
        let value = |ok: &dyn Fn(u32) -> bool, most: u32| (0..=most).rev().find(|&value| ok(value)).unwrap();
        let interval = value(&|interval| naive::holds(&Problem { interval, ..problem }, a, b), tiny.period);
        let separation = value(&|separation| naive::holds(&Problem { separation, ..problem }, a, b), tiny.wait_max);
        if !points.contains(&(interval, separation)) {
            points.push((interval, separation));
        }
    });
    let dominated = |p: &(u32, u32)| points.iter().any(|q| q != p && q.0 >= p.0 && q.1 >= p.1);
    let mut front: Vec<_> = points.iter().copied().filter(|p| !dominated(p)).collect();
    front.sort_by_key(|point| std::cmp::Reverse(point.0));
    front
}

/// The number of problems of each test: `EERUF_BRUTE_FORCE`, or 150.
fn config() -> ProptestConfig {
    let cases = std::env::var("EERUF_BRUTE_FORCE").map_or(150, |cases| cases.parse().expect("a number"));
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn nested_loops_agree_on_found_exhausted_and_count(tiny in tiny()) {
        let problem = tiny.problem();
        let search = tiny.search();
        let count = naive::count(&problem);
        let mut memory = vec![0; MEMORY_WORDS];
        match search.first::<64>(&mut memory, &mut Budget::unlimited()).unwrap() {
            Outcome::Found(table) => prop_assert!(count > 0 && holds(&problem, &table)),
            outcome => prop_assert_eq!((outcome, count), (Outcome::Exhausted, 0)),
        }
        // No memory, too little to keep entries for long, and plenty.
        for words in [0, 60, 5000] {
            let counted = search.count(None, &mut vec![7; words], &mut Budget::unlimited());
            prop_assert_eq!(counted, (Outcome::Exhausted, count), "{} words", words);
        }
        let (mut seen, mut before) = (Vec::new(), None::<Schedule<64>>);
        while let Outcome::Found(table) = search.next_table(before.as_ref(), &mut Budget::unlimited()).unwrap() {
            let [a, b] = waits(&table);
            seen.push((a, b));
            before = Some(table);
        }
        let mut expected = Vec::new();
        naive::for_each(&problem, &mut |a, b| expected.push((a.to_vec(), b.to_vec())));
        prop_assert_eq!(seen, expected);
    }

    #[test]
    fn nested_loops_agree_on_the_shortest_waits_and_period(tiny in tiny()) {
        let (problem, search, mut memory) = (tiny.problem(), tiny.search(), vec![0; MEMORY_WORDS]);
        let least_period = tiny.lag.iter().max().unwrap() + tiny.wait_max + 1;
        for of_waits in [true, false] {
            let at = |value| match of_waits {
                true => Problem { wait_max: value, ..problem },
                false => Problem { period: value, ..problem },
            };
            let mut values = if of_waits { 0..=tiny.wait_max } else { least_period..=tiny.period };
            let expected = values.find(|&value| naive::count(&at(value)) > 0);
            let shortest = if of_waits { WaitSearch::shortest_waits } else { WaitSearch::shortest_period };
            let found: Found<64> = shortest(&search, &mut memory, &mut Budget::unlimited()).unwrap();
            prop_assert_eq!((found.value.map(ticks), found.proven), (expected, true));
            prop_assert_eq!(found.bound, found.value);
            let keeps = found.schedule.zip(expected).is_none_or(|(table, value)| holds(&at(value), &table));
            prop_assert!(keeps && found.schedule.is_some() == expected.is_some());
        }
    }

    #[test]
    fn nested_loops_agree_on_the_best_values_and_the_front(tiny in tiny()) {
        let tiny = Owned {
            lag: tiny.lag.iter().take(3).copied().collect(),
            conflicts: tiny.conflicts.iter().take(3).map(|row| row & 7).collect(),
            ..tiny
        };
        let (problem, search) = (tiny.problem(), tiny.search());
        let mut memory = vec![0; MEMORY_WORDS];
        let front = naive_front(&tiny);
        let best = search.best_interval(&mut memory, &mut Budget::unlimited());
        let Found::<64> { schedule, value, proven, .. } = best.unwrap();
        prop_assert!(proven);
        let apart = tiny.conflicts.iter().any(|&row| row != 0);
        if apart {
            prop_assert_eq!(value.map(ticks), front.first().map(|point| point.0));
        } else {
            prop_assert_eq!(value.is_some(), !front.is_empty());
        }
        if let (Some(interval), Some(table)) = (value.map(ticks), schedule) {
            let at = Problem { interval, ..problem };
            prop_assert!(holds(&at, &table));
        }
        let best = search.best_t_delta(&mut memory, &mut Budget::unlimited());
        let Found::<64> { schedule, value, proven, .. } = best.unwrap();
        prop_assert!(proven);
        prop_assert_eq!(schedule.is_some(), !front.is_empty());
        if let (Some(separation), Some(table), true) = (value.map(separation), schedule, tiny.lag.len() > 1) {
            prop_assert_eq!(Some(separation), front.last().map(|point| point.1));
            let at = Problem { separation, ..problem };
            prop_assert!(holds(&at, &table));
        }
        if tiny.lag.len() > 1 && apart {
            let (mut points, mut before) = (Vec::new(), None::<FrontTable<64>>);
            while let Outcome::Found(table) =
                search.next_on_front(before.as_ref(), &mut memory, &mut Budget::unlimited()).unwrap()
            {
                let (interval, separation) = (ticks(table.min_interval), separation(table.t_delta.unwrap()));
                let at = Problem { interval, separation, ..problem };
                prop_assert!(holds(&at, &table.schedule));
                points.push((interval, separation));
                before = Some(table);
            }
            prop_assert_eq!(points, front);
        }
    }
}
