//! Drivers of modules that measure by themselves, one call at a time; and their ring, with scripted modules.

use fastrand::Rng;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use crate::four::{BEGIN, K, ring};
use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, SensorError, SpeedOfSound};
use eeruf_hc_sr04::measuring::{Fault, Mb1010, Measured, Measures, MeasuringRing, Srf08, Us100};
use eeruf_hc_sr04::modules::{Module, SRF08, US_100};
use eeruf_hc_sr04::{Health, SetupError};
use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::i2c::{Mock as Bus, Transaction};

const fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

fn read(bytes: [u8; 4]) -> Transaction {
    Transaction::write_read(0x70, vec![0], bytes.to_vec())
}

/// The result of an SRF08 that is started and asked at these times, with these transactions.
fn srf08(transactions: &[Transaction], asks: &[Micros]) -> Result<Measured, Fault> {
    let start = [Transaction::write(0x70, vec![0, 0x52])];
    let bus = Bus::new(start.iter().chain(transactions));
    let mut module = Srf08::new(bus, Srf08::<Bus>::ADDRESS);
    assert_eq!(module.start(), Ok(ms(2)));
    let answers: Vec<_> = asks.iter().map(|&since| module.result(since)).collect();
    module.release().done();
    *answers.last().unwrap()
}

#[test]
fn srf08_reports_echo_nothing_and_faults() {
    let nack = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);
    let busy = read([0xFF; 4]);
    let answer = |bytes| srf08(&[busy.clone(), read(bytes)], &[ms(2), ms(40), ms(65)]);
    assert_eq!(answer([10, 0x80, 0x2E, 0xE0]), Ok(Measured::Echo(ms(12))));
    assert_eq!(answer([10, 0x80, 0, 0]), Ok(Measured::Nothing));
    assert_eq!(answer([0, 0, 0, 0]), Err(Fault::Bus), "shorted to ground");
    assert_eq!(answer([0xFF; 4]), Err(Fault::NoAnswer), "still ranging, or cut");
    assert_eq!(answer([10, 0x80, 0xFF, 0xFF]), Err(Fault::Invalid), "cut within the read");
    let failed = |kind| srf08(&[read([0; 4]).with_error(kind)], &[ms(65)]);
    assert_eq!(failed(nack), Err(Fault::NoAnswer));
    assert_eq!(failed(ErrorKind::ArbitrationLoss), Err(Fault::Bus));
    // While it ranges it is asked only once.
    assert_eq!(srf08(std::slice::from_ref(&busy), &[ms(2), ms(33), ms(64)]), Ok(Measured::NotYet(ms(65))));
    // An earlier result is in its registers.
    assert_eq!(srf08(&[read([10, 0x80, 0x2E, 0xE0])], &[ms(2), ms(65), ms(66)]), Err(Fault::NoAnswer));

    let start = Transaction::write(0x7F, vec![0, 0x52]).with_error(nack);
    let mut module = Srf08::new(Bus::new(&[start]), 0x7F);
    assert_eq!(module.start(), Err(Fault::NoAnswer));
    module.release().done();
}

type Received = Result<u8, embedded_io::ErrorKind>;

/// A serial line, and the bytes and errors that have arrived.
#[derive(Clone, Default)]
struct Line(Rc<RefCell<VecDeque<Received>>>);

const NOISE: Received = Err(embedded_io::ErrorKind::InvalidData);

impl Line {
    fn holding(received: &[Received]) -> Self {
        let line = Self::default();
        line.0.borrow_mut().extend(received);
        line
    }
}

impl embedded_io::ErrorType for Line {
    type Error = embedded_io::ErrorKind;
}

impl embedded_io::ReadReady for Line {
    fn read_ready(&mut self) -> Result<bool, Self::Error> {
        Ok(!self.0.borrow().is_empty())
    }
}

impl embedded_io::Read for Line {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Self::Error> {
        bytes[0] = self.0.borrow_mut().pop_front().expect("a read that would wait")?;
        Ok(1)
    }
}

