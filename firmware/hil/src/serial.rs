//! The ring of the main program, which also sends its readings over the board's serial line, like a ring on a robot.
#![no_std]
#![no_main]

mod host;
mod lines;
mod ring;

use eeruf_core::Ring;
use eeruf_hil::{CONFIG, SCHEDULE, SENSORS};
use eeruf_serial::Recorder;

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, ring::echo_interrupt);

#[eeruf_board::entry]
fn main() -> ! {
    let mut recorder = Recorder::<SENSORS>::new("lm3s6965");
    eeruf_board::open_line();
    ring::run(
        |now| Ring::new(&SCHEDULE, CONFIG, now),
        |event, now, health, edges_lost| {
            if let Some(frame) = recorder.event(event, now, |sensor| health(sensor) as u8, edges_lost) {
                // The emulated line takes everything at once. On a real one a frame takes 2 ms, which calls for a queue
                // and an interrupt.
                frame.as_bytes().iter().for_each(|&byte| eeruf_board::send(byte));
            }
        },
    )
}
