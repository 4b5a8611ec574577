//! The conditions for many phases, against tables whose properties are known and against obvious loops.

use eeruf_core::{
    Criterion, Layout, Micros, Phase, Requirements, Schedule,
    conditions::ViolationKind,
    hopping::{HoppingCode, HoppingSchedule},
    phases::PhaseTable,
    tables::TABLE_I_D,
};
use proptest::prelude::*;
use serde_json::Value;

use crate::common::random::Random;

const AUDIBLE: Requirements<'static> = heard(36_000, 2380, 40_000);

/// A window, blanking time, and how long sound is heard.
const fn heard(window: u32, blanking: u32, audible: u32) -> Requirements<'static> {
    Requirements {
        window: Micros::new(window),
        blanking: Micros::new(blanking),
        audible: Some(Micros::new(audible)),
        ..Requirements::new(Micros::ZERO)
    }
}

const fn spaced(layout: Layout<'_>) -> Requirements<'_> {
    Requirements { layout, ..Requirements::new(Micros::ZERO) }
}

/// Kind, sensors, period, firing times by phase, and what is known of them.
type Case = (String, usize, u32, Vec<Vec<u32>>, [u32; 3]);

/// The cases of `tests/data/hopping-schedules.json`: kind, sensors, period, firing times, separation at one age, gap
/// between a sensor's firings, nearest neighbours.
fn cases() -> Vec<Case> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/hopping-schedules.json");
    let json: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let number = |value: &Value| u32::try_from(value.as_u64().unwrap()).unwrap();
    let case = |case: &Value| {
        let rows = case["t_fire_us"].as_array().unwrap().iter();
        let times = rows.map(|row| row.as_array().unwrap().iter().map(number).collect()).collect();
        let facts = ["separation_us", "gap_us", "nearest_neighbours_us"].map(|name| number(&case[name]));
        let sensors = number(&case["sensors"]) as usize;
        (case["kind"].as_str().unwrap().to_owned(), sensors, number(&case["period_us"]), times, facts)
    };
    json["cases"].as_array().unwrap().iter().map(case).collect()
}

fn check<const K: usize>(kind: &str, period_us: u32, times: &[Vec<u32>], [separation, gap, nearest]: [u32; 3]) {
    let rows: Vec<[Micros; K]> = times.iter().map(|row| std::array::from_fn(|x| Micros::new(row[x]))).collect();
    let table = PhaseTable::new(Micros::new(period_us), &rows);
    let least = table.separation(&AUDIBLE).unwrap();
    if kind == "slots" {
        // The path reads nearly the same with two ages, though each age by itself is separated.
        assert!(least.value.as_micros() <= 130 && least.ages.0 != least.ages.1, "{least:?}");
    } else {
        assert_eq!(least.value.as_micros(), separation, "{kind}: {least:?}");
        assert_eq!(least.ages.0, least.ages.1);
    }
    // What it names moves by so much.
    let path = |phase: Phase, age: i8| {
        let (phase, age) = (i64::from(phase.0), i64::from(age));
        let sent = (phase - age).rem_euclid(times.len() as i64);
        let t_fire = |phase: i64, sensor: u8| i64::from(times[phase as usize][usize::from(sensor)]);
        t_fire(sent, least.sensors.0) - age * i64::from(period_us) - t_fire(phase, least.sensors.1)
    };
    let (one, other) = (path(least.phases.0, least.ages.0), path(least.phases.1, least.ages.1));
    assert_eq!((one - other).unsigned_abs(), u64::from(least.value.as_micros()), "{least:?}");
    assert_eq!(table.min_refire().map(|refire| refire.value), Some(Micros::new(gap)));
    assert_eq!(table.min_interval(&spaced(Layout::Line(4))).map(|interval| interval.value), Some(Micros::new(nearest)));
}

// Tables of many phases are as separate as is known and those of slots only at one age.
#[test]
fn many_phase_tables_are_as_separate_as_known() {
    let cases = cases();
    assert_eq!(cases.len(), 14);
    for (kind, sensors, period_us, times, facts) in &cases {
        match sensors {
            8 => check::<8>(kind, *period_us, times, *facts),
            12 => check::<12>(kind, *period_us, times, *facts),
            _ => panic!("{sensors} sensors"),
        }
    }
}

#[test]
fn the_code_of_eight_sensors_is_the_known_one() {
    let (_, _, _, times, _) = cases().into_iter().next().unwrap();
    let code = HoppingCode::of(8, 11, 1, Micros::new(240)).unwrap();
    let lags = std::array::from_fn(|sensor| Micros::new(14_400 * (sensor as u32 % 4)));
    let schedule = HoppingSchedule::<8>::new(code, Micros::from_millis(60), lags).unwrap();
    for (row, known) in schedule.table::<11>().iter().zip(&times) {
        assert!(row.iter().map(|time| time.as_micros()).eq(known.iter().copied()));
    }
}

