//! Eqs. (13a), (13b): compares the fast check of `eeruf-core`, which sorts, with the longhand definition, which
//! compares all pairs; and tests the paper's claims about Table I.

use eeruf_core::tables::{TABLE_I_A, TABLE_I_B, TABLE_I_C, TABLE_I_D, THE_ONE_WITH_19_MS};
use eeruf_core::{Criterion, Layout, Micros, Phase, Requirements, Schedule, conditions::ViolationKind};
use proptest::prelude::*;

/// The smallest left side of (13a) and (13b) over all pairs, as printed (with the outer absolute value).
fn longhand_paper(a: &[i64], b: &[i64]) -> Option<i64> {
    pairs(a.len())
        .flat_map(|(x, y)| {
            [
                ((a[x] - a[y]).abs() - (b[x] - b[y]).abs()).abs(), // (13a)
                ((a[x] - b[y]).abs() - (b[x] - a[y]).abs()).abs(), // (13b)
            ]
        })
        .min()
}

/// The smallest change of crosstalk between consecutive readings, from (10a), (10b).
fn longhand_exact(a: &[i64], b: &[i64]) -> Option<i64> {
    pairs(a.len())
        .flat_map(|(x, y)| {
            [
                ((a[x] - a[y]) - (b[x] - b[y])).abs(), // x and y in the same phase
                ((a[x] - b[y]) - (b[x] - a[y])).abs(), // x one phase behind
            ]
        })
        .min()
}

fn pairs(sensors: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..sensors).flat_map(move |x| (0..sensors).filter(move |&y| y != x).map(move |y| (x, y)))
}

fn waits(schedule: &Schedule<64>, phase: Phase) -> Vec<i64> {
    schedule.t_wait(phase).iter().map(|t| i64::from(t.as_micros())).collect()
}

