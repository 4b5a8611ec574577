//! Votes over the last readings of a sensor, in rings that fire in turn: own walls, and one path of foreign sound.

use eeruf_core::{
    Instant, Micros, Phase, ReadingKind, Ring, RingConfig, RingEvent,
    flow::{InTurn, TurnSettings},
    judge::{Agreement, Explained, FiringContext, Heard, Judge, MOfN, MedianFilter, NoSounds, Sounds, Verdict},
};

use crate::common::random::Random;

const SENSORS: usize = 6;
const T_DELTA: Micros = Micros::new(80);
const P: u32 = 150;
/// Start of a run, two seconds before the clock wraps.
const BEGIN: Instant = Instant::from_micros(u32::MAX - 2_000_000);

/// Number of a sensor's readings, and of those accepted.
type Counts = (u32, u32);

/// Runs a ring for four seconds in a loop that is late by up to `late` us; `operates` performs operations on it.
/// `sound` gives the sensor that hears a firing at this time since the beginning, with the delay in us.
fn run<J: Judge>(
    judge: J,
    speed_mm_s: u32,
    (late, operates): (u32, bool),
    random: &mut Random,
    receiver: u8,
    mut sound: impl FnMut(u32, u8, &mut Random) -> Option<(u32, u8)>,
) -> Counts {
    let (window, mut turns) = (Micros::from_millis(25), TurnSettings::new(1 + random.up_to(1_000_000)));
    let audible = turns.most;
    if operates {
        // With less randomness and quiet, more is heard, and more agrees.
        turns.dice = Micros::new([0, 200, 2_000][random.up_to(2) as usize]);
        turns.most = if random.up_to(1) == 0 { turns.least } else { turns.most };
    }
    let plan = InTurn::<SENSORS>::new(SENSORS, turns, window, BEGIN).unwrap();
    let config = RingConfig::new().with_window(window).with_blanking(Micros::new(300)).with_audible(audible);
    let config = config.with_path_change(Micros::new(P));
    let mut ring = Ring::<_, J, SENSORS, 1, 8>::judged_by(plan, judge, config, BEGIN).unwrap();
    let (mut edges, mut now, mut is_paused, mut counts) = (vec![], BEGIN, false, (0, 0));
    while now.since(BEGIN) < Micros::from_millis(4_000) {
        let due = ring.next_deadline();
        let due = if now.has_reached(due) { now } else { due } + Micros::new(random.up_to(late));
        edges.sort_by_key(|&(at, _): &(Instant, u8)| at.since(BEGIN));
        if edges.first().is_some_and(|edge| due.has_reached(edge.0)) {
            let (at, sensor) = edges.remove(0);
            now = if at.has_reached(now) { at } else { now };
            ring.echo(sensor, at).unwrap();
            continue;
        }
        now = due;
        let sensor = random.up_to(SENSORS as u32 - 1) as u8;
        match random.up_to(1000) {
            _ if !operates => {}
            0 => {
                ring.pause();
                is_paused = true;
            }
            1..=3 => ring.disable(sensor).unwrap(),
            4..=20 => ring.enable(sensor).unwrap(),
            21 => ring.forget(sensor).unwrap(),
            22 => ring.restart(now),
            23..=200 if is_paused => {
                ring.resume();
                is_paused = false;
            }
            _ => {}
        }
        ring.moving(speed_mm_s, 0, now);
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let heard = sound(now.since(BEGIN).as_micros(), sensor, random);
                    edges.extend(heard.map(|(after, by)| (now + Micros::new(after), by)));
                }
                RingEvent::Reading(reading) if reading.sensor == receiver => {
                    counts.0 += 1;
                    counts.1 += u32::from(reading.kind == ReadingKind::Accepted);
                }
                _ => {}
            }
        }
    }
    counts
}

/// Readings of a receiver that has no wall and hears one path, which changes as fast as allowed.
fn one_path<J: Judge>(judge: J, speed_mm_s: u32, seed: u32) -> Counts {
    let mut random = Random(seed.into());
    let late = [0, 50, 1000, 5000][random.up_to(3) as usize];
    let [emitter, receiver] = [(); 2].map(|()| random.up_to(SENSORS as u32 - 1) as u8);
    // Its own second echoes count as foreign only after the window.
    let shortest = if emitter == receiver { 25_400 } else { 1_000 };
    let length = shortest + random.up_to(33_000 - shortest - 200);
    let nearer = random.up_to(1) == 1;
    run(judge, speed_mm_s, (late, true), &mut random, receiver, |at, sensor, random| {
        if sensor != emitter {
            return (sensor != receiver).then(|| (2_000 + random.up_to(10_000), sensor));
        }
        // At 2 v / c.
        let moved = (u64::from(at) * u64::from(speed_mm_s) * 2 / 343_000) as u32;
        let length = if nearer { length.saturating_sub(moved) } else { length + moved };
        Some((length.clamp(shortest, 33_200) + random.up_to(P - 3), receiver))
    })
}

