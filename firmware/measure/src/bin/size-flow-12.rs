//! A flow ring of twelve sensors in static memory, and nothing else: see `planned_in_static_memory!`.
#![no_std]
#![no_main]

use eeruf_core::flow::FlowRing;
use eeruf_measure::planned::flow;

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

eeruf_measure::planned_in_static_memory!(FlowRing<12>, flow::<12>(Instant::from_micros(0)));

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    ring_program();
    eeruf_board::say::leave(0)
}
