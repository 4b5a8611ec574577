//! Beside the shortest period: why it is not shorter, the largest interval or separation at a given one, and the
//! preferred schedule.

use eeruf_core::search::design::{
    Bound, Explanation, Problem, maximize_interval, maximize_separation, memory_words, prefer, shortest,
};

use crate::common::naive::{self, Layout};
use crate::common::naive_period::{assert_serves, paper_12};

#[test]
fn the_reason_names_what_to_relax() {
    let rows = naive::conflicts(Layout::Line, 12, 4);
    let mut memory = vec![0; memory_words(12)];
    let wide = Problem { window: 60, ..paper_12(&rows, 1) };
    let found = shortest(&wide, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(found.explanation, Explanation::Bound(Bound::Capacity { .. })));
    assert_eq!(
        found.explanation.to_string(),
        "window and separation: 12 sensors need 12 refire times 2 ticks apart, and the shortest must leave \
         a window of 60 ticks, which takes 82 ticks; a shorter window, a smaller separation or fewer sensors would \
         help, a shorter interval would not"
    );

    let narrow = paper_12(&rows, 1);
    let found = shortest(&narrow, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(found.explanation, Explanation::Bound(Bound::Classes { clique: 4, sensors: 12, period: 65, .. })));
    assert_eq!(
        found.explanation.to_string(),
        "interval and separation together: 4 sensors that are all neighbours and fire 15 ticks apart leave \
         too little time to tell 12 refire times 2 ticks apart, which takes 65 ticks; a shorter interval, a smaller \
         separation or fewer neighbours would help"
    );
    let rows_8 = naive::conflicts(Layout::Ring, 8, 4);
    let ring = Problem { sensors: 8, ..paper_12(&rows_8, 1) };
    let searched = shortest(&ring, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(searched.explanation, Explanation::Exhausted { period: 64, .. }));
}

#[test]
fn papers_half_ring_keeps_20_ms_at_100_ms() {
    // With |d| of at most 24 ms, as in the paper's tables, the window is 76 ms. With the paper's lags the answer is 19
    // ms; here lags are free.
    let rows = naive::conflicts(Layout::Line, 12, 4);
    let problem = Problem { window: 76, ..paper_12(&rows, 1) };
    let mut memory = vec![0; memory_words(12)];
    let largest = maximize_interval(&problem, 100, u64::MAX, &mut memory, &mut ()).unwrap();
    let (interval, firing) = largest.found.unwrap();
    assert_eq!((interval, largest.bound), (20, Some(20)));
    assert_serves(&Problem { interval, ..problem }, 100, &firing);
}

#[test]
fn twelve_sensors_keep_2_ms_separation_at_82_ms() {
    let rows = naive::conflicts(Layout::Line, 12, 4);
    let problem = Problem { window: 60, ..paper_12(&rows, 1) };
    let mut memory = vec![0; memory_words(12)];
    for (period, separation) in [(81, 1), (82, 2), (100, 3)] {
        let largest = maximize_separation(&problem, period, u64::MAX, &mut memory, &mut ()).unwrap();
        let (value, firing) = largest.found.unwrap();
        assert_eq!((value, largest.bound), (separation, Some(separation)));
        assert_serves(&Problem { separation, ..problem }, period, &firing);
    }
}

#[test]
fn the_preferred_schedule_is_no_worse_and_still_serves() {
    let rows = naive::conflicts(Layout::Line, 8, 4);
    let problem =
        Problem { sensors: 8, conflicts: &rows, separation: 20, interval: 150, window: 600, stale_echo: true };
    let mut memory = vec![0; memory_words(8)];
    let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
    let preferred = prefer(&problem, &found, 30_000, &mut memory, &mut ()).unwrap();
    let (separation, interval, window) = (preferred.separation.value, preferred.interval.value, preferred.window.value);
    assert!(separation >= 20 && interval >= 150 && window >= 600);
    assert_serves(&Problem { separation, interval, window, ..problem }, found.period, &preferred.firing);
}
