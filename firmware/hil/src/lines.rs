//! The echo lines, whose edges the host sends ahead of time, and the pins for the driver.

use core::cell::RefCell;
use core::convert::Infallible;

use critical_section::Mutex;
use eeruf_core::{Edge, Instant};
use eeruf_hil::{Ahead, MOST_AHEAD, Record, SENSORS};
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

use crate::host::Host;

struct Lines {
    /// The coming edges, soonest first, from `next` to `count`.
    ahead: [Ahead; MOST_AHEAD],
    next: usize,
    count: usize,
    /// True for each line that is high.
    high: [bool; SENSORS],
    /// Instant up to which edges have been played.
    played: Instant,
}

const NOTHING: Ahead = Ahead { edge: Edge { sensor: 0, high: false, at: Instant::from_micros(0) }, lost: false };

static LINES: Mutex<RefCell<Lines>> = Mutex::new(RefCell::new(Lines {
    ahead: [NOTHING; MOST_AHEAD],
    next: 0,
    count: 0,
    high: [false; SENSORS],
    played: Instant::from_micros(0),
}));

fn with<R>(f: impl FnOnce(&mut Lines) -> R) -> R {
    critical_section::with(|token| f(&mut LINES.borrow_ref_mut(token)))
}

/// Begins at `now`, without edges.
pub(crate) fn begin(now: Instant) {
    with(|lines| lines.played = now);
}

impl Lines {
    fn set_timer(&self) {
        if self.next < self.count {
            eeruf_board::set_echo(self.ahead[self.next].edge.at);
        }
    }

    /// Returns a pending edge, if there is one whose interrupt is not lost.
    fn edge(&mut self) -> Option<Edge> {
        let now = eeruf_board::now();
        while self.next < self.count {
            let Ahead { edge, lost } = self.ahead[self.next];
            if !now.has_reached(edge.at) {
                break;
            }
            self.next += 1;
            self.played = edge.at;
            self.high[usize::from(edge.sensor)] = edge.high;
            if !lost {
                return Some(Edge { at: now, ..edge });
            }
        }
        self.set_timer();
        None
    }

    /// Replaces the coming edges by the host's answer, which may also hold past edges.
    fn replace(&mut self, ahead: impl Iterator<Item = Ahead>) {
        self.next = 0;
        self.count = 0;
        for ahead in ahead {
            if !self.played.has_reached(ahead.edge.at) {
                self.ahead[self.count] = ahead;
                self.count += 1;
            }
        }
        self.set_timer();
    }
}

/// Returns a pending edge, if any, like an interrupt controller. The handler of the echo interrupt calls this until
/// there is none.
pub(crate) fn edge() -> Option<Edge> {
    with(Lines::edge)
}

/// The trigger or the echo pin of a sensor.
pub(crate) struct Pin<'h> {
    pub(crate) host: &'h Host,
    pub(crate) sensor: u8,
}

impl ErrorType for Pin<'_> {
    type Error = Infallible;
}

impl OutputPin for Pin<'_> {
    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    /// Triggers the module: an HC-SR04 measures from the falling edge of its trigger.
    fn set_low(&mut self) -> Result<(), Infallible> {
        let mut answer = [[[0; 4]; 2]; MOST_AHEAD];
        let answer = self.host.trigger(self.sensor, eeruf_board::now(), &mut answer);
        with(|lines| lines.replace(answer.iter().map(|words| Ahead::from_words(words.map(u32::from_le_bytes)))));
        Ok(())
    }
}

impl InputPin for Pin<'_> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let high = with(|lines| lines.high[usize::from(self.sensor)]);
        self.host.say(Record::level(self.sensor, high));
        Ok(high)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}
