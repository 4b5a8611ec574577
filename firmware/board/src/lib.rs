//! The board functions that a ring needs, for four boards that QEMU emulates.
//!
//! | board | target | core |
//! |---|---|---|
//! | `microbit` | `thumbv6m-none-eabi` | Cortex-M0 |
//! | `lm3s6965` | `thumbv7m-none-eabi` | Cortex-M3 |
//! | `an386` | `thumbv7em-none-eabihf` | Cortex-M4F |
//! | `rv_virt` | `riscv32imac-unknown-none-elf` | RV32IMAC |
//!
//! Each module has the same functions: a clock in microseconds, a one-shot alarm that only ends a sleep, a second timer
//! whose interrupt stands for an edge on an echo line, and a counter for measurements. [`fake_sensors`] simulates the
//! sensors, [`say`] prints through the debugger.
//!
//! To add a board, write `src/NAME.rs`, add a line below, its target and memory in `build.rs`, a runner in
//! `firmware/.cargo/config.toml`, and a row of `BOARDS` in `xtask/src/firmware.rs`.
#![no_std]

#[cfg_attr(board = "microbit", path = "microbit.rs")]
#[cfg_attr(board = "lm3s6965", path = "lm3s6965.rs")]
#[cfg_attr(board = "an386", path = "an386.rs")]
#[cfg_attr(board = "rv_virt", path = "rv_virt.rs")]
mod chip;
#[cfg(target_arch = "arm")]
mod cortex_m_common;
pub mod fake_sensors;
pub mod say;
#[cfg(any(board = "lm3s6965", board = "an386"))]
mod systick_clock;

use eeruf_core::Instant;

pub use chip::*;
#[cfg(target_arch = "arm")]
pub use cortex_m_common::*;
#[cfg(any(board = "lm3s6965", board = "an386"))]
use systick_clock::running;
#[cfg(any(board = "lm3s6965", board = "an386"))]
pub use systick_clock::{clear_alarm, clear_echo, set_alarm, set_echo};

/// The entry point of a program: `#[eeruf_board::entry] fn main() -> !`.
#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// Reads the clock.
pub fn now() -> Instant {
    Instant::from_micros(running().as_micros())
}

/// Proof that an image cannot panic: its panic handler calls a function that does not exist. If any path to a panic is
/// left after optimisation, the image does not link. Only for release builds, whose optimiser removes unreachable
/// paths.
#[macro_export]
macro_rules! no_panic {
    () => {
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo) -> ! {
            unsafe extern "C" {
                fn a_path_to_a_panic_is_left_in_this_image() -> !;
            }
            // SAFETY: never executed; the symbol does not exist, so an image that could execute it does not link.
            unsafe { a_path_to_a_panic_is_left_in_this_image() }
        }
    };
}

/// A panic handler for images that may fail, such as tests: prints the place, and exits with code 101.
#[macro_export]
macro_rules! say_panic {
    () => {
        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo) -> ! {
            $crate::say::panicked(info)
        }
    };
}
