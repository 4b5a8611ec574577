//! Lateness that a ring reports, and constant lateness, which costs no readings. Its effect on crosstalk is in `sound`.

use eeruf_core::tables::TABLE_I_D;
use eeruf_core::{Instant, Micros, PeriodStats, ReadingKind, Ring, RingConfig, RingEvent, Schedule, ScheduledRing};

type Table = Schedule<12>;

fn ring(table: &Table, t_delta: u32) -> ScheduledRing<'_, 12> {
    let window = table.min_refire();
    let config = RingConfig::new().with_t_delta(Micros::new(t_delta)).with_window(window);
    Ring::unverified(table, config, Instant::from_micros(0)).unwrap()
}

#[test]
fn firings_that_are_all_late_by_50_us_lose_nothing_good() {
    for steady in [0, 50] {
        let mut ring = ring(&TABLE_I_D, 999);
        let (mut now, mut readings, mut accepted) = (0_u32, 0, 0);
        while readings < 1200 {
            now = now.max(ring.next_deadline().as_micros()) + steady;
            match ring.poll(Instant::from_micros(now)) {
                Some(RingEvent::Fire { sensor, .. }) => {
                    ring.echo(sensor, Instant::from_micros(now + 9_000)).unwrap();
                }
                Some(RingEvent::Reading(reading)) => {
                    readings += 1;
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                }
                Some(RingEvent::PeriodEnded(stats)) => {
                    assert_eq!(stats.sum_late.as_micros(), 12 * steady);
                }
                None => {}
            }
        }
        // All but the first reading of each sensor.
        assert_eq!(accepted, 1200 - 12, "{steady} us late");
    }
}

#[test]
fn a_period_says_its_latest_step_and_the_sum() {
    let mut ring = ring(&TABLE_I_D, 999);
    let (mut now, mut fired, mut periods) = (0, 0, vec![]);
    while periods.len() < 7 {
        let late = if fired % 24 == 17 { 400 } else { u32::from(fired % 24 == 20) * 70 };
        now = now.max(ring.next_deadline().as_micros()) + late;
        match ring.poll(Instant::from_micros(now)) {
            Some(RingEvent::Fire { .. }) => fired += 1,
            Some(RingEvent::PeriodEnded(PeriodStats { max_late, sum_late, .. })) => {
                periods.push([max_late, sum_late].map(Micros::as_micros));
            }
            _ => {}
        }
    }
    assert_eq!(periods[0], [0, 0]);
    assert_eq!(periods[3..7], [[400, 470], [0, 0], [400, 470], [0, 0]], "{periods:?}");
}

#[test]
fn a_stall_before_the_end_of_a_period_counts_in_its_latest_step() {
    let mut ring = ring(&TABLE_I_D, 999);
    let (mut now, mut ends) = (0, vec![]);
    while ends.len() < 3 {
        let due = ring.next_deadline().as_micros();
        // The last firing of phase a is due at 99 ms, the period's end at 100 ms, and the next firing at 118 ms.
        now = if due == 100_000 { 105_000 } else { due.max(now) };
        if let Some(RingEvent::PeriodEnded(stats)) = ring.poll(Instant::from_micros(now)) {
            ends.push((stats.max_late.as_micros(), stats.sum_late.as_micros()));
        }
    }
    assert_eq!(ends, [(5_000, 0), (0, 0), (0, 0)]);
}
