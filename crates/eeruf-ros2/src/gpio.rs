//! A ring of HC-SR04 modules on this machine's own pins, as on a Raspberry Pi. It sends the node the messages that a
//! board would send.

#[cfg(target_os = "linux")]
mod chip;

use std::fs;
use std::hash::{BuildHasher as _, RandomState};
use std::path::Path;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender};
#[cfg(target_os = "linux")]
use std::thread;

use eeruf_core::flow::FlowRing;
use eeruf_core::{
    Edge, Instant, MAX_SENSORS, Micros, Ring, RingConfig, RingError, RingEvent, VerifiedSchedule, judge::Judge,
    plan::Plan,
};
use eeruf_design::{Effort, FlowDesign, PeriodProblem, RingSpec, shortest};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use eeruf_serial::{FiringMessage, Message, Received};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{Error, ErrorKind, ErrorType, InputPin, OutputPin};

use crate::board_line::{FromLine, nanoseconds};

/// Search budget in nodes, a second or two, for the shortest period at the start.
const BUDGET: u64 = 2_000_000;

/// The pins of all sensors, counted from 0, and the clock that stamps their edges.
pub(crate) trait Lines {
    /// Microseconds since some instant.
    fn now_us(&self) -> u64;
    fn set_trigger(&self, sensor: u8, high: bool) -> Result<(), String>;
    fn is_high(&self, sensor: u8) -> Result<bool, String>;
    fn delay_us(&self, us: u32);
    /// Returns the next edge of an echo line; waits for it until this instant, or not at all if that has passed.
    fn next_edge(&self, until_us: u64) -> Result<Option<Edge>, String>;
    /// The number of edges lost so far, modulo 256.
    fn lost(&self) -> u8;
}

/// Speeds of the robot, in mm/s and mrad/s.
pub(crate) type Speeds = [u32; 2];

/// The ring of a ring file: the way it fires, and the settings of its modules.
pub(crate) struct GpioRing {
    way: Way,
    settings: Settings,
    sensors: u8,
}

enum Way {
    Flow(Box<FlowDesign>),
    Table(Box<VerifiedSchedule<MAX_SENSORS>>),
}

impl GpioRing {
    /// Designs the ring of a file: flow, or the schedule that `eeruf design` finds.
    pub(crate) fn design(file: &Path, method: &str) -> Result<Self, String> {
        let wrong = |why: String| format!("ring: {}: {why}", file.display());
        let text = fs::read_to_string(file).map_err(|error| wrong(error.to_string()))?;
        let spec = RingSpec::in_file(file, &text).map_err(|error| format!("ring: {error}"))?;
        Self::of(&spec, method).map_err(wrong)
    }

    fn of(spec: &RingSpec, method: &str) -> Result<Self, String> {
        let module = spec.robot_ring().modules.first().copied();
        let problem: PeriodProblem<'_> = spec.problem();
        let way = match method {
            // Each robot draws random gaps of its own.
            "flow" => Way::Flow(Box::new(spec.flow(RandomState::new().hash_one(0) as u32 | 1)?)),
            "eeruf" => {
                let search = Effort { budget: BUDGET, ..Effort::default() };
                let found = shortest(&problem, &search, &mut ()).map_err(|error| error.to_string())?;
                let verified = found.schedule.verified(&problem.requirements);
                Way::Table(Box::new(verified.map_err(|error| error.to_string())?))
            }
            other => return Err(format!("method: {other}; expected flow, or eeruf for a table, on pins")),
        };
        let settings = match module {
            None => Settings::default(),
            Some(module) => Settings::of(&module)
                .ok_or_else(|| format!("module {}: expected one that answers by a pulse, as hc-sr04", module.name))?,
        };
        Ok(Self { way, settings, sensors: problem.sensors as u8 })
    }

    /// Fires and listens, and passes messages to `each` until it returns false. `speeds` gives the robot's motion.
    pub(crate) fn run<L: Lines>(
        &self,
        lines: L,
        speeds: &Receiver<Speeds>,
        each: impl FnMut(FromLine) -> bool,
    ) -> Result<(), String> {
        let now = instant(lines.now_us());
        match &self.way {
            Way::Table(schedule) => self.fire(Ring::new(schedule, RingConfig::new(), now), lines, speeds, each),
            Way::Flow(design) => {
                let &FlowDesign { turns, belief, window, blanking, limits } = &**design;
                let config = RingConfig::new().with_window(window).with_blanking(blanking);
                let ring = FlowRing::with_limits(self.sensors.into(), limits, turns, belief, config, now);
                self.fire(ring, lines, speeds, each)
            }
        }
    }

