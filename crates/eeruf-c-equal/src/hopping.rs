//! Rings that hop in time.

use crate::core_side::{echo, flat, state, upcoming};
use crate::{C, Do, Random};
use eeruf_core::{
    Instant, Micros, RingError, RingEvent,
    hopping::{HoppingCode, HoppingError, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    judge::TrackerSettings,
    watch::SensorWatch,
};

use crate::world::{World, same};

fn status_of(error: &HoppingError) -> i32 {
    match error {
        HoppingError::Sensors { .. } => -6,
        HoppingError::Phases { .. } => -7,
        HoppingError::Step { .. } => -23,
        HoppingError::Period { .. } => -8,
        HoppingError::Lag { .. } => -24,
        HoppingError::Tracker(_) => -25,
        HoppingError::TDelta { .. } => -15,
        HoppingError::Votes { .. } => -28,
        HoppingError::Ring(RingError::Blanking { .. }) => -18,
        HoppingError::Ring(RingError::CoarseTDelta { .. }) => -19,
        HoppingError::Window { .. } => -17,
        _ => unreachable!("{error}"),
    }
}

fn settings(r: &Random) -> HoppingSettings {
    let mut settings =
        r.one_of(&[HoppingSettings::BALANCED, HoppingSettings::QUICK, HoppingSettings::DRIVING, HoppingSettings::MAPS]);
    if r.once_in(2) {
        let t_delta = r.within(1, 220);
        let near = r.within(t_delta, 600);
        let votes = r.within(2, 7) as u8;
        settings.tracker = TrackerSettings::BALANCED
            .with_t_delta(Micros::new(t_delta))
            .with_near(Micros::new(near))
            .with_votes(votes)
            .with_score_limit(r.within(votes.into(), 15) as u8)
            .with_contradiction(r.within(1, 4) as u8)
            .with_solo_contradiction(r.within(1, 9) as u8)
            .with_tentative_votes(r.one_of(&[0, 2, 3, 4, 1]))
            .with_tentative_within(Micros::new(r.within(0, t_delta)));
        settings.solo_rate = r.one_of(&[0, 255, r.within(0, 255) as u8]);
        settings.solo_after = r.within(0, 9) as u8;
        settings.solo_spacing = r.within(0, 5) as u8;
        settings.shift_after = r.within(0, 6) as u8;
        settings.shift_spacing = r.within(0, 9) as u8;
        settings.shift_interval = Micros::new(r.one_of(&[0, 2_000, 8_000]));
        settings.neighbours = r.within(0, 5) as u8;
    }
    settings
}

/// One hopping ring for up to 4,000 steps, or until there are no numbers left; how many events it had.
///
/// # Panics
/// Where C and Rust differ.
pub fn run<const K: usize>(r: &Random) -> u64 {
    let (mut c, origin) = (C::new(), r);
    let s = settings(r);
    let (phases, step) = (r.one_of(&[2, 2, 2, 8, 16, r.within(0, 70) as u8]), r.one_of(&[240, 240, r.duration(900)]));
    let period = r.one_of(&[60_000, r.within(20_000, 120_000), r.duration(1 << 28)]);
    let longest = HoppingListening::MAX_WINDOW.as_micros();
    let window = r.one_of(&[36_000, 36_000, 30_000, r.within(1, 40_000), r.within(longest - 2_000, longest + 200)]);
    let blanking = r.one_of(&[0, 500, r.duration(4_000)]);
    let listening = HoppingListening::new(Micros::new(window))
        .with_blanking(Micros::new(blanking))
        .with_reach(Micros::new(r.one_of(&[window, r.duration(100_000)])));
    // Also where the clock begins, at which sensors would seem to have just fired.
    let (random_seed, start) = (r.within(0, 3), r.one_of(&[r.any() as u32, r.duration(50_000)]));
    let t = s.tracker;
    let mut numbers = vec![step, period, window, blanking, listening.reach.as_micros()];
    numbers.extend([s.shift_interval.as_micros(), random_seed]);
    numbers.extend([t.t_delta, t.near, t.tentative_within].map(Micros::as_micros));
    let small = [t.votes, t.score_limit, t.contradiction, t.solo_contradiction, t.tentative_votes, s.solo_rate];
    numbers.extend(small.map(u32::from));
    numbers.extend([s.solo_after, s.solo_spacing, s.shift_after, s.shift_spacing, s.neighbours].map(u32::from));
    let lags: Option<[Micros; K]> = r.once_in(2).then(|| [(); K].map(|()| Micros::new(r.within(0, period / 2))));
    // Mostly the ordinary code, else any, and the one whose period may be shortest.
    let any_code = HoppingCode::of(K, phases, r.one_of(&[0, r.within(0, 70) as u8]), Micros::new(step));
    let shortest = HoppingCode::shortest(K, phases, Micros::new(step));
    let (phases, code, rust) = match (r.within(0, 3), &any_code, &shortest) {
        (0, Ok(code), _) | (1, _, Ok(code)) => (code.phases(), 1 + code.first_multiplier(), Ok(*code)),
        _ => (phases, 0, HoppingCode::new(K, phases, Micros::new(step))),
    };
    numbers.push(code.into());
    numbers.extend(lags.iter().flatten().map(|lag| lag.as_micros()));
    let status = c.hopping(K as u8, phases, &numbers, start);
    let rust = rust.and_then(|code| {
        let schedule = match lags {
            Some(lags) => HoppingSchedule::<K>::new(code, Micros::new(period), lags)?,
            None => HoppingSchedule::spread(code, Micros::new(period))?,
        };
        HoppingRing::<K>::hopping(&schedule, s, listening, random_seed, Instant::from_micros(start))
    });
    let mut ring = match rust {
        Ok(ring) => ring,
        Err(error) => {
            assert_eq!(status, status_of(&error), "{r}: {error}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let mut world = World::new(r.clone(), K as u8, window);
    world.now = start;
    if r.once_in(2) {
        ring.expect_answers();
        same::<()>(&mut c, Do::ExpectAnswers, 0, 0, Ok(()));
    }
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    assert_eq!(c.watch(K as u8, start), 0);
    let moves = r.once_in(3);
    let mut count = 0;
    for step in 0..4_000 {
        if r.is_over() {
            break;
        }
        world.turn_clock(ring.next_deadline().as_micros());
        if world.random.once_in(20) {
            // Clocks of several cores differ by microseconds.
            world.now = world.now.wrapping_sub(world.random.within(1, 3));
        }
        for (at, sensor) in world.heard() {
            same(&mut c, Do::Echo, sensor, at, ring.echo(sensor, Instant::from_micros(at)));
        }
        let r = &world.random;
        if r.once_in(100) {
            let sensor = r.within(0, K as u32) as u8;
            match r.within(0, 12) {
                0..3 => same(&mut c, Do::Enable, sensor, 0, ring.disable(sensor)),
                3..8 => same(&mut c, Do::Enable, sensor, 1, ring.enable(sensor)),
                8 => {
                    let at = world.now.wrapping_add(r.duration(3_000));
                    same(&mut c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
                }
                9 => {
                    ring.pause();
                    same::<()>(&mut c, Do::Pause, 0, 1, Ok(()));
                }
                10 | 11 => {
                    ring.resume();
                    same::<()>(&mut c, Do::Pause, 0, 0, Ok(()));
                }
                _ => {
                    ring.restart(Instant::from_micros(world.now));
                    same::<()>(&mut c, Do::Restart, 0, world.now, Ok(()));
                }
            }
            assert_eq!(c.call(Do::IsEnabled, sensor, 0) == 1, ring.is_enabled(sensor));
        }
        let changes: Vec<i32> = (0..K).map(|_| r.duration(200) as i32 - 100).collect();
        for _ in 0..20 {
            let now = Instant::from_micros(world.now);
            let event = ring.poll_expecting(now, |x| if moves { changes[usize::from(x)] } else { 0 });
            let in_c = c.poll(world.now, moves.then_some(&changes));
            let at = || format!("{origin}, step {step}: {event:?}");
            assert_eq!(in_c, event.as_ref().map(flat).ok_or(0), "{}", at());
            assert_eq!(c.deadline(), ring.next_deadline().as_micros(), "{}", at());
            assert_eq!(c.upcoming(), upcoming(ring.upcoming()), "{}", at());
            let Some(event) = event else { break };
            count += 1;
            watch.observe(&event, now);
            let (sensor, later) =
                (world.random.within(0, K as u32) as u8, world.now.wrapping_add(world.random.duration(u32::MAX)));
            let known = watch.state(sensor, Instant::from_micros(later)).map(state).map_err(|_| -5);
            assert_eq!(c.state(sensor, later), known, "{}", at());
            match event {
                RingEvent::Fire { sensor, .. } => {
                    world.fired(sensor);
                    if world.random.once_in(60) {
                        same(&mut c, Do::Stuck, sensor, 0, ring.stuck(sensor));
                    }
                    if world.random.once_in(2) {
                        same(&mut c, Do::Answered, sensor, 0, ring.answered(sensor));
                        if world.random.once_in(4) {
                            same(&mut c, Do::Unanswered, sensor, 0, ring.unanswered(sensor));
                        }
                    }
                    if world.random.once_in(8) {
                        let echo = (!world.random.once_in(3)).then(|| world.random.duration(30_000));
                        let measured = ring.measured(sensor, echo.map(Micros::new));
                        same(&mut c, Do::Measured, sensor, echo.unwrap_or(crate::NO_ECHO), measured);
                    }
                    if world.random.once_in(40) {
                        same(&mut c, Do::Forget, sensor, 0, ring.forget(sensor));
                    }
                    if world.random.once_in(15) {
                        let at = world.now.wrapping_add(world.random.duration(2_000));
                        same(&mut c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
                    }
                }
                RingEvent::Reading(reading) => {
                    let confirmed = echo(ring.judge().confirmed(reading.sensor.into()));
                    assert_eq!(c.confirmed_us(reading.sensor), confirmed, "{}", at());
                    let how =
                        ring.plan().weighed(reading.sensor, 0).map(|of| u32::from(of.solo) | u32::from(of.steady) << 1);
                    let weighed = (how.unwrap_or(0), u32::from(ring.plan().changes()));
                    assert_eq!(c.weighed(reading.sensor), weighed, "{}", at());
                }
                RingEvent::PeriodEnded(_) => {
                    for sensor in 0..K as u8 {
                        assert_eq!(Some(Micros::new(c.lag_us(sensor))), ring.plan().t_lag(sensor.into()));
                    }
                    let solo = ring.plan().solo().map_or(255, i32::from);
                    assert_eq!(c.call(Do::Solo, 0, 0) & 255, solo, "{}", at());
                }
            }
        }
    }
    count
}