#[test]
fn two_phases_are_as_separate_as_13a_and_13b_say() {
    let rows = [0, 1].map(|phase| std::array::from_fn::<_, 12, _>(|x| TABLE_I_D.t_fire(Phase(phase), x).unwrap()));
    let table = PhaseTable::new(TABLE_I_D.period(), &rows);
    // All that can be heard: sound lives for two periods.
    let audible = heard(76_000, 0, 200_000);
    let least = table.separation(&audible).unwrap();
    assert_eq!(least.value, TABLE_I_D.separation(Criterion::Exact).unwrap().value);
    assert_eq!(table.min_refire().map(|refire| refire.value), Some(TABLE_I_D.min_refire()));
    let interval = TABLE_I_D.min_interval(Layout::Line(4)).unwrap().value;
    assert_eq!(table.min_interval(&spaced(Layout::Line(4))).map(|interval| interval.value), Some(interval));
}

#[test]
fn every_code_up_to_64_sensors_is_as_separate_as_its_step() {
    fn of<const K: usize, const M: usize>() {
        let code = HoppingCode::new(K, 2, Micros::new(100)).unwrap();
        assert_eq!(usize::from(code.phases()), M);
        let table = HoppingSchedule::<K>::spread(code, Micros::from_millis(60)).unwrap().table::<M>();
        let least = PhaseTable::new(Micros::from_millis(60), &table).separation(&AUDIBLE).unwrap();
        assert_eq!(least.value.as_micros(), 100, "{K}: {least:?}");
    }
    of::<2, 4>();
    of::<5, 6>();
    of::<12, 16>();
    of::<16, 18>();
    of::<24, 28>();
    of::<64, 66>();
}

proptest! {
    #[test]
    fn with_two_phases_the_conditions_are_the_papers(
        lags in proptest::array::uniform5(0..30_000_u32),
        waits in proptest::array::uniform2(proptest::array::uniform5(0..8_u32)),
        t_delta in 0..2_000_u32,
        interval in 0..6_000_u32,
        stale_echo in any::<bool>(),
    ) {
        let period = Micros::new(100_000);
        let lag = lags.map(Micros::new);
        let wait = waits.map(|row| row.map(|wait| Micros::new(1_000 * wait)));
        let schedule = Schedule::<5>::new(period, lag, wait).unwrap();
        let rows = [0, 1].map(|phase| std::array::from_fn::<_, 5, _>(|x| schedule.t_fire(Phase(phase), x).unwrap()));
        let (min_interval, layout) = (Micros::new(interval), Layout::Line(3));
        let window = Micros::new(60_000);
        let two = Requirements { min_interval, layout, window, stale_echo, ..Requirements::new(Micros::new(t_delta)) };
        // All ages of which the paper speaks can be heard.
        let many = Requirements { audible: Some(Micros::new(250_000)), ..two };
        let (two, many) = (schedule.verify(&two), PhaseTable::new(period, &rows).verify(&many));
        prop_assert_eq!(many.ok(), two.ok());
        prop_assert_eq!(many.max_t_delta(), two.max_t_delta());
        prop_assert_eq!(many.separation().map(|found| found.value), two.separation().map(|found| found.value));
        prop_assert_eq!(many.min_interval().map(|found| found.value), two.min_interval().map(|found| found.value));
        prop_assert_eq!(many.min_refire(), two.min_refire());
    }

    #[test]
    fn what_is_proven_of_a_code_is_what_its_table_says(
        sensors in 1..=9_usize,
        phases in 2..=13_u8,
        step in 1..700_u32,
        is_shortest in any::<bool>(),
        lags in proptest::array::uniform9(0..20_000_u32),
        t_delta in 1..400_u32,
    ) {
        let step = Micros::new(step);
        let of = if is_shortest { HoppingCode::shortest } else { HoppingCode::new };
        let code = of(sensors, phases, step).unwrap();
        let schedule = HoppingSchedule::<9>::new(code, Micros::new(40_000), lags.map(Micros::new)).unwrap();
        let requirements = Requirements {
            criterion: Criterion::Margin(Micros::new(90)),
            min_interval: Micros::new(1_000),
            window: Micros::new(30_000),
            ..Requirements::new(Micros::new(t_delta))
        };
        let rows = schedule.table::<67>();
        let table = PhaseTable::new(schedule.period(), &rows[..code.phases().into()]).with_sensors(sensors);
        let (proven, worked_out) = (schedule.verify(&requirements), table.verify(&requirements));
        // A path may be heard in one phase alone; then there is nothing to separate.
        if let Some(found) = worked_out.separation() {
            prop_assert!(found.value >= step);
        }
        prop_assert_eq!(proven.max_t_delta().is_some(), sensors > 1 && step.as_micros() >= 90);
        prop_assert_eq!(proven.min_interval(), worked_out.min_interval());
        prop_assert_eq!(proven.min_refire(), worked_out.min_refire());
    }
}

