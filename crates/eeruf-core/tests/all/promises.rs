//! Promises of a ring and its plans that were once broken: intervals across restarts and changes, firing after long
//! silences, and refusal of sizes and settings that do not fit.

use std::hash::{BuildHasher, BuildHasherDefault, DefaultHasher};

use eeruf_core::tables::{PAPER_12, TABLE_I_A, TABLE_I_D};
use eeruf_core::{
    EchoFilter, Instant, Layout, Micros, Phase, ReadingKind, Requirements, Ring, RingConfig, RingError, RingEvent,
    Schedule, ScheduledRing, VerifiedSchedule,
    plan::{ImmediateRefiring, Plan, ScheduledFiring, Upcoming},
};

fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

/// Settings that all schedules in milliseconds are verified for.
const CONFIG: RingConfig = RingConfig::new().with_t_delta(Micros::from_millis(1)).with_window(Micros::from_millis(5));

/// A schedule of firing times in milliseconds, verified for this interval between all its sensors.
fn verified<const K: usize>(period: u32, a: [u32; K], b: [u32; K], min_interval: u32) -> VerifiedSchedule<K> {
    let schedule = Schedule::from_firing(ms(period), [a.map(ms), b.map(ms)]).unwrap();
    let requirements = Requirements {
        min_interval: ms(min_interval),
        layout: Layout::Line(K as u8),
        window: ms(5),
        ..Requirements::new(ms(1))
    };
    schedule.verified(&requirements).unwrap()
}

/// The firings up to an instant.
fn fire_until<const K: usize>(ring: &mut ScheduledRing<'_, K>, end: u32) -> Vec<(u8, u32)> {
    let mut fired = vec![];
    loop {
        let now = ring.next_deadline();
        if now.as_micros() > end {
            return fired;
        }
        if let Some(RingEvent::Fire { sensor, .. }) = ring.poll(now) {
            fired.push((sensor, now.as_micros()));
        }
    }
}

/// The least time between two firings of different sensors.
fn least_interval(fired: &[(u8, u32)]) -> u32 {
    fired.windows(2).filter(|pair| pair[0].0 != pair[1].0).map(|pair| pair[1].1 - pair[0].1).min().unwrap()
}

// A restart keeps the smallest interval even if it exceeds the refire time and half a period.
#[test]
fn restart_keeps_an_interval_longer_than_refire() {
    let schedule = verified(48, [0, 40], [43, 0], 40);
    assert_eq!(schedule.min_refire(), ms(5));
    for restart in 0..200 {
        let mut ring: ScheduledRing<2> = Ring::new(&schedule, CONFIG, Instant::from_micros(0)).unwrap();
        let mut fired = fire_until(&mut ring, 1000 * restart);
        ring.restart(Instant::from_micros(1000 * restart));
        fired.extend(fire_until(&mut ring, 500_000));
        assert!(least_interval(&fired) >= 40_000, "restarted after {restart} ms: {fired:?}");
    }
}

#[test]
fn a_change_of_schedule_keeps_an_interval_that_both_keep() {
    let schedules = [verified(108, [0, 99], [102, 0], 99), verified(112, [0, 100], [104, 1], 99)];
    for (from, to) in [(0, 1), (1, 0)] {
        for change in 0..40 {
            let mut ring: ScheduledRing<2> = Ring::new(&schedules[from], CONFIG, Instant::from_micros(0)).unwrap();
            let mut fired = fire_until(&mut ring, 20_000 * change);
            ring.change_schedule(&schedules[to]).unwrap();
            fired.extend(fire_until(&mut ring, 2_000_000));
            assert!(least_interval(&fired) >= 99_000, "{fired:?}");
        }
    }
}

// A schedule that was not verified keeps its own intervals through a restart.
#[test]
fn unverified_schedule_keeps_its_intervals_on_restart() {
    let schedule = Schedule::from_firing(ms(48), [[ms(0), ms(40)], [ms(43), ms(0)]]).unwrap();
    let mut ring: ScheduledRing<2> = Ring::unverified(&schedule, CONFIG, Instant::from_micros(0)).unwrap();
    let mut fired = fire_until(&mut ring, 45_000);
    ring.restart(Instant::from_micros(45_000));
    fired.extend(fire_until(&mut ring, 500_000));
    assert!(least_interval(&fired) >= 40_000, "{fired:?}");
}

