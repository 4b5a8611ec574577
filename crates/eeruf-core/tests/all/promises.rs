//! What a ring and its schedulers promise, where it was once broken: intervals through restarts and changes, firing
//! after long silences, sizes and settings that do not fit.

use eeruf_core::tables::{TABLE_I_A, TABLE_I_D};
use eeruf_core::{
    EchoFilter, ImmediateRefiring, Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingError,
    RingEvent, Schedule, ScheduledFiring, ScheduledRing, Scheduler, SchedulerStep, VerifiedSchedule,
};

fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

/// A schedule of firing times in milliseconds, verified for this interval between all its sensors.
fn verified<const K: usize>(period: u32, a: [u32; K], b: [u32; K], min_interval: u32) -> VerifiedSchedule<K> {
    let schedule = Schedule::from_firing(ms(period), [a.map(ms), b.map(ms)]).unwrap();
    let requirements = Requirements {
        min_interval: ms(min_interval),
        layout: Layout::Line(K as u8),
        window: ms(5),
        ..Requirements::new(ms(1))
    };
    schedule.verify(&requirements).verified().unwrap()
}

/// The firings up to some instant.
fn fire_until<const K: usize>(ring: &mut ScheduledRing<'_, K>, end: u32) -> Vec<(u8, u32)> {
    let mut fired = vec![];
    loop {
        let now = ring.next_deadline();
        if now.as_micros() > end {
            return fired;
        }
        if let Some(RingEvent::Fire(sensor)) = ring.poll(now) {
            fired.push((sensor, now.as_micros()));
        }
    }
}

/// The least time between two firings of different sensors.
fn least_interval(fired: &[(u8, u32)]) -> u32 {
    fired.windows(2).filter(|pair| pair[0].0 != pair[1].0).map(|pair| pair[1].1 - pair[0].1).min().unwrap()
}

#[test]
fn a_restart_keeps_the_smallest_interval_where_it_is_longer_than_refire_time_and_half_a_period() {
    let schedule = verified(48, [0, 40], [43, 0], 40);
    assert_eq!(schedule.min_refire(), ms(5));
    let config = RingConfig::new(ms(1), ms(5));
    for restart in 0..200 {
        let mut ring: ScheduledRing<2> = Ring::new(&schedule, config, Instant::from_micros(0)).unwrap();
        let mut fired = fire_until(&mut ring, 1000 * restart);
        ring.restart(Instant::from_micros(1000 * restart));
        fired.extend(fire_until(&mut ring, 500_000));
        assert!(least_interval(&fired) >= 40_000, "restarted after {restart} ms: {fired:?}");
    }
}

#[test]
fn a_change_of_schedule_keeps_an_interval_that_both_keep() {
    let schedules = [verified(108, [0, 99], [102, 0], 99), verified(112, [0, 100], [104, 1], 99)];
    let config = RingConfig::new(ms(1), ms(5));
    for (from, to) in [(0, 1), (1, 0)] {
        for change in 0..40 {
            let mut ring: ScheduledRing<2> = Ring::new(&schedules[from], config, Instant::from_micros(0)).unwrap();
            let mut fired = fire_until(&mut ring, 20_000 * change);
            ring.change_schedule(&schedules[to]).unwrap();
            fired.extend(fire_until(&mut ring, 2_000_000));
            assert!(least_interval(&fired) >= 99_000, "{fired:?}");
        }
    }
}

#[test]
fn a_schedule_that_was_not_verified_keeps_its_own_intervals_through_a_restart() {
    let schedule = Schedule::from_firing(ms(48), [[ms(0), ms(40)], [ms(43), ms(0)]]).unwrap();
    let config = RingConfig::new(ms(1), ms(5));
    let mut ring: ScheduledRing<2> = Ring::new(&schedule, config, Instant::from_micros(0)).unwrap();
    let mut fired = fire_until(&mut ring, 45_000);
    ring.restart(Instant::from_micros(45_000));
    fired.extend(fire_until(&mut ring, 500_000));
    assert!(least_interval(&fired) >= 40_000, "{fired:?}");
}

/// How long scheduled firing alone, polled every 10 ms from `now` on, takes to fire.
fn time_to_fire(scheduler: &mut ScheduledFiring<'_, 12>, mut now: Instant) -> Micros {
    let start = now;
    loop {
        if let Some(SchedulerStep::Fire { .. }) = scheduler.poll(now) {
            return now.since(start);
        }
        now += ms(1);
        assert!(now.since(start) < Micros::from_millis(10_000), "silent for ten seconds");
    }
}

#[test]
fn scheduled_firing_alone_goes_on_after_a_pause_of_forty_minutes() {
    let mut scheduler = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    time_to_fire(&mut scheduler, Instant::from_micros(0));
    let forty_minutes = Instant::from_micros(0) + ms(40 * 60 * 1000);
    assert!(time_to_fire(&mut scheduler, forty_minutes) <= ms(200));
}

#[test]
fn forty_minutes_without_sensors_do_not_delay_a_change_of_schedule() {
    let mut scheduler = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    time_to_fire(&mut scheduler, Instant::from_micros(0));
    (0..12).for_each(|sensor| scheduler.set_enabled(sensor, false));
    let mut now = Instant::from_micros(0);
    while now.as_micros() < 40 * 60 * 1_000_000 {
        now = scheduler.deadline();
        assert!(matches!(scheduler.poll(now), Some(SchedulerStep::PeriodEnded { .. })));
    }
    (0..12).for_each(|sensor| scheduler.set_enabled(sensor, true));
    scheduler.change_schedule(&TABLE_I_A);
    assert!(time_to_fire(&mut scheduler, now) <= ms(400));
}

