//! Rings that fire in turn, in a world of true time: walls of their own in late loops, and foreign sound in
//! [`one_path`].

mod one_path;
mod world;

use eeruf_core::{
    EachSensor, Instant, Micros, ReadingKind, Requirements, RingConfig, RingEvent, SensorLimits, Silence, Uneven,
    flow::{BeliefSettings, FlowRing, InTurn, TurnSettings, Votes},
    judge::Judge as _,
    plan::OwnLimits,
};

use world::{Dice, Seen, World};

const DEFAULT: BeliefSettings = BeliefSettings::DEFAULT;
const CONFIG: RingConfig = RingConfig::new().with_window(Micros::from_millis(25)).with_blanking(Micros::new(300));
/// Start of a run, three seconds before the clock wraps.
const BEGIN: u32 = u32::MAX - 3_000_000;

/// The share of sensors whose first reading was believed by the second firing and by the third, in percent.
fn soon(seen: &[Seen]) -> [f64; 2] {
    [2, 3].map(|most| {
        let by = seen.iter().filter(|seen| seen.first.is_some_and(|first| first <= most)).count();
        100.0 * by as f64 / seen.len() as f64
    })
}

#[test]
fn own_walls_are_believed_in_loops_that_are_late() {
    for (late, tick) in [(0, 1), (100, 1), (1000, 1), (5000, 1), (0, 1000)] {
        for speed in [0, 1000] {
            let (mut begun, mut nearer) = (vec![], vec![]);
            for sensors in [2, 3, 4, 6, 8, 12, 24] {
                let mut all = vec![Seen::default(); sensors];
                for seed in 1..6 {
                    let mut world = World::new(sensors, seed, late, tick, speed);
                    let walls: Vec<_> = (0..sensors).map(|_| 5_000 + world.dice.below(17_000)).collect();
                    // Half a metre nearer, later.
                    for (until, less, first) in [(20_000_000, 0, &mut begun), (40_000_000, 2_915, &mut nearer)] {
                        let mut seen = vec![Seen::default(); sensors];
                        world.run(until, &mut seen, |now, sensor, dice| {
                            // Jitter of the module.
                            let wall = walls[usize::from(sensor)] - less;
                            vec![(now + u64::from(wall + dice.below(60)), sensor)]
                        });
                        for (all, seen) in all.iter_mut().zip(&seen) {
                            (all.fired, all.accepted) = (all.fired + seen.fired, all.accepted + seen.accepted);
                        }
                        first.extend(seen);
                    }
                    // Nothing is later than the loop, whatever firings the readings have brought forward.
                    assert!(late > 0 || world.latest < tick, "{} us late, tick {tick}", world.latest);
                }
                let share = |seen: &Seen| 100.0 * f64::from(seen.accepted) / f64::from(seen.fired);
                let mean = all.iter().map(share).sum::<f64>() / sensors as f64;
                let worst = all.iter().map(share).fold(100.0, f64::min);
                let rate = all.iter().map(|seen| seen.fired).sum::<u32>() / 200;
                let case = format!("{sensors} sensors, late {late}, tick {tick}, {speed} mm/s");
                println!("{case}: {mean:.1} %, worst {worst:.1}, {rate} firings/s");
                assert!(mean >= 97.0 && worst >= 90.0, "{case}: {mean} {worst}");
            }
            let ([second, third], near) = (soon(&begun), soon(&nearer));
            println!(
                "late {late}, tick {tick}, {speed} mm/s: second {second:.0} %, third {third:.0}; nearer {near:.0?}"
            );
            assert!(second >= 90.0 && third >= 98.0, "late {late}, tick {tick}: {second} {third}");
            assert!(near[0] >= 90.0 && near[1] >= 98.0, "late {late}, tick {tick}: nearer {near:?}");
        }
    }
}

/// Firings per second, and the share of readings accepted, of a ring whose echoes come at random times.
fn of_chance(belief: BeliefSettings, told_mm_s: Option<u32>) -> (u32, f64) {
    let mut world = World::believing(8, 5, 0, 1, belief);
    let mut seen = vec![Seen::default(); 8];
    for turn in 0..100 {
        if let Some(speed) = told_mm_s {
            let now = world.instant(world.now);
            world.ring.moving(speed, 0, now);
        }
        world.run(turn * 100_000, &mut seen, |now, sensor, dice| {
            vec![(now + u64::from(1_000 + dice.below(23_000)), sensor)]
        });
    }
    let [fired, accepted] =
        [|seen: &Seen| seen.fired, |seen: &Seen| seen.accepted].map(|of| seen.iter().map(of).sum::<u32>());
    (fired / 10, f64::from(accepted) / f64::from(fired))
}