/// Time until scheduled firing without a ring fires, polled every 10 ms from `now` on.
fn time_to_fire(plan: &mut ScheduledFiring<'_, 12>, mut now: Instant) -> Micros {
    let start = now;
    loop {
        if plan.poll(now).is_some() {
            return now.since(start);
        }
        now += ms(1);
        assert!(now.since(start) < Micros::from_millis(10_000), "silent for ten seconds");
    }
}

// Scheduled firing without a ring goes on after a pause of forty minutes.
#[test]
fn firing_goes_on_after_forty_minutes_of_pause() {
    let mut plan = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    time_to_fire(&mut plan, Instant::from_micros(0));
    let forty_minutes = Instant::from_micros(0) + ms(40 * 60 * 1000);
    assert!(time_to_fire(&mut plan, forty_minutes) <= ms(200));
}

// Forty minutes without sensors do not delay a change of schedule.
#[test]
fn forty_minutes_without_sensors_delay_no_change() {
    let mut plan = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    time_to_fire(&mut plan, Instant::from_micros(0));
    (0..12).for_each(|sensor| plan.set_enabled(sensor, false));
    let mut now = Instant::from_micros(0);
    while now.as_micros() < 40 * 60 * 1_000_000 {
        now = plan.deadline();
        assert_eq!(plan.poll(now), None);
    }
    (0..12).for_each(|sensor| plan.set_enabled(sensor, true));
    plan.change_to(&TABLE_I_A, ());
    assert!(time_to_fire(&mut plan, now) <= ms(400));
}

#[test]
fn forty_minutes_without_sensors_do_not_delay_a_restart() {
    let mut plan = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    time_to_fire(&mut plan, Instant::from_micros(0));
    plan.set_paused(true);
    let mut now = Instant::from_micros(0);
    while now.as_micros() < 40 * 60 * 1_000_000 {
        now = plan.deadline();
        assert_eq!(plan.poll(now), None);
    }
    plan.set_paused(false);
    plan.restart(now);
    // The deadline is near.
    assert!(plan.deadline().since(now) <= ms(200));
    assert!(time_to_fire(&mut plan, now) <= ms(200));
}

// Empty periods are caught up with if the poll is at most one period late.
#[test]
fn empty_periods_are_caught_up_one_late() {
    for (late, ended) in [(ms(99), 1), (ms(100), 2), (Micros::new(100_001), 1), (ms(60_000), 1)] {
        let mut ring: ScheduledRing<12> = Ring::unverified(&TABLE_I_D, CONFIG, Instant::from_micros(0)).unwrap();
        ring.pause();
        let now = ring.next_deadline() + late;
        let mut events = 0;
        while let Some(event) = ring.poll(now) {
            assert!(matches!(event, RingEvent::PeriodEnded(_)));
            events += 1;
        }
        assert_eq!(events, ended, "{late:?} late");
    }
}

/// Returns true if a reading survives a poll at an instant this long before the end of the period.
fn outlasts_a_step_back(back: u32) -> bool {
    let schedule = Schedule::<1>::from_firing(ms(20), [[ms(17)], [ms(18)]]).unwrap();
    let mut ring: ScheduledRing<1> = Ring::unverified(&schedule, CONFIG, Instant::from_micros(0)).unwrap();
    assert!(matches!(ring.poll(Instant::from_micros(17_000)), Some(RingEvent::Fire { .. })));
    assert_eq!(ring.poll(Instant::from_micros(20_000_u32.wrapping_sub(back))), None);
    loop {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { .. }) => return false,
            Some(RingEvent::Reading(_)) => return true,
            _ => {}
        }
    }
}

// A step back of the clock by up to three periods is no jump; one microsecond more is one.
#[test]
fn step_back_to_three_periods_is_no_jump() {
    assert_eq!([20_001, 60_000, 60_001].map(outlasts_a_step_back), [true, true, false]);
}

