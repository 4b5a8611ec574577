//! Rings that weigh readings by a tracker: what happens to them while they run.

use crate::core_side::{echo, flat, state, upcoming};
use crate::world::{World, same, set_silence};
use crate::{C, Do, Random};
use eeruf_core::hopping::{HoppingError, Weighed};
use eeruf_core::{
    Instant, Micros, PeriodStats, Ring, RingError, RingEvent,
    judge::{EchoTracker, TrackerSettings},
    plan::Plan,
    watch::SensorWatch,
};

/// A ring with a tracker of four hypotheses, as C has it.
pub(crate) type TrackingRing<P, const K: usize> = Ring<P, EchoTracker<K, 4>, K, 1, 1>;

/// The status that C has for an error.
pub(crate) fn status_of(error: &HoppingError) -> i32 {
    match error {
        HoppingError::Sensors { .. } => -6,
        HoppingError::Phases { .. } => -7,
        HoppingError::Step { .. } => -23,
        HoppingError::Period { .. } => -8,
        HoppingError::Lag { .. } => -24,
        HoppingError::Ring(RingError::Setting { .. }) => -25,
        HoppingError::TDelta { .. } => -15,
        HoppingError::Votes { .. } => -28,
        HoppingError::Ring(RingError::Blanking { .. }) => -18,
        HoppingError::Ring(RingError::CoarseTDelta { .. }) => -19,
        HoppingError::Window { .. } => -17,
        HoppingError::Shift { .. } => -27,
        HoppingError::OtherCode => -22,
        _ => unreachable!("{error}"),
    }
}

/// Settings of a tracker, each anywhere in its range.
pub(crate) fn settings(r: &Random) -> TrackerSettings {
    let t_delta = r.within(1, 220);
    let near = r.within(t_delta, 600);
    let votes = r.within(2, 7) as u8;
    TrackerSettings::BALANCED
        .with_t_delta(Micros::new(t_delta))
        .with_near(Micros::new(near))
        .with_votes(votes)
        .with_score_limit(r.within(votes.into(), 15) as u8)
        .with_contradiction(r.within(1, 4) as u8)
        .with_solo_contradiction(r.within(1, 9) as u8)
        .with_tentative_votes(r.one_of(&[0, 2, 3, 4, 1]))
        .with_tentative_within(Micros::new(r.within(0, t_delta)))
        .with_memory(r.one_of(&[0, 5, r.within(0, 255) as u8]))
}

/// They, in the order that `shim.c` names.
pub(crate) fn numbers(t: &TrackerSettings) -> [u32; 9] {
    let [t_delta, near, within] = [t.t_delta, t.near, t.tentative_within].map(Micros::as_micros);
    let small = [t.votes, t.score_limit, t.contradiction, t.solo_contradiction, t.tentative_votes, t.memory];
    let [votes, score_limit, contradiction, solo_contradiction, tentative_votes, memory] = small.map(u32::from);
    [t_delta, near, within, votes, score_limit, contradiction, solo_contradiction, tentative_votes, memory]
}

/// Runs a ring in both languages for up to 4,000 steps, or until there are no numbers left; the number of its events.
/// `plan_step` does what is for this plan alone: at odd times, and with the figures of a period that has ended.
///
/// # Panics
/// Where C and Rust differ.
pub(crate) fn run<P: Plan, const K: usize>(
    r: &Random,
    mut c: C,
    mut ring: TrackingRing<P, K>,
    window: u32,
    start: u32,
    weighed: impl Fn(&TrackingRing<P, K>, u8) -> Option<Weighed>,
    mut plan_step: impl FnMut(&mut C, &mut TrackingRing<P, K>, Option<&PeriodStats>, &str),
) -> u64 {
    let (origin, mut count) = (r, 0);
    let mut world = World::new(r.clone(), K as u8, window);
    world.now = start;
    set_silence(r, &mut c, &mut ring);
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    assert_eq!(c.watch(K as u8, start), 0);
    let moves = r.once_in(3);
    // Mostly as of a robot that drives, now and then of none that there is.
    let most = r.one_of(&[200, 200, 2_000, 200_000]);
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
            match r.within(0, 13) {
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
                13 => plan_step(&mut c, &mut ring, None, &format!("{origin}, step {step}")),
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
        let changes: Vec<i32> = (0..K).map(|_| r.duration(most) as i32 - (most / 2) as i32).collect();
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
                    let Some(of) = weighed(&ring, reading.sensor) else { unreachable!("{}", at()) };
                    let how = u32::from(of.solo) | u32::from(of.steady) << 1;
                    assert_eq!(c.weighed(reading.sensor), (how, u32::from(of.changes)), "{}", at());
                }
                RingEvent::PeriodEnded(stats) => plan_step(&mut c, &mut ring, Some(&stats), &at()),
            }
        }
    }
    count
}
