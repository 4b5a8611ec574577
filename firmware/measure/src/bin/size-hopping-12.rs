//! A hopping ring of twelve sensors in static memory, and nothing else: see `planned_in_static_memory!`.
#![no_std]
#![no_main]

use eeruf_core::hopping::{HoppingRing, HoppingSchedule};
use eeruf_measure::planned::{HOPPING_12, hopping};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

static SCHEDULE: HoppingSchedule<12> = HOPPING_12;

eeruf_measure::planned_in_static_memory!(HoppingRing<12>, 12, |now| hopping(&SCHEDULE, now));

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    ring_program();
    eeruf_board::say::leave(0)
}
