//! Instructions of each call of a hopping ring of twelve sensors: see [`say_calls`]. To be run with `-icount shift=10`,
//! as `instructions`.
#![no_std]
#![no_main]

use eeruf_board::say::leave;
use eeruf_core::Instant;
use eeruf_measure::planned::{HOPPING_12, hopping, say_calls};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let Ok(mut ring) = hopping(&HOPPING_12, Instant::from_micros(0)) else { leave(2) };
    say_calls(&mut ring, 100, |ring| Some(core::array::from_fn::<_, 12, _>(|sensor| ring.plan().t_lag(sensor))));
    leave(0)
}
