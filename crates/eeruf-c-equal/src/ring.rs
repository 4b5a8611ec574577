//! Comparison of rings that fire by tables in Rust and C.

use crate::core_side::{flat, state, status_of, status_of_violation, upcoming};
use crate::{C, Claim, Do, OwnNeeds, Random};
use eeruf_core::{
    EachSensor, EchoFilter, Instant, Layout, Micros, Requirements, Ring, RingConfig, RingError, RingEvent, Schedule,
    Uneven,
    plan::{Plan, ScheduledFiring},
    watch::SensorWatch,
};

use crate::world::{World, hear, measure, same, set_silence};

const K: usize = 16;

/// Requirements as numbers.
#[derive(Clone, Copy)]
pub struct Needs {
    t_delta_us: u32,
    min_interval_us: u32,
    window_us: u32,
    layout: u8,
    neighbours: u8,
    stale_echo: bool,
}

impl Needs {
    /// The claim of an unverified schedule with these requirements.
    fn claim(self) -> Claim {
        let Self { t_delta_us, min_interval_us, window_us, layout, neighbours, stale_echo } = self;
        Claim { verified_for: [t_delta_us, min_interval_us, window_us, 0, u32::MAX, 1], layout, neighbours, stale_echo }
    }
}

/// Verification, for schedules of two phases only.
pub trait Verify: Sized {
    /// Verifies in Rust, checks that C agrees, and returns the schedule, verified if possible, with the limits of each
    /// sensor.
    fn verify_as(self, c: &mut C, number: u32, needs: Needs, own: &[OwnNeeds]) -> (Self, EachSensor<K>);
}

impl Verify for Schedule<K, 2> {
    fn verify_as(self, c: &mut C, number: u32, needs: Needs, own: &[OwnNeeds]) -> (Self, EachSensor<K>) {
        let layout = match needs.layout {
            0 => Layout::Line(needs.neighbours),
            1 => Layout::Ring(needs.neighbours),
            _ => Layout::Blocks(needs.neighbours),
        };
        let of_each = |place: usize| own.iter().map(|own| Micros::new(own[place])).collect::<Vec<_>>();
        let (window, t_delta) = (of_each(0), of_each(1));
        let group = own.iter().enumerate().filter(|(_, own)| own[2] == 1).fold(0, |group, (x, _)| group | 1 << x);
        let together: &[u64] = if group == 0 { &[] } else { &[group] };
        let uneven = Uneven { window: &window, t_delta: &t_delta, together, ..Uneven::NONE };
        let requirements = Requirements {
            uneven: (!own.is_empty()).then_some(uneven),
            min_interval: Micros::new(needs.min_interval_us),
            window: Micros::new(needs.window_us),
            stale_echo: needs.stale_echo,
            layout,
            ..Requirements::new(Micros::new(needs.t_delta_us))
        };
        let verified = match self.verified_each(&requirements) {
            Ok(verified) => verified,
            Err(violation) => {
                let status = c.verified(number, needs.claim(), own);
                assert_eq!(status, status_of_violation(violation.kind), "{violation}");
                return (self, EachSensor::NONE);
            }
        };
        let most = verified.own_limits().most().copied().filter(|_| !own.is_empty());
        let claim = Claim::of(most.unwrap_or_else(|| verified.verified_for()));
        let [t_delta, _, window, separation, path_change, audible] = claim.verified_for;
        let as_asked = [t_delta, needs.min_interval_us, window, separation, path_change, audible];
        assert_eq!(c.verified(number, Claim { verified_for: as_asked, ..needs.claim() }, own), 0);
        // A schedule that was not verified for this is refused.
        let off = Claim { verified_for: [t_delta, 0, window, separation ^ 1, path_change, audible], ..needs.claim() };
        assert_eq!(c.verified(number, off, own), -10);
        let schedule = *verified.schedule();
        if own.is_empty() {
            return (schedule, EachSensor::NONE);
        }
        // Single pairs may keep other intervals, as tables of OTHER layout do.
        assert_eq!(c.verified(number, Claim { stale_echo: needs.stale_echo, ..claim }, own), 0);
        (schedule, *verified.own_limits())
    }
}

macro_rules! cannot_be_verified {
    ($($phases:literal)*) => {$(
        impl Verify for Schedule<K, $phases> {
            fn verify_as(self, c: &mut C, number: u32, needs: Needs, own: &[OwnNeeds]) -> (Self, EachSensor<K>) {
                assert_eq!(c.verified(number, needs.claim(), own), -7);
                (self, EachSensor::NONE)
            }
        }
    )*};
}
cannot_be_verified!(1 3 8);

