//! Comparison of rings of HC-SR04 modules in Rust and C.

use std::cell::Cell;

use crate::core_side::{flat, status_of};
use crate::{Between, C, Do, Random};
use eeruf_core::{
    Edge, Instant, Micros, Requirements, Ring, RingConfig, RingEvent, Schedule, ScheduledRing, VerifiedSchedule,
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings, SetupError};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{Error, ErrorKind, ErrorType, InputPin, OutputPin};

use crate::world::{World, same};

const K: usize = 6;

/// Behaviour of all modules' pins at the next firing.
#[derive(Clone, Copy, Default)]
struct Fault {
    high: bool,
    cannot_read: bool,
    cannot_write: bool,
}

#[derive(Debug)]
struct Broken;

impl Error for Broken {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

struct Pin<'f>(&'f Cell<Fault>);

impl ErrorType for Pin<'_> {
    type Error = Broken;
}

impl OutputPin for Pin<'_> {
    fn set_low(&mut self) -> Result<(), Broken> {
        if self.0.get().cannot_write { Err(Broken) } else { Ok(()) }
    }

    fn set_high(&mut self) -> Result<(), Broken> {
        Ok(())
    }
}

impl InputPin for Pin<'_> {
    fn is_high(&mut self) -> Result<bool, Broken> {
        if self.0.get().cannot_read { Err(Broken) } else { Ok(self.0.get().high) }
    }

    fn is_low(&mut self) -> Result<bool, Broken> {
        self.is_high().map(|high| !high)
    }
}

struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _ns: u32) {}
}

fn health(health: Health) -> i32 {
    match health {
        Health::Well => 0,
        Health::Missing => 1,
        Health::StuckHigh => 2,
        Health::Chatters => 3,
        Health::LosesEdges => 4,
        Health::PinError => 5,
        _ => unreachable!("{health}"),
    }
}

fn schedule(r: &Random, c: &mut C) -> VerifiedSchedule<K> {
    let tables = [(70_000, 0, 10_000, 11_000), (80_000, 100, 10_500, 11_500), (62_000, 0, 9_500, 10_400)];
    let (period, first, by_a, by_b) = r.one_of(&tables);
    let spread = |by: u32| [0, 1, 2, 3, 4, 5].map(|x| Micros::new(first + x * by));
    let schedule = Schedule::<K>::from_firing(Micros::new(period), [by_a, by_b].map(spread)).unwrap();
    let verified = schedule.verified(&Requirements::new(Micros::new(400))).unwrap();
    c.verified_schedule(0, &verified);
    verified
}

/// Returns the edges of a triggered module: mostly one pulse, with the disturbances of real wiring.
fn pulse(r: &Random, edges: &mut Vec<(u32, u8, bool)>, now: u32, sensor: u8, width: u32) {
    let rise = now.wrapping_add(r.one_of(&[450, 450, r.duration(3_000)]));
    let fall = rise.wrapping_add(r.one_of(&[width, width, width + r.duration(300), 38_000, r.duration(40_000)]));
    if r.once_in(8) {
        // The trigger itself.
        edges.extend([(now.wrapping_add(1), sensor, true), (now.wrapping_add(11), sensor, false)]);
    }
    if r.once_in(12) {
        let short = rise.wrapping_sub(200);
        edges.extend([(short, sensor, true), (short.wrapping_add(r.duration(190)), sensor, false)]);
    }
    if !r.once_in(12) {
        edges.push((rise, sensor, true));
    }
    if r.once_in(6) {
        // A gap in the pulse.
        let gap = rise.wrapping_add(width / 2);
        edges.extend([(gap, sensor, false), (gap.wrapping_add(r.duration(200)), sensor, true)]);
    }
    if !r.once_in(12) {
        edges.push((fall, sensor, false));
    }
    if r.once_in(12) {
        edges.extend([(fall.wrapping_add(300), sensor, true), (fall.wrapping_add(900), sensor, false)]);
    }
}

/// Runs one ring of modules for up to 3,000 steps, or until the random bytes end. Returns the number of events.
///
/// # Panics
/// If C and Rust differ.
pub fn run(r: &Random) -> u64 {
    let mut c = C::new();
    let schedule = schedule(r, &mut c);
    let start = r.any() as u32;
    let config = RingConfig::new().with_window(Micros::new(40_000)).with_blanking(Micros::new(r.duration(400)));
    let blanking = config.blanking.as_micros();
    let ring = Ring::new(&schedule, config, Instant::from_micros(start)).unwrap();
    assert_eq!(c.ring(0, [0, 40_000, blanking, 0, 0], 2, start), 0);
    let mut settings = Settings::default();
    settings.min_retrigger = Micros::new(r.one_of(&[58_000, 66_000, 60_000]));
    settings.shortest = Micros::new(r.within(0, 150));
    let status = c.modules(settings.min_retrigger.as_micros(), settings.shortest.as_micros() as u16);
    let fault = Cell::new(Fault::default());
    if r.once_in(4) {
        // A timer triggers the modules, and may measure their pulses.
        let modules = HcSr04Ring::by_hardware(ring, settings);
        return compare(r, c, status, modules, (start, None), HcSr04Ring::poll_triggered);
    }
    let pins = [(); K].map(|()| Pins { trigger: Pin(&fault), echo: Pin(&fault) });
    let modules = HcSr04Ring::new(ring, pins, NoDelay, settings);
    compare(r, c, status, modules, (start, Some(&fault)), HcSr04Ring::poll)
}

