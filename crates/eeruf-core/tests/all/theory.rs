//! The numbers of `docs/explanation/theory.md`, section by section, against the code; its tables are read from the page
//! itself.
//!
//! Claims with a test of their own are not repeated: (13a), (13b) pair by pair, the rearrangements of Table I, nested
//! loops for tables of waits, and that every period of `tests/data/shortest-periods.json` is the shortest.

use eeruf_core::search::{Budget, Found, WaitProblem, WaitSearch, memory_words};
use eeruf_core::tables::{TABLE_I_B, TABLE_I_C, TABLE_I_D, THE_ONE_WITH_19_MS};
use eeruf_core::{Criterion, Layout, Micros, Phase, Requirements, Schedule, conditions::Least};
use eeruf_period::{PeriodProblem, ShortestPeriod};

const THEORY: &str = include_str!("../../../../docs/explanation/theory.md");

const fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

/// The cells of each row below the header of the table whose header begins with `first`.
fn table(first: &str) -> Vec<Vec<&'static str>> {
    let mut lines = THEORY.lines().skip_while(|line| !line.starts_with(&format!("| {first} |")));
    let cells = |line: &'static str| line.trim_matches('|').split('|').map(str::trim).collect::<Vec<_>>();
    let header = lines.next().map(cells).expect("the table is there");
    let rows: Vec<_> = lines.skip(1).take_while(|line| line.starts_with('|')).map(cells).collect();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == header.len()), "{rows:?}");
    [vec![header], rows].concat()
}

/// A row of a figure: a name, then numbers in columns.
fn row(name: &str, places: usize, width: usize, numbers: impl Iterator<Item = i32>) -> String {
    numbers.fold(format!("{name:<places$}"), |row, number| format!("{row}{number:>width$}"))
}

fn fire_ms(schedule: &Schedule<12>, phase: Phase, sensor: usize) -> i32 {
    let t_fire = schedule.t_fire(phase, sensor).expect("the sensor is there");
    i32::try_from(t_fire.as_micros()).unwrap() / 1000
}