// A reading has the period and phase in which its sensor fired.
#[test]
fn reading_is_of_its_firings_period_and_phase() {
    // The window closes in the next period, which is of the other phase.
    let schedule = Schedule::<1>::from_firing(ms(20), [[ms(17)], [ms(18)]]).unwrap();
    let mut ring: ScheduledRing<1> = Ring::unverified(&schedule, CONFIG, Instant::from_micros(0)).unwrap();
    let (mut period, mut fired, mut readings) = (0, None, 0);
    while readings < 9 {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { phase, .. }) => fired = Some((period, phase)),
            Some(RingEvent::PeriodEnded(stats)) => {
                assert_eq!(stats.period, period);
                period += 1;
            }
            Some(RingEvent::Reading(reading)) => {
                assert_eq!(Some((reading.period, reading.phase)), fired.take());
                assert_eq!((reading.period, reading.period + 1), (readings, period));
                readings += 1;
            }
            _ => {}
        }
    }
}

#[test]
fn a_ring_smaller_than_its_scheduler_is_refused() {
    let plan = ScheduledFiring::new(&TABLE_I_D, Instant::default());
    let error = Ring::<_, _, 8, 1>::with_plan(plan, CONFIG, Instant::default());
    assert_eq!(error.unwrap_err().to_string(), "a plan of 12 sensors; expected at most the 8 of the ring");
}

#[test]
fn a_schedule_with_room_for_300_sensors_fires_those_that_it_has() {
    let times = [ms(0), ms(15), ms(30)];
    let schedule = Schedule::<300>::from_slices(ms(60), &[Micros::ZERO; 3], [&times, &times]).unwrap();
    let mut plan = ScheduledFiring::new(&schedule, Instant::default());
    let mut fired = vec![];
    for _ in 0..12 {
        if let Some(Upcoming { sensor, .. }) = plan.poll(plan.deadline()) {
            fired.push(sensor);
        }
    }
    // The first firing of a period is due when the one before ends.
    assert_eq!(fired, [0, 1, 2].repeat(4));
}

// A ring takes no larger `t_delta` than its schedule was verified for, at the start or later.
#[test]
fn ring_takes_no_larger_t_delta_than_verified() {
    let good = TABLE_I_D.verified(&Requirements::new(Micros::new(999))).unwrap();
    let better = TABLE_I_D.verified(&Requirements::new(Micros::new(500))).unwrap();
    let ring = |t_delta| -> Result<ScheduledRing<12>, RingError> {
        Ring::new(&good, RingConfig::new().with_t_delta(t_delta).with_window(ms(40)), Instant::default())
    };
    let refusal = "a t_delta of 30 ms; expected at most 999 us, which the schedule was verified for";
    assert_eq!(ring(ms(30)).unwrap_err().to_string(), refusal);
    let mut running = ring(Micros::new(999)).unwrap();
    assert_eq!(running.set_t_delta(ms(30)).unwrap_err().to_string(), refusal);
    let refused = RingError::TDelta { t_delta: Micros::new(999), verified: Micros::new(500) };
    assert_eq!(running.change_schedule(&better), Err(refused));
    running.set_t_delta(Micros::new(500)).unwrap();
    assert_eq!(running.change_schedule(&better), Ok(()));
    // The schedule to come counts, too.
    assert_eq!(running.set_t_delta(Micros::new(999)), Err(refused));
    assert_eq!(running.t_delta(), Micros::new(500));
}