prop_compose! {
    /// Waits that often coincide or nearly do, with any lags.
    fn any_schedule()(sensors in 1..=16_usize)(
        lags in prop::collection::vec(0..50_000_u32, sensors),
        waits in prop::collection::vec((0..40_u32, 0..40_u32, 0..3_u32, 0..3_u32), sensors),
    ) -> Schedule<64> {
        let lags: Vec<_> = lags.into_iter().map(Micros::new).collect();
        let a: Vec<_> = waits.iter().map(|w| Micros::new(w.0 * 1000 + w.2)).collect();
        let b: Vec<_> = waits.iter().map(|w| Micros::new(w.1 * 1000 + w.3)).collect();
        Schedule::from_slices(Micros::from_millis(100), &lags, [&a, &b]).unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn the_fast_check_equals_the_longhand_definition(schedule in any_schedule()) {
        let (a, b) = (waits(&schedule, Phase::A), waits(&schedule, Phase::B));
        for (criterion, longhand) in
            [(Criterion::Paper, longhand_paper(&a, &b)), (Criterion::Exact, longhand_exact(&a, &b))]
        {
            let fast = schedule.separation(criterion);
            prop_assert_eq!(fast.map(|fast| i64::from(fast.value.as_micros())), longhand);
        }
    }

    #[test]
    fn the_report_is_ok_exactly_up_to_its_largest_t_delta(schedule in any_schedule(), stale_echo: bool, paper: bool) {
        let criterion = if paper { Criterion::Paper } else { Criterion::Exact };
        let at = |us| Requirements { criterion, stale_echo, ..Requirements::new(Micros::new(us)) };
        match schedule.verify(&at(0)).max_t_delta() {
            // A single sensor without stale echoes has no limit.
            Some(limit) if limit > Micros::from_millis(1_000) => prop_assert!(schedule.sensors() == 1),
            Some(limit) => {
                prop_assert!(schedule.verify(&at(limit.as_micros())).ok());
                prop_assert!(!schedule.verify(&at(limit.as_micros() + 1)).ok());
            }
            None => prop_assert!(!schedule.verify(&at(0)).ok()),
        }
    }

    // The conditions do not change with the order of the sensors or of the phases.
    #[test]
    fn conditions_do_not_depend_on_order(schedule in any_schedule()) {
        let reversed = |phase| schedule.t_wait(phase).iter().rev().copied().collect::<Vec<_>>();
        let lags: Vec<_> = schedule.t_lag().iter().rev().copied().collect();
        let mirrored =
            Schedule::<64>::from_slices(schedule.period(), &lags, [&reversed(Phase::B), &reversed(Phase::A)]).unwrap();
        for criterion in [Criterion::Paper, Criterion::Exact] {
            prop_assert_eq!(
                schedule.separation(criterion).map(|s| s.value),
                mirrored.separation(criterion).map(|s| s.value)
            );
        }
    }

    #[test]
    fn violations_name_every_pair_that_fails_and_no_other(schedule in any_schedule(), t_delta in 0..4000_u32) {
        let requirements = Requirements { criterion: Criterion::Paper, ..Requirements::new(Micros::new(t_delta)) };
        let (a, b) = (waits(&schedule, Phase::A), waits(&schedule, Phase::B));
        let failing = pairs(a.len())
            .filter(|&(x, y)| x < y && longhand_paper(&[a[x], a[y]], &[b[x], b[y]]).unwrap() <= 2 * i64::from(t_delta))
            .map(|(x, y)| (x as u8, y as u8));
        let mut named: Vec<_> = schedule.verify(&requirements).violations().map(|v| v.sensors).collect();
        named.sort_unstable();
        named.dedup();
        prop_assert_eq!(named, failing.collect::<Vec<_>>());
    }
}

#[test]
fn printed_13a_without_outer_value_fails_on_table_i() {
    for table in [TABLE_I_B, TABLE_I_D] {
        let us = |phase| table.t_wait(phase).iter().map(|t| i64::from(t.as_micros())).collect::<Vec<_>>();
        let (a, b) = (us(Phase::A), us(Phase::B));
        let printed = pairs(12).map(|(x, y)| (a[x] - a[y]).abs() - (b[x] - b[y]).abs()).min();
        assert_eq!(printed, Some(-22_000));
    }
}

// Tables I-b and I-d meet (13a) and (13b) just below one millisecond.
#[test]
fn tables_i_b_and_i_d_hold_below_one_millisecond() {
    for table in [TABLE_I_B, TABLE_I_D, THE_ONE_WITH_19_MS] {
        for criterion in [Criterion::Paper, Criterion::Exact] {
            assert_eq!(table.separation(criterion).unwrap().value, Micros::from_millis(2));
            let at = |us| Requirements { criterion, ..Requirements::new(Micros::new(us)) };
            assert_eq!(table.verify(&at(0)).max_t_delta(), Some(Micros::new(999)));
            assert!(table.verify(&at(999)).ok());
            assert!(!table.verify(&at(1000)).ok());
        }
    }
}

#[test]
fn table_i_a_alternates_nothing_and_rejects_nothing() {
    let report_at = Requirements::new(Micros::ZERO);
    assert_eq!(TABLE_I_A.verify(&report_at).max_t_delta(), None);
    // 66 pairs fail (13a) and (13b) each.
    assert_eq!(TABLE_I_A.verify(&report_at).violations().count(), 132);
}

// Table I-c is Table I-b in firing times, with sensors 4 and 1 one millisecond apart.
#[test]
fn table_i_c_is_table_i_b_in_firing_times() {
    for (phase, sensor) in [Phase::A, Phase::B].into_iter().flat_map(|p| (0..12).map(move |x| (p, x))) {
        assert_eq!(TABLE_I_B.t_fire(phase, sensor), TABLE_I_C.t_fire(phase, sensor));
    }
    let closest = TABLE_I_C.min_interval(Layout::Line(4)).unwrap();
    assert_eq!((closest.value, closest.sensors), (Micros::from_millis(1), (3, 0)));
    assert_eq!(closest.phases, (Phase::A, Phase::B));
}

// Table I-d keeps 19 ms within its blocks but 17 ms within any four adjacent sensors.
#[test]
fn table_i_d_has_19_ms_in_blocks_and_17_ms_adjacent() {
    assert_eq!(TABLE_I_D.min_interval(Layout::Blocks(4)).unwrap().value, Micros::from_millis(19));
    let closest = TABLE_I_D.min_interval(Layout::Line(4)).unwrap();
    assert_eq!((closest.value, closest.sensors), (Micros::from_millis(17), (1, 4)));
    assert_eq!(closest.phases, (Phase::B, Phase::B));
    assert_eq!(THE_ONE_WITH_19_MS.min_interval(Layout::Line(4)).unwrap().value, Micros::from_millis(19));
}

#[test]
fn a_violation_says_who_what_and_where_it_is_from() {
    let requirements = Requirements {
        min_interval: Micros::from_millis(15),
        window: Micros::from_millis(80),
        stale_echo: true,
        ..Requirements::new(Micros::new(1999))
    };
    let texts = |kind| {
        let violations = TABLE_I_B.verify(&requirements).violations();
        violations.filter(|v| v.kind == kind).map(|v| v.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(
        texts(ViolationKind::CrosstalkA)[0],
        "crosstalk between sensors 1 and 2 moves by 2 ms from one reading to the next; \
         to be rejected it needs at least 3.999 ms (Eq. (13a))"
    );
    assert_eq!(texts(ViolationKind::CrosstalkB), [] as [String; 0]);
    assert_eq!(
        texts(ViolationKind::Interval),
        [
            "sensors 4 and 1 fire 1 ms apart between phases a and b; neighbours need at least 15 ms (Sec. 3.1 c)",
            "sensors 4 and 5 fire 9 ms apart between phases a and b; neighbours need at least 15 ms (Sec. 3.1 c)",
            "sensors 8 and 5 fire 9 ms apart between phases a and b; neighbours need at least 15 ms (Sec. 3.1 c)",
        ]
    );
    assert_eq!(
        texts(ViolationKind::Window),
        [
            "sensor 1 fires again 76 ms after phase a; it listens for 80 ms (T_wind)",
            "sensor 2 fires again 78 ms after phase a; it listens for 80 ms (T_wind)"
        ]
    );
    let stale = Requirements { stale_echo: true, ..Requirements::new(Micros::new(2000)) };
    let last = TABLE_I_B.verify(&stale).violations().last().unwrap();
    assert_eq!(
        last.to_string(),
        "an echo of sensor 12 from the period before moves by 4 ms from one reading to the next; \
         to be rejected it needs at least 4.001 ms (Eq. (13b) with x = y)"
    );
}
