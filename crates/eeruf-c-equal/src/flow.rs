//! Comparison of flow rings in Rust and C.

use crate::core_side::{echo, flat, state, status_of, upcoming};
use crate::world::{World, hear, measure, same, set_silence};
use crate::{C, Do, Random};
use eeruf_core::{
    EachSensor, Instant, Micros, Requirements, RingConfig, RingError, RingEvent, Uneven,
    flow::{BeliefSettings, FlowRing, TurnSettings, Votes},
    judge::Judge as _,
    plan::{OwnLimits, Plan as _},
    watch::SensorWatch,
};

/// Draws settings within their ranges, or just outside.
fn settings(r: &Random) -> (TurnSettings, BeliefSettings) {
    let (mut turns, mut belief) = (TurnSettings::new(r.within(1, u32::MAX)), BeliefSettings::DEFAULT);
    if r.once_in(2) {
        let most = r.one_of(&[33_500, r.within(1, 80_000), r.duration(250_001)]);
        let least = r.one_of(&[r.within(0, most), most, most.saturating_add(1)]);
        (turns.least, turns.most) = (Micros::new(least), Micros::new(most));
        turns.rest = Micros::new(r.one_of(&[60_000, 30_000, r.within(1, 150_000), r.duration(4_000_001)]));
        turns.dice = Micros::new(r.one_of(&[0, 2_000, 8_000, r.duration(250_001)]));
    }
    if r.once_in(20) {
        turns.seed = 0;
    }
    if r.once_in(2) {
        belief.t_delta = Micros::new(r.one_of(&[r.duration(400), r.duration(40_000)]));
        belief.near = Micros::new(r.one_of(&[r.duration(400), r.duration(10_001)]));
        belief.path_change = Micros::new(r.one_of(&[r.duration(400), r.duration(65_535)]));
        (belief.memory, belief.hold) = (r.within(0, 255) as u8, r.one_of(&[1, 4, r.within(0, 101) as u8]));
    }
    belief.top_speed_mm_s = r.one_of(&[0, 0, 300, 1_000, r.within(0, 65_535) as u16]);
    belief.alone = r.once_in(2);
    belief.votes = r.one_of(&[Votes::ByMotion, Votes::ByMotion, Votes::EveryEcho, Votes::TwoInARow]);
    (turns, belief)
}

/// Draws the limits of each sensor, also as numbers for C: window, `t_delta`, group and line. Some sensors fire
/// together, some share an echo line, in at most two sets each.
fn own_limits<const K: usize>(r: &Random, window: u32) -> (EachSensor<K>, Vec<u32>) {
    let t_deltas = [(); K].map(|()| Micros::new(r.within(0, 200)));
    let windows = [(); K].map(|()| Micros::new(r.one_of(&[window, window, r.within(1, window.max(1))])));
    let sets = || [(); K].map(|()| r.one_of(&[0, 0, 1, 2]));
    let members = |sets: [u32; K], set: u32| (0..K).filter(|&x| sets[x] == set).fold(0, |bits, x| bits | 1_u64 << x);
    let in_twos = |sets| [1, 2].map(|set| members(sets, set)).into_iter().filter(|set| set.count_ones() > 1);
    let (groups, lines) = (sets(), sets());
    let (together, shared_lines): (Vec<u64>, Vec<u64>) = (in_twos(groups).collect(), in_twos(lines).collect());
    let uneven = Uneven {
        t_delta: &t_deltas,
        window: &windows,
        together: &together,
        shared_lines: &shared_lines,
        ..Uneven::NONE
    };
    let requirements =
        Requirements { window: Micros::new(window), uneven: Some(uneven), ..Requirements::new(Micros::new(200)) };
    let limits = TurnSettings::limits(K, &requirements).expect("one value for each sensor, and sets that are apart");
    // A sensor that is alone in its set belongs to no set.
    let set_of = |sets: [u32; K], x: usize| if members(sets, sets[x]).count_ones() > 1 { sets[x] } else { 0 };
    let of_each = |x: usize| [windows[x].as_micros(), t_deltas[x].as_micros(), set_of(groups, x), set_of(lines, x)];
    (limits, (0..K).flat_map(of_each).collect())
}