// A ring listens no longer than its schedule was verified for, at the start or later.
#[test]
fn ring_listens_no_longer_than_verified() {
    let verified =
        |window| TABLE_I_D.verified(&Requirements { window, ..Requirements::new(Micros::new(999)) }).unwrap();
    let (long, short) = (verified(ms(50)), verified(ms(40)));
    let refusal = "a listening window of 60 ms; expected at most 50 ms, which the schedule was verified for";
    let ring = Ring::new(&long, RingConfig::new().with_window(ms(60)), Instant::default());
    assert_eq!(ring.unwrap_err().to_string(), refusal);
    let mut running = Ring::new(&long, RingConfig::new(), Instant::default()).unwrap();
    assert_eq!((running.t_delta(), running.window()), (Micros::new(999), ms(50)));
    assert_eq!(running.set_window(ms(60)).unwrap_err().to_string(), refusal);
    let refused = RingError::VerifiedWindow { window: ms(50), verified: ms(40) };
    assert_eq!(running.change_schedule(&short), Err(refused));
    running.set_window(ms(40)).unwrap();
    assert_eq!(running.change_schedule(&short), Ok(()));
    assert_eq!(running.set_window(ms(50)), Err(refused));
    // An unverified schedule limits the window to the time until a sensor fires again.
    let mut running = Ring::unverified(&TABLE_I_D, CONFIG, Instant::default()).unwrap();
    assert_eq!(running.set_window(ms(76)), Ok(()));
    assert_eq!(running.set_window(ms(77)), Err(RingError::Window { window: ms(77), min_refire: ms(76) }));
}

// `t_delta` and blanking are shorter than the window, at the start and later.
#[test]
fn t_delta_and_blanking_are_below_the_window() {
    let start = |config| Ring::unverified(&TABLE_I_D, config, Instant::default()).unwrap_err().to_string();
    let coarse = "a t_delta of 5 ms; expected less than the window of 5 ms, and at most 65.535 ms";
    assert_eq!(start(CONFIG.with_t_delta(ms(5))), coarse);
    let blank = "a blanking time of 5 ms; expected less than the window of 5 ms, and at most 65.535 ms";
    assert_eq!(start(CONFIG.with_blanking(ms(5))), blank);
    let mut ring = Ring::unverified(&TABLE_I_D, CONFIG.with_blanking(ms(4)), Instant::default()).unwrap();
    assert_eq!(ring.set_t_delta(ms(5)).unwrap_err().to_string(), coarse);
    assert_eq!(ring.set_blanking(ms(5)).unwrap_err().to_string(), blank);
    assert_eq!(ring.set_window(ms(4)), Err(RingError::Blanking { blanking: ms(4), window: ms(4) }));
    assert_eq!(ring.set_blanking(ms(3)), Ok(()));
    assert_eq!((ring.t_delta(), ring.window(), ring.blanking()), (ms(1), ms(5), ms(3)));
}

// An unverified schedule needs explicit `t_delta` and window.
#[test]
fn unverified_schedule_needs_t_delta_and_window() {
    for config in [RingConfig::new(), RingConfig::new().with_window(ms(5)), RingConfig::new().with_t_delta(ms(1))] {
        let error = Ring::unverified(&TABLE_I_D, config, Instant::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a schedule that was not verified; expected both t_delta and window in the configuration"
        );
    }
    // A verified schedule keeps its limits, whichever constructor takes it.
    let verified = TABLE_I_D.verified(&Requirements::new(Micros::new(999))).unwrap();
    assert!(Ring::unverified(&verified, CONFIG, Instant::default()).is_err());
    assert!(Ring::unverified(&verified, RingConfig::new(), Instant::default()).is_ok());
}