#[test]
fn a_violation_names_sensors_phases_and_what_would_do() {
    let rows = [[0, 2_000], [500, 2_600], [700, 3_000]].map(|row| row.map(Micros::new));
    let table = PhaseTable::new(Micros::new(20_000), &rows);
    let requirements = Requirements {
        min_interval: Micros::new(2_050),
        layout: Layout::Line(2),
        window: Micros::new(19_500),
        ..Requirements::new(Micros::new(150))
    };
    let violations: Vec<_> = table.verify(&requirements).violations().map(|found| found.to_string()).collect();
    let expected = [
        "sound of sensor 1 moves by 100 us for sensor 2 from phase a (0 periods old) to phase b (0 periods old); \
         to be rejected it needs at least 301 us (Eqs. (13a), (13b) for many phases)",
        "sensors 1 and 2 fire 2 ms apart in phase a; neighbours need at least 2.05 ms (Sec. 3.1 c)",
        "sensor 2 fires again 19 ms after phase c; it listens for 19.5 ms (T_wind)",
    ];
    assert_eq!(violations, expected);
    // A margin that the step leaves is enough by the second criterion.
    let loose = Requirements { criterion: Criterion::Margin(Micros::new(50)), ..requirements };
    let loose = Requirements { t_delta: Micros::new(50), ..loose };
    assert!(!table.verify(&loose).violations().any(|found| found.kind == ViolationKind::Crosstalk));
    assert_eq!(table.verify(&loose).max_t_delta(), Some(Micros::new(50)));
}

// An interval too long for 32 bits is not taken for a short one.
#[test]
fn interval_beyond_32_bits_is_not_short() {
    // From the one sensor to the other in the next period it is 2^32 + 4 us.
    let times = [[Micros::ZERO, Micros::new(5)]];
    let table = PhaseTable::new(Micros::MAX, &times);
    assert_eq!(table.min_interval(&spaced(Layout::Line(2))).unwrap().value, Micros::new(5));
}

// A path that is heard in one phase only counts for no separation.
#[test]
fn path_in_one_phase_counts_for_no_separation() {
    let us = Micros::new;
    // By half a period the one firing moves: no window of 5 ms hears a path in both phases, of whatever length.
    let rows = [[us(0), us(10_000)], [us(0), us(40_000)]];
    let table = PhaseTable::new(us(60_000), &rows);
    let audible = |window| heard(window, 0, 200_000);
    assert_eq!(table.separation(&audible(29_999)), None);
    assert_eq!(table.separation(&audible(30_000)).map(|least| least.value), Some(us(30_000)));
}

/// Separation of a table of two sensors, by trying each length of a path: from x to y, of any two phases and ages.
fn tried(times: &[[u32; 2]], period: u32, asked: &Requirements<'_>, stale: bool) -> Option<u32> {
    let phases = times.len() as i64;
    let us = |time: Micros| i64::from(time.as_micros());
    // What a path of this length reads in a phase, if its sound is this many periods old.
    let reading = |x: usize, y: usize, (phase, age): (i64, i64), length: i64| {
        let sent = (phase - age).rem_euclid(phases) as usize;
        i64::from(times[sent][x]) + length - i64::from(times[phase as usize][y]) - age * i64::from(period)
    };
    let heard = |reads: i64| (us(asked.blanking)..=us(asked.window)).contains(&reads);
    // Its own sound counts however long its path is.
    let reach = if stale { i64::from(6 * period) } else { us(asked.audible.unwrap_or_default()) };
    let events: Vec<_> = (0..phases).flat_map(|phase| (-1..=3).map(move |age| (phase, age))).collect();
    let mut least = None;
    for (x, y) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        for &one in &events {
            for &other in events.iter().filter(|other| other.0 > one.0) {
                // Own sound that is no period old, or a whole cycle, is as it should be.
                let counts = if stale { x == y && one.1 % phases != 0 && other.1 % phases != 0 } else { x != y };
                let lengths = (0..=reach).filter(|_| counts);
                for (a, b) in lengths.map(|length| (reading(x, y, one, length), reading(x, y, other, length))) {
                    if heard(a) && heard(b) {
                        least = Some(least.map_or(a.abs_diff(b), |least: u64| least.min(a.abs_diff(b))));
                    }
                }
            }
        }
    }
    least.map(|least| least as u32)
}