/// Runs one flow ring for up to 4,000 steps, or until the random bytes end. Returns the number of events.
///
/// # Panics
/// If C and Rust differ.
pub fn run<const K: usize>(r: &Random) -> u64 {
    let mut c = C::new();
    let (t, mut b) = settings(r);
    let window = r.one_of(&[25_000, 36_000, 36_000, r.within(1, 40_000), r.duration(4_000_001)]);
    if window > 4_000_000 {
        // One error at a time, since their order is unspecified.
        b = BeliefSettings::DEFAULT;
    }
    let blanking = r.one_of(&[0, 300, 2_380, r.duration(40_000)]);
    // Also close to 0, where sensors would seem to have just fired.
    let start = r.one_of(&[r.any() as u32, r.duration(50_000)]);
    let mut numbers = vec![window, blanking];
    numbers.extend([t.least, t.most, t.rest, t.dice].map(Micros::as_micros));
    numbers.push(t.seed);
    numbers.extend([b.t_delta, b.near, b.path_change].map(Micros::as_micros));
    let votes = [Votes::ByMotion, Votes::EveryEcho, Votes::TwoInARow].iter().position(|&votes| votes == b.votes);
    numbers.extend([b.memory.into(), b.hold.into(), b.top_speed_mm_s.into(), u32::from(b.alone)]);
    numbers.extend(votes.map(|votes| votes as u32));
    let config = RingConfig::new().with_window(Micros::new(window)).with_blanking(Micros::new(blanking));
    let now = Instant::from_micros(start);
    if r.once_in(2) {
        let (limits, own) = own_limits::<K>(r, window);
        let status = c.flow(K as u8, &numbers, &own, start);
        return compare(r, c, status, FlowRing::<K, 1, _>::with_limits(K, limits, t, b, config, now), window, start);
    }
    let status = c.flow(K as u8, &numbers, &[], start);
    compare(r, c, status, FlowRing::<K>::flow(K, t, b, config, now), window, start)
}

