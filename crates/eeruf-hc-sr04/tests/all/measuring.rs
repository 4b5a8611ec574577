//! Rings of four modules that measure by themselves, in simulated time: SRF08 on I2C, US-100 on a serial line, MB1010
//! by pulse width. Each fake follows its data sheet and can have faults.

use fastrand::Rng;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use crate::four::{BEGIN, K, ring};
use eeruf_core::{Instant, Micros, Reading, ReadingKind, RingEvent};
use eeruf_hc_sr04::Health;
use eeruf_hc_sr04::measuring::{Mb1010, Measures, MeasuringRing, Srf08, Us100};
use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource, Operation};
use embedded_hal_mock::eh1::delay::NoopDelay;

/// The space in front of a module.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Space {
    /// A wall, whose echo takes this many microseconds.
    Wall(u32),
    Free,
}

/// A fault of one measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trouble {
    None,
    /// A cut wire: no acknowledgement, no byte, no pulse.
    Cut,
    /// A bus error that disappears when the module is asked again.
    Blip,
    /// The bus, the line or the pin reports an error.
    Bus,
    /// A part of the answer is missing.
    Truncated,
    /// The answer contains bytes that the module did not send.
    Garbled,
    /// The result comes too late; on a serial line, after the next start.
    Late,
    /// The result comes twice.
    Twice,
    /// The start is not received: only an earlier firing's result is there.
    Ignored,
    /// The data line is shorted to ground.
    Shorted,
}

impl Trouble {
    const ALL: [Self; 9] = {
        use Trouble::*;
        [Cut, Blip, Bus, Truncated, Garbled, Late, Twice, Ignored, Shorted]
    };

    /// Returns true if the result of the firing can still be obtained.
    fn is_harmless(self) -> bool {
        matches!(self, Self::None | Self::Blip | Self::Twice)
    }
}

/// The space and the trouble of a sensor's firing.
type Script = Rc<dyn Fn(u8, u32) -> (Space, Trouble)>;

/// State that the fakes share: the time, in microseconds, and the script.
struct World {
    now: u64,
    random: Rng,
    script: Script,
    firings: [u32; K],
    /// Pulses to report: time of the end, sensor, and width.
    pulses: Vec<(u64, u8, u32)>,
}

impl World {
    /// Starts a sensor; returns its echo time with some jitter, and its trouble.
    fn start(&mut self, sensor: u8) -> (Option<u32>, Trouble) {
        let firing = &mut self.firings[usize::from(sensor)];
        let (space, trouble) = (self.script)(sensor, *firing);
        *firing += 1;
        match space {
            Space::Wall(us) => (Some(us + self.random.u32(..=30)), trouble),
            Space::Free => (None, trouble),
        }
    }
}

type Shared = Rc<RefCell<World>>;

/// An SRF08 on a bus of its own.
struct I2cFake {
    world: Shared,
    sensor: u8,
    ranges_until: u64,
    trouble: Trouble,
    echo_us: u16,
    reads: u32,
}

const NACK: ErrorKind = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);

impl embedded_hal::i2c::ErrorType for I2cFake {
    type Error = ErrorKind;
}

impl embedded_hal::i2c::I2c for I2cFake {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        assert_eq!(address, 0x70 + self.sensor);
        let mut world = self.world.borrow_mut();
        if let [Operation::Write(command)] = operations {
            assert_eq!(*command, [0x00, 0x52]);
            let (echo, trouble) = world.start(self.sensor);
            // While it ranges it does not respond.
            let deaf = world.now < self.ranges_until;
            self.trouble = trouble;
            if trouble == Trouble::Cut || (deaf && trouble != Trouble::Shorted) {
                return Err(NACK);
            }
            if !matches!(trouble, Trouble::Ignored | Trouble::Shorted) {
                let late = if trouble == Trouble::Late { 40_000 } else { 0 };
                self.ranges_until = world.now + 65_000 + late;
                self.echo_us = echo.map_or(0, |us| us as u16);
                self.reads = 0;
            }
            return Ok(());
        }
        let [Operation::Write([0]), Operation::Read(bytes)] = operations else { panic!("{operations:?}") };
        if self.trouble == Trouble::Shorted {
            bytes.fill(0);
            return Ok(());
        }
        if self.trouble == Trouble::Cut {
            return Err(NACK);
        }
        if world.now < self.ranges_until {
            // Some hosts report a missing acknowledgement, others read an undriven bus.
            bytes.fill(0xFF);
            return if self.sensor % 2 == 0 { Err(NACK) } else { Ok(()) };
        }
        self.reads += 1;
        let [high, low] = self.echo_us.to_be_bytes();
        bytes.copy_from_slice(&[10, 0x80, high, low]);
        match self.trouble {
            Trouble::Bus => return Err(ErrorKind::ArbitrationLoss),
            Trouble::Blip if self.reads < 3 => return Err(ErrorKind::Bus),
            // The module stops driving the bus during the read.
            Trouble::Truncated => bytes[2..].fill(0xFF),
            Trouble::Garbled => bytes[0] = 0xFF,
            _ => {}
        }
        Ok(())
    }
}

