//! Flow rings of the corpus.
//!
//! Lines beside those of other rings: `W` the settings and the start, in the order of [`settings`]; `G` silence needs a
//! witness from now on, `Y` a sensor that answered (1) or did not (0); `M` the change of each sensor that the polls to
//! come expect; `Z` a pause or its end; `B` a sensor whose echoes are forgotten; `Q` the quiet of a sensor before and
//! after its firing; `U` sensor and instant of each firing to come.

use eeruf_core::{
    Instant, Micros, Reading, RingEvent,
    flow::{FlowRing, FlowSettings},
    hopping::HoppingListening,
    judge::TrackerSettings,
    watch::SensorWatch,
};

use super::{Text, World, flat, flat_state, silence};
use crate::common::random::Random;

const STEPS: u32 = 260;
/// Seeds of rings in which a port differs if it gets a border of the rules wrong: of rest, of memory, of how gaps are
/// shared out, of lateness, of what is learned of a moving robot, of what is near.
pub(super) const RARE: [u64; 9] = [9, 12, 23, 31, 106, 203, 312, 383, 530];

/// Mostly those of every robot.
fn settings(r: &mut Random) -> FlowSettings {
    let mut settings = FlowSettings::DEFAULT;
    if r.once_in(2) {
        let (t_delta, votes) = (r.within(20, 220), r.within(2, 7));
        settings.tracker = TrackerSettings::BALANCED
            .with_t_delta(Micros::new(t_delta))
            .with_near(Micros::new(r.within(t_delta, 600)))
            .with_tentative_within(Micros::new(r.up_to(t_delta)))
            .with_votes(votes as u8)
            .with_score_limit(r.within(votes, 15) as u8)
            .with_contradiction(r.within(1, 4) as u8)
            .with_tentative_votes(r.one_of(&[0, 2, 3, 4]))
            .with_memory(r.one_of(&[0, 5, 40]));
        settings.unserved_after = r.up_to(5) as u8;
        settings.shortest_gap = Micros::new(r.within(0, 12_000));
        settings.masked_adds = Micros::new(r.within(0, 12_000));
        settings.unserved_adds = Micros::new(r.within(0, 12_000));
        settings.believed_takes = Micros::new(r.within(0, 3_000));
        settings.travel = Micros::new(r.within(0, 800));
    }
    if r.once_in(2) {
        settings.step = Micros::new(r.within(240, 400));
        settings.shortest_cycle = Micros::new(r.within(60_000, 140_000));
        settings.longest_cycle = Micros::new(r.within(50_000, 500_000));
        settings.rest = Micros::new(r.one_of(&[0, 60_000, 130_000]));
        settings.lead = Micros::new(r.one_of(&[0, 4_000, 40_000]));
    }
    settings
}

/// Writes down a ring of any number of sensors.
pub(super) fn run_any(r: &mut Random, text: &mut Text) {
    match r.up_to(4) {
        0 => run::<1>(r, text),
        1 => run::<3>(r, text),
        2 => run::<5>(r, text),
        3 => run::<12>(r, text),
        _ => run::<8>(r, text),
    }
}

fn begin<const K: usize>(r: &mut Random, text: &mut Text) -> (FlowRing<K>, u32, u32) {
    let s = settings(r);
    let windows = [36_000, 36_000, r.within(9_000, 36_000)];
    let (window, blanking) = (r.one_of(&windows), r.up_to(1) * r.duration(3_000));
    let reach = window + r.up_to(1) * r.up_to(20_000);
    let starts = [0, r.duration(300_000).wrapping_neg(), r.next() as u32];
    let start = r.one_of(&starts);
    let gaps = [s.step, s.shortest_gap, s.masked_adds, s.believed_takes, s.unserved_adds].map(Micros::as_micros);
    let cycles = [s.shortest_cycle, s.rest, s.lead, s.longest_cycle, s.travel].map(Micros::as_micros);
    let t = s.tracker;
    let within = [t.t_delta, t.near, t.tentative_within].map(Micros::as_micros);
    let votes = [t.votes, t.score_limit, t.contradiction, t.tentative_votes, t.memory].map(u32::from);
    let listens = [K as u32, window, blanking, reach];
    text.add('W', [&listens[..], &gaps, &[s.unserved_after.into()], &cycles, &within, &votes, &[start]].concat());
    let listening =
        HoppingListening::new(Micros::new(window)).with_blanking(Micros::new(blanking)).with_reach(Micros::new(reach));
    (FlowRing::flow(K, s, listening, Instant::from_micros(start)).unwrap(), window, start)
}

