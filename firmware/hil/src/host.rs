//! The host, reached through the debugger's file access: records go to the emulator's standard output, answers come
//! from its standard input. Emulated time stands still while the board waits.

use core::cell::RefCell;

use eeruf_board::say;
use eeruf_board::say::leave;
use eeruf_core::Instant;
use eeruf_hil::{MOST_AHEAD, Orders, Record};
use semihosting::fs::File;
use semihosting::io::{Read, Write};

/// Number of records buffered before they are sent.
const KEPT: usize = 64;

/// The host.
pub(crate) struct Host(RefCell<Pipes>);

struct Pipes {
    input: File,
    output: File,
    kept: [[u8; Record::BYTES]; KEPT],
    count: usize,
}

impl Host {
    /// Opens the pipes and reads the orders.
    pub(crate) fn open() -> (Self, Orders) {
        let (Ok(mut input), Ok(output)) = (File::open(c"/dev/stdin"), File::create(c"/dev/stdout")) else {
            say!("no host: this program runs under eeruf-hil");
            leave(4)
        };
        let mut words = [[0; 4]; 4];
        read(&mut input, words.as_flattened_mut());
        let pipes = Pipes { input, output, kept: [[0; Record::BYTES]; KEPT], count: 0 };
        (Self(RefCell::new(pipes)), Orders::from_words(words.map(u32::from_le_bytes)))
    }

    /// Queues a record; a full buffer is sent at once.
    pub(crate) fn say(&self, record: Record) {
        let mut pipes = self.0.borrow_mut();
        if pipes.count == KEPT {
            pipes.flush();
        }
        let count = pipes.count;
        pipes.kept[count] = record.to_bytes();
        pipes.count += 1;
    }

    /// Sends the queued records.
    pub(crate) fn flush(&self) {
        self.0.borrow_mut().flush();
    }

    /// Reports that a sensor has been triggered, and waits for all coming edges: two words for each.
    pub(crate) fn trigger<'b>(
        &self,
        sensor: u8,
        at: Instant,
        answer: &'b mut [[[u8; 4]; 2]; MOST_AHEAD],
    ) -> &'b [[[u8; 4]; 2]] {
        self.say(Record::trigger(sensor, at));
        let mut pipes = self.0.borrow_mut();
        pipes.flush();
        let mut count = [0; 4];
        read(&mut pipes.input, &mut count);
        let answer = &mut answer[..u32::from_le_bytes(count) as usize];
        read(&mut pipes.input, answer.as_flattened_mut().as_flattened_mut());
        answer
    }
}

impl Pipes {
    fn flush(&mut self) {
        if self.output.write_all(self.kept[..self.count].as_flattened()).is_err() {
            leave(6);
        }
        self.count = 0;
    }
}

fn read(input: &mut File, bytes: &mut [u8]) {
    if input.read_exact(bytes).is_err() {
        leave(5);
    }
}