impl embedded_io::Write for Line {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        assert_eq!((bytes, self.0.borrow().len()), (&[0x55][..], 0), "the command, on a line that was cleared");
        Ok(1)
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The result of a US-100 that sends these distances at these times, each in one piece.
fn us100(answers: &[(Micros, u16)]) -> Result<Measured, Fault> {
    let line = Line::default();
    let mut module = Us100::new(line.clone());
    assert_eq!(module.start(), Ok(ms(5)));
    for &(at, mm) in answers {
        line.0.borrow_mut().extend(mm.to_be_bytes().map(Ok));
        assert_eq!(module.result(at), Ok(Measured::NotYet(at.saturating_add(ms(5)))));
    }
    module.result(ms(100))
}

#[test]
fn us100_reports_echo_nothing_and_faults() {
    assert_eq!(us100(&[(ms(20), 1_716)]), Ok(Measured::Echo(ms(10))));
    assert_eq!(us100(&[(ms(30), 11_000)]), Ok(Measured::Nothing), "it has listened for as long as it sees");
    assert_eq!(us100(&[(ms(20), 11_000)]), Err(Fault::Invalid), "it cannot know yet");
    assert_eq!(us100(&[(ms(9), 1_716)]), Err(Fault::Invalid), "sooner than its echo");
    assert_eq!(us100(&[(ms(3), 1_716), (ms(20), 858)]), Ok(Measured::Echo(ms(5))), "an earlier one, and this one");
    assert_eq!(us100(&[(ms(20), 858), (ms(20), 859)]), Err(Fault::Invalid));
    assert_eq!(us100(&[]), Err(Fault::NoAnswer));
    assert_eq!(us100(&[(ms(50), 0)]), Err(Fault::Invalid));
    assert_eq!(us100(&[(ms(50), 19)]), Err(Fault::Invalid), "nearer than it measures");
    assert_eq!(us100(&[(ms(50), u16::MAX)]), Err(Fault::Invalid), "beyond what sound travels meanwhile");

    let mut module = Us100::new(Line::holding(&[Ok(6), NOISE, Ok(180)]));
    assert!(matches!(module.result(ms(20)), Ok(Measured::NotYet(_))));
    assert_eq!(module.result(ms(100)), Err(Fault::Bus));

    // With sound 1 m/s slower, the same distance takes longer.
    let mut module = Us100::new(Line::holding(&[Ok(6), Ok(180)])).with_speed(SpeedOfSound::from_mm_per_s(342_200));
    assert_eq!(module.result(ms(100)), Ok(Measured::Echo(Micros::new(10_029))));
}

#[test]
fn us100_start_discards_all_that_its_line_holds() {
    let old = [NOISE, Ok(10), NOISE, Ok(7), Ok(208)];
    let mut module = Us100::new(Line::holding(&old));
    module.start().unwrap();
    assert_eq!(module.result(ms(100)), Err(Fault::NoAnswer));
    // An endless answer does not come from a US-100.
    assert_eq!(Us100::new(Line::holding(&[Ok(1); 40])).start(), Err(Fault::Invalid));
    assert_eq!(Us100::new(Line::holding(&[NOISE; 40])).start(), Err(Fault::Bus));
}

#[test]
fn mb1010_reports_echo_nothing_and_faults() {
    let trigger = [Level::set(State::High), Level::set(State::Low)];
    let answer = |pulses: &[Micros], since| {
        let mut module = Mb1010::new(Pin::new(&trigger), NoopDelay);
        module.pulse(ms(7)); // before the start
        assert_eq!(module.start(), Ok(ms(5)));
        pulses.iter().for_each(|&width| module.pulse(width));
        let result = module.result(since);
        module.release().0.done();
        result
    };
    assert_eq!(answer(&[], ms(5)), Ok(Measured::NotYet(ms(10))));
    assert_eq!(answer(&[], ms(45)), Err(Fault::NoAnswer));
    assert_eq!(answer(&[ms(12)], ms(15)), Ok(Measured::Echo(ms(12))));
    assert_eq!(answer(&[ms(12); 2], ms(15)), Ok(Measured::Echo(ms(12))), "reported twice");
    assert_eq!(answer(&[Micros::new(37_500)], ms(40)), Ok(Measured::Nothing));
    for pulses in [&[ms(16)][..], &[Micros::new(90)], &[ms(12), ms(3)]] {
        assert_eq!(answer(pulses, ms(15)), Err(Fault::Invalid), "{pulses:?}");
    }
    assert_eq!(answer(&[ms(43)], ms(50)), Err(Fault::Invalid), "longer than it holds its line");

    let io = MockError::Io(std::io::ErrorKind::Other);
    for failing in [0, 1] {
        let mut levels = trigger.to_vec();
        levels[failing] = levels[failing].clone().with_error(io.clone());
        let mut module = Mb1010::new(Pin::new(&levels), NoopDelay);
        assert_eq!(module.start(), Err(Fault::Bus));
        module.pulse(ms(12));
        assert_eq!(module.result(ms(15)), Ok(Measured::NotYet(ms(20))), "of no start");
        module.release().0.done();
    }
}

/// A custom module that gives the same answer each time, after 20 ms.
#[derive(Debug)]
struct Scripted {
    module: Module,
    start: Result<Micros, Fault>,
    answer: Result<Measured, Fault>,
    asked: u32,
}

impl Scripted {
    fn new(answer: Result<Measured, Fault>) -> Self {
        Self { module: SRF08, start: Ok(ms(20)), answer, asked: 0 }
    }
}

impl Measures for Scripted {
    fn module(&self) -> &Module {
        &self.module
    }