#[test]
fn a_table_is_as_separate_as_trying_each_length_of_a_path_finds() {
    let (mut random, mut apart, mut by_age) = (Random(11), 0, [0; 5]);
    for _ in 0..800 {
        let (phases, period) = (2 + random.up_to(3) as usize, 8 + random.up_to(12));
        let times: Vec<[u32; 2]> = (0..phases).map(|_| [(); 2].map(|()| random.up_to(period + 2))).collect();
        let audible = heard(2 + random.up_to(period), random.up_to(3), random.up_to(4 * period));
        let rows: Vec<_> = times.iter().map(|row| row.map(Micros::new)).collect();
        let table = PhaseTable::new(Micros::new(period), &rows);
        for (stale, says) in [(false, table.separation(&audible)), (true, table.stale_separation(&audible))] {
            let value = says.map(|separation| separation.value.as_micros());
            assert_eq!(value, tried(&times, period, &audible, stale), "{times:?}, {period} us, {audible:?}, {stale}");
            apart += u32::from(value.is_some_and(|value| value > 0));
            for age in says.iter().flat_map(|separation| [separation.ages.0, separation.ages.1]) {
                by_age[usize::try_from(age + 1).unwrap()] += 1;
            }
        }
    }
    assert!(apart > 200 && by_age.iter().all(|&often| often > 5), "{apart} {by_age:?}");
}

// Neighbours that fire last and first are close across the end of a period.
#[test]
fn neighbours_are_close_across_the_period_end() {
    let rows = [[0, 50], [20, 50], [0, 45]].map(|row| row.map(Micros::from_millis));
    let table = PhaseTable::new(Micros::from_millis(60), &rows);
    let least = table.min_interval(&spaced(Layout::Line(2))).unwrap();
    // The second sensor after 50 ms of phase 1, and the first at once in phase 2.
    assert_eq!((least.value, least.sensors, least.phases), (Micros::from_millis(10), (1, 0), (Phase(1), Phase(2))));
}

/// Two sensors that move by 500 us and 3 ms from one phase to the other: crosstalk moves by 2.5 ms, the first one's own
/// stale echo by 1 ms.
const MOVING: [[Micros; 2]; 2] = [[Micros::ZERO, Micros::new(20_000)], [Micros::new(500), Micros::new(23_000)]];

/// Requirements that `MOVING` just keeps at a period of 60 ms.
const JUST_KEPT: Requirements<'static> = Requirements {
    criterion: Criterion::Margin(Micros::new(600)),
    window: Micros::new(57_000),
    audible: Some(Micros::new(100_000)),
    min_interval: Micros::new(20_000),
    layout: Layout::Line(2),
    stale_echo: true,
    ..Requirements::new(Micros::new(400))
};

#[test]
fn what_is_kept_just_so_is_kept_and_a_microsecond_more_is_named() {
    let table = PhaseTable::new(Micros::new(60_000), &MOVING);
    let kept = table.verify(&JUST_KEPT);
    assert_eq!((kept.ok(), kept.violations().next()), (true, None));
    let margin = |us| Criterion::Margin(Micros::new(us));
    let stale = Requirements { criterion: margin(601), ..JUST_KEPT };
    let crosstalk = Requirements { criterion: margin(2_101), stale_echo: false, ..JUST_KEPT };
    let interval = Requirements { min_interval: Micros::new(20_001), ..JUST_KEPT };
    let window = Requirements { window: Micros::new(57_001), ..JUST_KEPT };
    // As `--json` and Python spell them, and where they come from.
    for (asked, name, source) in [
        (crosstalk, "crosstalk", "Eqs. (13a), (13b) for many phases"),
        (stale, "stale_echo", "Eq. (13b)"),
        (interval, "interval", "Sec. 3.1 c"),
        (window, "window", "T_wind"),
    ] {
        let found = table.verify(&asked);
        let named: Vec<_> =
            found.violations().map(|violation| (violation.kind.as_str(), violation.kind.source())).collect();
        assert_eq!((found.ok(), named), (false, vec![(name, source)]));
    }
}

// A stale echo that moves less than crosstalk limits t delta where it is asked for.
#[test]
fn stale_echo_limits_t_delta_where_asked() {
    let table = PhaseTable::new(Micros::new(60_000), &MOVING);
    let found = |stale_echo, criterion| {
        let asked = Requirements { stale_echo, criterion, ..JUST_KEPT };
        let found = table.verify(&asked);
        (found.stale_separation().map(|stale| stale.value), found.max_t_delta())
    };
    let us = |us| Some(Micros::new(us));
    assert_eq!(found(true, JUST_KEPT.criterion), (us(1_000), us(400)));
    assert_eq!(found(true, Criterion::Exact), (us(1_000), us(499)));
    assert_eq!(found(false, JUST_KEPT.criterion), (None, us(1_900)));
}
