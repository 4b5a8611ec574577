//! Cost of the searches, the filter and a ring in instructions, under callgrind.
#![allow(missing_docs, unused_qualifications, reason = "what the macros generate")]

use std::hint::black_box;

use eeruf_core::search::{Budget, WaitProblem, WaitSearch, memory_words};
use eeruf_core::tables::PAPER_12;
use eeruf_core::{Criterion, EchoFilter, Instant, Layout, Micros, Requirements, Ring, RingConfig, RingEvent};
use eeruf_period::PeriodProblem;
use gungraun::{library_benchmark, library_benchmark_group, main};

/// The shortest period of a ring with a separation of 2 ms, neighbours 15 ms apart, proven.
fn design(sensors: usize, layout: Layout<'_>, window_ms: u32, tick: Micros) -> Option<Micros> {
    let needs = PeriodProblem {
        sensors,
        requirements: Requirements {
            min_interval: Micros::from_millis(15),
            window: Micros::from_millis(window_ms),
            layout,
            ..Requirements::new(Micros::new(999))
        },
        tick,
    };
    let found = black_box(needs).shortest(u64::MAX, &mut ()).ok()?;
    assert!(found.proven());
    Some(found.period())
}

// The paper's half ring of twelve.
#[library_benchmark]
fn design_paper_12() -> Option<Micros> {
    design(12, Layout::Line(4), 30, Micros::from_millis(1))
}

// The same in ticks of 0.1 ms.
#[library_benchmark]
fn design_paper_12_fine() -> Option<Micros> {
    design(12, Layout::Line(4), 30, Micros::new(100))
}

// A closed ring of eight, whose proof in fine ticks costs most, compared with that in ticks of 1 ms.
#[library_benchmark]
fn design_ring_8() -> Option<Micros> {
    design(8, Layout::Ring(4), 30, Micros::from_millis(1))
}

// The same in ticks of 0.1 ms.
#[library_benchmark]
fn design_ring_8_fine() -> Option<Micros> {
    design(8, Layout::Ring(4), 30, Micros::new(100))
}

// A line of 24.
#[library_benchmark]
fn design_line_24() -> Option<Micros> {
    design(24, Layout::Line(4), 15, Micros::from_millis(1))
}

// The largest smallest interval of a table of waits for twelve sensors, proven.
#[library_benchmark]
fn best_interval_12() -> Option<Micros> {
    let needs = WaitProblem {
        sensors: 12,
        period: Micros::from_millis(100),
        wait_max: Micros::from_millis(24),
        tick: Micros::from_millis(1),
        t_lag: None,
        t_delta: Micros::new(999),
        min_interval: Micros::from_millis(15),
        neighbours: 4,
        layout: Layout::Line(4),
        criterion: Criterion::Exact,
    };
    let search = WaitSearch::new(&black_box(needs)).ok()?;
    let mut memory = vec![0; memory_words(12)];
    search.best_interval::<12>(&mut memory, &mut Budget::unlimited()).ok()?.value
}

// A thousand readings of one sensor.
#[library_benchmark]
fn filter_1000_readings() -> u32 {
    let Ok(mut filter) = EchoFilter::<1>::new(Micros::new(500), 2) else { return 0 };
    let mut accepted = 0;
    for n in 0..1000 {
        let verdict = filter.push(0, Some(Micros::new(black_box(9000 + n % 7 * 100))));
        accepted += u32::from(verdict.is_ok_and(|verdict| verdict.t_echo.is_some()));
    }
    accepted
}

// A hundred periods of twelve sensors: 1,200 firings and echoes.
#[library_benchmark]
fn ring_100_periods() -> u32 {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    let Ok(mut ring) = Ring::new(&PAPER_12, config, Instant::default()) else { return 0 };
    let (mut periods, mut readings) = (0, 0);
    while periods < 100 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let heard = ring.echo(sensor, now + Micros::from_millis(black_box(12)));
                    readings += u32::from(heard.is_err());
                }
                RingEvent::Reading(_) => readings += 1,
                RingEvent::PeriodEnded(_) => periods += 1,
            }
        }
    }
    readings
}

library_benchmark_group!(
    name = core;
    benchmarks = design_paper_12, design_paper_12_fine, design_ring_8, design_ring_8_fine, design_line_24,
        best_interval_12, filter_1000_readings, ring_100_periods
);
main!(library_benchmark_groups = core);
