//! A simulated PIO that runs the driver's program cycle by cycle.

use std::collections::VecDeque;

use eeruf_core::{Instant, Micros};
use eeruf_hc_sr04::capture::{PIO_HZ, PIO_PROGRAM};

/// A state machine of a PIO.
pub(crate) struct StateMachine {
    begin: Instant,
    pub(crate) at: usize,
    /// Half microseconds since the loop began.
    cycles: u64,
    x: u32,
    y: u32,
    isr: u32,
    osr: u32,
    pub(crate) from_host: VecDeque<u32>,
    pub(crate) to_host: VecDeque<(Instant, u32)>,
}

/// Length of the FIFO.
const WORDS: usize = 4;

impl StateMachine {
    pub(crate) fn new(begin: Instant) -> Self {
        let (from_host, to_host) = (VecDeque::new(), VecDeque::new());
        Self { begin, at: 0, cycles: 0, x: 0, y: 0, isr: 0, osr: 0, from_host, to_host }
    }

    fn now(&self) -> Instant {
        self.begin + Micros::new((self.cycles / u64::from(PIO_HZ / 1_000_000)) as u32)
    }

    /// Runs the program up to an instant; `pin` gives the level of the line at each instant.
    pub(crate) fn run(
        &mut self,
        until: Instant,
        mut pin: impl FnMut(Instant) -> bool,
        mut triggers: impl FnMut(Instant),
    ) {
        let end = u64::from(until.since(self.begin).as_micros()) * u64::from(PIO_HZ / 1_000_000);
        while self.cycles < end {
            let word = PIO_PROGRAM[self.at];
            let (operand, bits) = (word >> 5 & 7, u32::from(word & 31));
            let mut next = (self.at + 1) % PIO_PROGRAM.len();
            match word >> 13 {
                0 => {
                    let jumps = match operand {
                        0 => true,
                        2 => {
                            self.x = self.x.wrapping_sub(1);
                            self.x != u32::MAX
                        }
                        6 => pin(self.now()),
                        other => panic!("condition {other}"),
                    };
                    next = if jumps { bits as usize } else { next };
                }
                2 => {
                    let source = match operand {
                        0 => u32::from(pin(self.now())),
                        1 => self.x,
                        2 => self.y,
                        3 => 0,
                        7 => self.osr,
                        other => panic!("source {other}"),
                    };
                    self.isr = self.isr << bits | source & ((1 << bits) - 1);
                }
                3 => {
                    assert_eq!((operand, bits), (1, 24), "out x, 24, to the right");
                    (self.x, self.osr) = (self.osr & 0xFF_FFFF, self.osr >> 24);
                }
                4 if word == 0x8000 => {
                    if self.to_host.len() < WORDS {
                        self.to_host.push_back((self.now(), self.isr));
                    }
                    self.isr = 0;
                }
                4 => {
                    assert_eq!(word, 0x80A0, "pull block");
                    let Some(word) = self.from_host.pop_front() else {
                        self.cycles = end;
                        return;
                    };
                    self.osr = word;
                }
                5 => {
                    assert_eq!(word & 0xFF, 0x27, "mov x, osr");
                    self.x = self.osr;
                }
                7 if operand == 2 => self.y = bits,
                7 => {
                    assert_eq!(operand, 0, "set pins");
                    if bits == 1 {
                        triggers(self.now());
                    }
                }
                other => panic!("instruction {other}"),
            }
            self.cycles += 1 + u64::from(word >> 8 & 31);
            self.at = next;
        }
    }
}
