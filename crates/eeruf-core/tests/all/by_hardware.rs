//! Rings whose hardware triggers at the instants of [`Ring::upcoming`] and reports echoes by value.

use eeruf_core::{
    Instant, Micros, ReadingKind, Ring, RingConfig, RingError, RingEvent, ScheduledRing, SensorError, Silence,
    judge::Judge,
    plan::{Plan, Upcoming},
    tables::{PAPER_12, TABLE_I_D},
};

use crate::common::random::Random;

fn at(us: u32) -> Instant {
    Instant::from_micros(us)
}

fn ring(start: u32) -> ScheduledRing<'static, 12> {
    Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), at(start)).unwrap()
}

/// A wall in front of each sensor, with 30 us of jitter.
fn wall(r: &mut Random, sensor: u8) -> Micros {
    Micros::new(4_000 + 1_500 * u32::from(sensor) + r.up_to(30))
}

/// Runs a loop with a turn every 0 to 5 ms, Table I-d and a wall for each sensor; returns the numbers of readings and
/// of accepted readings.
fn late_loop(seed: u64, by_timer: bool) -> (u32, u32) {
    let config = RingConfig::new().with_t_delta(Micros::new(999)).with_window(Micros::from_millis(40));
    let start = u32::MAX - 2_000_000;
    let (mut r, mut now) = (Random(seed), at(start));
    let mut ring = ScheduledRing::<12>::unverified(&TABLE_I_D, config, now).unwrap();
    let (mut readings, mut accepted) = (0, 0);
    // Echo edges that have come but are not reported yet.
    let mut edges: Vec<(u8, Instant)> = vec![];
    while readings < 3_600 {
        now += Micros::new(r.up_to(5_000));
        loop {
            // The events since the last turn, in order.
            let fires = ring.upcoming().next().filter(|next| by_timer && now.has_reached(next.due));
            let until = fires.map_or(now, |next| next.due);
            edges.retain(|&(sensor, edge)| {
                let has_come = until.has_reached(edge);
                if has_come {
                    ring.echo(sensor, edge).unwrap();
                }
                !has_come
            });
            while let Some(event) = ring.poll(until) {
                match event {
                    RingEvent::Fire { sensor, due, .. } => {
                        assert!(
                            !by_timer || due == until,
                            "the timer fires {sensor} at {until:?}, the ring at {due:?}"
                        );
                        edges.push((sensor, until + wall(&mut r, sensor)));
                    }
                    RingEvent::Reading(reading) => {
                        readings += 1;
                        accepted += u32::from(reading.kind == ReadingKind::Accepted);
                    }
                    RingEvent::PeriodEnded(_) => {}
                }
            }
            if fires.is_none() {
                break;
            }
        }
    }
    (readings, accepted)
}

#[test]
fn late_loop_with_timed_triggers_accepts_own_walls() {
    for seed in 20_000..20_005 {
        let (readings, accepted) = late_loop(seed, true);
        println!("seed {seed}: {accepted} of {readings} with the timer");
        assert!(100 * accepted >= 99 * readings, "{accepted} of {readings} accepted");
        let (readings, accepted) = late_loop(seed, false);
        println!("seed {seed}: {accepted} of {readings} without");
        assert!(4 * accepted < 3 * readings, "without the timer {accepted} of {readings}");
    }
}

/// The next firings of a ring if it is polled on time.
fn fired<P: Plan, J: Judge, const H: usize>(mut ring: Ring<P, J, 12, 1, H>, number: usize) -> Vec<Upcoming> {
    let mut fired = vec![];
    while fired.len() < number {
        let now = ring.next_deadline();
        if let Some(RingEvent::Fire { sensor, phase, due }) = ring.poll(now) {
            fired.push(Upcoming { sensor, phase, due });
        }
    }
    fired
}

#[test]
fn upcoming_lists_firings_as_polled_on_time() {
    let mut ring = ring(u32::MAX - 300_000);
    ring.disable(3).unwrap();
    for step in 0..200 {
        let upcoming: Vec<_> = ring.upcoming().collect();
        // To the end of the next period: of a table at least one whole period.
        assert!((11..=22).contains(&upcoming.len()), "{}", upcoming.len());
        assert_eq!(upcoming, fired(ring.clone(), upcoming.len()), "step {step}");
        let now = ring.next_deadline() + Micros::new(if step % 7 == 0 { 900 } else { 0 });
        ring.poll(now);
    }
    ring.change_schedule(&PAPER_12).unwrap();
    let last = ring.upcoming().last().map_or(0, |last| last.phase.0);
    assert_eq!(last, ring.upcoming().next().unwrap().phase.0, "the schedule that follows is another's business");
    ring.pause();
    assert_eq!(ring.upcoming().count(), 0);
}

#[test]
fn report_after_keeps_readings_open_for_what_comes_late() {
    let mut ring = ring(0);
    ring.set_silence(Silence::NeedsAnswer);
    ring.set_report_after(Micros::from_millis(70)).unwrap();
    let mut kinds: Vec<(u8, ReadingKind)> = vec![];
    let mut due: Vec<(Instant, u8)> = vec![];
    while kinds.len() < 300 {
        let now = ring.next_deadline();
        due.retain(|&(reported, sensor)| {
            let has_come = now.has_reached(reported);
            if has_come {
                // Sensor 0 hears a wall, 1 nothing, 3 something beyond the window; 2 reports nothing at all.
                let t_echo = [Some(12_000), None, None, Some(40_001)].get(usize::from(sensor)).copied().flatten();
                if sensor != 2 {
                    ring.measured(sensor, t_echo.map(Micros::new)).unwrap();
                }
            }
            !has_come
        });
        match ring.poll(now) {
            // The report takes 65 ms, the window 40.
            Some(RingEvent::Fire { sensor, .. }) => due.push((now + Micros::from_millis(65), sensor)),
            Some(RingEvent::Reading(reading)) => kinds.push((reading.sensor, reading.kind)),
            _ => {}
        }
    }
    let of = |sensor| kinds.iter().filter(move |&&(x, _)| x == sensor).skip(1).map(|&(_, kind)| kind);
    assert!(of(0).all(|kind| kind == ReadingKind::Accepted), "{:?}", of(0).collect::<Vec<_>>());
    assert!(of(1).all(|kind| kind == ReadingKind::Clear), "{:?}", of(1).collect::<Vec<_>>());
    assert!(of(2).chain(of(3)).all(|kind| kind == ReadingKind::Unanswered));
    let longest = ring.plan().min_refire();
    let more = longest.saturating_add(Micros::new(1));
    assert_eq!(ring.set_report_after(more), Err(RingError::Window { window: more, min_refire: longest }));
    assert_eq!(ring.measured(12, None), Err(SensorError { sensor: 12, sensors: 12 }));
}
