//! Flow rings of the corpus.
//!
//! Further lines: `W` sensors, window, blanking, then the settings in the order of [`begin`], votes by number, and the
//! start; `D` the robot's speed (mm/s) and turn (mrad/s) at an instant; `G` silence needs a witness from now on, `Y` a
//! sensor that answered (1) or did not (0), `H` a measured echo time of its last firing, `M` one between two limits;
//! `Z` a pause or its end; `B` a sensor whose echoes are forgotten; `Q` the quiet of a sensor, and its believed echo
//! time; `U` sensor and instant of the next firing, if one comes in this round.

use eeruf_core::{
    Instant, Micros, Reading, RingConfig, RingEvent,
    flow::{BeliefSettings, FlowRing, TurnSettings, Votes},
    judge::Judge as _,
    watch::SensorWatch,
};

use super::{NONE, Text, World, edge, flat, flat_state, silence};
use crate::common::random::Random;

const STEPS: u32 = 300;
/// All kinds of votes, in the order of their numbers.
const VOTES: [Votes; 3] = [Votes::ByMotion, Votes::EveryEcho, Votes::TwoInARow];

/// Random settings, mostly the defaults.
fn settings(r: &mut Random) -> (TurnSettings, BeliefSettings) {
    let (mut turns, mut belief) = (TurnSettings::new(r.within(1, u32::MAX)), BeliefSettings::DEFAULT);
    if r.once_in(2) {
        let longest = [33_500, 24_000, r.within(1_000, 80_000)];
        let most = r.one_of(&longest);
        turns.most = Micros::new(most);
        turns.least = Micros::new(r.within(100, most));
        let (rests, dice) = ([60_000, 30_000, r.within(1_000, 150_000)], [0, 2_000, 8_000, r.within(8, 20_000)]);
        turns.rest = Micros::new(r.one_of(&rests));
        turns.dice = Micros::new(r.one_of(&dice));
    }
    if r.once_in(2) {
        let times = [&mut belief.t_delta, &mut belief.near, &mut belief.path_change];
        times.into_iter().for_each(|time| *time = Micros::new(r.up_to(400)));
        (belief.memory, belief.hold) = (r.up_to(12) as u8, r.within(1, 8) as u8);
    }
    belief.top_speed_mm_s = r.one_of(&[0, 0, 300, 1_000, u16::MAX]);
    (belief.alone, belief.votes) = (r.once_in(2), r.one_of(&[VOTES[0], VOTES[0], VOTES[1], VOTES[2]]));
    (turns, belief)
}

/// Records a ring of any number of sensors.
pub(super) fn run_any(r: &mut Random, text: &mut Text, looks: u32) {
    match r.up_to(6) {
        0 => run::<1>(r, text, looks),
        1 => run::<2>(r, text, looks),
        2 => run::<3>(r, text, looks),
        3 => run::<6>(r, text, looks),
        4 => run::<12>(r, text, looks),
        5 => run::<24>(r, text, looks),
        _ => run::<8>(r, text, looks),
    }
}

fn begin<const K: usize>(r: &mut Random, text: &mut Text) -> (FlowRing<K>, u32, u32) {
    let (t, b) = settings(r);
    // No longer than a sensor rests.
    let windows = [25_000, 36_000, r.within(4_000, 36_000)];
    let (window, blanking) = (r.one_of(&windows), r.up_to(1) * r.duration(3_000));
    let starts = [0, r.duration(300_000).wrapping_neg(), r.next() as u32];
    let start = r.one_of(&starts);
    let turns = [t.least, t.most, t.rest, t.dice].map(Micros::as_micros);
    let belief = [b.t_delta, b.near, b.path_change].map(Micros::as_micros);
    let votes = VOTES.iter().position(|&votes| votes == b.votes).unwrap() as u32;
    let numbers = [b.memory.into(), b.hold.into(), b.top_speed_mm_s.into(), b.alone.into(), votes];
    text.add('W', [&[K as u32, window, blanking][..], &turns, &[t.seed], &belief, &numbers, &[start]].concat());
    let config = RingConfig::new().with_window(Micros::new(window)).with_blanking(Micros::new(blanking));
    (FlowRing::flow(K, t, b, config, Instant::from_micros(start)).unwrap(), window, start)
}

