//! Tests of the paper's tables, the shared cases, a ring and a search on the board itself.
#![no_std]
#![no_main]

use eeruf_core::search::{Budget, Outcome, WaitProblem, WaitSearch};
use eeruf_core::tables::{PAPER_12, TABLE_I_A, TABLE_I_B, TABLE_I_C, TABLE_I_D, THE_ONE_WITH_19_MS};
use eeruf_core::{
    Criterion, Instant, Layout, Micros, Phase, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Schedule,
    ScheduledRing, Tally,
};
use eeruf_on_target::{run, tests};

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

/// A schedule with the shortest period for its needs, in ticks.
struct ShortestPeriod {
    layout: Layout<'static>,
    tick_us: u32,
    min_interval: u32,
    separation: u32,
    window: u32,
    stale_echo: bool,
    period: u32,
    fire_a: &'static [u32],
    fire_b: &'static [u32],
}

include!(concat!(env!("OUT_DIR"), "/cases.rs"));

fn tables_i_b_and_i_d_are_separated_by_2_ms_and_i_a_by_nothing() {
    for criterion in [Criterion::Paper, Criterion::Exact] {
        for table in [TABLE_I_B, TABLE_I_C, TABLE_I_D, THE_ONE_WITH_19_MS] {
            // Table I-c gives firing times, which say nothing about the sums of waits.
            if table != TABLE_I_C || criterion == Criterion::Exact {
                assert_eq!(table.separation(criterion).map(|least| least.value), Some(Micros::from_millis(2)));
            }
        }
        assert_eq!(TABLE_I_A.separation(criterion).map(|least| least.value), Some(Micros::ZERO));
    }
}

fn table_i_d_keeps_19_ms_in_its_blocks_and_17_ms_on_the_line() {
    let interval = |table: &Schedule<12>, layout| table.min_interval(layout).map(|least| least.value);
    assert_eq!(interval(&TABLE_I_D, Layout::Blocks(4)), Some(Micros::from_millis(19)));
    assert_eq!(interval(&TABLE_I_D, Layout::Line(4)), Some(Micros::from_millis(17)));
    assert_eq!(interval(&TABLE_I_B, Layout::Line(4)), Some(Micros::from_millis(1)));
    assert_eq!(interval(&THE_ONE_WITH_19_MS, Layout::Line(4)), Some(Micros::from_millis(19)));
}

fn every_schedule_of_the_shared_cases_meets_its_requirements() {
    for case in SHORTEST_PERIODS {
        let us = |ticks: u32| Micros::new(ticks * case.tick_us);
        let mut times = [[Micros::ZERO; 32]; 2];
        for (times, ticks) in times.iter_mut().zip([case.fire_a, case.fire_b]) {
            for (time, &ticks) in times.iter_mut().zip(ticks) {
                *time = us(ticks);
            }
        }
        let sensors = case.fire_a.len();
        let schedule = Schedule::<32>::from_slices(
            us(case.period),
            &[Micros::ZERO; 32][..sensors],
            [&times[0][..sensors], &times[1][..sensors]],
        )
        .expect("a schedule");
        let requirements = Requirements {
            min_interval: us(case.min_interval),
            layout: case.layout,
            window: us(case.window),
            stale_echo: case.stale_echo,
            ..Requirements::new(Micros::new((case.separation * case.tick_us - 1) / 2))
        };
        assert_eq!(schedule.verify(&requirements).violations().next(), None);
    }
}

/// Tests the example of section 7.2 of the proofs.
fn three_sensors_have_3912_tables_of_waits() {
    let ms = Micros::from_millis;
    let search = WaitSearch::new(&WaitProblem {
        sensors: 3,
        period: ms(30),
        wait_max: ms(6),
        tick: ms(1),
        t_lag: Some(&[ms(0), ms(10), ms(20)]),
        t_delta: Micros::new(999),
        min_interval: ms(5),
        neighbours: 3,
        layout: Layout::Line(3),
        criterion: Criterion::Paper,
    })
    .expect("a problem");
    let (mut tables, mut last) = (0, None::<Schedule<3>>);
    while let Outcome::Found(table) = search.next_table(last.as_ref(), &mut Budget::unlimited()).expect("room") {
        assert!(table.separation(Criterion::Paper).is_some_and(|least| least.value >= ms(2)));
        assert!(table.min_interval(Layout::Line(3)).is_some_and(|least| least.value >= ms(5)));
        (tables, last) = (tables + 1, Some(table));
    }
    assert_eq!(tables, 3912);
}

/// Checks a ring with walls 0.9 m to 2.8 m away: sensor `x` hears its echo after `5 + x` ms.
fn ring_accepts_walls_from_period_two_on_through_a_clock_wrap() {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    let mut ring: ScheduledRing<12> =
        Ring::new(&PAPER_12, config, Instant::from_micros(u32::MAX - 1_000_000)).expect("a ring");
    let mut tally = Tally::<u32>::default();
    let mut periods = 0;
    while periods < 40 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    ring.echo(sensor, now + Micros::from_millis(5 + u32::from(sensor))).expect("a sensor");
                }
                RingEvent::Reading(reading) => {
                    assert_eq!(reading.t_echo, Some(Micros::from_millis(5 + u32::from(reading.sensor))));
                    assert!(reading.phase == Phase((reading.period % 2) as u8));
                    tally.count(reading.kind);
                }
                RingEvent::PeriodEnded(stats) => {
                    assert_eq!(stats.max_late, Micros::ZERO);
                    periods += 1;
                }
            }
        }
    }
    // All readings but each sensor's first, and perhaps some pending ones of the last period.
    assert_eq!(tally.of(ReadingKind::First), 12);
    assert!(tally.of(ReadingKind::Accepted) >= 39 * 12 - 12 && tally.of(ReadingKind::Rejected) == 0);
}

fn readings_that_alternate_as_crosstalk_does_are_all_rejected() {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    let mut ring: ScheduledRing<12> = Ring::new(&PAPER_12, config, Instant::default()).expect("a ring");
    let mut tally = Tally::<u32>::default();
    let (mut periods, mut phase) = (0, Phase::A);
    while periods < 20 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                // All others hear the sound of sensor 1 after 20 ms.
                RingEvent::Fire { sensor, .. } if sensor > 0 => {
                    let at = |x| TABLE_I_D.t_fire(phase, x).map_or(0, Micros::as_micros);
                    let reading = (30_000 + at(0)).wrapping_sub(at(usize::from(sensor)));
                    if reading < 36_000 {
                        ring.echo(sensor, now + Micros::new(reading)).expect("a sensor");
                    }
                }
                RingEvent::Fire { .. } => {}
                RingEvent::Reading(reading) => tally.count(reading.kind),
                RingEvent::PeriodEnded(_) => {
                    periods += 1;
                    phase = Phase(periods % 2);
                }
            }
        }
    }
    assert_eq!(tally.of(ReadingKind::Accepted), 0);
    assert!(tally.of(ReadingKind::Rejected) > 20);
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    run(tests![
        tables_i_b_and_i_d_are_separated_by_2_ms_and_i_a_by_nothing,
        table_i_d_keeps_19_ms_in_its_blocks_and_17_ms_on_the_line,
        every_schedule_of_the_shared_cases_meets_its_requirements,
        three_sensors_have_3912_tables_of_waits,
        ring_accepts_walls_from_period_two_on_through_a_clock_wrap,
        readings_that_alternate_as_crosstalk_does_are_all_rejected,
    ])
}
