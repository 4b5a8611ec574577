//! The conditions for many phases, against tables whose properties are known and against obvious loops.

use eeruf_core::{Audible, HoppingCode, HoppingSchedule, Layout, Micros, PhaseTable, tables::TABLE_I_D};
use serde_json::Value;

const AUDIBLE: Audible =
    Audible { window: Micros::new(36_000), blanking: Micros::new(2380), reach: Micros::new(40_000) };

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
    assert_eq!(table.min_refire(), Some(Micros::new(gap)));
    assert_eq!(table.min_interval(Layout::Line(4)), Some(Micros::new(nearest)));
}

#[test]
fn tables_of_many_phases_are_as_separate_as_is_known_and_those_of_slots_only_at_one_age() {
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
    let code = HoppingCode::new(8, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<8>::spread(code, Micros::from_millis(60), 4).unwrap();
    for (row, known) in schedule.table::<11>().iter().zip(&times) {
        assert!(row.iter().map(|time| time.as_micros()).eq(known.iter().copied()));
    }
}

#[test]
fn two_phases_are_as_separate_as_13a_and_13b_say() {
    let rows =
        [0, 1].map(|phase| std::array::from_fn::<_, 12, _>(|x| TABLE_I_D.t_fire(eeruf_core::Phase(phase), x).unwrap()));
    let table = PhaseTable::new(TABLE_I_D.period(), &rows);
    // All that can be heard: sound lives for two periods.
    let audible = Audible { reach: Micros::from_millis(200), ..Audible::new(Micros::from_millis(76)) };
    let least = table.separation(&audible).unwrap();
    assert_eq!(least.value, TABLE_I_D.separation(eeruf_core::Criterion::Exact).unwrap().value);
    assert_eq!(table.min_refire(), Some(TABLE_I_D.min_refire()));
    let interval = TABLE_I_D.min_interval(Layout::Line(4)).unwrap().value;
    assert_eq!(table.min_interval(Layout::Line(4)), Some(interval));
}

#[test]
fn every_code_up_to_64_sensors_is_as_separate_as_its_step() {
    fn of<const K: usize, const M: usize>() {
        let code = HoppingCode::new(K, 2, Micros::new(100)).unwrap();
        assert_eq!(usize::from(code.phases()), M);
        let table = HoppingSchedule::<K>::spread(code, Micros::from_millis(60), 4).unwrap().table::<M>();
        let least = PhaseTable::new(Micros::from_millis(60), &table).separation(&AUDIBLE).unwrap();
        assert_eq!(least.value.as_micros(), 100, "{K}: {least:?}");
    }
    of::<2, 3>();
    of::<5, 7>();
    of::<12, 13>();
    of::<16, 17>();
    of::<24, 29>();
    of::<64, 67>();
}