    fn start(&mut self) -> Result<Micros, Fault> {
        self.start
    }

    fn result(&mut self, since: Micros) -> Result<Measured, Fault> {
        assert!(since >= ms(20));
        self.asked += 1;
        self.answer
    }
}

type ScriptedRing<M> = MeasuringRing<ScheduledRing<'static, K>, M, K>;

/// Polls at each deadline; returns the kinds of reading of each sensor.
fn poll_all<M: Measures>(ring: &mut ScriptedRing<M>) -> [Vec<ReadingKind>; K] {
    let mut kinds = std::array::from_fn(|_| vec![]);
    for _ in 0..3_000 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            if let RingEvent::Reading(reading) = event {
                kinds[usize::from(reading.sensor)].push(reading.kind);
            }
        }
    }
    kinds
}

fn last<M: Measures>(ring: &mut ScriptedRing<M>) -> [ReadingKind; K] {
    poll_all(ring).map(|kinds| *kinds.last().unwrap())
}

#[test]
fn unlike_modules_share_a_ring() {
    // An echo beyond the window counts as silence within it.
    let answers = [Ok(Measured::Echo(ms(9))), Ok(Measured::Echo(ms(40))), Ok(Measured::Nothing), Err(Fault::NoAnswer)];
    let [mut near, mut far, mut none, mut dead] = answers.map(Scripted::new);
    let modules: [&mut dyn Measures; K] = [&mut near, &mut far, &mut none, &mut dead];
    let mut ring = MeasuringRing::new(ring(), modules).unwrap();
    let kinds = [ReadingKind::Accepted, ReadingKind::Clear, ReadingKind::Clear, ReadingKind::Unanswered];
    assert_eq!(last(&mut ring), kinds);
    assert_eq!([2, 3, 4].map(|sensor| ring.health(sensor)), [Health::Well, Health::Missing, Health::Missing]);
    assert!(ring.module_mut(3).is_some() && ring.module_mut(4).is_none());
    assert_eq!(ring.disable(4), Err(SensorError { sensor: 4, sensors: 4 }));
    assert!(dead.asked > 25 * near.asked, "it is asked until its time is over: {} times", dead.asked);
}

#[test]
fn health_follows_the_last_firing() {
    let faults = [Fault::Bus, Fault::Truncated, Fault::Invalid];
    let modules = std::array::from_fn(|x| Scripted::new(Err(*faults.get(x).unwrap_or(&Fault::Bus))));
    let mut ring = MeasuringRing::new(ring(), modules).unwrap();
    let failed = ring.module_mut(3).unwrap();
    (failed.start, failed.answer) = (Err(Fault::Bus), Ok(Measured::Nothing));
    assert_eq!(last(&mut ring), [ReadingKind::Unanswered; K]);
    let health = |ring: &ScriptedRing<Scripted>| [0, 1, 2, 3].map(|sensor| ring.health(sensor));
    assert_eq!(health(&ring), [Health::PinError, Health::LosesEdges, Health::Chatters, Health::PinError]);
    assert_eq!(ring.module_mut(3).unwrap().asked, 0, "it was never started");

    (0..4).for_each(|x| *ring.module_mut(x).unwrap() = Scripted::new(Ok(Measured::Nothing)));
    assert_eq!(last(&mut ring), [ReadingKind::Clear; K]);
    assert_eq!(health(&ring), [Health::Well; K]);

    // A module that never finishes does not stop the ring.
    (0..4).for_each(|x| *ring.module_mut(x).unwrap() = Scripted::new(Ok(Measured::NotYet(ms(0)))));
    assert_eq!(last(&mut ring), [ReadingKind::Unanswered; K]);
    assert_eq!(health(&ring), [Health::Missing; K]);
}

#[test]
fn table_too_fast_for_a_module_is_refused() {
    let ring = || Ring::new(&eeruf_core::tables::PAPER_12, RingConfig::new(), BEGIN).unwrap();
    let modules = |module| [(); 12].map(|()| Scripted { module, ..Scripted::new(Ok(Measured::Nothing)) });
    let refused = |module| match MeasuringRing::new(ring(), modules(module)) {
        Err(SetupError::Retrigger { min_refire, min_retrigger }) => {
            (min_refire < min_retrigger).then_some(min_retrigger)
        }
        _ => None,
    };
    assert_eq!(refused(SRF08), None);
    assert_eq!(refused(US_100), Some(ms(100)));
    assert_eq!(refused(Module { report_us: 99_000, ..SRF08 }), Some(ms(99)));
}

