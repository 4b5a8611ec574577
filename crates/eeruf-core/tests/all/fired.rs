//! Firings whose true instant the caller reports.

use eeruf_core::tables::PAPER_12;
use eeruf_core::{Instant, Micros, PeriodStats, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, SensorError};

use crate::common::random::Random;

fn at(us: u32) -> Instant {
    Instant::from_micros(us)
}

fn ring() -> ScheduledRing<'static, 12> {
    Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), at(0)).unwrap()
}

/// The result of a run in which firing `n` happens `late(n)` us after its poll, and its echo comes 9 ms later.
struct Run {
    fired: Vec<(u8, u32)>,
    /// The scheduled instants, without any lateness.
    planned: Vec<u32>,
    accepted: usize,
    echoes: Vec<u32>,
    stats: Vec<PeriodStats>,
}

fn run(firings: u32, late: impl Fn(u32) -> u32) -> Run {
    let mut ring = ring();
    let mut run = Run { fired: vec![], planned: vec![], accepted: 0, echoes: vec![], stats: vec![] };
    let (mut now, mut n, mut sum) = (0_u32, 0, 0);
    while n < firings {
        now = now.max(ring.next_deadline().as_micros());
        match ring.poll(at(now)) {
            Some(RingEvent::Fire { sensor, due, .. }) => {
                run.planned.push(due.as_micros() - sum);
                let fired = now + late(n);
                sum += fired - due.as_micros();
                ring.fired(sensor, at(fired)).unwrap();
                ring.echo(sensor, at(fired + 9_000)).unwrap();
                run.fired.push((sensor, fired));
                n += 1;
            }
            Some(RingEvent::Reading(reading)) => {
                run.accepted += usize::from(reading.kind == ReadingKind::Accepted);
                run.echoes.extend(reading.t_echo.map(Micros::as_micros));
            }
            Some(RingEvent::PeriodEnded(stats)) => run.stats.push(stats),
            None => {}
        }
    }
    run
}

#[test]
fn an_event_says_when_its_sensor_was_due_and_in_which_phase() {
    let mut ring = ring();
    let mut seen = 0;
    while seen < 48 {
        let due = ring.next_deadline();
        if let Some(RingEvent::Fire { sensor, phase, due: said }) = ring.poll(due + Micros::new(7)) {
            let period = seen / 12;
            assert_eq!((said, phase.0), (due, period % 2));
            assert!(PAPER_12.firing_order(phase).contains(&sensor));
            seen += 1;
        }
    }
}

// Echo times count from the instant of firing and no interval gets shorter.
#[test]
fn echo_times_count_from_the_firing() {
    let mut random = Random(7);
    let lateness: Vec<u32> = (0..600).map(|_| random.up_to(3_000)).collect();
    let run = run(600, |n| lateness[n as usize]);
    assert!(run.echoes.iter().all(|&echo| echo == 9_000), "{:?}", run.echoes);
    for (pair, planned) in run.fired.windows(2).zip(run.planned.windows(2)) {
        assert!(pair[1].1 - pair[0].1 >= planned[1] - planned[0], "{pair:?}, planned {planned:?}");
    }
    for sensor in 0..12 {
        let own: Vec<_> = run.fired.iter().filter(|fired| fired.0 == sensor).map(|fired| fired.1).collect();
        assert!(own.windows(2).all(|pair| pair[1] - pair[0] >= 76_000));
    }
}

// An instant reported after the poll counts like lateness of the poll.
#[test]
fn instant_after_the_poll_counts_as_lateness() {
    // The sixth firing of twelve is 40 us late, or reported as late.
    let late = |n: u32| u32::from(n % 12 == 5) * 40;
    let said = run(480, late);
    let mut polled = Run { fired: vec![], planned: vec![], accepted: 0, echoes: vec![], stats: vec![] };
    let mut ring = ring();
    let (mut now, mut n) = (0_u32, 0);
    while n < 480 {
        let due = ring.next_deadline().as_micros();
        now = now.max(due);
        // Events due before the firing are emitted on time.
        let mut probe = ring.clone();
        if matches!(probe.poll(at(now)), Some(RingEvent::Fire { .. })) {
            now += late(n);
        }
        match ring.poll(at(now)) {
            Some(RingEvent::Fire { sensor, .. }) => {
                ring.echo(sensor, at(now + 9_000)).unwrap();
                polled.fired.push((sensor, now));
                n += 1;
            }
            Some(RingEvent::PeriodEnded(stats)) => polled.stats.push(stats),
            _ => {}
        }
    }
    assert_eq!(said.fired, polled.fired);
    let figures = |run: &Run| -> Vec<_> { run.stats.iter().map(|stats| (stats.max_late, stats.sum_late)).collect() };
    assert_eq!(figures(&said), figures(&polled));
    assert!(said.stats[3].max_late == Micros::new(40) && said.stats[3].sum_late == Micros::new(40));
}