/// The needs of the examples: I = 15, D = 2.
fn needs(sensors: usize, layout: Layout<'_>, window: u32) -> PeriodProblem<'_> {
    let requirements =
        Requirements { layout, min_interval: ms(15), window: ms(window), ..Requirements::new(Micros::new(999)) };
    PeriodProblem { sensors, requirements, tick: ms(1) }
}

fn shortest(needs: &PeriodProblem<'_>, budget: u64) -> ShortestPeriod {
    needs.shortest(budget, &mut ()).expect("the needs make sense")
}

/// The paper's lags and its period of 100 ms, four neighbours of a line, and waits up to 24 ms.
fn waits(sensors: usize, t_delta_us: u32, tick_us: u32) -> WaitSearch {
    let problem = WaitProblem {
        sensors,
        period: ms(100),
        wait_max: ms(24),
        tick: Micros::new(tick_us),
        t_lag: None,
        t_delta: Micros::new(t_delta_us),
        min_interval: Micros::ZERO,
        neighbours: 4,
        layout: Layout::Line(4),
        criterion: Criterion::Exact,
    };
    WaitSearch::new(&problem).expect("the needs make sense")
}

fn best_interval(search: &WaitSearch) -> Found<24> {
    let mut memory = vec![0; memory_words(24)];
    search.best_interval(&mut memory, &mut Budget::unlimited()).expect("memory suffices")
}

// Section 2: crosstalk from sensor 1 to 2 of Table I-d reads as in the example.
#[test]
fn section_2_example_of_table_i_d_holds() {
    assert_eq!((TABLE_I_D.shift_us(0), TABLE_I_D.shift_us(1)), (6_000, 12_000));
    let reads = |travels: i32, old: i32, own: Phase, of_sender: Phase| {
        travels - 100 * old + fire_ms(&TABLE_I_D, of_sender, 0) - fire_ms(&TABLE_I_D, own, 1)
    };
    let (a, b) = (Phase::A, Phase::B);
    assert_eq!((reads(40, 0, a, a), reads(40, 0, b, b)), (15, 21));
    assert_eq!((reads(140, 1, a, b), reads(140, 1, b, a)), (9, 27));
    // As printed, (13a) of sensors 1 and 12 of Table I-b.
    let wait = |phase, sensor: usize| TABLE_I_B.t_wait(phase)[sensor];
    assert_eq!((wait(a, 0), wait(a, 11), wait(b, 0), wait(b, 11)), (ms(24), ms(24), ms(0), ms(22)));
}

// Section 3: the difference of two sizes is the smaller of difference and sum.
#[test]
fn section_3_difference_of_two_sizes_holds() {
    for (p, q) in (-20_i32..=20).flat_map(|p| (-20_i32..=20).map(move |q| (p, q))) {
        assert_eq!((p.abs() - q.abs()).abs(), (p - q).abs().min((p + q).abs()));
    }
}

#[test]
fn section_3_the_marks_on_the_ruler_are_those_of_table_i_d() {
    let mut marks: Vec<_> = (0..12).map(|x| (TABLE_I_D.shift_us(x).abs() / 1000, x as i32 + 1)).collect();
    marks.sort_unstable();
    assert!(THEORY.contains(&row("|d|", 5, 4, marks.iter().map(|mark| mark.0))));
    assert!(THEORY.contains(&row("sensor", 5, 4, marks.iter().map(|mark| mark.1)).replace("sensor   ", "sensor  ")));
}

#[test]
fn section_3_the_smallest_intervals_of_table_i_are_as_tabled() {
    let closest = |value, sensors, phases| Some(Least { value: ms(value), sensors, phases });
    let (a, b) = (Phase::A, Phase::B);
    for table in [TABLE_I_B, TABLE_I_C] {
        assert_eq!(table.min_interval(Layout::Line(4)), closest(1, (3, 0), (a, b)));
    }
    assert_eq!(TABLE_I_D.min_interval(Layout::Line(4)), closest(17, (1, 4), (b, b)));
    let tabled: Vec<_> = table("table").into_iter().skip(1).map(|row| row[1]).collect();
    assert_eq!(tabled, ["1 ms", "19 ms", "17 ms", "19 ms"]);
    assert_eq!(TABLE_I_D.min_interval(Layout::Blocks(4)).unwrap().value, ms(19));
    assert_eq!(THE_ONE_WITH_19_MS.min_interval(Layout::Line(4)).unwrap().value, ms(19));
    let b = THE_ONE_WITH_19_MS.t_wait(b).iter().map(|wait| (wait.as_micros() / 1000).to_string());
    assert!(THEORY.contains(&format!("b = {}", b.collect::<Vec<_>>().join(" "))));
}

// Section 4: Table I-d rejects stale echoes; a sensor that alternates nothing does not.
#[test]
fn section_4_table_i_d_rejects_stale_echoes() {
    let stale = Requirements { stale_echo: true, ..Requirements::new(Micros::new(999)) };
    assert!(TABLE_I_D.verify(&stale).ok());
    let alone = Schedule::<1>::from_firing(ms(100), [[ms(0)]; 2]).unwrap();
    assert!(!alone.verify(&stale).ok());
}

#[test]
fn section_5_1_the_simple_bounds_are_as_computed() {
    let bound = |needs: &PeriodProblem<'_>| shortest(needs, 0).bound;
    assert_eq!(bound(&needs(12, Layout::Line(4), 60)), ms(60 + 2 * 11));
    assert_eq!(bound(&needs(4, Layout::Line(4), 15)), ms(60));
    assert!(bound(&needs(10, Layout::Ring(4), 15)) >= ms(75));
    // 105 by density, and one tick more because the moves of a permutation sum to 0 (section 5.3).
    assert_eq!(bound(&needs(7, Layout::Ring(4), 15)), ms(106));
    // Waits up to 24 ms hold 13 values |d|, and no 14.
    let found = |sensors| best_interval(&waits(sensors, 999, 1000)).schedule.is_some();
    assert!(found(13) && !found(14));
}

// Section 5.2: the best intervals of the paper's lags meet the bound.
#[test]
fn section_5_2_papers_lags_meet_the_bound() {
    for (tick_us, best_us) in [(1000, 19_000), (500, 19_500), (100, 19_500)] {
        let best = best_interval(&waits(12, 999, tick_us));
        assert_eq!((best.value, best.proven), (Some(Micros::new(best_us)), true));
    }
    // Half the separation, D = 1.
    let [sensors, best] = &table("K")[..] else { panic!("two rows") };
    for (sensors, best) in sensors.iter().zip(best).skip(1) {
        let (sensors, best): (usize, u32) = (sensors.parse().unwrap(), best.parse().unwrap());
        assert_eq!(best, (100 - (sensors as u32 - 1)) / 4);
        let found = best_interval(&waits(sensors, 499, 1000));
        assert_eq!((found.value, found.proven), (Some(ms(best)), true));
    }
}

// Section 5.2: the construction works at 82 ms and at no shorter period.
#[test]
fn section_5_2_construction_serves_at_82_ms() {
    let (n, separation, groups) = (4, 2, 3);
    let b = core::array::from_fn(|i| i as u32 % n * 15);
    let d: [u32; 12] = core::array::from_fn(|i| separation * (i as u32 % n * groups + i as u32 / n));
    let a: [u32; 12] = core::array::from_fn(|i| b[i] + d[i]);
    for (name, times) in [("phase b", b), ("phase a", a), ("d", d)] {
        assert!(THEORY.contains(&row(name, 10, 4, times.iter().map(|&time| time as i32))), "{name} {times:?}");
    }
    let needs = needs(12, Layout::Line(4), 60);
    let schedule = Schedule::from_firing(ms(82), [a.map(ms), b.map(ms)]).unwrap();
    assert!(schedule.verify(&needs.requirements).ok());
    assert_eq!(shortest(&needs, 100_000).period(), ms(82));
}

// Section 5.3: four neighbours need 60 ms in another order, and 66 ms with a long window.
#[test]
fn section_5_3_four_neighbours_need_60_ms() {
    let times = |times: [u32; 4]| times.map(ms);
    let (a, b) = (times([30, 15, 45, 0]), times([0, 15, 30, 45]));
    let needs_15 = needs(4, Layout::Line(4), 15);
    let schedule = Schedule::from_firing(ms(60), [a, b]).unwrap();
    assert!(schedule.verify(&needs_15.requirements).ok());
    assert_eq!(schedule.separation(Criterion::Exact).unwrap().value, ms(15));
    assert_eq!(schedule.min_refire(), ms(15));
    let found = shortest(&needs_15, 100_000);
    assert_eq!((found.period(), found.proven()), (ms(60), true));
    let found = shortest(&needs(4, Layout::Line(4), 60), 100_000);
    assert_eq!((found.period(), found.proven()), (ms(60 + 2 * 3), true));
}

/// Values of the formulas of sections 5.1, 5.3 and 5.4 for n = 4, I = 15, D = 2 and R = 15, 30, 45 or 60.
fn by_formula(layout: &str, sensors: u32, window: u32) -> u32 {
    let groups = sensors / 4;
    let line = match window {
        15 => 60 + 2 * (groups - 1),
        30 => 60 + 2 * groups - 1,
        45 => 60 + 2 * (2 * groups - 1),
        _ => 0,
    };
    let ring = if layout == "ring" { 60 + 2 * groups } else { 0 };
    let classes = line.max(ring).min(60 + 15_u32.div_ceil(2));
    classes.max(window + 2 * (sensors - 1)).max(60)
}

// Section 5.3: the shortest periods are those of the corpus, and 28 of 32 follow from formulas.
#[test]
fn section_5_3_shortest_periods_are_those_of_the_corpus() {
    let corpus: serde_json::Value =
        serde_json::from_str(include_str!("../../../../tests/data/shortest-periods.json")).unwrap();
    let rows = table("ring");
    let (mut cells, mut exceptions) = (0, Vec::new());
    for row in &rows[1..] {
        let (layout, sensors) = row[0].split_once(' ').unwrap();
        let sensors: u32 = sensors.parse().unwrap();
        for (window, cell) in rows[0].iter().zip(row).skip(1) {
            let window: u32 = window.strip_prefix("R = ").unwrap().parse().unwrap();
            let wanted = serde_json::json!({ "sensors": sensors, "layout": layout, "window": window, "neighbours": 4,
                "separation": 2, "min_interval": 15, "tick_us": 1000, "stale_echo": false });
            let wanted = wanted.as_object().unwrap();
            let mut cases = corpus["cases"].as_array().unwrap().iter();
            let case = cases.find(|case| wanted.iter().all(|(key, value)| case[key] == *value)).unwrap();
            assert_eq!(case["period"].to_string(), *cell, "{layout} {sensors} {window}");
            let period: u32 = cell.parse().unwrap();
            cells += 1;
            if by_formula(layout, sensors, window) != period {
                assert!(by_formula(layout, sensors, window) < period);
                exceptions.push((layout, sensors, window));
            }
        }
    }
    assert_eq!(cells, 32);
    assert_eq!(exceptions, [("line", 12, 45), ("ring", 8, 30), ("ring", 12, 45), ("ring", 24, 15)]);
}

// Section 5.3: counting alone ends below the four that were searched.
#[test]
fn section_5_3_counting_ends_below_four_searched() {
    // Without a search node, the bound comes from counting.
    let bound = |sensors, layout, window| shortest(&needs(sensors, layout, window), 0).bound;
    assert_eq!(bound(12, Layout::Line(4), 45), ms(68));
    assert_eq!(bound(12, Layout::Ring(4), 45), ms(68));
    assert_eq!(bound(8, Layout::Ring(4), 30), ms(64));
    assert_eq!(bound(24, Layout::Ring(4), 15), ms(68));
}

// Section 5.5: finer ticks gain half a millisecond for a line of twelve.
#[test]
fn section_5_5_finer_ticks_gain_half_a_millisecond() {
    for (tick_us, period_us) in [(1000, 70_000), (100, 69_500)] {
        let needs = PeriodProblem { tick: Micros::new(tick_us), ..needs(12, Layout::Line(4), 45) };
        let found = shortest(&needs, 100_000);
        assert_eq!((found.period(), found.proven()), (Micros::new(period_us), true));
    }
}

// Section 6.1: the closed matrix is that of three firings in order.
#[test]
fn section_6_1_closed_matrix_is_of_three_firings() {
    let far = 1000;
    let mut most = [[0, 0, 0, 0], [65, 0, -15, far], [65, far, 0, -15], [65, far, far, 0]];
    for over in 0..4 {
        for (u, v) in (0..4).flat_map(|u| (0..4).map(move |v| (u, v))) {
            most[u][v] = most[u][v].min(most[u][over] + most[over][v]);
        }
    }
    for (name, cells) in ["start", "a_x", "a_y", "a_z"].into_iter().zip(most) {
        assert!(THEORY.contains(&row(name, 22, 7, cells.into_iter())), "{name} {cells:?}");
    }
}

// Section 7: the best interval takes a few dozen nodes, and three neighbours have 3912 tables.
#[test]
fn section_7_best_interval_takes_few_nodes() {
    assert!(best_interval(&waits(12, 999, 1000)).nodes < 100);
    let problem = WaitProblem {
        sensors: 3,
        period: ms(30),
        wait_max: ms(6),
        tick: ms(1),
        t_lag: None,
        t_delta: Micros::new(999),
        min_interval: ms(5),
        neighbours: 3,
        layout: Layout::Line(3),
        criterion: Criterion::Paper,
    };
    let search = WaitSearch::new(&problem).unwrap();
    assert_eq!(search.count(None, &mut [], &mut Budget::unlimited()).1, 3912);
}

#[test]
fn section_8_a_robot_with_table_i_d_may_drive_at_1_38_m_s() {
    assert_eq!(TABLE_I_D.max_refire(), ms(124));
    assert_eq!(TABLE_I_D.max_speed_mm_s(Micros::new(999), 343_200), 1382);
}
