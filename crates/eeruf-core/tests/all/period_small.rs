//! Random problems: on tiny ones the search agrees with plain nested loops, on larger ones the schedules serve.

use eeruf_core::search::Outcome;
use eeruf_core::search::design::{Problem, decide, memory_words, shortest};
use proptest::prelude::*;

use crate::common::naive::{self, Layout};
use crate::common::naive_period::{check, nested_loops};

prop_compose! {
    /// Any conflicts between up to four sensors, with small needs.
    fn tiny()(
        sensors in 1..=4usize, pairs in any::<u64>(), separation in 1..=3u32, interval in 0..=4u32,
        window in 0..=8u32, stale_echo in any::<bool>(), layout in 0..4
    ) -> (Vec<u64>, u32, u32, u32, bool) {
        let rows = match layout {
            0 => naive::conflicts(Layout::Line, sensors, 2),
            1 => naive::conflicts(Layout::Ring, sensors, 2),
            2 => naive::conflicts(Layout::Blocks, sensors, 2),
            _ => naive::conflicts_where(sensors, |x, y| pairs >> (x * 4 + y) & 1 == 1),
        };
        (rows, separation, interval, window, stale_echo)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_search_agrees_with_nested_loops_on_tiny_problems(
        (rows, separation, interval, window, stale_echo) in tiny(), period in 1..=9u32
    ) {
        let problem = Problem { sensors: rows.len(), conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(rows.len())];
        match decide(&problem, period, u64::MAX, &mut memory, &mut ()).unwrap().outcome {
            Outcome::Found(firing) => {
                prop_assert_eq!(check(&problem, period, firing.fire_a(), firing.fire_b()), Ok(()));
            }
            Outcome::Exhausted => prop_assert!(!nested_loops(&problem, period)),
            Outcome::BudgetSpent => prop_assert!(false, "no budget was set"),
        }
    }

    // The shortest period of tiny problems is where nested loops begin to succeed.
    #[test]
    fn shortest_period_is_where_nested_loops_succeed(
        (rows, separation, interval, window, stale_echo) in tiny()
    ) {
        let problem = Problem { sensors: rows.len(), conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(rows.len())];
        let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
        prop_assert!(found.proven());
        prop_assert_eq!(check(&problem, found.period, found.firing.fire_a(), found.firing.fire_b()), Ok(()));
        // What nested loops manage.
        if found.period > 1 && u64::from(found.period - 1).pow(2 * rows.len() as u32) < 2_000_000 {
            prop_assert!(!nested_loops(&problem, found.period - 1));
        }
    }

    #[test]
    fn larger_problems_get_schedules_that_serve_and_bounds_in_order(
        sensors in 5..=9usize, seed in any::<u64>(), separation in 1..=4u32, interval in 0..=12u32,
        window in 0..=60u32, stale_echo in any::<bool>(),
    ) {
        let rows = naive::conflicts_where(sensors, |x, y| seed.rotate_left((x * 11 + y * 7) as u32) & 3 == 0);
        let problem = Problem { sensors, conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(sensors)];
        let found = shortest(&problem, 3_000, &mut memory, &mut ()).unwrap();
        prop_assert!(found.bound <= found.period);
        prop_assert_eq!(check(&problem, found.period, found.firing.fire_a(), found.firing.fire_b()), Ok(()));
    }
}