fn run<const K: usize>(r: &mut Random, text: &mut Text) {
    let (mut ring, window, start) = begin::<K>(r, text);
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    let needs_answers = r.once_in(2);
    ring.set_silence(silence(text, if needs_answers { start % 2 } else { 2 }));
    let mut world = World {
        now: start,
        late: r.one_of(&[0, 0, 30, 300, 3_000]),
        calm: r.one_of(&[1, 10, 100]),
        // Some have nothing in range: what they hear comes after the window.
        own: (0..K).map(|_| r.within(1, window + window / 4)).collect(),
        path: r.within(100, window),
        path_only: false,
        echoes: vec![],
    };
    let speed = r.one_of(&[0, 0, 60, 400]);
    let mut change = [0; K];
    for step in 0..STEPS {
        if speed > 0 && step % 40 == 0 {
            change = [(); K].map(|()| r.up_to(speed) as i32 - (speed / 2) as i32);
            text.add_signed('M', change);
        }
        world.turn_clock(r, ring.next_deadline().as_micros());
        for (at, sensor) in world.heard() {
            text.add('E', [sensor.into(), at]);
            ring.echo(sensor, Instant::from_micros(at)).unwrap();
        }
        if r.once_in(12 * world.calm) {
            operate(r, text, &mut ring, world.now);
            if text.0.lines().last().is_some_and(|line| line.starts_with('R')) {
                watch.restart(Instant::from_micros(world.now));
            }
        }
        for _ in 0..20 {
            let event = ring.poll_expecting(Instant::from_micros(world.now), |x| change[usize::from(x)]);
            let numbers = [world.now, ring.next_deadline().as_micros()];
            text.add('P', numbers.into_iter().chain(event.iter().flat_map(flat)));
            let Some(event) = event else { break };
            watch.observe(&event, Instant::from_micros(world.now));
            match event {
                RingEvent::Fire { sensor, .. } => fired(r, text, (&mut ring, &mut world), sensor, needs_answers),
                RingEvent::Reading(Reading { sensor, .. }) => {
                    let own = &mut world.own[usize::from(sensor)];
                    *own = own.saturating_add_signed(change[usize::from(sensor)]).clamp(1, window + window / 4);
                    let at = world.now.wrapping_add(100 * u32::from(sensor));
                    let state = watch.state(sensor, Instant::from_micros(at)).unwrap();
                    text.add('O', [sensor.into(), at].into_iter().chain(flat_state(state)));
                }
                RingEvent::PeriodEnded(_) => {
                    let sensor = r.up_to(K as u32 - 1) as u8;
                    let (before, after) = ring.plan().quiet(sensor).unwrap();
                    text.add('Q', [sensor.into(), before.as_micros(), after.as_micros()]);
                    let upcoming = ring.upcoming().map(|firing| [firing.sensor.into(), firing.due.as_micros()]);
                    let upcoming = upcoming.collect::<Vec<_>>().concat();
                    text.add('U', upcoming);
                }
            }
        }
    }
}

/// Events at and after a firing.
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
    if r.once_in(8 * world.calm) {
        fired = fired.wrapping_add(r.duration(2_000));
        text.add('F', [sensor.into(), fired]);
        ring.fired(sensor, Instant::from_micros(fired)).unwrap();
    }
    world.fired(r, sensor, fired);
}

/// Does something to the ring.
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