// Immediate refiring keeps any refire time that the clock can tell.
#[test]
fn immediate_refiring_takes_any_refire_time() {
    for min_refire in [ms(100_000), Micros::MAX] {
        let mut plan = ImmediateRefiring::new(&TABLE_I_D, min_refire, Instant::default());
        let mut last = [None; 12];
        let mut now = Instant::default();
        for _ in 0..20_000 {
            now = plan.deadline();
            if let Some(Upcoming { sensor, .. }) = plan.poll(now) {
                let last = last[usize::from(sensor)].replace(now);
                assert!(last.is_none_or(|last| now.since(last) >= ms(100_000)), "{min_refire}");
                plan.ended(sensor, now + ms(10));
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
    let mut ring = Ring::unverified(
        &slow,
        RingConfig::new().with_t_delta(us(999)).with_window(us(16_705)),
        Instant::from_micros(0),
    )
    .unwrap();
    let fired = Instant::from_micros(261_885);
    assert!(matches!(ring.poll(fired), Some(RingEvent::Fire { sensor: 0, .. })));
    ring.change_to_unverified(&fast).unwrap();
    let (mut now, mut events) = (fired, vec![]);
    let has_fired = |events: &[RingEvent]| events.iter().any(|event| matches!(event, RingEvent::Fire { .. }));
    while !has_fired(&events) {
        while let Some(event) = ring.poll(now) {
            events.push(event);
        }
        if !has_fired(&events) {
            now = ring.next_deadline();
        }
    }
    assert!(events.iter().any(|event| matches!(event, RingEvent::Reading(_))), "{events:?}");
    assert!(now.since(fired) >= slow.min_refire());
}

#[test]
fn schedules_are_equal_by_their_times_verified_or_not() {
    let plain = Schedule::<2>::from_firing(ms(100), [[ms(10), ms(55)], [ms(20), ms(60)]]).unwrap();
    let verified = verified(100, [10, 55], [20, 60], 40);
    assert_eq!(plain, *verified);
    for (period, a, b) in [(101, [10, 55], [20, 60]), (100, [10, 54], [20, 60]), (100, [10, 55], [20, 59])] {
        let other = Schedule::<2>::from_firing(ms(period), [a.map(ms), b.map(ms)]).unwrap();
        assert_ne!(plain, other);
    }
}

// The paper's ring of twelve is verified for 17 ms between neighbours.
#[test]
fn papers_ring_is_verified_for_17_ms() {
    assert_eq!(PAPER_12.verified_for().min_interval, Micros::from_millis(17));
}

#[test]
fn schedule_knows_its_phases_and_verification() {
    assert_eq!((TABLE_I_D.phases(), TABLE_I_D.is_verified(), PAPER_12.is_verified()), (2, false, true));
    let firings = [(2, 0), (0, 12), (2, 12)].map(|(phase, sensor)| TABLE_I_D.t_fire(Phase(phase), sensor));
    assert_eq!(firings, [None; 3]);
}

#[test]
fn schedules_hash_as_they_compare() {
    let hash = |schedule: &Schedule<12>| BuildHasherDefault::<DefaultHasher>::default().hash_one(schedule);
    let verified: &Schedule<12> = &PAPER_12;
    assert_eq!((verified, hash(verified)), (&TABLE_I_D, hash(&TABLE_I_D)));
    assert!(TABLE_I_A != TABLE_I_D && hash(&TABLE_I_A) != hash(&TABLE_I_D));
}

/// The kind of the first reading of sensor 1 after this many minutes without a poll, if it agrees with the one before
/// and both echo times exceed the audible time.
fn across_a_sleep(minutes: u32) -> ReadingKind {
    let config = RingConfig::new().with_audible(ms(10));
    let mut ring = Ring::new(&PAPER_12, config, Instant::from_micros(0)).unwrap();
    let (mut now, mut awake, mut kinds) = (Instant::from_micros(0), true, vec![]);
    loop {
        if awake && kinds.len() == 4 {
            awake = false;
            // Close to the end of the period, which precedes the sensor's next firing.
            while !matches!(ring.upcoming().next(), Some(Upcoming { sensor: 0, .. })) {
                now = ring.next_deadline();
                ring.poll(now);
            }
            now += ms(60_000 * minutes);
            kinds.clear();
        } else {
            let due = ring.next_deadline();
            now = if now.has_reached(due) { now } else { due };
        }
        match ring.poll(now) {
            Some(RingEvent::Fire { sensor: 1, .. }) => ring.echo(1, now + ms(30)).unwrap(),
            Some(RingEvent::Reading(reading)) if reading.sensor == 1 => kinds.push(reading.kind),
            _ => {}
        }
        if !awake && !kinds.is_empty() {
            return kinds[0];
        }
    }
}

// A reading from before the ring slept is compared with nothing: the instant it was heard at is forgotten.
#[test]
fn readings_across_a_long_sleep_are_not_compared() {
    for minutes in [18, 20, 25, 30, 35] {
        assert_ne!(across_a_sleep(minutes), ReadingKind::Accepted, "{minutes} minutes");
    }
}
