//! ARM MPS2 with the AN386 image: Cortex-M4F. SysTick at 1 MHz is the clock, CMSDK timer 0 the alarm, timer 1 the echo
//! lines, and one of the dual timers counts instructions.

use crate::cortex_m_common::{Register, enable_interrupts};
use crate::systick_clock;

/// The name of this board.
pub const NAME: &str = "an386";
pub(crate) const ALARM_IRQ: u16 = 8;
pub(crate) const ECHO_IRQ: u16 = 9;
pub(crate) const SPARE_IRQ: u16 = 20;
pub(crate) const NVIC_PRIO_BITS: u8 = 3;
pub(crate) const VECTORS: usize = 32;
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`).
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 25_600;

pub(crate) const ALARM_TIMER: usize = 0x4000_0000;
pub(crate) const ECHO_TIMER: usize = 0x4000_1000;
pub(crate) const CONTROL: usize = 0x0;
pub(crate) const INTERRUPT_CLEAR: usize = 0xC;
pub(crate) const TIMER_TICKS_PER_US: u32 = 25;
pub(crate) const SYSTICK_LOG2_TICKS_PER_US: u32 = 0;
/// The reference clock of 1 MHz.
pub(crate) const SYSTICK_SOURCE: u32 = 0;

const DUAL_TIMER: usize = 0x4000_2000;
const VALUE: usize = 0x4;
const RELOAD: usize = 0x8;

/// Starts clock and interrupts.
pub fn start() {
    systick_clock::start();
    // Free-running, 32 bits, undivided.
    Register::at(DUAL_TIMER, 0x8).write(0b1000_0010);
    enable_interrupts();
}

/// Lets a stopped timer run down once.
pub(crate) fn run_down(timer: usize, ticks: u32) {
    // Without a reload value it stops at zero.
    Register::at(timer, RELOAD).write(0);
    Register::at(timer, VALUE).write(ticks);
    Register::at(timer, CONTROL).write(0b1001);
}

/// Reads a counter proportional to the instructions executed.
pub fn count() -> u32 {
    // The counter counts down.
    !Register::at(DUAL_TIMER, 0x4).read()
}
