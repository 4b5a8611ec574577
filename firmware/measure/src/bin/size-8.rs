//! Image for measuring the size of plan and filter for 8 sensors.
#![no_std]
#![no_main]

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);
eeruf_measure::ring_in_static_memory!(8);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    ring_program();
    eeruf_board::say::leave(1)
}
