//! Faults of one echo line: a ring of HC-SR04 modules in Rust and in C, among the edges of
//! `tests/data/line-faults.txt`.

use std::cell::{Cell, RefCell};
use std::convert::Infallible;
use std::rc::Rc;

use crate::core_side::{flat, state};
use crate::{C, Do, Flat};
use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Requirements, Ring, RingConfig, Schedule, ScheduledRing, VerifiedSchedule,
    watch::SensorWatch,
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// Number of sensors in the ring.
const K: usize = 4;
/// The sensor with the fault.
pub const FAULTY: u8 = 1;
/// The number of periods of a run.
const PERIODS: u32 = 100;
const T_DELTA_US: u32 = 240;
const WINDOW_US: u32 = 40_000;
/// Edges of a healthy module that faces a wall at 1 m, and of one that faces nothing.
const WALL: [Play; 2] = [Play { us: 450, high: true, is_lost: false }, Play { us: 6_280, high: false, is_lost: false }];
const NOTHING: [Play; 2] = [WALL[0], Play { us: 38_450, high: false, is_lost: false }];

/// An edge of a line.
#[derive(Clone, Copy, Debug)]
pub struct Play {
    /// Microseconds after the trigger.
    us: u32,
    high: bool,
    /// True if the line changes without an interrupt.
    is_lost: bool,
}

/// The connection of the faulty sensor's line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wiring {
    /// To the sensor's own pin.
    Own,
    /// To the pin of this sensor, whose own line goes to the faulty sensor's pin.
    Exchanged(u8),
    /// To the sensor's own pin, but without the call that the driver needs.
    Forgotten,
}

/// The state that a driver must report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Says {
    /// An obstacle at this echo time in microseconds.
    Obstacle(u32),
    /// Free space.
    Clear,
    /// The sensor does not answer.
    Unanswered,
    /// Nothing is known.
    Unknown,
    /// Nothing is known for 250 ms, then no answer.
    Held,
}

/// A row of the file.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The name.
    pub name: String,
    /// The sensor's surroundings.
    pub before: String,
    wiring: Wiring,
    edges: Vec<Play>,
    /// The right state for a driver that gets its edges by interrupts.
    pub says: Says,
}

/// The file: a schedule, and faults.
#[derive(Clone, Debug)]
pub struct Faults {
    schedule: VerifiedSchedule<K>,
    /// T_p.
    pub period_us: u32,
    /// The rows.
    pub faults: Vec<Fault>,
}

impl Fault {
    /// Number of readings until two pulses of the line are over, so that silence counts twice.
    pub fn two_pulses(&self, period_us: u32) -> usize {
        let falls = self.edges.last().map_or(0, |edge| edge.us);
        (2 * falls.div_ceil(period_us)).saturating_sub(1) as usize
    }
}

impl Faults {
    /// Reads the file's text.
    ///
    /// # Panics
    /// If a line does not have the format that the head of the file describes.
    pub fn read(text: &str) -> Self {
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        let mut rows = rows.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
        let numbers = |words: &str| words.split_whitespace().map(|us| us.parse().unwrap()).collect::<Vec<u32>>();
        let Some(["schedule", period, a, b]) = rows.next().as_deref().map(<[&str; 4]>::try_from).map(Result::unwrap)
        else {
            panic!("no schedule")
        };
        let period_us = period.parse().unwrap();
        let times = [a, b].map(|words| micros(numbers(words).try_into().unwrap()));
        let schedule = Schedule::<K>::from_firing(Micros::new(period_us), times).unwrap();
        let schedule = schedule.verified(&Requirements::new(Micros::new(T_DELTA_US))).unwrap();
        Self { schedule, period_us, faults: rows.map(|row| fault(&row)).collect() }
    }
}

fn micros(us: [u32; K]) -> [Micros; K] {
    us.map(Micros::new)
}

fn fault(row: &[&str]) -> Fault {
    let &[name, before, line, edges, says, _] = row else { panic!("six columns expected: {row:?}") };
    let words = |words: &str| words.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let wiring = match words(line).as_slice() {
        [own] if own == "own" => Wiring::Own,
        [forgotten] if forgotten == "forgotten" => Wiring::Forgotten,
        [exchanged, with] if exchanged == "exchanged" => Wiring::Exchanged(with.parse().unwrap()),
        _ => panic!("{name}: line {line}"),
    };
    let says = match words(says).as_slice() {
        [obstacle, us] if obstacle == "obstacle" => Says::Obstacle(us.parse().unwrap()),
        [clear] if clear == "clear" => Says::Clear,
        [unanswered] if unanswered == "unanswered" => Says::Unanswered,
        [unknown] if unknown == "unknown" => Says::Unknown,
        [held] if held == "held" => Says::Held,
        _ => panic!("{name}: says {says}"),
    };
    let edge = |word: &str| {
        let (word, is_lost) = word.strip_suffix('*').map_or((word, false), |word| (word, true));
        let us = word.strip_prefix(['+', '-']).and_then(|us| us.parse().ok());
        Play { us: us.unwrap_or_else(|| panic!("{name}: edge {word}")), high: word.starts_with('+'), is_lost }
    };
    let edges = edges.split_whitespace().map(edge).collect();
    Fault { name: name.to_owned(), before: before.to_owned(), wiring, edges, says }
}