/// Draws a schedule of this many sensors, in both languages, and a window that it usually allows.
fn schedule<const M: usize>(r: &Random, c: &mut C, sensors: u8, period: u32) -> Fires<M>
where
    Schedule<K, M>: Verify,
{
    let t_delta = r.within(1, 700);
    let step = 2 * t_delta + 1 + r.duration(40);
    let mut times = [[0; K]; M];
    let apart = r.once_in(5);
    // Sensors that are not all alike; the first two fire together.
    let uneven = M == 2 && r.once_in(3);
    let pair = uneven && sensors > 1 && r.once_in(3);
    for x in 0..usize::from(sensors) {
        let first = r.within(0, period - 1);
        times[0][x] = if apart { x as u32 * period / u32::from(sensors) } else { first };
        for phase in 1..M {
            // In distinct steps, so that (13a) and (13b) mostly hold.
            let wait = step * (x as u32 + u32::from(r.once_in(50)));
            let later = times[0][x] + wait;
            times[phase][x] = if later < period { later } else { times[0][x].saturating_sub(wait) };
        }
    }
    for row in times.iter_mut().filter(|_| pair && !r.once_in(9)) {
        row[1] = row[0];
    }
    let rows = times.map(|row| row.map(Micros::new));
    let used = usize::from(sensors);
    let rows: Vec<&[Micros]> = rows.iter().map(|row| &row[..used]).collect();
    let rows: [&[Micros]; M] = rows.try_into().expect("as many rows as phases");
    let rust = Schedule::from_slices(Micros::new(period), &vec![Micros::ZERO; used], rows);
    let rust = rust.expect("each firing lies in its period");
    c.schedule(&rust);
    let needs = Needs {
        t_delta_us: t_delta,
        min_interval_us: r.one_of(&[0, 0, 0, r.duration(period / 4)]),
        window_us: r.one_of(&[0, r.within(1, period)]),
        layout: r.within(0, 2) as u8,
        neighbours: r.within(0, 5) as u8,
        stale_echo: r.once_in(4),
    };
    let own: Vec<OwnNeeds> = (0..sensors)
        .filter(|_| uneven)
        .map(|x| {
            let window = r.one_of(&[0, r.within(1, period.div_ceil(2)), r.within(1, period)]);
            [window, r.one_of(&[t_delta, r.within(1, t_delta)]), u32::from(pair && x < 2)]
        })
        .collect();
    if r.once_in(5) { (rust, EachSensor::NONE) } else { rust.verify_as(c, 0, needs, &own) }
}

fn change(c: &mut C, what: Do, value: u32, rust: Result<(), RingError>) {
    assert_eq!(c.call(what, 0, value), rust.map_or_else(|error| status_of(&error), |()| 0), "{what:?} {value}");
}

type Table<'s, const M: usize> = Ring<ScheduledFiring<'s, K, M, &'s EachSensor<K>>, EchoFilter<K>, K>;

/// A schedule, and the limits of each sensor that it allows.
type Fires<const M: usize> = (Schedule<K, M>, EachSensor<K>);

