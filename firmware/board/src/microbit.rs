//! BBC micro:bit: nRF51822, Cortex-M0. TIMER0 is clock and alarm, TIMER1 the echo lines, TIMER2 counts instructions.

use eeruf_core::{Instant, Micros};

use crate::cortex_m_common::{Register, enable_interrupts, pend_alarm, pend_echo};

/// The name of this board.
pub const NAME: &str = "microbit";
pub(crate) const ALARM_IRQ: u16 = 8;
pub(crate) const ECHO_IRQ: u16 = 9;
pub(crate) const SPARE_IRQ: u16 = 20;
pub(crate) const NVIC_PRIO_BITS: u8 = 2;
pub(crate) const VECTORS: usize = 32;
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`).
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 16_384;

const TIMER0: usize = 0x4000_8000;
const TIMER1: usize = 0x4000_9000;
const TIMER2: usize = 0x4000_A000;
const START: usize = 0x000;
const STOP: usize = 0x004;
const CLEAR: usize = 0x00C;
const CAPTURE_1: usize = 0x044;
const COMPARE_0: usize = 0x140;
const INTENSET: usize = 0x304;
const BITMODE: usize = 0x508;
const PRESCALER: usize = 0x510;
const CC_0: usize = 0x540;
const CC_1: usize = 0x544;

/// Starts clock and interrupts.
pub fn start() {
    // Both run at 16 MHz / 2^4.
    for timer in [TIMER0, TIMER1] {
        Register::at(timer, BITMODE).write(3);
        Register::at(timer, PRESCALER).write(4);
        Register::at(timer, INTENSET).write(1 << 16);
    }
    Register::at(TIMER0, START).write(1);
    Register::at(TIMER2, BITMODE).write(3);
    Register::at(TIMER2, PRESCALER).write(0);
    Register::at(TIMER2, START).write(1);
    enable_interrupts();
}

fn capture(timer: usize) -> u32 {
    // An interrupt between these two lines may capture again: the result is then a little later, never earlier.
    Register::at(timer, CAPTURE_1).write(1);
    Register::at(timer, CC_1).read()
}

/// Returns the time since the start.
pub(crate) fn running() -> Micros {
    Micros::new(capture(TIMER0))
}

/// Sets the alarm, replacing any other. If `at` has passed, it goes off at once.
pub fn set_alarm(at: Instant) {
    Register::at(TIMER0, CC_0).write(at.as_micros());
    // The compare register only fires when the counter reaches it.
    if crate::now().has_reached(at) {
        pend_alarm();
    }
}

/// Clears the alarm; its handler calls this.
pub fn clear_alarm() {
    Register::at(TIMER0, COMPARE_0).write(0);
}

/// Sets the instant of the next echo interrupt, replacing any other. If `at` has passed, it comes at once.
pub fn set_echo(at: Instant) {
    let now = crate::now();
    Register::at(TIMER1, STOP).write(1);
    Register::at(TIMER1, COMPARE_0).write(0);
    if now.has_reached(at) {
        pend_echo();
        return;
    }
    Register::at(TIMER1, CLEAR).write(1);
    Register::at(TIMER1, CC_0).write(at.since(now).as_micros());
    Register::at(TIMER1, START).write(1);
}

/// Clears the echo interrupt; its handler calls this.
pub fn clear_echo() {
    Register::at(TIMER1, STOP).write(1);
    Register::at(TIMER1, COMPARE_0).write(0);
}

/// Reads a counter proportional to the instructions executed.
pub fn count() -> u32 {
    capture(TIMER2)
}