/// A US-100 on a line of 9600 baud: bytes or errors, in order of time.
struct SerialFake {
    world: Shared,
    sensor: u8,
    line: VecDeque<(u64, Result<u8, embedded_io::ErrorKind>)>,
}

const BYTE_US: u64 = 1_042;

impl embedded_io::ErrorType for SerialFake {
    type Error = embedded_io::ErrorKind;
}

impl embedded_io::ReadReady for SerialFake {
    fn read_ready(&mut self) -> Result<bool, Self::Error> {
        let now = self.world.borrow().now;
        Ok(self.line.front().is_some_and(|&(at, _)| at <= now))
    }
}

impl embedded_io::Read for SerialFake {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Self::Error> {
        bytes[0] = self.line.pop_front().expect("a read that would wait").1?;
        Ok(1)
    }
}

impl embedded_io::Write for SerialFake {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        assert_eq!(bytes, [0x55]);
        let mut world = self.world.borrow_mut();
        let (echo, trouble) = world.start(self.sensor);
        // Millimetres at 343.2 m/s; without an echo, a distance beyond its range after the time to listen.
        let mm = echo.map_or(5_500, |us| (u64::from(us) * 343_200 + 1_000_000) / 2_000_000) as u16;
        let [high, low] = mm.to_be_bytes();
        let mut at = world.now + BYTE_US + u64::from(echo.unwrap_or(33_000)) + 2_000;
        let answer = match trouble {
            Trouble::Cut | Trouble::Ignored => vec![],
            Trouble::Bus => vec![Ok(high), Err(embedded_io::ErrorKind::InvalidData), Ok(low)],
            Trouble::Truncated => vec![Ok(high)],
            Trouble::Garbled => vec![Ok(high), Ok(0x5A), Ok(low)],
            Trouble::Twice => vec![Ok(high), Ok(low), Ok(high), Ok(low)],
            Trouble::Shorted => vec![Ok(0), Ok(0)],
            Trouble::None | Trouble::Blip | Trouble::Late => vec![Ok(high), Ok(low)],
        };
        if trouble == Trouble::Late {
            at = world.now + 118_000;
        }
        for byte in answer {
            at += BYTE_US;
            self.line.push_back((at, byte));
        }
        self.line.make_contiguous().sort_by_key(|&(at, _)| at);
        Ok(1)
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The RX pin of an MB1010; a capture unit watches its PW pin.
struct RxFake {
    world: Shared,
    sensor: u8,
    is_high: bool,
}

#[derive(Debug)]
struct PinFault;

impl embedded_hal::digital::Error for PinFault {
    fn kind(&self) -> embedded_hal::digital::ErrorKind {
        embedded_hal::digital::ErrorKind::Other
    }
}

impl embedded_hal::digital::ErrorType for RxFake {
    type Error = PinFault;
}

impl embedded_hal::digital::OutputPin for RxFake {
    fn set_high(&mut self) -> Result<(), PinFault> {
        self.is_high = true;
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), PinFault> {
        if !std::mem::take(&mut self.is_high) {
            return Ok(());
        }
        let mut world = self.world.borrow_mut();
        let (echo, trouble) = world.start(self.sensor);
        let width = echo.unwrap_or(37_500);
        let rises = world.now + 20 + 310;
        let ends = rises + u64::from(width);
        let sensor = self.sensor;
        match trouble {
            Trouble::Cut | Trouble::Ignored => {}
            Trouble::Bus => return Err(PinFault),
            Trouble::Truncated => world.pulses.push((rises + 40, sensor, 40)),
            Trouble::Garbled => world.pulses.extend([(ends, sensor, width), (ends + 500, sensor, 400)]),
            Trouble::Twice => world.pulses.extend([(ends, sensor, width), (ends + 500, sensor, width)]),
            Trouble::Late => world.pulses.push((ends + 115_000 - u64::from(width), sensor, width)),
            Trouble::Shorted => world.pulses.push((rises + 60_000, sensor, 60_000)),
            Trouble::None | Trouble::Blip => world.pulses.push((ends, sensor, width)),
        }
        Ok(())
    }
}

/// A module under test, which may accept a captured pulse.
trait Fake: Measures {
    fn of(world: &Shared, sensor: u8) -> Self;

