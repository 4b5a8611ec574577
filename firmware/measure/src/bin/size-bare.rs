//! Baseline for the programs `size-8`, `size-12` and `size-24`: an image without a ring.
#![no_std]
#![no_main]

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    while core::hint::black_box(true) {
        eeruf_board::set_alarm(core::hint::black_box(eeruf_board::now()));
    }
    eeruf_board::say::leave(1)
}