#[test]
fn votes_follow_from_motion_and_company() {
    let of = |alone, votes, top_speed_mm_s| BeliefSettings { alone, votes, top_speed_mm_s, ..DEFAULT };
    let every = [
        (of(true, Votes::ByMotion, 0), Some(100)),
        (of(true, Votes::ByMotion, 500), None),
        (of(false, Votes::EveryEcho, 0), None),
        (of(false, Votes::EveryEcho, 500), None),
    ];
    let two = [
        (of(true, Votes::ByMotion, 0), None),
        (of(true, Votes::ByMotion, 500), Some(0)),
        (of(false, Votes::ByMotion, 500), None),
        (of(true, Votes::TwoInARow, 500), Some(500)),
    ];
    for (belief, told) in every {
        let (_, accepted) = of_chance(belief, told);
        // All but the firings in progress.
        assert!(accepted > 0.99, "{belief:?} {told:?}: {accepted}");
    }
    for (belief, told) in two {
        let (_, accepted) = of_chance(belief, told);
        assert!(accepted < 0.2, "{belief:?} {told:?}: {accepted}");
    }
    // Twice the least quiet: near walls, so that no sensor needs more.
    let rate = |votes| {
        let mut world = World::believing(8, 5, 0, 1, BeliefSettings { votes, ..DEFAULT });
        let mut seen = vec![Seen::default(); 8];
        world.run(20_000_000, &mut seen, |now, sensor, _| vec![(now + 2_000, sensor)]);
        assert!((0..8).all(|x| world.ring.plan().doubt_of(x).unwrap().as_micros() < 12_010));
        seen.iter().map(|seen| seen.fired).sum::<u32>() / 20
    };
    let [two, every] = [Votes::TwoInARow, Votes::EveryEcho].map(rate);
    assert!((120..=134).contains(&two) && (73..=78).contains(&every), "{two} {every}");
}

#[test]
fn a_ring_that_the_compiler_made_begins_by_restart() {
    const MADE: FlowRing<24> = match FlowRing::flow(8, TurnSettings::new(1), DEFAULT, CONFIG, Instant::from_micros(0)) {
        Ok(ring) => ring,
        Err(_) => panic!("settings out of range"),
    };
    let firings = |seed| {
        let mut ring = MADE.clone();
        assert!(ring.set_seed(0).is_err());
        ring.set_seed(seed).unwrap();
        ring.restart(Instant::from_micros(BEGIN));
        let (mut world, mut seen) = (World::<_, 1>::of(ring, 1, 0, 1), vec![Seen::default(); 8]);
        world.run(5_000_000, &mut seen, |now, sensor, _| vec![(now + 5_000, sensor)]);
        assert!(seen.iter().all(|seen| seen.fired > 50 && seen.accepted + 2 >= seen.fired));
        world.fired
    };
    assert_eq!(firings(7), firings(7));
    assert_ne!(firings(7), firings(8));
}

#[test]
fn both_ways_to_begin_fire_at_the_same_instants() {
    let mut dice = Dice { state: 5, travel: 0 };
    for seed in 1..200 {
        let mut turns = TurnSettings::new(seed);
        turns.most = Micros::new(7_000 + dice.below(60_000));
        turns.least = Micros::new(100 + dice.below(6_900));
        let belief =
            BeliefSettings { top_speed_mm_s: [0, 500][dice.below(2) as usize], alone: seed % 3 == 0, ..DEFAULT };
        let begin = Instant::from_micros(seed << 25);
        let mut one = FlowRing::<24>::flow(8, turns, belief, CONFIG, begin).unwrap();
        let mut other = FlowRing::<24>::with_limits(8, (), turns, belief, CONFIG, begin).unwrap();
        for _ in 0..100 {
            let now = one.next_deadline();
            assert_eq!((now, one.poll(now)), (other.next_deadline(), other.poll(now)), "{turns:?}");
        }
    }
}