/// The pins: the level of each line, and the sensor triggered last.
#[derive(Default)]
struct Wires {
    levels: [Cell<bool>; K],
    triggered: Cell<Option<u8>>,
}

/// A driver of a ring on [`Wires`], used by a program that may forget a call for the faulty sensor.
trait Driver {
    fn deadline(&self) -> u32;
    /// Returns the next event; triggers the sensor that fires if the driver allows it.
    fn poll(&mut self, now: u32) -> Option<Flat>;
    fn edge(&mut self, sensor: u8, high: bool, at: u32);
    /// Returns a state in the form of [`core_side::state`](state).
    fn state(&self, sensor: u8, now: u32) -> [u32; 5];
    fn is_well(&self, sensor: u8) -> bool;
}

struct Pin(Rc<Wires>, u8);

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.triggered.set(Some(self.1));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.levels[usize::from(self.1)].get())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _ns: u32) {}
}

struct InRust<'s> {
    ring: HcSr04Ring<ScheduledRing<'s, K>, Pin, Pin, NoDelay, K>,
    watch: SensorWatch<K>,
    forgets: bool,
}

impl<'s> InRust<'s> {
    fn new(faults: &'s Faults, wires: &Rc<Wires>, forgets: bool, now: u32) -> Self {
        let now = Instant::from_micros(now);
        let config = RingConfig::new().with_window(Micros::new(WINDOW_US));
        let ring = Ring::new(&faults.schedule, config, now).unwrap();
        let pin = |x| Pin(Rc::clone(wires), x as u8);
        let pins = std::array::from_fn(|x| Pins { trigger: pin(x), echo: pin(x) });
        let ring = HcSr04Ring::new(ring, pins, NoDelay, Settings::default()).unwrap();
        Self { ring, watch: SensorWatch::new(0, now), forgets }
    }
}

impl Driver for InRust<'_> {
    fn deadline(&self) -> u32 {
        self.ring.next_deadline().as_micros()
    }

    fn poll(&mut self, now: u32) -> Option<Flat> {
        let now = Instant::from_micros(now);
        let event = self.ring.poll(now)?;
        self.watch.observe(&event, now);
        Some(flat(&event))
    }

    fn edge(&mut self, sensor: u8, high: bool, at: u32) {
        // The driver triggers by itself; the program can only forget to report edges.
        if !(self.forgets && sensor == FAULTY) {
            self.ring.edge(Edge { sensor, high, at: Instant::from_micros(at) }).unwrap();
        }
    }

    fn state(&self, sensor: u8, now: u32) -> [u32; 5] {
        state(self.watch.state(sensor, Instant::from_micros(now)).unwrap())
    }

    fn is_well(&self, sensor: u8) -> bool {
        self.ring.health(sensor) == Health::Well
    }
}

struct InC {
    ring: RefCell<C>,
    wires: Rc<Wires>,
    forgets: bool,
}

impl InC {
    fn new(faults: &Faults, wires: &Rc<Wires>, forgets: bool, now: u32) -> Self {
        let mut ring = C::new();
        ring.verified_schedule(0, &faults.schedule);
        assert_eq!(ring.ring(0, [0, WINDOW_US, 0, 0, 0], 2, now), 0);
        let Settings { min_retrigger, shortest, .. } = Settings::default();
        assert_eq!(ring.modules(min_retrigger.as_micros(), shortest.as_micros() as u16), 0);
        assert_eq!(ring.watch(K as u8, now), 0);
        Self { ring: RefCell::new(ring), wires: Rc::clone(wires), forgets }
    }
}

impl Driver for InC {
    fn deadline(&self) -> u32 {
        self.ring.borrow().deadline()
    }

    fn poll(&mut self, now: u32) -> Option<Flat> {
        let ring = self.ring.get_mut();
        let event = ring.poll(now, None).ok()?;
        if event[0] == 0 {
            let sensor = event[1] as u8;
            let level = u8::from(self.wires.levels[usize::from(sensor)].get());
            // A program that forgets to report a firing still triggers.
            let forgets = self.forgets && sensor == FAULTY;
            if forgets || ring.call(Do::FireModule, sensor | level << 7, now) == 0 {
                self.wires.triggered.set(Some(sensor));
            }
        }
        Some(event)
    }