/// Runs a ring until its last sensor fires, with modules that never answer; returns the ring and the time.
fn after_the_last_fires() -> (ScriptedRing<Scripted>, Instant) {
    let modules = std::array::from_fn(|_| Scripted::new(Err(Fault::NoAnswer)));
    let (mut ring, mut now) = (MeasuringRing::new(ring(), modules).unwrap(), BEGIN);
    while !std::iter::from_fn(|| ring.poll(now)).any(|event| matches!(event, RingEvent::Fire { sensor: 3, .. })) {
        now = ring.next_deadline();
    }
    (ring, now)
}

/// Polls every millisecond; returns the number of times that the last sensor's module was asked.
fn asked(ring: &mut ScriptedRing<Scripted>, from: Instant, polls: u32) -> u32 {
    for at in 0..polls {
        while ring.poll(from + ms(at)).is_some() {}
    }
    ring.module_mut(3).unwrap().asked
}

#[test]
fn restart_drops_measurements_under_way() {
    let (mut ring, now) = after_the_last_fires();
    ring.restart(now);
    assert_eq!(asked(&mut ring, now, 50), 0);
}

#[test]
fn module_is_asked_no_longer_than_it_may_take() {
    let (mut ring, now) = after_the_last_fires();
    assert_eq!(asked(&mut ring, now + ms(10_000), 50), 1, "once, after a loop that came late");

    // A clock that steps back makes the ring forget its firings. When the clock is right again the ring is paused.
    let (mut ring, now) = after_the_last_fires();
    asked(&mut ring, Instant::from_micros(now.as_micros().wrapping_sub(5_000_000)), 1);
    ring.pause();
    let asked = asked(&mut ring, now, 500);
    assert!((1..60).contains(&asked), "{asked}");
}

// Bus traffic would make the firing later than the poll says.
#[test]
fn due_firing_waits_for_no_answer() {
    let modules = std::array::from_fn(|_| Scripted::new(Err(Fault::NoAnswer)));
    let mut ring = MeasuringRing::new(ring(), modules).unwrap();
    let all = |ring: &mut ScriptedRing<Scripted>| (0..4).map(|x| ring.module_mut(x).unwrap().asked).sum::<u32>();
    let (mut now, mut fired) = (BEGIN, 0);
    for _ in 0..3_000 {
        now = ring.next_deadline() + ms(7);
        loop {
            let before = all(&mut ring);
            let Some(event) = ring.poll(now) else { break };
            if let RingEvent::Fire { .. } = event {
                assert_eq!(all(&mut ring), before);
                fired += 1;
            }
        }
    }
    assert!(fired > 500, "{fired} by {now:?}");
}

// Neither operations nor jumps of the clock make a dead module or a wall clear.
#[test]
fn operations_and_clock_jumps_make_nothing_clear() {
    let answers = [Ok(Measured::Echo(ms(9))), Err(Fault::NoAnswer), Err(Fault::Bus)];
    let modules = std::array::from_fn(|x| Scripted::new(answers[x % 3]));
    let mut ring = MeasuringRing::new(ring(), modules).unwrap();
    let (mut random, mut now, mut accepted) = (Rng::with_seed(77), BEGIN, 0);
    for _ in 0..200_000 {
        let deadline = ring.next_deadline();
        now = match random.u32(..=2_000) {
            0 => Instant::from_micros(random.u32(..=u32::MAX - 1)),
            1..=20 => now + Micros::new(random.u32(..=200_000)),
            _ if deadline.has_reached(now) => deadline,
            _ => now + Micros::new(random.u32(..=100)),
        };
        let sensor = random.u32(..=4) as u8;
        match random.u32(..=3_000) {
            0 => ring.pause(),
            1..=30 => ring.resume(),
            31..=40 => _ = ring.disable(sensor),
            41..=80 => _ = ring.enable(sensor),
            81..=90 => ring.restart(now),
            _ => {}
        }
        while let Some(event) = ring.poll(now) {
            let RingEvent::Reading(reading) = event else { continue };
            assert!(!matches!(reading.kind, ReadingKind::NoEcho | ReadingKind::Clear), "{reading:?}");
            accepted += u32::from(reading.kind == ReadingKind::Accepted);
        }
    }
    assert!(accepted > 1_000, "{accepted}");
}
