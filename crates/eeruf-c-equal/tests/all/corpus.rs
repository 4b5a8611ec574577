//! A corpus of rings for those who cannot call Rust: what happens to each, and what core says. C says the same here;
//! `c/micropython/test_corpus.py` reads the file. `EERUF_WRITE=1` writes it anew.
//!
//! Lines: `S` a schedule, its period, then for each phase its firing times; `V` requirements (`t_delta`, interval,
//! window, neighbours, layout, stale echo), then separation and window, 0 if they are not met; `L` how a ring listens
//! (`t_delta`, window, blanking, consecutive) and its start; then echoes `E`, stuck lines `K`, late firings `F`,
//! sensors enabled or not `N`, restarts `R`, and polls `P` with the deadline after it and the event, if there was one.
//! An echo time of 2^32 - 1 is none.

use std::fmt::Write;

use eeruf_c_equal::core_side::flat;
use eeruf_c_equal::ring::Verify;
use eeruf_c_equal::world::{World, same};
use eeruf_c_equal::{C, Do, Needs, Random};
use eeruf_core::{Instant, Micros, Ring, RingConfig, RingEvent, Schedule, ScheduledFiring};

const K: usize = 16;
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../c/tests/corpus.txt");
/// So many rings, and so many steps of each, keep the file small.
const RINGS: u64 = 24;
const STEPS: u32 = 40;

fn add(text: &mut String, kind: char, all: impl IntoIterator<Item = u32>) {
    text.push(kind);
    for number in all {
        write!(text, " {number}").expect("a string takes all");
    }
    text.push('\n');
}

/// A schedule whose crosstalk mostly moves, and the `t_delta` and window that it was verified for.
fn schedule<const M: usize>(r: &Random, c: &mut C, text: &mut String) -> (Schedule<K, M>, Option<[u32; 2]>)
where
    Schedule<K, M>: Verify,
{
    let sensors = r.within(1, 6);
    let period = r.within(30_000, 90_000);
    let (t_delta, wait) = (r.within(50, 500), r.within(900, 1_400));
    let rows: Vec<Vec<u32>> = (0..M as u32)
        .map(|phase| (0..sensors).map(|x| (x * period / (sensors + 1) + phase * wait * (x + 1)) % period).collect())
        .collect();
    let micros: Vec<Vec<Micros>> = rows.iter().map(|row| row.iter().copied().map(Micros::new).collect()).collect();
    let slices: Vec<&[Micros]> = micros.iter().map(Vec::as_slice).collect();
    let slices: [&[Micros]; M] = slices.try_into().expect("as many rows as phases");
    let lags = vec![Micros::ZERO; sensors as usize];
    let rust = Schedule::from_slices(Micros::new(period), &lags, slices).expect("each firing lies in its period");
    let all: Vec<u32> = rows.concat();
    assert_eq!(c.schedule(period, sensors as u8, M as u8, &all), 0);
    add(text, 'S', [period, M as u32].into_iter().chain(all));
    if M != 2 || r.once_in(5) {
        return (rust, None);
    }
    let needs = Needs {
        t_delta_us: t_delta,
        min_interval_us: r.one_of(&[0, 0, r.duration(period / 6)]),
        window_us: r.one_of(&[0, r.within(10_000, period)]),
        layout: r.within(0, 2) as u8,
        neighbours: r.within(0, 4) as u8,
        stale_echo: r.once_in(4),
    };
    let verified = rust.verify_as(c, 0, needs);
    let mut line = vec![t_delta, needs.min_interval_us, needs.window_us, needs.neighbours.into()];
    line.extend([u32::from(needs.layout), u32::from(needs.stale_echo)]);
    let promised = verified.is_verified().then(|| c.verify(0, needs).1);
    line.extend(promised.map_or([0; 2], |promised| [promised.separation_us, promised.window_us]));
    add(text, 'V', line);
    (verified, promised.map(|promised| [t_delta, promised.window_us]))
}