/// A ring of modules on pins, or on none.
type Modules<'s, T, I, D> = HcSr04Ring<ScheduledRing<'s, K>, T, I, D, K>;

/// Runs both rings, if both can be made. `faults` are the faults of the pins, if any.
fn compare<'s, T, I, D>(
    r: &Random,
    mut c: C,
    status: i32,
    modules: Result<Modules<'s, T, I, D>, SetupError>,
    (start, faults): (u32, Option<&Cell<Fault>>),
    poll: impl Fn(&mut Modules<'s, T, I, D>, Instant) -> Option<RingEvent>,
) -> u64 {
    let (origin, timed, uncertain) = (r, faults.is_none(), r.once_in(2));
    let mut modules = match modules {
        Ok(modules) => modules,
        Err(error) => {
            assert!(matches!(error, SetupError::Retrigger { .. }) && status == -21, "{r}: {status}");
            return 0;
        }
    };
    assert_eq!(status, 0, "{r}");
    let mut world = World::new(r.clone(), K as u8, 40_000);
    world.now = start;
    let mut edges: Vec<(u32, u8, bool)> = vec![];
    let mut count = 0;
    for step in 0..3_000 {
        if r.is_over() {
            break;
        }
        world.turn_clock(modules.next_deadline().as_micros());
        let now = world.now;
        let due: Vec<_> = edges.extract_if(.., |(at, ..)| now.wrapping_sub(*at) < 1 << 31).collect();
        if edges.len() > 300 {
            edges.clear();
        }
        let r = &world.random;
        for (at, sensor, high) in due {
            let (with_level, latest) = (sensor | u8::from(high) << 7, Instant::from_micros(at));
            if uncertain {
                // C stores how much sooner a line may have risen in units of 8 us.
                let units = r.one_of(&[0, r.within(0, 30), r.within(0, 254)]);
                let since = at.wrapping_sub(c.call(Do::FiredAt, sensor, 0) as u32);
                let before = if high { 8 * units.min(since / 8) } else { r.one_of(&[units, r.duration(60_000)]) };
                let earliest = at.wrapping_sub(before);
                let rust = modules.edge_between(sensor, high, Instant::from_micros(earliest), latest);
                let expected = rust.map_or_else(|error| status_of(&error), |()| 0);
                assert_eq!(c.between(Between::Edge, with_level, earliest, at), expected, "{origin}, step {step}");
            } else {
                same(&mut c, Do::Edge, with_level, at, modules.edge(Edge { sensor, high, at: latest }));
            }
        }
        for _ in 0..20 {
            let r = &world.random;
            let next = Fault { high: r.once_in(30), cannot_read: r.once_in(60), cannot_write: r.once_in(60) };
            if let Some(faults) = faults {
                faults.set(next);
            }
            let event = poll(&mut modules, Instant::from_micros(world.now));
            let in_c = c.poll(world.now, None);
            let at = || format!("{origin}, step {step}: {event:?}");
            assert_eq!(in_c, event.as_ref().map(flat).ok_or(0), "{}", at());
            let Some(event) = event else { break };
            count += 1;
            if let RingEvent::Fire { sensor, .. } = event {
                let with_level = sensor | u8::from(next.high) << 7;
                let status = match next.cannot_read {
                    _ if timed => c.call(Do::Triggered, sensor, 0),
                    true => c.call(Do::CannotRead, sensor, world.now),
                    false => c.call(Do::FireModule, with_level, world.now),
                };
                assert_eq!(status, if !timed && (next.high || next.cannot_read) { 2 } else { 0 }, "{}", at());
                if r.once_in(6) {
                    let width = r.one_of(&[3_000 + 4_000 * u32::from(sensor), 38_000, r.duration(40_000)]);
                    same(&mut c, Do::Pulse, sensor, width, modules.pulse(sensor, Micros::new(width)));
                }
                if status == 0 && next.cannot_write && !timed {
                    assert_eq!(c.call(Do::CannotWrite, sensor, 0), 0);
                }
                pulse(r, &mut edges, world.now, sensor, 3_000 + 4_000 * u32::from(sensor));
                if r.once_in(12) {
                    let at = world.now.wrapping_sub(r.duration(50)).wrapping_add(r.duration(400));
                    same(&mut c, Do::ModuleFired, sensor, at, modules.fired(sensor, Instant::from_micros(at)));
                }
            }
            assert_eq!(c.deadline(), modules.next_deadline().as_micros(), "{}", at());
            for sensor in 0..=K as u8 {
                assert_eq!(c.call(Do::Health, sensor, 0), health(modules.health(sensor)), "{}", at());
            }
        }
    }
    count
}