/// The judges under test, at this speed.
fn votes(m: u8, n: u8, speed_mm_s: u32) -> MOfN<SENSORS, 5> {
    MOfN::new(m, n, T_DELTA).unwrap().with_top_speed(speed_mm_s as u16)
}

#[test]
fn one_path_of_foreign_sound_never_has_votes() {
    let rings = std::env::var("RINGS").ok().and_then(|rings| rings.parse().ok()).unwrap_or(400);
    for (m, n) in [(2, 2), (2, 3), (3, 4), (3, 5), (2, 5)] {
        for speed_mm_s in [0, 500, 1000] {
            let (mut readings, mut wrong, mut agreed) = (0, 0, 0);
            for seed in 1..=rings {
                let (of, accepted) = one_path(votes(m, n, speed_mm_s), speed_mm_s, seed);
                (readings, wrong) = (readings + of, wrong + accepted);
                // Votes without explanations, which do not learn that the robot moves.
                agreed += if speed_mm_s == 0 { one_path(Agreement(votes(m, n, 0)), 0, seed).1 } else { 0 };
            }
            println!("{m} of {n}, {speed_mm_s} mm/s: {readings} readings, {wrong} accepted; {agreed} by agreement");
            assert_eq!(wrong, 0, "{m} of {n}, {speed_mm_s} mm/s, of {readings}");
            assert!(readings > 20 * rings && (speed_mm_s > 0 || agreed > rings / 2), "{readings} {agreed}");
        }
    }
}

#[test]
fn own_walls_have_votes() {
    for (m, n, least) in [(1, 1, 99), (2, 2, 75), (2, 3, 85), (3, 4, 78), (3, 5, 82)] {
        for (speed_mm_s, late) in [(0, 0), (0, 1000), (1000, 1000)] {
            let (mut readings, mut accepted) = (0, 0);
            for seed in 1..20 {
                let mut random = Random(seed);
                let wall = 4_000 + random.up_to(14_000);
                let of =
                    run(votes(m, n, speed_mm_s), speed_mm_s, (late, false), &mut random, 2, |at, sensor, random| {
                        let moved = (u64::from(at) * u64::from(speed_mm_s) * 2 / 343_000) as u32 / 8;
                        Some((wall.saturating_sub(moved).max(500) + random.up_to(60), sensor))
                    });
                (readings, accepted) = (readings + of.0, accepted + of.1);
            }
            let share = 100 * accepted / readings;
            println!("{m} of {n}, {speed_mm_s} mm/s, late {late}: {share} % of {readings}");
            assert!(share >= least, "{m} of {n}, {speed_mm_s} mm/s, late {late}: {share} %");
        }
    }
}

/// Verdicts on echoes of one sensor; 0 is silence and 1 a firing without information.
fn verdicts(judge: &mut impl Judge, echoes_us: &[u32], expected_change_us: i32) -> Vec<Verdict> {
    let push = |&echo_us: &u32| {
        let echoes: Vec<_> = Some(Micros::new(echo_us)).filter(|_| echo_us > 1).into_iter().collect();
        let mut firing = FiringContext::new(Phase::A);
        firing.expected_change_us = expected_change_us;
        let since_before = Micros::from_millis(60);
        let heard = Heard { sensor: 0, fired: BEGIN, since_before, echoes: &echoes, firing, t_delta: T_DELTA };
        if echo_us == 1 { judge.skip(&heard, ReadingKind::Stuck) } else { judge.judge(&heard, &NoSounds) }
    };
    echoes_us.iter().map(push).collect()
}

fn kinds(judge: &mut impl Judge, echoes_us: &[u32], expected_change_us: i32) -> Vec<ReadingKind> {
    verdicts(judge, echoes_us, expected_change_us).iter().map(|verdict| verdict.kind).collect()
}

#[test]
fn votes_count_readings_of_the_last_n() {
    use ReadingKind::*;
    let mut three_of_four = votes(3, 4, 0);
    let read = [9_000, 9_080, 5_000, 9_080, 9_161, 0, 0, 0, 1, 0, 9_000];
    let expected = [First, Repeated, Rejected, Accepted, Rejected, NoEcho, NoEcho, Clear, Stuck, Clear, Rejected];
    assert_eq!(kinds(&mut three_of_four, &read, 0), expected);
    assert_eq!((three_of_four.is_clear(0), three_of_four.age(0)), (false, Some(7)));
    // Odometry expects 100 us less from reading to reading.
    assert_eq!(kinds(&mut votes(2, 3, 0), &[9_000, 5_000, 8_800], -100), [First, Rejected, Accepted]);
    assert_eq!(kinds(&mut votes(2, 3, 0), &[9_000, 5_000, 8_800], 0), [First, Rejected, Rejected]);
    assert_eq!(kinds(&mut votes(1, 1, 0), &[9_000, 0, 5_000], 0), [Accepted, Clear, Accepted]);
    // Readings that are forgotten, or from before a restart, have no vote.
    let mut two = votes(2, 2, 0);
    kinds(&mut two, &[9_000], 0);
    two.forget(0);
    assert_eq!(kinds(&mut two, &[9_000], 0), [First]);
    two.restart();
    assert_eq!(kinds(&mut two, &[9_000, 9_000], 0), [First, Accepted]);
    // The last firing was 1 ms later than it seemed.
    two.fired_later(0, 1_000);
    assert_eq!(kinds(&mut two, &[8_000], 0), [Accepted]);
}