#[test]
fn dice_of_another_seed_fire_otherwise() {
    let firings = |seed| {
        let mut world = World::new(4, seed, 0, 1, 0);
        let mut fired = vec![];
        world.run(2_000_000, &mut vec![Seen::default(); 4], |now, _, _| {
            fired.push(now);
            vec![]
        });
        fired
    };
    assert_eq!(firings(5), firings(5));
    assert_ne!(firings(5), firings(6));
    assert!(World::new(4, 9, 0, 1, 0).ring.judge().believed(0).is_none());
}

/// A world of sensors that are not all alike.
fn uneven(sensors: usize, seed: u32, late: u32, uneven: Uneven<'_>) -> World<InTurn<24, EachSensor<24>>> {
    world_of(sensors, TurnSettings::new(seed), late, uneven)
}

fn world_of(sensors: usize, turns: TurnSettings, late: u32, uneven: Uneven<'_>) -> World<InTurn<24, EachSensor<24>>> {
    let requirements =
        Requirements { window: Micros::from_millis(25), uneven: Some(uneven), ..Requirements::new(Micros::new(80)) };
    let limits = TurnSettings::limits::<24>(sensors, &requirements).unwrap();
    let (turns, begin) = (turns.keeping(&requirements), Instant::from_micros(BEGIN));
    World::of(FlowRing::with_limits(sensors, limits, turns, DEFAULT, CONFIG, begin).unwrap(), turns.seed, late, 1)
}

/// The firings of a sensor.
fn of<P>(world: &World<P>, sensor: u8) -> Vec<u64> {
    world.fired.iter().filter(|fired| fired.1 == sensor).map(|fired| fired.0).collect()
}

#[test]
fn sensors_that_fire_together_have_one_turn() {
    let groups = [0b1_0001, 0b1000_1100];
    let mut world = uneven(8, 3, 0, Uneven { together: &groups, ..Uneven::NONE });
    let mut seen = vec![Seen::default(); 8];
    let own = |now, sensor: u8, dice: &mut Dice| {
        vec![(now + 2_000 + u64::from(sensor) * 500 + u64::from(dice.below(60)), sensor)]
    };
    world.run(10_000_000, &mut seen, own);
    for turn in world.fired.windows(2) {
        let [(before, x), (after, y)] = turn else { unreachable!() };
        let together = groups.iter().any(|group| group >> x & group >> y & 1 == 1);
        assert!(if together { after == before } else { after - before >= 6_000 }, "{turn:?}");
    }
    assert!(of(&world, 2) == of(&world, 3) && of(&world, 3) == of(&world, 7) && of(&world, 0) == of(&world, 4));
    // Partners explain nothing.
    assert!(seen.iter().all(|seen| seen.accepted + 4 > seen.fired && seen.fired > 150), "{}", seen[2].accepted);
    // The whole group gets as much quiet as any of them needs.
    let masked = |now, sensor, dice: &mut Dice| match sensor {
        7 => vec![(now + 1_000 + u64::from(dice.below(4_000)), 7)],
        _ => own(now, sensor, dice),
    };
    world.run(14_000_000, &mut seen, masked);
    let (begin, plan) = (world.fired.len(), world.ring.plan());
    let [doubts, well] = [7, 3].map(|x| plan.doubt_of(x).unwrap().as_micros());
    assert!(doubts > 24_000 && well < 8_000, "{doubts} {well}");
    world.run(20_000_000, &mut seen, masked);
    for pair in world.fired[begin..].windows(2) {
        let [before, after] = pair else { unreachable!() };
        assert!(![2, 3, 7].contains(&after.1) || after.0 == before.0 || after.0 - before.0 > 20_000, "{pair:?}");
    }
    // When a sensor is disabled another takes its turn; when it is enabled it takes the turn back.
    world.ring.disable(2).unwrap();
    let (with, alone) = (of(&world, 3).len(), of(&world, 2).len());
    world.run(24_000_000, &mut seen, own);
    assert!(of(&world, 2).len() == alone && of(&world, 3).len() > with + 50);
    assert_eq!(of(&world, 3)[with..], of(&world, 7)[with..]);
    world.ring.enable(2).unwrap();
    // A pause between two that fire together.
    while world.fired.last().is_none_or(|fired| fired.1 != 2) {
        let now = world.instant(world.now + 100);
        world.now += 100;
        if let Some(RingEvent::Fire { sensor, .. }) = world.ring.poll(now) {
            world.fired.push((world.now, sensor));
        }
    }
    world.ring.pause();
    let begin = world.fired.len();
    world.run(world.now + 500_000, &mut seen, own);
    assert_eq!(world.fired.len(), begin);
    world.ring.resume();
    world.run(world.now + 2_000_000, &mut seen, own);
    let after = |sensor| world.fired[begin..].iter().filter(move |fired| fired.1 == sensor).map(|fired| fired.0);
    assert!(after(3).eq(after(7)) && after(3).eq(after(2)) && after(3).count() > 20);
}

