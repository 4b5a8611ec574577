//! The reference: a ring on the host that gets every input of the ring on the board, in the same order, and must emit
//! the same events.
//!
//! Its trigger pins fire into the simulated world, but only after the board has reported the same trigger.

use core::cell::RefCell;
use core::convert::Infallible;
use std::rc::Rc;
use std::thread;
use std::time::Duration;

use eeruf_core::{Edge, Instant, Reading, Ring, RingEvent, judge::Judge, plan::Plan};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings};
use eeruf_hil::{Record, SENSORS, Topic};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

use crate::emulator::Emulator;
use crate::lines::Lines;

/// State shared by ring and pins: the board, its lines, and the first error.
pub(crate) struct Session<'w> {
    pub(crate) board: Emulator,
    pub(crate) lines: Lines<'w>,
    /// Time when the board was started and its clock's reading then, if it runs in real time.
    pace: Option<(std::time::Instant, Instant)>,
    wrong: Option<String>,
}

pub(crate) type Shared<'w> = Rc<RefCell<Session<'w>>>;

impl<'w> Session<'w> {
    pub(crate) fn new(board: Emulator, lines: Lines<'w>, pace: Option<Instant>) -> Shared<'w> {
        let pace = pace.map(|start| (std::time::Instant::now(), start));
        Rc::new(RefCell::new(Self { board, lines, pace, wrong: None }))
    }

    /// Returns the board's next record, which must have this topic.
    pub(crate) fn expect(&mut self, topic: Topic, sensor: u8) -> Result<Record, String> {
        let record = self.board.next()?.ok_or_else(|| format!("the board ended where {topic:?} was expected"))?;
        if record.topic() == Some(topic) && record.sensor() == sensor {
            return Ok(record);
        }
        let (said, of) = (record.topic(), record.sensor() + 1);
        Err(format!("the host's ring expected {topic:?} of sensor {}, the board said {said:?} of {of}", sensor + 1))
    }

    fn level(&mut self, sensor: u8) -> Result<bool, String> {
        Ok(self.expect(Topic::Level, sensor)?.flag() != 0)
    }

    fn trigger(&mut self, sensor: u8) -> Result<(), String> {
        let at = self.expect(Topic::Trigger, sensor)?.instant();
        if let Some((began, start)) = self.pace {
            // The board's time stands still until it is answered.
            let due = began + Duration::from_micros(at.since(start).as_micros().into());
            thread::sleep(due.saturating_duration_since(std::time::Instant::now()));
        }
        self.lines.trigger(sensor, at)?;
        let ahead = self.lines.ahead(at)?;
        self.board.answer(&ahead)
    }

    /// Stores an error until the poll is over, since the driver expects pins that cannot fail.
    fn store_error<T: Default>(&mut self, result: Result<T, String>) -> T {
        result.unwrap_or_else(|wrong| {
            self.wrong.get_or_insert(wrong);
            T::default()
        })
    }
}

/// A trigger or echo pin of the reference.
pub(crate) struct Pin<'w> {
    session: Shared<'w>,
    sensor: u8,
}

impl ErrorType for Pin<'_> {
    type Error = Infallible;
}

impl OutputPin for Pin<'_> {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        let mut session = self.session.borrow_mut();
        let result = session.trigger(self.sensor);
        session.store_error(result);
        Ok(())
    }
}

impl InputPin for Pin<'_> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let mut session = self.session.borrow_mut();
        let result = session.level(self.sensor);
        Ok(session.store_error(result))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// A delay that does not wait: the board's records give all times.
pub(crate) struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

/// A ring like the board's, on pins of this kind.
pub(crate) type HostRing<R, P> = HcSr04Ring<R, P, P, NoDelay, SENSORS>;

/// Puts a ring on pins like the board.
pub(crate) fn on_pins<P: Plan, J: Judge, I: OutputPin + InputPin, const H: usize>(
    ring: Ring<P, J, SENSORS, 1, H>,
    pin: impl Fn(u8) -> I,
) -> Result<HostRing<Ring<P, J, SENSORS, 1, H>, I>, String> {
    let pins = core::array::from_fn(|x| Pins { trigger: pin(x as u8), echo: pin(x as u8) });
    HcSr04Ring::new(ring, pins, NoDelay, Settings::default()).map_err(|error| error.to_string())
}

/// The ring on the host.
pub(crate) struct Reference<'w, R> {
    session: Shared<'w>,
    ring: HostRing<R, Pin<'w>>,
}

impl<'w, P: Plan, J: Judge, const H: usize> Reference<'w, Ring<P, J, SENSORS, 1, H>> {
    /// Makes a reference from a ring built like the board's, at the same instant.
    pub(crate) fn new(session: &Shared<'w>, ring: Ring<P, J, SENSORS, 1, H>) -> Result<Self, String> {
        let pin = |sensor| Pin { session: Rc::clone(session), sensor };
        Ok(Self { session: Rc::clone(session), ring: on_pins(ring, pin)? })
    }

    pub(crate) fn edge(&mut self, edge: Edge) -> Result<(), String> {
        self.session.borrow_mut().lines.notice(edge)?;
        self.ring.edge(edge).map_err(|error| error.to_string())
    }

    /// Polls, and compares the event with the board's.
    pub(crate) fn poll(&mut self, now: Instant) -> Result<Option<RingEvent>, String> {
        let event = self.ring.poll(now);
        let mut session = self.session.borrow_mut();
        if let Some(wrong) = session.wrong.take() {
            return Err(wrong);
        }
        let mine = Record::event(event.as_ref());
        let board = session.expect(Topic::Event, mine.sensor())?;
        if board == mine {
            Ok(event)
        } else {
            Err(format!("the host's ring emitted {event:?}, {:x?}; the board's {:x?}", mine.0, board.0))
        }
    }

    /// Compares the deadline and the state of the sensors with the board's.
    pub(crate) fn compare(&self, said: Record) -> Result<(), String> {
        let mine = match said.topic() {
            Some(Topic::Deadline) => Record::deadline(self.ring.next_deadline()),
            // How many edges were lost before they came to the ring is the board's to know.
            _ => Record::state(self.health(), said.flag()),
        };
        if said == mine {
            Ok(())
        } else {
            Err(format!("the host's ring is at {:x?}, the board's at {:x?}", mine.0, said.0))
        }
    }

    pub(crate) fn health(&self) -> [Health; SENSORS] {
        core::array::from_fn(|sensor| self.ring.health(sensor as u8))
    }
}

/// The readings of every sensor, in the order of its firings.
pub(crate) type Read = [Vec<Reading>; SENSORS];
