//! Frames of C and Rust on a serial line.

use eeruf_c_equal::core_side::{explanation, flat};
use eeruf_c_equal::{C, Do, Random};
use eeruf_core::{
    Instant, Micros, Phase, ReadingKind, Ring, RingConfig, RingEvent, Schedule, judge::Explanation,
    plan::ScheduledFiring, tables::PAPER_12,
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

/// Runs one ring whose clock is late, jumps and wraps. Returns the number of frames.
fn run(seed: u64) -> u64 {
    let (r, mut c) = (Random::new(seed), C::new());
    // An unverified table, on both sides.
    let t_fire = |phase, sensor| PAPER_12.t_fire(phase, sensor).expect("one of twelve");
    let rows = [Phase::A, Phase::B].map(|phase| std::array::from_fn::<_, 12, _>(|sensor| t_fire(phase, sensor)));
    let slices = [&rows[0][..], &rows[1][..]];
    let schedule = Schedule::<12, 2>::from_slices(PAPER_12.period(), &[Micros::ZERO; 12], slices).unwrap();
    c.schedule(&schedule);
    let (t_delta, window, start) = (500, 30_000, r.any() as u32);
    assert_eq!(c.ring(0, [t_delta, window, 0, 0, 0], 2, start), 0);
    let config = RingConfig::new().with_t_delta(Micros::new(t_delta)).with_window(Micros::new(window));
    let start_at = Instant::from_micros(start);
    let mut ring = Ring::<ScheduledFiring<'_, 12, 2>, _, 12>::unverified(&schedule, config, start_at).unwrap();
    // Only 16 letters of the name are sent.
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
            assert_eq!(c.serial_event(SENSORS, world.now), in_rust, "seed {seed}: {event:?}");
            count += u64::from(!in_rust.is_empty());
        }
    }
    count
}