#[test]
fn sensors_on_one_line_never_listen_at_once() {
    let ms = Micros::from_millis;
    let (windows, refire) = ([20, 25, 12, 12, 25, 20].map(ms), [0, 0, 0, 70, 0, 0].map(ms));
    // Sets with a common sensor form one line.
    let lines = [0b11_0000, 0b01_0010, 0b1100, 0b10_0001];
    let mut world =
        uneven(6, 1, 500, Uneven { window: &windows, refire: &refire, shared_lines: &lines, ..Uneven::NONE });
    let mut seen = vec![Seen::default(); 6];
    world.run(30_000_000, &mut seen, |now, sensor, dice| {
        vec![(now + u64::from(2_000 + 1_000 * u32::from(sensor) + dice.below(60)), sensor)]
    });
    for line in [0b11_0011, 0b1100] {
        let on: Vec<_> = world.fired.iter().filter(|fired| line >> fired.1 & 1 == 1).collect();
        for pair in on.windows(2) {
            let window = u64::from(windows[usize::from(pair[0].1)].as_micros());
            assert!(pair[1].0 - pair[0].0 >= window, "{pair:?}");
        }
    }
    for (x, seen) in (0..).zip(&seen) {
        assert!(of(&world, x).windows(2).all(|pair| pair[1] - pair[0] >= 70_000));
        assert!(seen.fired > 200 && seen.accepted + 9 > seen.fired, "{x}: {} of {}", seen.accepted, seen.fired);
    }
}

#[test]
fn each_sensor_has_its_own_window_and_t_delta() {
    let of = |t_delta, window| SensorLimits { t_delta: Micros::new(t_delta), window: Micros::new(window) };
    let accepted = |limits: [SensorLimits; 3]| {
        let limits = EachSensor::for_flow(limits, &[]);
        // Beliefs must not help.
        let belief = BeliefSettings { near: Micros::ZERO, ..DEFAULT };
        let begin = Instant::from_micros(BEGIN);
        let ring = FlowRing::with_limits(3, limits, TurnSettings::new(1), belief, CONFIG, begin).unwrap();
        let (mut world, mut seen) = (World::<_, 1>::of(ring, 1, 0, 1), vec![Seen::default(); 3]);
        let mut turn = 0;
        world.run(10_000_000, &mut seen, |now, sensor, _| {
            turn += 1;
            vec![(now + 12_000 + if sensor == 0 { 0 } else { turn / 3 % 2 * 70 }, sensor)]
        });
        seen.iter().map(|seen| seen.accepted * 100 / seen.fired).collect::<Vec<_>>()
    };
    let alike = accepted([of(80, 25_000); 3]);
    // A farther wall must outlast the belief.
    assert!(alike.iter().all(|&share| share > 85), "{alike:?}");
    let own = accepted([of(80, 10_000), of(80, 25_000), of(50, 25_000)]);
    assert!(own[0] == 0 && own[1] > 85 && own[2] < 5, "{own:?}");
}

#[test]
fn own_wall_is_found_behind_what_comes_before_it() {
    fn share<const E: usize>() -> u32 {
        let begin = Instant::from_micros(BEGIN);
        let ring = FlowRing::flow(6, TurnSettings::new(9), DEFAULT, CONFIG, begin).unwrap();
        let (mut world, mut seen) = (World::<_, E>::of(ring, 3, 1000, 1), vec![Seen::default(); 6]);
        world.run(20_000_000, &mut seen, |now, sensor, dice| {
            let masks = now + u64::from(1_000 + dice.below(8_000));
            [masks, now + 10_000 + u64::from(sensor) * 500 + u64::from(dice.below(60))].map(|at| (at, sensor)).to_vec()
        });
        let [fired, accepted] = [|x: &Seen| x.fired, |x: &Seen| x.accepted].map(|of| seen.iter().map(of).sum::<u32>());
        100 * accepted / fired
    }
    let [one, two] = [share::<1>(), share::<2>()];
    assert!(one < 20 && two >= 97, "{one} {two}");
}