    fn fire<P: Plan, J: Judge, const H: usize, L: Lines>(
        &self,
        ring: Result<Ring<P, J, MAX_SENSORS, 1, H>, RingError>,
        lines: L,
        speeds: &Receiver<Speeds>,
        mut each: impl FnMut(FromLine) -> bool,
    ) -> Result<(), String> {
        let lines = Rc::new(lines);
        let pins = std::array::from_fn(|n| {
            let sensor = u8::try_from(n).ok().filter(|&sensor| sensor < self.sensors);
            let pin = Pin { lines: Rc::clone(&lines), sensor };
            Pins { trigger: pin.clone(), echo: pin }
        });
        let ring = ring.map_err(|error| error.to_string())?;
        let ring = HcSr04Ring::new(ring, pins, Delay(Rc::clone(&lines)), self.settings);
        let mut ring = ring.map_err(|error| error.to_string())?;
        let mut known = Known { sequence: 0, fired: [(instant(0), Micros::ZERO); MAX_SENSORS] };
        let hello = Message::Hello { sensors: self.sensors, clock: "gpio".to_owned() };
        if !(each(FromLine::Opened) && each(known.frame(hello))) {
            return Ok(());
        }
        loop {
            let now_us = lines.now_us();
            if let Some([speed_mm_s, turn_mrad_s]) = speeds.try_iter().last() {
                ring.moving(speed_mm_s, turn_mrad_s, instant(now_us));
            }
            // No window closes on an edge that came in time.
            while let Some(edge) = lines.next_edge(0)? {
                _ = ring.edge(edge);
            }
            while let Some(event) = ring.poll(instant(now_us)) {
                let health = |sensor| ring.health(sensor) as u8;
                let message = known.message(&event, instant(now_us), (0..self.sensors).map(health), lines.lost());
                if message.is_some_and(|message| !each(known.frame(message))) {
                    return Ok(());
                }
            }
            let left = ring.next_deadline().since(instant(now_us));
            // A deadline that has passed seems to be more than half a turn of the clock ahead.
            let left_us = if left.as_micros() > i32::MAX as u32 { 0 } else { u64::from(left.as_micros()) };
            if let Some(edge) = lines.next_edge(now_us + left_us)? {
                _ = ring.edge(edge);
            }
        }
    }
}

/// Opens the lines and fires in a thread of its own until the receiver is gone.
#[cfg(target_os = "linux")]
pub(crate) fn listen(
    ring: GpioRing,
    chip: &str,
    [triggers, echoes]: [&[u32]; 2],
    speeds: Receiver<Speeds>,
    to: Sender<FromLine>,
) -> Result<(), String> {
    let lines = chip::Chip::open(chip, triggers, echoes)?;
    thread::spawn(move || {
        if let Err(error) = ring.run(lines, &speeds, |from| to.send(from).is_ok()) {
            _ = to.send(FromLine::Lost(error));
        }
    });
    Ok(())
}

fn instant(us: u64) -> Instant {
    // Wraps, as instants do.
    Instant::from_micros(us as u32)
}

/// The known state of the ring.
struct Known {
    sequence: u16,
    fired: [(Instant, Micros); MAX_SENSORS],
}

impl Known {
    fn frame(&mut self, message: Message) -> FromLine {
        let sequence = self.sequence;
        self.sequence = sequence.wrapping_add(1);
        FromLine::Frame(Ok(Received { sequence, message, of_hopping: false }), nanoseconds())
    }

    fn message(
        &mut self,
        event: &RingEvent,
        now: Instant,
        health: impl Iterator<Item = u8>,
        edges_lost: u8,
    ) -> Option<Message> {
        match *event {
            RingEvent::Fire { sensor, due, .. } => {
                if let Some(place) = self.fired.get_mut(usize::from(sensor)) {
                    *place = (now, now.since(due));
                }
                None
            }
            RingEvent::Reading(reading) => {
                let &(fired, late) = self.fired.get(usize::from(reading.sensor))?;
                Some(Message::Firing(FiringMessage::of(&reading, fired, late, now)))
            }
            RingEvent::PeriodEnded(ref stats) => {
                let (period, max_late, health) = (stats.period, stats.max_late, health.collect());
                Some(Message::Period { period, max_late, edges_lost, health })
            }
        }
    }
}

/// Trigger or echo line of a sensor; `None` for a sensor that the ring does not have.
struct Pin<L> {
    lines: Rc<L>,
    sensor: Option<u8>,
}

