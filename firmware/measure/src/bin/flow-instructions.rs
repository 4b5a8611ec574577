//! Counts the instructions of each call of a flow ring of twelve sensors: see [`say_calls`]. Run it with `-icount
//! shift=10`, like `instructions`.
#![no_std]
#![no_main]

use eeruf_board::say::leave;
use eeruf_core::Instant;
use eeruf_measure::planned::{flow, say_calls};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let Ok(mut ring) = flow::<12>(Instant::from_micros(0)) else { leave(2) };
    say_calls(&mut ring);
    leave(0)
}