#[test]
fn one_by_one_and_groups_are_turns_with_the_most_quiet() {
    let turns = TurnSettings::new(4).one_by_one();
    for (together, rate) in [(&[][..], 28), (&[0b1_0001, 0b10_0010, 0b100_0100, 0b1000_1000], 57)] {
        let mut world = world_of(8, turns, 1000, Uneven { together, ..Uneven::NONE });
        let mut seen = vec![Seen::default(); 8];
        // With less quiet, far walls are heard in another sensor's turn.
        let far = |now, sensor, dice: &mut Dice| vec![(now + u64::from(24_000 + dice.below(60)), sensor)];
        world.run(20_000_000, &mut seen, far);
        let group = |sensor: u8| if together.is_empty() { sensor } else { sensor % 4 };
        for pair in world.fired.windows(2) {
            let apart = pair[1].0 - pair[0].0;
            assert!(if group(pair[0].1) == group(pair[1].1) { apart == 0 } else { apart >= 33_500 }, "{pair:?}");
        }
        assert!((world.fired.len() as u64 / 20).abs_diff(rate) <= 1, "{}", world.fired.len());
        assert!(seen.iter().all(|seen| seen.accepted + 5 > seen.fired));
    }
}

#[test]
fn a_pause_keeps_belief_and_quiet_and_enabling_begins_anew() {
    let mut world = World::new(4, 3, 0, 1, 0);
    let own = |now, sensor, _: &mut Dice| vec![(now + 9_000 + u64::from(sensor) * 1_000, sensor)];
    world.run(2_000_000, &mut vec![Seen::default(); 4], own);
    let doubt = |world: &World, sensor| world.ring.plan().doubt_of(sensor).unwrap().as_micros();
    assert_eq!(doubt(&world, 1), 6_000);
    world.ring.pause();
    world.run(3_000_000, &mut vec![Seen::default(); 4], own);
    world.ring.resume();
    assert_eq!((doubt(&world, 1), world.ring.judge().believed(1)), (6_000, Some(Micros::new(10_000))));
    let mut seen = vec![Seen::default(); 4];
    world.run(3_500_000, &mut seen, own);
    assert!(seen.iter().all(|seen| seen.first == Some(1)));
    world.ring.disable(1).unwrap();
    world.ring.enable(1).unwrap();
    world.ring.forget(2).unwrap();
    for begun in [1, 2] {
        assert_eq!((doubt(&world, begun), world.ring.judge().believed(begun)), (11_500, None));
    }
    assert_eq!(doubt(&world, 3), 6_000);
}

#[test]
fn a_firing_that_was_later_than_its_reading_told_moves_the_rest() {
    let mut world = World::new(2, 3, 0, 1, 0);
    let own = |now, sensor, _: &mut Dice| vec![(now + 5_000, sensor)];
    world.run(1_000_000, &mut vec![Seen::default(); 2], own);
    while world.fired.last().is_none_or(|last| last.1 != 0 || world.now < last.0 + 5_000) {
        world.run(world.now + 1, &mut vec![Seen::default(); 2], own);
    }
    let later = world.fired.last().unwrap().0 + 3_000;
    world.ring.fired(0, world.instant(later)).unwrap();
    assert_eq!(world.ring.judge().believed(0), Some(Micros::new(2_000)));
    world.run(world.now + 200_000, &mut vec![Seen::default(); 2], own);
    let next = world.fired.iter().find(|fired| fired.1 == 0 && fired.0 > later).unwrap();
    assert!(next.0 - later >= 60_000, "{}", next.0 - later);
}

