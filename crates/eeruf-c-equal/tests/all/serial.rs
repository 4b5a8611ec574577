//! Frames of C and Rust on a serial line.

use eeruf_c_equal::core_side::{explanation, flat};
use eeruf_c_equal::{C, Do, Random};
use eeruf_core::{
    Instant, Micros, Phase, ReadingKind, Ring, RingConfig, RingEvent, Schedule,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    judge::Explanation,
    plan::ScheduledFiring,
    tables::PAPER_12,
};
use eeruf_serial::{Frame, Recorder};

use eeruf_c_equal::world::{World, same};

const SENSORS: u8 = 12;

#[test]
fn the_same_events_make_the_same_frames() {
    let (mut frames, mut seed) = (0, 0);
    while frames < crate::events() / 4 {
        frames += run(seed);
        seed += 1;
    }
}

/// Makes two of three readings ambiguous, on both sides.
fn explain(event: &mut RingEvent, c: &mut C) {
    let RingEvent::Reading(reading) = event else { return };
    let by = match reading.period % 3 {
        0 => return,
        1 => Explanation::Sensor(reading.sensor ^ 1),
        _ => Explanation::History,
    };
    (reading.kind, reading.explained_by) = (ReadingKind::Ambiguous, Some(by));
    c.explain(explanation(reading.explained_by) as u8);
}

/// One ring, its clock late, jumping and wrapping; how many frames it made.
fn run(seed: u64) -> u64 {
    let (r, mut c) = (Random::new(seed), C::new());
    // A table that nobody verified, on both sides.
    let t_fire = |phase, sensor| PAPER_12.t_fire(phase, sensor).expect("one of twelve");
    let rows = [Phase::A, Phase::B].map(|phase| std::array::from_fn::<_, 12, _>(|sensor| t_fire(phase, sensor)));
    let slices = [&rows[0][..], &rows[1][..]];
    let schedule = Schedule::<12, 2>::from_slices(PAPER_12.period(), &[Micros::ZERO; 12], slices).unwrap();
    let times: Vec<u32> = rows.as_flattened().iter().map(|time| time.as_micros()).collect();
    assert_eq!(c.schedule(PAPER_12.period().as_micros(), SENSORS, 2, &times), 0);
    let (t_delta, window, start) = (500, 30_000, r.any() as u32);
    assert_eq!(c.ring(0, [t_delta, window, 0, 0, 0], 2, start), 0);
    let config = RingConfig::new().with_t_delta(Micros::new(t_delta)).with_window(Micros::new(window));
    let start_at = Instant::from_micros(start);
    let mut ring = Ring::<ScheduledFiring<'_, 12, 2>, _, 12>::unverified(&schedule, config, start_at).unwrap();
    // Of the name 16 letters are sent.
    let mut recorder = Recorder::<12>::new("board of sixteen letters");
    let mut world = World::new(r, SENSORS, window);
    world.now = start;
    let mut count = 0;
    for _ in 0..2_000 {
        world.turn_clock(ring.next_deadline().as_micros());
        for (at, sensor) in world.heard() {
            same(&mut c, Do::Echo, sensor, at, ring.echo(sensor, Instant::from_micros(at)));
        }
        let now = Instant::from_micros(world.now);
        for _ in 0..20 {
            let event = ring.poll(now);
            assert_eq!(c.poll(world.now, None), event.as_ref().map(flat).ok_or(0), "seed {seed}");
            let Some(mut event) = event else { break };
            explain(&mut event, &mut c);
            if let RingEvent::Fire { sensor, .. } = event {
                world.fired(sensor);
            }
            let in_rust = recorder.event(&event, now, |_| 0, 0);
            let in_rust = in_rust.as_ref().map_or(&[][..], Frame::as_bytes);
            assert_eq!(c.serial_event(SENSORS, None, world.now), in_rust, "seed {seed}: {event:?}");
            count += u64::from(!in_rust.is_empty());
        }
    }
    count
}

// A hopping ring says with each reading how it was weighed in the same frames.
#[test]
fn hopping_frames_say_how_readings_were_weighed() {
    let (mut frames, mut seed) = (0, 0);
    while frames < crate::events() / 8 {
        frames += hop(seed);
        seed += 1;
    }
}

/// One hopping ring of eight, its clock late, jumping and wrapping; how many frames it made.
fn hop(seed: u64) -> u64 {
    const EIGHT: u8 = 8;
    let (r, mut c) = (Random::new(seed), C::new());
    let (start, settings) = (r.any() as u32, HoppingSettings::BALANCED);
    let code = HoppingCode::new(8, 5, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<8>::spread(code, Micros::from_millis(60)).unwrap();
    let listening = HoppingListening::new(Micros::from_millis(36));
    let mut ring = HoppingRing::<8>::hopping(&schedule, settings, listening, 1, Instant::from_micros(start)).unwrap();
    let t = settings.tracker;
    let reach = listening.reach.as_micros();
    let mut numbers = vec![240, 60_000, 36_000, 0, reach, settings.shift_interval.as_micros(), 1];
    numbers.extend([t.t_delta, t.near, t.tentative_within].map(Micros::as_micros));
    let small = [t.votes, t.score_limit, t.contradiction, t.solo_contradiction, t.tentative_votes, t.memory];
    numbers.extend(small.map(u32::from));
    let paces =
        [settings.solo_rate, settings.solo_after, settings.solo_spacing, settings.shift_after, settings.shift_spacing];
    numbers.extend(paces.map(u32::from));
    numbers.extend([settings.neighbours, 0].map(u32::from));
    assert_eq!(c.hopping(EIGHT, 5, &numbers, &[], start), 0);
    let mut recorder = Recorder::<8>::new("board of sixteen letters");
    let mut world = World::new(r, EIGHT, 36_000);
    world.now = start;
    let mut count = 0;
    for _ in 0..2_000 {
        world.turn_clock(ring.next_deadline().as_micros());
        for (at, sensor) in world.heard() {
            same(&mut c, Do::Echo, sensor, at, ring.echo(sensor, Instant::from_micros(at)));
        }
        let now = Instant::from_micros(world.now);
        let changes: Vec<i32> = (0..8).map(|_| world.random.duration(200) as i32 - 100).collect();
        let change = |sensor: u8| changes[usize::from(sensor)];
        for _ in 0..20 {
            let event = ring.poll_expecting(now, change);
            assert_eq!(c.poll(world.now, Some(&changes)), event.as_ref().map(flat).ok_or(0), "seed {seed}");
            let Some(mut event) = event else { break };
            explain(&mut event, &mut c);
            if let RingEvent::Fire { sensor, .. } = event {
                world.fired(sensor);
            }
            let in_rust = recorder.hopping_event(&event, now, (&ring, change), |_| 0, 0);
            let in_rust = in_rust.as_ref().map_or(&[][..], Frame::as_bytes);
            assert_eq!(c.serial_event(EIGHT, Some(&changes), world.now), in_rust, "seed {seed}: {event:?}");
            count += u64::from(!in_rust.is_empty());
        }
    }
    count
}
