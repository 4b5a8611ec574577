//! Stellaris LM3S6965 evaluation board: Cortex-M3. SysTick is the clock, GPTM 0 the alarm, GPTM 1 the echo lines.
//!
//! The general-purpose timers of the emulated chip cannot be read while they run, hence SysTick, which runs at 4 MHz
//! and must be read every 4 s.

use crate::cortex_m_common::{Register, enable_interrupts};
use crate::systick_clock;

/// The name of this board.
pub const NAME: &str = "lm3s6965";
pub(crate) const ALARM_IRQ: u16 = 19;
pub(crate) const ECHO_IRQ: u16 = 21;
pub(crate) const SPARE_IRQ: u16 = 5;
pub(crate) const NVIC_PRIO_BITS: u8 = 3;
pub(crate) const VECTORS: usize = 44;
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`).
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 4_096;

pub(crate) const ALARM_TIMER: usize = 0x4003_0000;
pub(crate) const ECHO_TIMER: usize = 0x4003_1000;
pub(crate) const CONTROL: usize = 0x00C;
pub(crate) const INTERRUPT_CLEAR: usize = 0x024;
/// Ticks per microsecond of timers and SysTick: 200 MHz / 50.
pub(crate) const TIMER_TICKS_PER_US: u32 = 4;
pub(crate) const SYSTICK_LOG2_TICKS_PER_US: u32 = 2;
/// The core's clock.
pub(crate) const SYSTICK_SOURCE: u32 = 0b100;

const RCC2: Register = Register::at(0x400F_E000, 0x070);
const CONFIG: usize = 0x000;
const MODE_A: usize = 0x004;
const INTERRUPT_MASK: usize = 0x018;
const LOAD_A: usize = 0x028;

/// Starts clock and interrupts.
pub fn start() {
    RCC2.write(1 << 31 | (200 / TIMER_TICKS_PER_US - 1) << 23);
    systick_clock::start();
    for timer in [ALARM_TIMER, ECHO_TIMER] {
        Register::at(timer, CONTROL).write(0);
        Register::at(timer, CONFIG).write(0);
        Register::at(timer, MODE_A).write(1);
        Register::at(timer, INTERRUPT_MASK).write(1);
    }
    enable_interrupts();
}

/// Lets a stopped timer run down once.
pub(crate) fn run_down(timer: usize, ticks: u32) {
    Register::at(timer, LOAD_A).write(ticks);
    Register::at(timer, CONTROL).write(1);
}

/// Reads a counter of 24 bits proportional to the instructions executed.
pub fn count() -> u32 {
    systick_clock::ticks()
}