/// Performs a random operation without an instant on a ring, or reports a speed.
fn call<U: OwnLimits>(ring: &mut FlowRing<24, 1, U>, dice: &mut Dice, now: Instant) {
    let sensor = dice.below(ring.sensors() as u32) as u8;
    match dice.below(12) {
        0 => ring.pause(),
        1 | 2 => ring.resume(),
        3 | 4 => ring.disable(sensor).unwrap(),
        5..=7 => ring.enable(sensor).unwrap(),
        8 => ring.forget(sensor).unwrap(),
        9 => ring.set_window(Micros::new(20_000 + dice.below(5_001))).unwrap(),
        10 => ring.set_report_after(Micros::new(dice.below(50_000))).unwrap(),
        _ => ring.moving([0, 1_000][dice.below(2) as usize], 0, now),
    }
}

/// Polls a ring at each of its deadlines, calls it in between, and checks that nothing is late.
fn is_never_late<U: OwnLimits>(mut ring: FlowRing<24, 1, U>, seed: u32, mut now: Instant) {
    let (mut dice, mut fired) = (Dice { state: seed.into(), travel: 0 }, 0);
    for _ in 0..2_000 {
        let next = ring.next_deadline();
        assert!(next.has_reached(now), "seed {seed}: due {next:?} at {now:?}");
        let calls = dice.below(4) == 0;
        now = if calls { now + Micros::new(dice.below(next.since(now).as_micros() + 1)) } else { next };
        for _ in 0..u32::from(calls) * (1 + dice.below(3)) {
            call(&mut ring, &mut dice, now);
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, due, .. } => {
                    assert_eq!(due, now, "seed {seed}: sensor {sensor} in its turn {fired}");
                    fired += 1;
                    let echo = (dice.below(3) > 0).then(|| Micros::new(1_000 + dice.below(19_000)));
                    ring.measured(sensor, echo).unwrap();
                }
                RingEvent::PeriodEnded(stats) => assert_eq!(stats.max_late, Micros::ZERO, "seed {seed}"),
                RingEvent::Reading(_) => {}
            }
        }
    }
    assert!(fired > 200, "seed {seed}: {fired}");
}

#[test]
fn no_call_makes_a_loop_late_that_polls_in_time() {
    for seed in 1..150 {
        let (begin, sensors) = (Instant::from_micros(BEGIN), [1, 2, 3, 8, 12][seed as usize % 5]);
        let turns = TurnSettings::new(seed);
        is_never_late(FlowRing::flow(sensors, turns, DEFAULT, CONFIG, begin).unwrap(), seed, begin);
        let uneven = Uneven { together: &[0b1_0001, 0b1000_1100], shared_lines: &[0b10_0010], ..Uneven::NONE };
        is_never_late(world_of(8, turns, 0, uneven).ring, seed, begin);
    }
}

/// Kinds of a sensor's readings at these firings, after its wall has stood for 30 firings and disappeared.
fn after_a_wall(alone: bool, speed_mm_s: u32, echoes: [bool; 3]) -> Vec<ReadingKind> {
    let belief = BeliefSettings { alone, ..BeliefSettings::DEFAULT };
    let config = RingConfig::new().with_window(Micros::from_millis(25)).with_blanking(Micros::new(300));
    let (mut now, mut fired, mut kinds) = (Instant::from_micros(7), 0, vec![]);
    let mut ring = FlowRing::<1>::flow(1, TurnSettings::new(5), belief, config, now).unwrap();
    ring.set_silence(Silence::Trusted);
    while kinds.len() < 33 {
        ring.moving(speed_mm_s, 0, now);
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    if *echoes.get(fired.max(30) - 30).filter(|_| fired >= 30).unwrap_or(&(fired < 30)) {
                        ring.echo(sensor, now + Micros::new(5_000)).unwrap();
                    }
                    fired += 1;
                }
                RingEvent::Reading(reading) => kinds.push(reading.kind),
                RingEvent::PeriodEnded(_) => {}
            }
        }
        now = ring.next_deadline();
    }
    kinds.split_off(30)
}

#[test]
fn silence_is_believed_at_once_of_a_robot_that_moves_and_of_a_belief_in_silence() {
    use ReadingKind::{Clear, NoEcho};
    for alone in [true, false] {
        assert_eq!(after_a_wall(alone, 500, [false; 3]), [Clear; 3], "alone: {alone}");
        // Standing, silence outlasts what four readings have confirmed.
        assert_eq!(after_a_wall(alone, 0, [false; 3]), [NoEcho; 3], "alone: {alone}");
    }
    // An echo that is not believed does not end a run of silence.
    assert_eq!(after_a_wall(false, 500, [false, true, false])[2], Clear);
}