fn run<const M: usize>(seed: u64, text: &mut String)
where
    Schedule<K, M>: Verify,
{
    let (r, mut c) = (Random::new(seed), C::new());
    let (schedule, promised) = schedule::<M>(&r, &mut c, text);
    let [t_delta, window] = promised.unwrap_or_else(|| [r.within(50, 900), schedule.min_refire().as_micros()]);
    let window = r.one_of(&[window, window - window / 3]);
    let (blanking, consecutive) = (r.one_of(&[0, r.duration(3_000)]), r.one_of(&[2, 2, 3]));
    let start = r.one_of(&[0, 0_u32.wrapping_sub(r.duration(300_000)), r.any() as u32]);
    add(text, 'L', [t_delta, window, blanking, consecutive.into(), start]);
    let mut config = RingConfig::new().with_blanking(Micros::new(blanking)).with_consecutive(consecutive);
    (config.t_delta, config.window) = (Some(Micros::new(t_delta)), Some(Micros::new(window)));
    assert_eq!(c.ring(0, [t_delta, window, blanking], consecutive, start), 0, "seed {seed}");
    let mut ring = Ring::<ScheduledFiring<'_, K, M>, K>::unverified(&schedule, config, Instant::from_micros(start))
        .expect("C has one");
    let sensors = schedule.sensors() as u8;
    let mut world = World::new(r, sensors, window);
    world.now = start;
    for _ in 0..STEPS {
        world.turn_clock(ring.next_deadline().as_micros());
        for (at, sensor) in world.heard() {
            if sensor < sensors {
                add(text, 'E', [sensor.into(), at]);
                same(&mut c, Do::Echo, sensor, at, ring.echo(sensor, Instant::from_micros(at)));
            }
        }
        if world.random.once_in(20) {
            let sensor = world.random.within(0, u32::from(sensors) - 1) as u8;
            let what = world.random.within(0, 6);
            if what == 0 {
                add(text, 'R', [world.now]);
                ring.restart(Instant::from_micros(world.now));
                same::<()>(&mut c, Do::Restart, 0, world.now, Ok(()));
            } else {
                let on = what > 2;
                add(text, 'N', [sensor.into(), on.into()]);
                let done = if on { ring.enable(sensor) } else { ring.disable(sensor) };
                same(&mut c, Do::Enable, sensor, on.into(), done);
            }
        }
        for _ in 0..20 {
            let event = ring.poll(Instant::from_micros(world.now));
            let expected = event.as_ref().map(flat);
            assert_eq!(c.poll(world.now, None), expected.ok_or(0), "seed {seed}");
            let mut line = vec![world.now, ring.next_deadline().as_micros()];
            line.extend(expected.iter().flat_map(|flat| match flat[0] {
                0 => &flat[..4],
                1 => &flat[..8],
                _ => &flat[..],
            }));
            add(text, 'P', line);
            let Some(event) = event else { break };
            if let RingEvent::Fire { sensor, .. } = event {
                world.fired(sensor);
                if world.random.once_in(20) {
                    add(text, 'K', [sensor.into()]);
                    same(&mut c, Do::Stuck, sensor, 0, ring.stuck(sensor));
                }
                if world.random.once_in(10) {
                    let at = world.now.wrapping_add(world.random.duration(4_000));
                    add(text, 'F', [sensor.into(), at]);
                    same(&mut c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
                }
            }
        }
    }
}

#[test]
fn the_corpus_is_what_core_and_c_say() {
    let mut text = String::new();
    for seed in 0..RINGS {
        match seed % 8 {
            6 => run::<1>(seed, &mut text),
            7 => run::<3>(seed, &mut text),
            _ => run::<2>(seed, &mut text),
        }
    }
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(FILE, &text).expect("the corpus can be written");
    }
    let kept = std::fs::read_to_string(FILE).expect("c/tests/corpus.txt");
    assert!(kept == text, "c/tests/corpus.txt is not what core says; EERUF_WRITE=1 writes it anew");
}