fn run<const K: usize>(r: &mut Random, text: &mut Text, looks: u32) {
    let (mut ring, window, start) = begin::<K>(r, text);
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    let needs_answers = r.once_in(2);
    ring.set_silence(silence(text, if needs_answers { start % 2 } else { 2 }));
    let mut world = World {
        now: start,
        late: r.one_of(&[0, 0, 30, 300, 1_000, 5_000]),
        calm: r.one_of(&[1, 10, 100]),
        // Some have nothing in range: their echoes come after the window.
        own: (0..K).map(|_| r.within(1, window + window / 4)).collect(),
        path: r.within(100, window),
        path_only: r.once_in(4),
        echoes: vec![],
        looks,
    };
    let (moves, tick) = (r.once_in(2), r.one_of(&[1, 1, 1_000]));
    for _ in 0..STEPS {
        world.turn_clock(r, ring.next_deadline().as_micros());
        world.now = world.now.wrapping_add((tick - world.now % tick) % tick);
        for (at, sensor) in world.heard() {
            edge((r, text), &mut ring, sensor, at, looks);
        }
        if moves && r.once_in(20) {
            let (speeds, turns) = ([0, 0, 1_000, r.duration(4_000)], [0, 0, r.duration(3_000)]);
            let (speed, turn) = (r.one_of(&speeds), r.one_of(&turns));
            text.add('D', [speed, turn, world.now]);
            ring.moving(speed, turn, Instant::from_micros(world.now));
            for own in &mut world.own {
                *own = (*own + r.up_to(speed / 4)).saturating_sub(r.up_to(speed / 4)).max(1);
            }
        }
        if r.once_in(12 * world.calm) {
            operate(r, text, &mut ring, world.now);
            if text.0.lines().last().is_some_and(|line| line.starts_with('R')) {
                watch.restart(Instant::from_micros(world.now));
            }
        }
        for _ in 0..20 {
            let event = ring.poll(Instant::from_micros(world.now));
            let numbers = [world.now, ring.next_deadline().as_micros()];
            text.add('P', numbers.into_iter().chain(event.iter().flat_map(flat)));
            let Some(event) = event else { break };
            watch.observe(&event, Instant::from_micros(world.now));
            match event {
                RingEvent::Fire { sensor, .. } => fired(r, text, (&mut ring, &mut world), sensor, needs_answers),
                RingEvent::Reading(Reading { sensor, .. }) => {
                    let at = world.now.wrapping_add(100 * u32::from(sensor));
                    let state = watch.state(sensor, Instant::from_micros(at)).unwrap();
                    text.add('O', [sensor.into(), at].into_iter().chain(flat_state(state)));
                    let quiet = ring.plan().doubt_of(sensor).unwrap().as_micros();
                    let believed = ring.judge().believed(sensor).map_or(NONE, Micros::as_micros);
                    text.add('Q', [sensor.into(), quiet, believed]);
                }
                RingEvent::PeriodEnded(_) => {
                    let upcoming = ring.upcoming().map(|firing| [firing.sensor.into(), firing.due.as_micros()]);
                    let upcoming = upcoming.collect::<Vec<_>>().concat();
                    text.add('U', upcoming);
                }
            }
        }
    }
}

/// Performs the events at and after a firing.
fn fired<const K: usize>(
    r: &mut Random,
    text: &mut Text,
    (ring, world): (&mut FlowRing<K>, &mut World),
    sensor: u8,
    needs_answers: bool,
) {
    let mut fired = world.now;
    if r.once_in(24 * world.calm) {
        text.add('K', [sensor.into()]);
        ring.stuck(sensor).unwrap();
    }
    if needs_answers && !r.once_in(8) {
        text.add('Y', [sensor.into(), 1]);
        ring.answered(sensor).unwrap();
        if r.once_in(16) {
            text.add('Y', [sensor.into(), 0]);
            ring.unanswered(sensor).unwrap();
        }
    }
    if world.looks > 0 && r.once_in(4) {
        let least = world.own[usize::from(sensor)];
        let most = least + r.duration(world.looks);
        text.add('M', [sensor.into(), least, most]);
        ring.measured_between(sensor, Micros::new(least), Micros::new(most)).unwrap();
    }
    if r.once_in(8 * world.calm) {
        let echo = r.one_of(&[NONE, world.own[usize::from(sensor)]]);
        text.add('H', [sensor.into(), echo]);
        ring.measured(sensor, (echo != NONE).then_some(Micros::new(echo))).unwrap();
    }
    if r.once_in(8 * world.calm) {
        let by = r.duration(4_000);
        fired = if r.once_in(2) { fired.wrapping_add(by) } else { fired.wrapping_sub(by) };
        text.add('F', [sensor.into(), fired]);
        ring.fired(sensor, Instant::from_micros(fired)).unwrap();
    }
    world.fired(r, sensor, fired);
}

/// Performs a random operation on the ring.
fn operate<const K: usize>(r: &mut Random, text: &mut Text, ring: &mut FlowRing<K>, now: u32) {
    let sensor = r.up_to(K as u32 - 1) as u8;
    match r.up_to(9) {
        0 => {
            text.add('R', [now]);
            ring.restart(Instant::from_micros(now));
        }
        1 => {
            text.add('Z', [1]);
            ring.pause();
        }
        2 | 3 => {
            text.add('Z', [0]);
            ring.resume();
        }
        4 => {
            text.add('B', [sensor.into()]);
            ring.forget(sensor).unwrap();
        }
        5 => {
            let at = now.wrapping_sub(r.duration(100_000));
            text.add('F', [sensor.into(), at]);
            ring.fired(sensor, Instant::from_micros(at)).unwrap();
        }
        what => {
            let on = what > 6;
            text.add('N', [sensor.into(), on.into()]);
            if on { ring.enable(sensor).unwrap() } else { ring.disable(sensor).unwrap() }
        }
    }
}