impl<L> Clone for Pin<L> {
    fn clone(&self) -> Self {
        Self { lines: Rc::clone(&self.lines), sensor: self.sensor }
    }
}

/// A kernel error at a pin, which the driver turns into the sensor's health.
#[derive(Debug)]
pub(crate) struct PinError;

impl Error for PinError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl<L> ErrorType for Pin<L> {
    type Error = PinError;
}

impl<L: Lines> OutputPin for Pin<L> {
    fn set_low(&mut self) -> Result<(), PinError> {
        self.sensor.map_or(Ok(()), |sensor| self.lines.set_trigger(sensor, false).map_err(|_| PinError))
    }

    fn set_high(&mut self) -> Result<(), PinError> {
        self.sensor.map_or(Ok(()), |sensor| self.lines.set_trigger(sensor, true).map_err(|_| PinError))
    }
}

impl<L: Lines> InputPin for Pin<L> {
    fn is_high(&mut self) -> Result<bool, PinError> {
        self.sensor.map_or(Ok(false), |sensor| self.lines.is_high(sensor).map_err(|_| PinError))
    }

    fn is_low(&mut self) -> Result<bool, PinError> {
        self.is_high().map(|is_high| !is_high)
    }
}

struct Delay<L>(Rc<L>);

impl<L: Lines> DelayNs for Delay<L> {
    fn delay_ns(&mut self, ns: u32) {
        self.0.delay_us(ns.div_ceil(1000));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::cell::{Cell, RefCell};
    use std::collections::BTreeSet;

    use eeruf_core::ReadingKind;

    /// Modules that face fixed walls, and a clock that advances while the ring waits. Module 2 has a cut wire, nothing
    /// is in range of module 3, and the line of module 4 is stuck. The object in front of module 1 may jump.
    struct Modules {
        jumps: bool,
        now_us: Cell<u64>,
        edges: RefCell<BTreeSet<(u64, u8, bool)>>,
        triggered: RefCell<Vec<(u64, u8)>>,
    }

    const SENSORS: u8 = 5;
    const ECHOES_US: [u64; 2] = [5_800, 11_600];

    impl Lines for Modules {
        fn now_us(&self) -> u64 {
            // Reading it takes a little time.
            self.now_us.set(self.now_us.get() + 2);
            self.now_us.get()
        }

        fn set_trigger(&self, sensor: u8, high: bool) -> Result<(), String> {
            let now = self.now_us();
            if high {
                self.triggered.borrow_mut().push((now, sensor));
                return Ok(());
            }
            let width = match sensor {
                2 => return Ok(()),
                3 => 38_000,
                1 if self.jumps && self.triggered.borrow().iter().filter(|fired| fired.1 == 1).count() % 2 == 0 => {
                    ECHOES_US[1] + 2_000
                }
                _ => ECHOES_US[usize::from(sensor)],
            };
            self.edges.borrow_mut().extend([(now + 450, sensor, true), (now + 450 + width, sensor, false)]);
            Ok(())
        }

        fn is_high(&self, sensor: u8) -> Result<bool, String> {
            Ok(sensor == 4)
        }

        fn delay_us(&self, us: u32) {
            self.now_us.set(self.now_us.get() + u64::from(us));
        }

        fn next_edge(&self, until_us: u64) -> Result<Option<Edge>, String> {
            let first = self.edges.borrow().first().copied();
            match first.filter(|(at, ..)| *at <= until_us.max(self.now_us.get())) {
                Some((at, sensor, high)) => {
                    self.edges.borrow_mut().pop_first();
                    // The edge is read later than it came, but has the kernel's time stamp.
                    self.now_us.set(self.now_us.get().max(at + 30));
                    Ok(Some(Edge { sensor, high, at: instant(at) }))
                }
                None => {
                    self.now_us.set(self.now_us.get().max(until_us));
                    Ok(None)
                }
            }
        }

        fn lost(&self) -> u8 {
            0
        }
    }

    const RING: &str = "sensors = 5\nmodule = \"hc-sr04\"\nlayout = \"ring\"\njitter_us = 100\nmin_interval_us = 0\n\
                        spacing_deg = 72\nradius_m = 0.2";

    type OfSensor = Vec<(ReadingKind, Option<Micros>)>;

    /// The readings of 40 periods by sensor, and the health at the end. The ring gets the speeds once per period.
    fn read(
        start_us: u64,
        (ring, method): (&str, &str),
        jumps: bool,
        told: impl Fn(u32) -> Option<Speeds>,
    ) -> (Vec<OfSensor>, Vec<u8>) {
        let ring = GpioRing::of(&RingSpec::from_text(ring).unwrap(), method).unwrap();
        assert_eq!(ring.sensors, SENSORS);
        let (now_us, edges, triggered) = (Cell::new(start_us), RefCell::default(), RefCell::default());
        let modules = Modules { jumps, now_us, edges, triggered };
        let (tell, speeds) = std::sync::mpsc::channel();
        told(0).into_iter().for_each(|told| tell.send(told).unwrap());
        let (mut readings, mut healths, mut next) = (vec![vec![]; 5], vec![], 0);
        ring.run(modules, &speeds, |from| {
            let FromLine::Frame(frame, _) = from else { return true };
            let Received { sequence, message, .. } = frame.unwrap();
            assert_eq!(sequence, next);
            next += 1;
            match message {
                Message::Hello { sensors, .. } => assert_eq!(sensors, SENSORS),
                Message::Firing(firing) => {
                    assert!(firing.late.as_micros() < 200, "{firing:?}");
                    readings[usize::from(firing.sensor)].push((firing.kind, firing.t_echo));
                }
                Message::Period { period, health, .. } => {
                    healths = health;
                    told(period + 1).into_iter().for_each(|told| tell.send(told).unwrap());
                    return period < 40;
                }
            }
            true
        })
        .unwrap();
        (readings, healths)
    }

    #[test]
    fn ring_on_pins_reads_walls_and_what_is_broken() {
        // The second start goes through the clock's wrap.
        let starts = [1_000, u64::from(u32::MAX) - 1_000_000];
        for (start_us, method) in starts.into_iter().flat_map(|start| [(start, "flow"), (start, "eeruf")]) {
            let (readings, health) = read(start_us, (RING, method), false, |_| None);
            for (sensor, echo_us) in ECHOES_US.into_iter().enumerate() {
                let right = |&&(kind, t_echo): &&(ReadingKind, Option<Micros>)| {
                    kind == ReadingKind::Accepted && t_echo.is_some_and(|t_echo| t_echo.as_micros() == echo_us as u32)
                };
                let (all, right) = (readings[sensor].len(), readings[sensor].iter().filter(right).count());
                assert!(all >= 39 && right >= all - 1, "{method}, sensor {sensor}: {right} of {all}");
            }
            let all = |sensor: usize, kind| readings[sensor].iter().skip(2).all(|reading| reading.0 == kind);
            assert!(all(2, ReadingKind::Unanswered), "{:?}", readings[2]);
            assert!(all(3, ReadingKind::Clear), "{:?}", readings[3]);
            assert!(all(4, ReadingKind::Stuck), "{:?}", readings[4]);
            assert_eq!(health, [0, 0, 1, 0, 2]);
        }
    }

    #[test]
    fn ring_by_flow_moves_as_it_is_told() {
        let ring = format!("{RING}\nspeed_m_s = 0.9\nothers = false");
        let accepted = |told: fn(u32) -> Option<Speeds>| {
            let (readings, _) = read(1_000, (&ring, "flow"), true, told);
            let is_accepted = |&(kind, _): &(ReadingKind, Option<Micros>)| kind == ReadingKind::Accepted;
            readings[1].iter().map(is_accepted).collect::<Vec<bool>>()
        };
        let count = |of: &[bool]| of.iter().filter(|&&is| is).count();
        // As the file says, every echo counts while the robot moves alone; on a stationary one a jump does not.
        let untold = accepted(|_| None);
        assert_eq!(count(&untold), untold.len());
        let standing = accepted(|_| Some([0, 0]));
        assert!(count(&standing) < standing.len() / 2, "{standing:?}");
        // After half a second without a report the file's speed holds.
        let silent = accepted(|period| (period < 15).then_some([0, 0]));
        assert!(count(&silent[..15]) < 8 && count(&silent[30..]) == silent[30..].len(), "{silent:?}");
        let turning = accepted(|_| Some([0, 500]));
        assert_eq!(count(&turning), turning.len());
    }

    #[test]
    fn module_without_pulses_and_unknown_way_are_refused() {
        let other = GpioRing::of(&RingSpec::from_text(RING).unwrap(), "simultaneous").err().unwrap();
        assert_eq!(other, "method: simultaneous; expected flow, or eeruf for a table, on pins");
        let spec = RingSpec::from_text(&RING.replace("hc-sr04", "srf08")).unwrap();
        let error = GpioRing::of(&spec, "flow").err().unwrap();
        assert!(error.contains("srf08") && error.contains("expected one that answers by a pulse"), "{error}");
    }
}
