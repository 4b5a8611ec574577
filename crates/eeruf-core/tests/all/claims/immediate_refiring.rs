//! Immediate refiring (Sec. 3, Figs. 2a and 2b), to the microsecond: Eqs. (1)-(10).
//!
//! Sensor x sees a true echo after `T_echo`. Sensor y sees nothing of its own, but hears x over a critical path of
//! length `L` (all in microseconds). With `t_x(i)`, `t_y(i)` for the i-th firings and `W` for the wait before a firing:
//!
//! ```text
//! t_x(i+1) = t_x(i) + T_echo + W_x          x fires again after its echo and its wait
//! T_err(i) = t_x(i) + L - t_y(i)            what y reads
//! t_y(i+1) = t_y(i) + T_err(i) + W_y        y fires again after what it takes for its echo, and its wait
//! ```
//!
//! and so, whatever `L` is and whenever they began, `T_err(i+1) = T_echo + W_x - W_y`: (8) for constant waits, (10a)
//! and (10b) for alternating ones.

use std::collections::VecDeque;

use eeruf_core::{
    Instant, Micros, ReadingKind, RingConfig, RingEvent, Schedule, judge::AgreementRing, plan::ImmediateRefiring,
};
use proptest::prelude::*;

const T_DELTA: u32 = 500;
const WINDOW: u32 = 60_000;

/// One sensor's waits in phases a and b, in microseconds.
type Waits = [u32; 2];

/// The echo times and verdicts of y, by agreement alone, as in the paper.
fn readings_of_y(t_echo: u32, path: u32, lag_y: u32, x: Waits, y: Waits) -> Vec<(u32, ReadingKind)> {
    let us = |x, y| [Micros::new(x), Micros::new(y)];
    let schedule =
        Schedule::<2>::new(Micros::from_millis(200), us(0, lag_y), [us(x[0], y[0]), us(x[1], y[1])]).unwrap();
    let config = RingConfig::new().with_t_delta(Micros::new(T_DELTA)).with_window(Micros::new(WINDOW));
    let plan = ImmediateRefiring::new(&schedule, Micros::ZERO, Instant::default());
    let mut ring: AgreementRing<_, 2> = AgreementRing::agreement_alone(plan, config, Instant::default()).unwrap();
    let mut heard = VecDeque::new();
    let mut readings = vec![];
    for _ in 0..400 {
        let mut now = ring.next_deadline();
        // Sound that arrives before the next deadline interrupts the sleep.
        if let Some(&at) = heard.front().filter(|at: &&Instant| now.has_reached(**at)) {
            heard.pop_front();
            now = at;
            ring.echo(1, at).unwrap();
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor: 0, .. } => {
                    ring.echo(0, now + Micros::new(t_echo)).unwrap();
                    heard.push_back(now + Micros::new(path));
                }
                RingEvent::Reading(reading) if reading.sensor == 1 => {
                    readings.extend(reading.t_echo.map(|t| (t.as_micros(), reading.kind)));
                }
                _ => {}
            }
        }
    }
    readings
}

proptest! {
    // With constant waits the error settles on the echo time of the other sensor and is believed.
    #[test]
    fn constant_waits_settle_on_the_other_echo(
        t_echo in 5_000..30_000_u32,
        path in 5_000..40_000_u32,
        lag_y in 0..5_000_u32,
        wait in 1..8_000_u32,
    ) {
        let readings = readings_of_y(t_echo, path, lag_y, [wait; 2], [wait; 2]);
        prop_assert!(readings.len() > 20);
        for &(t_err, kind) in &readings[3..] {
            prop_assert_eq!((t_err, kind), (t_echo, ReadingKind::Accepted)); // (8)
        }
    }

    // With alternating waits the error alternates between (10a) and (10b) and is rejected.
    #[test]
    fn alternating_waits_reject_the_other_echo(
        t_echo in 15_000..30_000_u32,
        path in 5_000..40_000_u32,
        lag_y in 0..5_000_u32,
        x in (0..7_000_u32, 0..7_000_u32),
        y in (0..7_000_u32, 0..7_000_u32),
    ) {
        let readings = readings_of_y(t_echo, path, lag_y, [x.0, x.1], [y.0, y.1]);
        prop_assert!(readings.len() > 20);
        // Which of y's phases meets which of x's depends on the path: (10a), (10b), or x one phase behind.
        let in_step = [t_echo + x.0 - y.0, t_echo + x.1 - y.1];
        let behind = [t_echo + x.1 - y.0, t_echo + x.0 - y.1];
        for pair in readings[3..].windows(2) {
            let mut seen = [pair[0].0, pair[1].0];
            seen.sort_unstable();
            let sorted = |mut pair: [u32; 2]| { pair.sort_unstable(); pair };
            prop_assert!(seen == sorted(in_step) || seen == sorted(behind), "{seen:?} {in_step:?} {behind:?}");
            let expected = if seen[1] - seen[0] <= T_DELTA { ReadingKind::Accepted } else { ReadingKind::Rejected };
            prop_assert_eq!(pair[1].1, expected);
        }
    }
}

// Equal waits settle on the other sensor's echo; different waits never settle.
#[test]
fn only_equal_waits_settle() {
    // Equal waits: y reads x's 12 ms.
    assert_eq!(readings_of_y(12_000, 17_000, 2_000, [5_000; 2], [5_000; 2])[3], (12_000, ReadingKind::Accepted));
    // Alternating waits: 12 + 8 - 2 and 12 + 4 - 6 ms in turn.
    let readings = readings_of_y(12_000, 17_000, 2_000, [8_000, 4_000], [2_000, 6_000]);
    let mut pair = [readings[3], readings[4]];
    pair.sort_unstable_by_key(|&(t_err, _)| t_err);
    assert_eq!(pair, [(10_000, ReadingKind::Rejected), (18_000, ReadingKind::Rejected)]);
}