/// Runs both rings, if both can be made.
fn compare<const K: usize, U: OwnLimits>(
    r: &Random,
    mut c: C,
    status: i32,
    ring: Result<FlowRing<K, 1, U>, RingError>,
    window: u32,
    start: u32,
) -> u64 {
    let mut ring = match ring {
        Ok(ring) => ring,
        Err(error) => {
            assert_eq!(status, status_of(&error), "{r}: {error}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let (origin, mut count) = (r, 0);
    let mut world = World::new(r.clone(), K as u8, window.min(80_000));
    world.now = start;
    set_silence(r, &mut c, &mut ring);
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    assert_eq!(c.watch(K as u8, start), 0);
    let (moves, uncertain, tick) = (r.once_in(2), r.once_in(2), r.one_of(&[1, 1, 1_000]));
    let acts = r.one_of(&[20, 100, 1_000]);
    for step in 0..4_000 {
        if r.is_over() {
            break;
        }
        world.turn_clock(ring.next_deadline().as_micros());
        world.now = world.now.wrapping_add((tick - world.now % tick) % tick);
        if world.random.once_in(20) {
            // Clocks of several cores differ by microseconds.
            world.now = world.now.wrapping_sub(world.random.within(1, 3));
        }
        for edge in world.heard() {
            hear((&world.random, uncertain), &mut c, &mut ring, edge);
        }
        if world.random.once_in(4) {
            // A held line falls, before or after its reading.
            let sensor = world.random.within(0, K as u32) as u8;
            same(&mut c, Do::Answered, sensor, 0, ring.answered(sensor));
        }
        let r = &world.random;
        if moves && r.once_in(30) {
            let most = r.one_of(&[2_000, 2_000, u32::MAX]);
            let (speed, turn) = (r.one_of(&[0, r.duration(most)]), r.one_of(&[0, 0, r.duration(most)]));
            ring.moving(speed, turn, Instant::from_micros(world.now));
            assert_eq!(c.moving(speed, turn, world.now), 0);
        }
        if r.once_in(acts) {
            act(r, &mut c, &mut ring, world.now);
        }
        for _ in 0..20 {
            let now = Instant::from_micros(world.now);
            let event = ring.poll(now);
            let in_c = c.poll(world.now, None);
            let at = || format!("{origin}, step {step}: {event:?}");
            assert_eq!(in_c, event.as_ref().map(flat).ok_or(0), "{}", at());
            // C decides about the next firing when first asked, also by the operations at a firing.
            let asks = step % 2 == 0 || !matches!(event, Some(RingEvent::Fire { .. }));
            if asks {
                assert_eq!(c.deadline(), ring.next_deadline().as_micros(), "{}", at());
                assert_eq!(c.upcoming(), upcoming(ring.upcoming()), "{}", at());
            }
            let Some(event) = event else { break };
            count += 1;
            watch.observe(&event, now);
            let (sensor, later) =
                (world.random.within(0, K as u32) as u8, world.now.wrapping_add(world.random.duration(u32::MAX)));
            let known = watch.state(sensor, Instant::from_micros(later)).map(state).map_err(|_| -5);
            assert_eq!(c.state(sensor, later), known, "{}", at());
            if asks {
                let quiet = ring.plan().doubt_of(sensor).map_or(0, Micros::as_micros);
                let believed = echo(ring.judge().believed(sensor));
                assert_eq!(c.quiet_and_belief(sensor), [quiet, believed], "{}", at());
            }
            if let RingEvent::Fire { sensor, .. } = event {
                fired((&mut world, uncertain), &mut c, &mut ring, sensor);
            }
        }
    }
    count
}

/// Draws operations at and after a firing.
fn fired<const K: usize, U: OwnLimits>(
    (world, uncertain): (&mut World, bool),
    c: &mut C,
    ring: &mut FlowRing<K, 1, U>,
    sensor: u8,
) {
    world.fired(sensor);
    let r = &world.random;
    if r.once_in(60) {
        same(c, Do::Stuck, sensor, 0, ring.stuck(sensor));
    }
    if r.once_in(3) {
        same(c, Do::Holds, sensor, 0, ring.holds(sensor));
    }
    if r.once_in(2) {
        same(c, Do::Answered, sensor, 0, ring.answered(sensor));
        if r.once_in(4) {
            same(c, Do::Unanswered, sensor, 0, ring.unanswered(sensor));
        }
    }
    if r.once_in(8) {
        measure((r, uncertain), c, ring, sensor);
    }
    if r.once_in(40) {
        same(c, Do::Forget, sensor, 0, ring.forget(sensor));
    }
    if r.once_in(15) {
        let early = r.once_in(2);
        let by = r.duration(if early { 300 } else { 20_000 });
        let at = if early { world.now.wrapping_sub(by) } else { world.now.wrapping_add(by) };
        same(c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
    }
}

/// Draws operations at any time.
fn act<const K: usize, U: OwnLimits>(r: &Random, c: &mut C, ring: &mut FlowRing<K, 1, U>, now: u32) {
    let sensor = r.within(0, K as u32) as u8;
    match r.within(0, 14) {
        0..3 => same(c, Do::Enable, sensor, 0, ring.disable(sensor)),
        3..8 => same(c, Do::Enable, sensor, 1, ring.enable(sensor)),
        8 | 9 => {
            let by = r.one_of(&[50, 6_000, 200_000]);
            let at = now.wrapping_sub(r.duration(by)).wrapping_add(r.duration(by));
            same(c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
        }
        10 => {
            ring.pause();
            same::<()>(c, Do::Pause, 0, 1, Ok(()));
        }
        11 | 12 => {
            ring.resume();
            same::<()>(c, Do::Pause, 0, 0, Ok(()));
        }
        13 => {
            let longest = ring.plan().min_refire().as_micros();
            let report = r.one_of(&[0, r.duration(100_000), longest, longest.saturating_add(1)]);
            let set = ring.set_report_after(Micros::new(report));
            assert_eq!(c.call(Do::SetReportAfter, 0, report), set.map_or_else(|error| status_of(&error), |()| 0));
        }
        _ => {
            ring.restart(Instant::from_micros(now));
            same::<()>(c, Do::Restart, 0, now, Ok(()));
        }
    }
    assert_eq!(c.call(Do::IsEnabled, sensor, 0) == 1, ring.is_enabled(sensor));
}