#[test]
fn median_is_the_middle_of_the_last_readings() {
    use ReadingKind::*;
    let mut median = MedianFilter::<1>::new(3, T_DELTA).unwrap();
    let said = verdicts(&mut median, &[9_000, 9_000, 3_000, 9_000, 0, 0, 1, 5_000, 0, 7_000], 0);
    let us = |us| Some(Micros::new(us));
    let expected = [
        (First, us(9_000)),
        (First, us(9_000)),
        (Accepted, us(9_000)),
        (Accepted, us(9_000)),
        (Accepted, us(9_000)),
        (Clear, None),
        // Three in a row are known again.
        (Stuck, None),
        (First, us(5_000)),
        (NoEcho, None),
        (Accepted, us(7_000)),
    ];
    assert_eq!(said.iter().map(|verdict| (verdict.kind, verdict.t_echo)).collect::<Vec<_>>(), expected);
    assert_eq!(said.iter().map(|verdict| verdict.age).collect::<Vec<_>>()[4..7], [Some(0), Some(1), Some(2)]);
    // The last firing was 1 ms later than it seemed.
    median.fired_later(0, 1_000);
    assert_eq!(verdicts(&mut median, &[9_000], 0)[0].t_echo, us(9_000));
    assert_eq!(verdicts(&mut median, &[0], 0)[0].t_echo, us(9_000));
    // The nearer one in the middle of four, by a slow and obvious sort; and when its firing was.
    let mut random = Random(3);
    let read: Vec<_> = (0..500).map(|_| random.up_to(3) * 1_000).collect();
    let mut median = MedianFilter::<1, 7>::new(4, T_DELTA).unwrap();
    for (k, &echo) in read.iter().enumerate() {
        let said = verdicts(&mut median, &[if echo == 1 { 0 } else { echo }], 0)[0];
        let Some(first) = k.checked_sub(3) else { continue };
        let mut four: Vec<_> = read[first..=k].iter().map(|&echo| if echo == 0 { u32::MAX } else { echo }).collect();
        four.sort_unstable();
        let middle = Some(four[1]).filter(|&echo| echo < u32::MAX);
        assert_eq!((said.t_echo, said.kind == Clear), (middle.map(Micros::new), middle.is_none()));
        let firing = read[k - usize::from(median.stands_for(0))];
        assert_eq!(firing, middle.unwrap_or(0));
    }
}

#[test]
fn judges_refuse_votes_out_of_their_range() {
    let error = |m, n| MOfN::<1, 4>::new(m, n, T_DELTA).unwrap_err().to_string();
    assert_eq!(error(3, 5), "n is 5; expected 1 to 4");
    assert_eq!(error(4, 3), "m is 4; expected 1 to 3");
    assert_eq!(error(0, 3), "m is 0; expected 1 to 3");
    assert_eq!(MedianFilter::<1>::new(4, T_DELTA).unwrap_err().to_string(), "of is 4; expected 1 to 3");
}

/// Records the earlier firing that the judge asked about.
struct Asked(std::cell::Cell<Option<u8>>);

impl Sounds for Asked {
    fn explain(&self, _: Micros, _: Micros) -> Explained {
        Explained::ByNothing
    }

    fn explain_after(&self, ago: u8, _: Micros, _: Micros, _: Micros) -> Explained {
        self.0.set(Some(ago));
        Explained::ByNothing
    }

    fn is_masked(&self, _: Micros) -> bool {
        false
    }
}

// A firing whose line is held and that is then silent counts as one of the earlier firings.
#[test]
fn held_firing_is_one_of_those_before() {
    for falls in [false, true] {
        let (mut judge, asked) = (MOfN::<1, 3>::new(2, 3, T_DELTA).unwrap(), Asked(std::cell::Cell::new(None)));
        let echoes = [Micros::new(9_000)];
        let heard = |number: u32, echoes, since_before| {
            let (fired, firing) = (Instant::from_micros(100_000 * number), FiringContext::new(Phase::A));
            Heard { sensor: 0, fired, since_before, echoes, firing, t_delta: T_DELTA }
        };
        let refire = Micros::from_millis(100);
        assert_eq!(judge.judge(&heard(0, &echoes, refire), &asked).kind, ReadingKind::First);
        judge.hold(&heard(1, &[], refire));
        if falls {
            assert_eq!(judge.judge(&heard(1, &[], Micros::ZERO), &asked).kind, ReadingKind::NoEcho);
        }
        assert_eq!(judge.judge(&heard(2, &echoes, refire), &asked).kind, ReadingKind::Accepted);
        assert_eq!(asked.0.get(), Some(2), "falls: {falls}");
    }
}
