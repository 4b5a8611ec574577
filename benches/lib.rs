//! Timings, and the calls whose instructions are counted.

use std::hint::black_box;
use std::time::{Duration, Instant};

use eeruf_core::search::{Budget, WaitProblem, WaitSearch, memory_words};
use eeruf_core::tables::PAPER_12;
use eeruf_core::{Criterion, Instant as Now, Layout, Micros, Requirements, Ring, RingConfig, RingEvent};
use eeruf_design::{Effort, RingSpec};
use eeruf_period::PeriodProblem;

/// Runs something for a fifth of a second, at least once, and prints the shortest time and the rate in things per
/// second. Under `cargo test`, which passes no `--bench`, it runs once.
pub fn time<R>(name: &str, things: usize, mut run: impl FnMut() -> R) {
    let is_timed = std::env::args().any(|arg| arg == "--bench");
    let (began, mut best_s) = (Instant::now(), f64::INFINITY);
    while best_s.is_infinite() || is_timed && began.elapsed() < Duration::from_millis(200) {
        let start = Instant::now();
        black_box(run());
        best_s = best_s.min(start.elapsed().as_secs_f64());
    }
    if is_timed {
        println!("{name:<64} {:>12.4} ms {:>14.0} a second", 1e3 * best_s, things as f64 / best_s);
    }
}

/// A call whose instructions are counted.
pub type Call = fn() -> Option<u32>;

/// The calls by name.
pub const CALLS: [(&str, Call); 5] = [
    ("period of a line of 12", period_of_line_12),
    ("period of a ring of 8 in ticks of 0.1 ms", period_of_ring_8),
    ("design of a ring file", design_of_file),
    ("best interval of 12", best_interval),
    ("1200 firings of 12", firings),
];

/// The shortest period of a ring with a separation of 2 ms, neighbours 15 ms apart, listening for 30 ms.
fn period(sensors: usize, layout: Layout<'_>, tick: u32) -> Option<u32> {
    let requirements = Requirements {
        min_interval: Micros::from_millis(15),
        window: Micros::from_millis(30),
        layout,
        ..Requirements::new(Micros::new(999))
    };
    let needs = PeriodProblem { sensors, requirements, tick: Micros::new(tick) };
    let found = black_box(needs).shortest(u64::MAX, &mut ()).ok()?;
    found.proven().then(|| found.period().as_micros())
}

fn period_of_line_12() -> Option<u32> {
    period(12, Layout::Line(4), 1000)
}

fn period_of_ring_8() -> Option<u32> {
    period(8, Layout::Ring(4), 100)
}

/// Does the work of `eeruf design --period-only`, from text to schedule, with the atlas.
pub fn design_of_file() -> Option<u32> {
    let text = "sensors = 12\nt_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 30_000";
    let spec = RingSpec::from_text(black_box(text)).ok()?;
    let design = spec.shortest(&Effort { what_if: true, ..Effort::default() }, &mut ()).ok()?;
    design.found.value.map(Micros::as_micros)
}

fn best_interval() -> Option<u32> {
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
    let best = search.best_interval::<12>(&mut memory, &mut Budget::unlimited()).ok()?;
    best.value.map(Micros::as_micros)
}

fn firings() -> Option<u32> {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    let mut ring = Ring::new(&PAPER_12, config, Now::default()).ok()?;
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
    Some(readings)
}