/// Performs a random action that a caller may take now and then.
fn act<const M: usize>(r: &Random, c: &mut C, ring: &mut Table<'_, M>, now: u32) {
    let sensor = r.within(0, ring.sensors() as u32) as u8;
    match r.within(0, 12) {
        0 => {
            ring.pause();
            change(c, Do::Pause, 1, Ok(()));
        }
        1 | 2 => {
            ring.resume();
            change(c, Do::Pause, 0, Ok(()));
        }
        3 => same(c, Do::Enable, sensor, 0, ring.disable(sensor)),
        4..7 => same(c, Do::Enable, sensor, 1, ring.enable(sensor)),
        7 => {
            ring.restart(Instant::from_micros(now));
            change(c, Do::Restart, now, Ok(()));
        }
        8..10 => {
            let longest = ring.plan().min_refire().as_micros();
            let report = r.one_of(&[0, r.duration(100_000), longest, longest.saturating_add(1)]);
            change(c, Do::SetReportAfter, report, ring.set_report_after(Micros::new(report)));
        }
        _ => {
            let by = r.one_of(&[50, 6_000, 200_000]);
            let at = now.wrapping_sub(r.duration(by)).wrapping_add(r.duration(by));
            same(c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
        }
    }
    assert_eq!(c.call(Do::IsEnabled, sensor, 0) == 1, ring.is_enabled(sensor));
}

/// Runs one ring for up to 3,000 steps, or until the random bytes end. Returns the number of events.
///
/// # Panics
/// If C and Rust differ.
pub fn run<const M: usize>(r: &Random) -> u64
where
    Schedule<K, M>: Verify,
{
    let mut c = C::new();
    let sensors = r.within(1, K as u32) as u8;
    let period = r.one_of(&[r.within(20_000, 120_000), r.within(30_000, 60_000), 1 + r.duration((1 << 28) - 1)]);
    let (first, limits) = &schedule::<M>(r, &mut c, sensors, period);
    let longest = first.min_refire().as_micros();
    let window = r.one_of(&[0, 0, longest, r.within(0, longest), r.duration(longest), longest.saturating_add(1)]);
    let (t_delta, blanking) = (r.one_of(&[0, r.duration(900)]), r.one_of(&[0, 0, r.duration(3_000)]));
    let path_change = r.one_of(&[0, 0, r.duration(1_000), r.duration(70_000)]);
    let audible = r.one_of(&[0, 0, 0, r.within(1, 2 * period.min(200_000)), r.duration(1 << 27)]);
    let consecutive = r.one_of(&[2, 2, 2, 3, r.within(0, 9) as u8]);
    let start = r.any() as u32;
    let some = |us: u32| (us != 0).then_some(Micros::new(us));
    let mut config = RingConfig::new().with_blanking(Micros::new(blanking)).with_consecutive(consecutive);
    (config.t_delta, config.window) = (some(t_delta), some(window));
    (config.path_change, config.audible) = (some(path_change), some(audible));
    let status = c.ring(0, [t_delta, window, blanking, path_change, audible], consecutive, start);
    let plan = ScheduledFiring::with_limits(first, limits, Instant::from_micros(start));
    let mut ring = match Table::<M>::with_plan(plan, config, Instant::from_micros(start)) {
        Ok(ring) => ring,
        Err(error) => {
            assert_eq!(status, status_of(&error), "{r}: {error}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let mut world = World::new(r.clone(), sensors, ring.window().as_micros());
    world.now = start;
    set_silence(r, &mut c, &mut ring);
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    assert_eq!(c.watch(sensors, start), 0);
    let (moves, uncertain) = (r.once_in(3), r.once_in(2));
    let acts = r.one_of(&[10, 100, 1_000]);
    let mut count = 0;
    for step in 0..3_000 {
        if r.is_over() {
            break;
        }
        world.turn_clock(ring.next_deadline().as_micros());
        for edge in world.heard() {
            hear((&world.random, uncertain), &mut c, &mut ring, edge);
        }
        if world.random.once_in(4) {
            // A held line falls, before or after its reading.
            let sensor = world.random.within(0, u32::from(sensors)) as u8;
            same(&mut c, Do::Answered, sensor, 0, ring.answered(sensor));
        }
        if world.random.once_in(acts) {
            act(&world.random, &mut c, &mut ring, world.now);
        }
        let changes: Vec<i32> = (0..sensors).map(|_| world.random.duration(400) as i32 - 200).collect();
        for _ in 0..20 {
            let now = Instant::from_micros(world.now);
            let event = ring.poll_expecting(now, |x| if moves { changes[usize::from(x)] } else { 0 });
            let in_c = c.poll(world.now, moves.then_some(&changes));
            let at = || format!("{r}, {M} phases, step {step}: {event:?}");
            assert_eq!(in_c, event.as_ref().map(flat).ok_or(0), "{}", at());
            assert_eq!(c.deadline(), ring.next_deadline().as_micros(), "{}", at());
            assert_eq!(c.upcoming(), upcoming(ring.upcoming()), "{}", at());
            let Some(event) = event else { break };
            count += 1;
            watch.observe(&event, now);
            let (sensor, later) = (
                world.random.within(0, u32::from(sensors) - 1) as u8,
                world.now.wrapping_add(world.random.duration(u32::MAX)),
            );
            let known = watch.state(sensor, Instant::from_micros(later)).map(state).map_err(|_| -5);
            assert_eq!(c.state(sensor, later), known, "{}", at());
            if let RingEvent::Fire { sensor, .. } = event {
                world.fired(sensor);
                if world.random.once_in(40) {
                    same(&mut c, Do::Stuck, sensor, 0, ring.stuck(sensor));
                }
                if world.random.once_in(3) {
                    same(&mut c, Do::Holds, sensor, 0, ring.holds(sensor));
                }
                if world.random.once_in(2) {
                    same(&mut c, Do::Answered, sensor, 0, ring.answered(sensor));
                    if world.random.once_in(4) {
                        same(&mut c, Do::Unanswered, sensor, 0, ring.unanswered(sensor));
                    }
                }
                if world.random.once_in(8) {
                    measure((&world.random, uncertain), &mut c, &mut ring, sensor);
                }
                if world.random.once_in(40) {
                    same(&mut c, Do::Forget, sensor, 0, ring.forget(sensor));
                }
                if world.random.once_in(15) {
                    let early = world.random.once_in(2);
                    let by = world.random.duration(if early { 300 } else { 20_000 });
                    let at = if early { world.now.wrapping_sub(by) } else { world.now.wrapping_add(by) };
                    same(&mut c, Do::Fired, sensor, at, ring.fired(sensor, Instant::from_micros(at)));
                }
            }
        }
    }
    count
}
