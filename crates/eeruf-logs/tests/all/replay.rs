//! A flow ring's log, judged again like the ring itself.

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings, Votes};
use eeruf_core::judge::Judge as _;
use eeruf_core::{EachSensor, Instant, Micros, ReadingKind, RingConfig, RingEvent, Silence};
use eeruf_logs::{Firing, FiringLog, FlowSettings, Replayed, replay_flow};
use eeruf_serial::Encoder;

use crate::random::Random;

const SENSORS: usize = 8;
const WINDOW: Micros = Micros::from_millis(25);
const BLANKING: Micros = Micros::new(300);

/// A ring's log, and its beliefs after each firing.
struct Ran {
    log: FiringLog,
    settings: FlowSettings,
    believed: Vec<Option<Micros>>,
}

/// Runs a ring whose loop is late by up to `late`, with own walls, foreign paths, and a clock that wraps.
fn ran(seed: u64, belief: BeliefSettings, late: u32, silence: Silence, speed_mm_s: Option<u32>) -> Ran {
    let random = &mut Random(seed);
    let begins = u32::MAX - 2_000_000;
    let at = |us: i64| Instant::from_micros(begins.wrapping_add(us as u32));
    let turns = TurnSettings::new(1 + seed as u32);
    let config = RingConfig::new().with_window(WINDOW).with_blanking(BLANKING);
    let mut ring = FlowRing::<SENSORS>::flow(SENSORS, turns, belief, config, at(0)).unwrap();
    ring.set_silence(silence);
    // Some have nothing in range.
    let own: Vec<i64> = (0..SENSORS).map(|_| 2_000 + random.below(26_000)).collect();
    let paths: Vec<Vec<i64>> = own.iter().map(|_| own.iter().map(|_| 2_000 + random.below(60_000)).collect()).collect();
    let (mut edges, mut now) = (vec![], 0_i64);
    let (mut firings, mut believed, mut open) = (Vec::<Firing>::new(), vec![], [usize::MAX; SENSORS]);
    let mut period = 0;
    while firings.len() < 3_000 {
        let due = now + i64::from(ring.next_deadline().since(at(now)).as_micros().cast_signed()).max(0);
        now = due + random.below(i64::from(late) + 1);
        edges.sort_unstable();
        while let Some(&(edge, sensor)) = edges.first().filter(|(edge, _)| *edge <= now) {
            edges.remove(0);
            ring.echo(sensor, at(edge)).unwrap();
        }
        if let Some(speed) = speed_mm_s {
            ring.moving(speed, 0, at(now));
        }
        while let Some(event) = ring.poll(at(now)) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let x = usize::from(sensor);
                    open[x] = firings.len();
                    let g_us_ms = speed_mm_s.map(|speed| speed as f32 / 171.5);
                    let (t_echo_us, reading) = (None, None);
                    firings.push(Firing { sensor, fired_us: now, period, phase: 0, t_echo_us, reading, g_us_ms });
                    believed.push(None);
                    let is_heard = random.below(20) > 0;
                    edges.extend(is_heard.then_some((now + own[x] + random.below(41), sensor)));
                    if silence == Silence::NeedsAnswer && random.below(30) > 0 {
                        ring.answered(sensor).unwrap();
                    }
                    let heard = |y: &u8| random.below(3) == 0 && *y != sensor;
                    let others: Vec<u8> = (0..SENSORS as u8).filter(heard).collect();
                    edges.extend(others.iter().map(|&y| (now + paths[x][usize::from(y)], y)));
                }
                RingEvent::Reading(reading) if reading.kind == ReadingKind::Late => {}
                RingEvent::Reading(reading) => {
                    let row = open[usize::from(reading.sensor)];
                    firings[row].reading = Some(reading.kind);
                    firings[row].t_echo_us = reading.t_echo.map(Micros::as_micros);
                    believed[row] = ring.judge().believed(reading.sensor);
                }
                RingEvent::PeriodEnded(stats) => period = stats.period + 1,
            }
        }
    }
    // The last ones are not judged yet.
    let judged = firings.iter().position(|firing| firing.reading.is_none()).unwrap();
    firings.truncate(judged);
    let settings =
        FlowSettings { window: WINDOW, blanking: BLANKING, audible: turns.most, belief, limits: EachSensor::NONE };
    Ran { log: FiringLog::new("test", firings), settings, believed }
}

/// Returns how many readings the replay judges as the ring did, in kind and belief, and how many there are.
fn equal(log: &FiringLog, ran: &Ran) -> (usize, usize) {
    let again = replay_flow(log, &ran.settings).unwrap();
    let rows = log.firings.iter().zip(&again).zip(&ran.believed);
    let equal = |((firing, again), believed): ((&Firing, &Option<Replayed>), &Option<Micros>)| {
        again.is_some_and(|again| (Some(again.kind), again.believed) == (firing.reading, *believed))
    };
    (rows.filter(|&row| equal(row)).count(), log.firings.len())
}

#[test]
fn log_of_a_flow_ring_is_judged_again_as_the_ring_did() {
    let standing = BeliefSettings::DEFAULT;
    let alone = BeliefSettings { alone: true, ..standing };
    let every = BeliefSettings { votes: Votes::EveryEcho, ..standing };
    let trusted = Silence::Trusted;
    for seed in 1..=6 {
        for (belief, late, silence, speed) in [
            (standing, 0, trusted, None),
            (standing, 0, Silence::NeverFree, None),
            (standing, 0, Silence::NeedsAnswer, None),
            (every, 0, trusted, None),
            (standing, 0, trusted, Some(500)),
            (alone, 0, trusted, Some(1_000)),
            (standing, 900, trusted, None),
            (standing, 5_000, trusted, Some(300)),
        ] {
            let ran = ran(seed, belief, late, silence, speed);
            let (equal, of) = equal(&ran.log, &ran);
            // A firing and an edge of one moment may come in either order.
            assert!(of > 2_900 && equal + 1 >= of, "{seed}, {late} us, {silence:?}, {speed:?}: {equal} of {of}");
        }
    }
}

#[test]
fn frames_of_a_flow_ring_are_judged_again_as_the_ring_did() {
    let ran = ran(1, BeliefSettings::DEFAULT, 900, Silence::Trusted, None);
    let mut encoder = Encoder::new();
    let mut frames = encoder.hello(SENSORS as u8, "board").as_bytes().to_vec();
    for firing in &ran.log.firings {
        let fired = Instant::from_micros((firing.fired_us as u32).wrapping_sub(2_000_000));
        let frame = eeruf_serial::FiringMessage {
            sensor: firing.sensor,
            phase: 0,
            kind: firing.reading.unwrap(),
            fired,
            period: firing.period,
            t_echo: firing.t_echo_us.map(Micros::new),
            late: Micros::ZERO,
            age: Micros::ZERO,
            explained_by: None,
        };
        frames.extend(encoder.firing(&frame).as_bytes());
    }
    let log = FiringLog::read_from(&frames[..], "line.bin".as_ref()).unwrap();
    assert_eq!(equal(&log, &ran), (log.firings.len(), ran.log.firings.len()));
}