    fn captured(&mut self, _width: Micros) {}
}

impl Fake for Srf08<I2cFake> {
    fn of(world: &Shared, sensor: u8) -> Self {
        let world = world.clone();
        let fake = I2cFake { world, sensor, ranges_until: 0, trouble: Trouble::None, echo_us: 0, reads: 0 };
        Self::new(fake, Self::ADDRESS + sensor)
    }
}

impl Fake for Us100<SerialFake> {
    fn of(world: &Shared, sensor: u8) -> Self {
        Self::new(SerialFake { world: world.clone(), sensor, line: VecDeque::new() })
    }
}

impl Fake for Mb1010<RxFake, NoopDelay> {
    fn of(world: &Shared, sensor: u8) -> Self {
        Self::new(RxFake { world: world.clone(), sensor, is_high: false }, NoopDelay)
    }

    fn captured(&mut self, width: Micros) {
        self.pulse(width);
    }
}

fn instant(us: u64) -> Instant {
    Instant::from_micros(us as u32)
}

/// Runs a loop that is up to `late` microseconds late; returns each sensor's readings and its health.
fn run<M: Fake>(periods: u32, script: &Script, late: u32) -> ([Vec<Reading>; K], [Health; K]) {
    let world = World {
        now: BEGIN.as_micros().into(),
        random: Rng::with_seed(2_000),
        script: script.clone(),
        firings: [0; K],
        pulses: vec![],
    };
    let world = Rc::new(RefCell::new(world));
    let modules = std::array::from_fn(|x| M::of(&world, x as u8));
    let mut ring = MeasuringRing::new(ring(), modules).unwrap();
    let (mut readings, mut ended) = (std::array::from_fn(|_| vec![]), 0);
    while ended < periods {
        let now = {
            let mut world = world.borrow_mut();
            let wait = ring.next_deadline().since(instant(world.now)).as_micros();
            // A deadline in the past is due at once.
            let wait = if wait > u32::MAX / 2 { 0 } else { wait };
            let next = world.pulses.iter().map(|&(at, ..)| at).min().unwrap_or(u64::MAX).max(world.now);
            world.now = (world.now + u64::from(wait)).min(next) + u64::from(world.random.u32(..=late));
            world.now
        };
        let pulses = std::mem::take(&mut world.borrow_mut().pulses);
        let (mut ends, later): (Vec<_>, _) = pulses.into_iter().partition(|&(at, ..)| at <= now);
        world.borrow_mut().pulses = later;
        ends.sort_unstable();
        for (_, sensor, width) in ends {
            ring.module_mut(sensor).unwrap().captured(Micros::new(width));
        }
        while let Some(event) = ring.poll(instant(now)) {
            match event {
                RingEvent::Fire { .. } => {}
                RingEvent::Reading(reading) => readings[usize::from(reading.sensor)].push(reading),
                RingEvent::PeriodEnded(_) => ended += 1,
            }
        }
    }
    (readings, std::array::from_fn(|x| ring.health(x as u8)))
}

/// Checks each sensor's readings against the script: only the wall is accepted, only reported free space is clear, and
/// after two good firings in a row at least 98 % of the results are accepted or clear.
fn check(readings: &[Vec<Reading>; K], script: &Script) {
    for (sensor, readings) in readings.iter().enumerate() {
        let (mut right, mut all) = (0, 0);
        let mut before = false;
        for (firing, reading) in readings.iter().enumerate() {
            let (space, trouble) = script(sensor as u8, firing as u32);
            let good = trouble.is_harmless();
            let context = format!("sensor {sensor}, firing {firing}, {trouble:?}: {reading:?}");
            match (reading.kind, space) {
                (ReadingKind::NoEcho | ReadingKind::Clear, _) => assert!(good && space == Space::Free, "{context}"),
                (ReadingKind::First | ReadingKind::Accepted, Space::Wall(us)) => {
                    let t_echo = reading.t_echo.unwrap().as_micros();
                    // A millimetre is 6 us.
                    assert!(good && (us - 6..=us + 36).contains(&t_echo), "{context}");
                }
                (ReadingKind::Ambiguous, Space::Wall(_)) => assert!(good, "{context}"),
                (ReadingKind::Unanswered, _) => assert!(!good, "{context}"),
                _ => panic!("{context}"),
            }
            if good && before {
                all += 1;
                right += u32::from(matches!(reading.kind, ReadingKind::Accepted | ReadingKind::Clear));
            }
            before = good;
        }
        assert!(100 * right >= 98 * all, "sensor {sensor}: {right} of {all}");
    }
}

fn no_trouble(sensor: u8, _: u32) -> (Space, Trouble) {
    let space = [Space::Wall(4_000), Space::Wall(12_000), Space::Free, Space::Wall(25_000)];
    (space[usize::from(sensor)], Trouble::None)
}

/// Two sensors with each kind of trouble in turn, one whose wire is cut later, and one without trouble.
fn troubles(sensor: u8, firing: u32) -> (Space, Trouble) {
    let now_and_then = |every: u32| match firing % every {
        4 => Trouble::ALL[(firing / every) as usize % Trouble::ALL.len()],
        _ => Trouble::None,
    };
    match sensor {
        0 => (Space::Wall(12_000), now_and_then(6)),
        1 => (Space::Free, now_and_then(7)),
        2 => (Space::Wall(20_000), Trouble::None),
        _ => (Space::Free, if firing < 150 { Trouble::None } else { Trouble::Cut }),
    }
}

fn holds<M: Fake>() {
    let script: Script = Rc::new(no_trouble);
    let (readings, health) = run::<M>(300, &script, 200);
    check(&readings, &script);
    assert_eq!(health, [Health::Well; K]);
    assert!(readings.iter().all(|readings| readings.len() >= 298));

    // A loop that is late loses no answer; walls may be ambiguous then.
    let (readings, health) = run::<M>(300, &script, 5_000);
    assert_eq!(health, [Health::Well; K]);
    assert!(readings.iter().flatten().all(|reading| reading.kind != ReadingKind::Unanswered));
    let is_clear = |reading: &&Reading| reading.kind == ReadingKind::Clear;
    assert_eq!(readings[2].iter().filter(is_clear).count(), readings[2].len() - 1);

    let script: Script = Rc::new(troubles);
    let (readings, health) = run::<M>(1_000, &script, 200);
    check(&readings, &script);
    assert_eq!(health[2..], [Health::Well, Health::Missing]);
    assert!(readings.iter().all(|readings| readings.len() >= 998));

    for trouble in Trouble::ALL {
        // After ten good firings the trouble lasts for ever; two sensors face walls, two face free space.
        let script: Script = Rc::new(move |sensor, firing| {
            let space = [Space::Wall(12_000), Space::Free][usize::from(sensor % 2)];
            (space, if firing < 10 { Trouble::None } else { trouble })
        });
        let (readings, health) = run::<M>(100, &script, 200);
        check(&readings, &script);
        assert_eq!(health == [Health::Well; K], trouble.is_harmless(), "{trouble:?}: {health:?}");
    }
}

#[test]
fn ring_of_srf08_sees_walls_and_space_despite_faults() {
    holds::<Srf08<I2cFake>>();
}

#[test]
fn ring_of_us100_sees_walls_and_space_despite_faults() {
    holds::<Us100<SerialFake>>();
}

#[test]
fn ring_of_mb1010_sees_walls_and_space_despite_faults() {
    holds::<Mb1010<RxFake, NoopDelay>>();
}
