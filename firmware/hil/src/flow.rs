//! A ring of eight HC-SR04 sensors that fires by flow, in lock step with a simulator on the host. The main loop is that
//! of any other ring, but also reports every input and output of the ring to the host.
#![no_std]
#![no_main]

mod host;
mod lines;
mod ring;

use eeruf_hil::flow_ring;

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, ring::echo_interrupt);

#[eeruf_board::entry]
fn main() -> ! {
    ring::run(flow_ring, |_, _, _, _| {})
}