#[test]
fn firings_that_are_all_said_to_be_50_us_late_lose_nothing_good() {
    for late in [0, 50, 400] {
        let run = run(1200, |_| late);
        // All but the first reading of each sensor, and those still to come.
        assert!(run.accepted >= 1200 - 12 - 4, "{late} us late: {}", run.accepted);
        assert_eq!(run.stats[5].max_late, Micros::new(late));
        assert_eq!(run.stats[5].sum_late, Micros::new(12 * late));
    }
}

#[test]
fn whatever_the_instants_that_are_said_no_crosstalk_is_accepted() {
    let mut random = Random(3);
    let (mut compared, mut readings) = (0, 0);
    for seed in 0..60_u32 {
        let mut ring = ring();
        let path = 1_000 + random.up_to(74_000);
        let ahead = 1 + random.up_to(10) as u8;
        let most = 1 << random.up_to(11);
        let (mut now, mut arrivals, mut fired, mut unsaid) = (0_u32, vec![], 0, None);
        while fired < 600 {
            now = now.max(ring.next_deadline().as_micros());
            arrivals.retain(|&(sensor, arrives)| {
                if arrives <= now {
                    ring.echo(sensor, at(arrives)).unwrap();
                }
                arrives > now
            });
            let event = ring.poll(at(now));
            if let Some((sensor, true_instant)) = unsaid.take() {
                ring.fired(sensor, at(true_instant)).unwrap();
            }
            match event {
                Some(RingEvent::Fire { sensor, .. }) => {
                    fired += 1;
                    let true_instant = now + random.up_to(most);
                    arrivals.push(((sensor + ahead) % 12, true_instant + path));
                    if seed % 2 == 1 && random.up_to(50) == 0 {
                        // Reported too late, after the next poll.
                        unsaid = Some((sensor, true_instant));
                    } else {
                        ring.fired(sensor, at(true_instant)).unwrap();
                    }
                    now += random.up_to(most);
                }
                Some(RingEvent::Reading(reading)) => {
                    readings += 1;
                    compared += u32::from(reading.kind == ReadingKind::Rejected);
                    assert_ne!(reading.kind, ReadingKind::Accepted, "seed {seed}: {reading:?}");
                }
                _ => {}
            }
        }
    }
    assert!(compared * 10 > readings, "{compared} of {readings} compared");
}

#[test]
fn an_instant_before_the_poll_or_after_the_reading_is_ignored() {
    let mut ring = ring();
    let RingEvent::Fire { sensor, .. } = ring.poll(at(24_000)).unwrap() else { panic!("fires") };
    let next = ring.next_deadline();
    ring.fired(sensor, at(23_000)).unwrap();
    assert_eq!(ring.next_deadline(), next);
    ring.echo(sensor, at(24_010)).unwrap();
    assert!(matches!(ring.poll(at(24_010)), Some(RingEvent::Fire { .. } | RingEvent::Reading(_))));
    while ring.poll(at(24_010)).is_some() {}
    let next = ring.next_deadline();
    ring.fired(sensor, at(24_500)).unwrap();
    assert_eq!(ring.next_deadline(), next);
    assert_eq!(ring.fired(12, at(24_500)), Err(SensorError { sensor: 12, sensors: 12 }));
}

#[test]
fn said_after_another_firing_it_counts_all_the_same() {
    let mut ring = ring();
    let (mut now, mut fired, mut accepted) = (0_u32, vec![], 0);
    while fired.len() < 240 {
        now = now.max(ring.next_deadline().as_micros());
        match ring.poll(at(now)) {
            Some(RingEvent::Fire { sensor, .. }) => {
                fired.push((sensor, now));
                ring.echo(sensor, at(now + 9_000)).unwrap();
                if fired.len() == 121 {
                    now += 300;
                    ring.fired(sensor, at(now)).unwrap();
                }
                if fired.len() == 123 {
                    // The firing before the last one; its sensor still listens.
                    let (before, when) = fired[121];
                    ring.fired(before, at(when + 500)).unwrap();
                }
            }
            Some(RingEvent::Reading(reading)) if fired.len() > 24 => {
                accepted += u32::from(reading.kind == ReadingKind::Accepted);
                assert!(matches!(reading.kind, ReadingKind::Accepted | ReadingKind::Ambiguous), "{reading:?}");
            }
            _ => {}
        }
    }
    assert!((190..=216).contains(&accepted), "{accepted}");
}