    fn edge(&mut self, sensor: u8, high: bool, at: u32) {
        assert_eq!(self.ring.get_mut().call(Do::Edge, sensor | u8::from(high) << 7, at), 0);
    }

    fn state(&self, sensor: u8, now: u32) -> [u32; 5] {
        self.ring.borrow().state(sensor, now).unwrap()
    }

    fn is_well(&self, sensor: u8) -> bool {
        self.ring.borrow_mut().call(Do::Health, sensor, 0) == 0
    }
}

/// A reading of the faulty sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    /// The kind of reading, numbered as [`ReadingKind`].
    pub kind: u32,
    /// The state after the event, in the form of [`core_side::state`](state).
    pub state: [u32; 5],
    /// True if the sensor's line is healthy.
    pub is_well: bool,
}

impl Said {
    /// Returns true if the reading or the state is free space.
    pub fn is_clear(&self) -> bool {
        self.kind == ReadingKind::Clear as u32 || self.state[0] == 2
    }

    /// Returns true if a driver must report this.
    pub fn is(&self, says: Says) -> bool {
        match says {
            Says::Obstacle(us) => self.kind == ReadingKind::Accepted as u32 && self.state[..2] == [1, us],
            Says::Clear => self.kind == ReadingKind::Clear as u32 && self.state[0] == 2,
            Says::Unanswered | Says::Held => self.state[0] == 4 && !self.is_clear(),
            Says::Unknown => self.state[0] == 0 && !self.is_clear(),
        }
    }
}

/// Readings of a run: of the faulty sensor, and of the sensor whose wire is exchanged with it.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Readings of the faulty sensor.
    pub faulty: Vec<Said>,
    /// Readings of the sensor whose wires are exchanged with it, if any.
    pub partner: Vec<Said>,
}

/// Runs a driver. The fault begins `onset_us` after the start; until then the sensor is healthy and faces a wall.
fn run(driver: &mut dyn Driver, wires: &Wires, fault: &Fault, onset_us: u32, start: u32) -> Outcome {
    let partner = if let Wiring::Exchanged(with) = fault.wiring { Some(with) } else { None };
    let (mut outcome, mut periods, mut now) = (Outcome::default(), 0, start);
    let mut edges: Vec<(u32, u8, Play)> = vec![];
    while periods < PERIODS {
        let deadline = driver.deadline();
        let next = edges.iter().map(|&(at, ..)| at).min_by_key(|at| at.wrapping_sub(now));
        now = next.filter(|at| at.wrapping_sub(now) <= deadline.wrapping_sub(now)).unwrap_or(deadline);
        for (at, sensor, Play { high, is_lost, .. }) in edges.extract_if(.., |&mut (at, ..)| at == now) {
            wires.levels[usize::from(sensor)].set(high);
            if !is_lost {
                driver.edge(sensor, high, at);
            }
        }
        while let Some(event) = driver.poll(now) {
            if let Some(sensor) = wires.triggered.take() {
                let line = match partner {
                    Some(with) if sensor == FAULTY => with,
                    Some(with) if sensor == with => FAULTY,
                    _ => sensor,
                };
                let played = match sensor {
                    FAULTY if now.wrapping_sub(start) < onset_us => &WALL,
                    FAULTY => &fault.edges[..],
                    _ if Some(sensor) == partner => &NOTHING,
                    _ => &WALL,
                };
                // A module whose line is high ignores its trigger.
                if !wires.levels[usize::from(line)].get() {
                    edges.extend(played.iter().map(|&play| (now.wrapping_add(play.us), line, play)));
                }
            }
            let sensor = event[1] as u8;
            match event[0] {
                1 if sensor == FAULTY || Some(sensor) == partner => {
                    let (state, is_well) = (driver.state(sensor, now), driver.is_well(sensor));
                    let said = Said { kind: event[4], state, is_well };
                    if sensor == FAULTY { outcome.faulty.push(said) } else { outcome.partner.push(said) }
                }
                2 => periods += 1,
                _ => {}
            }
        }
    }
    outcome
}

/// Runs the drivers of Rust and of C, in this order, for 100 periods, with a fault that begins `onset_us` after the
/// start.
///
/// # Panics
/// If the drivers refuse the ring.
pub fn outcomes(faults: &Faults, fault: &Fault, onset_us: u32) -> [Outcome; 2] {
    // The clock wraps in each run.
    let (start, forgets) = (u32::MAX - 2_000_000, fault.wiring == Wiring::Forgotten);
    let wires = Rc::new(Wires::default());
    let in_rust = run(&mut InRust::new(faults, &wires, forgets, start), &wires, fault, onset_us, start);
    let wires = Rc::new(Wires::default());
    [in_rust, run(&mut InC::new(faults, &wires, forgets, start), &wires, fault, onset_us, start)]
}