#[test]
fn a_ring_smaller_than_its_scheduler_is_refused() {
    let scheduler = ScheduledFiring::new(&TABLE_I_D, Instant::default());
    let error = Ring::<_, 8, 1>::with_scheduler(scheduler, RingConfig::new(ms(1), ms(40)), Instant::default());
    assert_eq!(error.unwrap_err().to_string(), "a scheduler of 12 sensors; expected at most the 8 of the ring");
}

#[test]
fn a_schedule_with_room_for_300_sensors_fires_those_that_it_has() {
    let times = [ms(0), ms(15), ms(30)];
    let schedule = Schedule::<300>::from_slices(ms(60), &[Micros::ZERO; 3], [&times, &times]).unwrap();
    let mut scheduler = ScheduledFiring::new(&schedule, Instant::default());
    let mut fired = vec![];
    for _ in 0..12 {
        if let Some(SchedulerStep::Fire { sensor, .. }) = scheduler.poll(scheduler.deadline()) {
            fired.push(sensor);
        }
    }
    assert_eq!(fired, [0, 1, 2, 0, 1, 2, 0, 1, 2]);
}

#[test]
fn a_ring_takes_no_larger_t_delta_than_its_schedule_was_verified_for_at_the_start_or_later() {
    let good = TABLE_I_D.verify(&Requirements::new(Micros::new(999))).verified().unwrap();
    let better = TABLE_I_D.verify(&Requirements::new(Micros::new(500))).verified().unwrap();
    let ring = |t_delta| -> Result<ScheduledRing<12>, RingError> {
        Ring::new(&good, RingConfig::new(t_delta, ms(40)), Instant::default())
    };
    assert_eq!(
        ring(ms(30)).unwrap_err().to_string(),
        "a t_delta of 30 ms; expected at most 999 us, which the schedule was verified for"
    );
    let mut running = ring(Micros::new(999)).unwrap();
    let refused = RingError::TDelta { t_delta: Micros::new(999), verified: Micros::new(500) };
    assert_eq!(running.change_schedule(&better), Err(refused));
    assert_eq!(ring(Micros::new(500)).unwrap().change_schedule(&better), Ok(()));
    let coarse: Result<ScheduledRing<12>, _> =
        Ring::new(&TABLE_I_D, RingConfig::new(ms(40), ms(40)), Instant::default());
    assert_eq!(coarse.unwrap_err().to_string(), "a t_delta of 40 ms; expected less than the window of 40 ms");
}

#[test]
fn immediate_refiring_holds_back_for_any_refire_time_that_the_clock_can_tell() {
    for min_refire in [ms(100_000), Micros::MAX] {
        let mut scheduler = ImmediateRefiring::new(&TABLE_I_D, min_refire, Instant::default());
        let mut last = [None; 12];
        let mut now = Instant::default();
        for _ in 0..20_000 {
            now = scheduler.deadline();
            if let Some(SchedulerStep::Fire { sensor, .. }) = scheduler.poll(now) {
                let last = last[usize::from(sensor)].replace(now);
                assert!(last.is_none_or(|last| now.since(last) >= ms(100_000)), "{min_refire}");
                scheduler.ended(sensor, now + ms(10));
            }
        }
        assert!(last.iter().all(Option::is_some) && now != Instant::default());
    }
}

#[test]
fn the_longest_echo_time_is_an_echo_and_no_silence() {
    let mut filter = EchoFilter::<1>::new(Micros::new(500), 2).unwrap();
    assert_eq!(filter.push(0, Some(Micros::MAX)).unwrap().kind, ReadingKind::First);
    assert_eq!(filter.push(0, Some(Micros::MAX)).unwrap().kind, ReadingKind::Accepted);
    assert_eq!(filter.push(0, None).unwrap().kind, ReadingKind::NoEcho);
}

#[test]
fn a_change_to_a_faster_schedule_is_no_jump_of_the_clock() {
    let us = Micros::new;
    let slow = Schedule::<1>::from_firing(us(262_912), [[us(261_885)], [us(261_885)]]).unwrap();
    let fast = Schedule::<1>::from_firing(us(101_632), [[us(97_265)], [us(101_235)]]).unwrap();
    let mut ring = Ring::new(&slow, RingConfig::new(us(999), us(16_705)), Instant::from_micros(0)).unwrap();
    let fired = Instant::from_micros(261_885);
    assert_eq!(ring.poll(fired), Some(RingEvent::Fire(0)));
    ring.change_schedule(&fast).unwrap();
    let (mut now, mut events) = (fired, vec![]);
    while !events.contains(&RingEvent::Fire(0)) {
        while let Some(event) = ring.poll(now) {
            events.push(event);
        }
        if !events.contains(&RingEvent::Fire(0)) {
            now = ring.next_deadline();
        }
    }
    assert!(events.iter().any(|event| matches!(event, RingEvent::Reading(_))), "{events:?}");
    assert!(now.since(fired) >= slow.min_refire());
}
