//! ARM MPS2 with the AN386 image: Cortex-M4F. SysTick at 1 MHz is the clock, CMSDK timer 0 the alarm, timer 1 the echo
//! lines, and one of the dual timers counts instructions.

use core::cell::Cell;

use critical_section::Mutex;
use eeruf_core::Instant;

use crate::cortex_m_common::{Register, enable_interrupts, pend_alarm, pend_echo};

/// The name of this board.
pub const NAME: &str = "an386";
pub(crate) const ALARM_IRQ: u16 = 8;
pub(crate) const ECHO_IRQ: u16 = 9;
pub(crate) const SPARE_IRQ: u16 = 20;
pub(crate) const NVIC_PRIO_BITS: u8 = 3;
pub(crate) const VECTORS: usize = 32;
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`).
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 25_600;

const SYSTICK_CONTROL: Register = Register::at(0xE000_E010, 0x0);
const SYSTICK_RELOAD: Register = Register::at(0xE000_E010, 0x4);
const SYSTICK_CURRENT: Register = Register::at(0xE000_E010, 0x8);
const TIMER0: usize = 0x4000_0000;
const TIMER1: usize = 0x4000_1000;
const DUAL_TIMER: usize = 0x4000_2000;
const CONTROL: usize = 0x0;
const VALUE: usize = 0x4;
const RELOAD: usize = 0x8;
const INTERRUPT_CLEAR: usize = 0xC;
const TICKS_PER_US: u32 = 25;

struct Clock {
    ticks: Cell<u32>,
    wraps: Cell<u32>,
}

/// SysTick at the last reading, and how often it had wrapped: it has 24 bits and must be read every 16 s.
static CLOCK: Mutex<Clock> = Mutex::new(Clock { ticks: Cell::new(0), wraps: Cell::new(0) });

/// Starts clock and interrupts.
pub fn start() {
    SYSTICK_RELOAD.write(0x00FF_FFFF);
    SYSTICK_CURRENT.write(0);
    // From the 1 MHz reference clock.
    SYSTICK_CONTROL.write(0b001);
    // Free-running, 32 bits, undivided.
    Register::at(DUAL_TIMER, 0x8).write(0b1000_0010);
    enable_interrupts();
}

/// The clock.
pub fn now() -> Instant {
    critical_section::with(|token| {
        let clock = CLOCK.borrow(token);
        // SysTick counts down.
        let ticks = 0x00FF_FFFF_u32.wrapping_sub(SYSTICK_CURRENT.read()) & 0x00FF_FFFF;
        if ticks < clock.ticks.replace(ticks) {
            clock.wraps.set(clock.wraps.get().wrapping_add(1));
        }
        Instant::from_micros(clock.wraps.get() << 24 | ticks)
    })
}

fn one_shot(timer: usize, at: Instant, pend: fn()) {
    let now = now();
    Register::at(timer, CONTROL).write(0);
    Register::at(timer, INTERRUPT_CLEAR).write(1);
    if now.has_reached(at) {
        pend();
        return;
    }
    // Without a reload value the timer stops when it has run down.
    Register::at(timer, RELOAD).write(0);
    Register::at(timer, VALUE).write(at.since(now).as_micros().saturating_mul(TICKS_PER_US));
    Register::at(timer, CONTROL).write(0b1001);
}

/// Sets the alarm, and forgets any other. If `at` has passed it goes off at once.
pub fn set_alarm(at: Instant) {
    one_shot(TIMER0, at, pend_alarm);
}

/// To be called by the alarm's handler.
pub fn clear_alarm() {
    Register::at(TIMER0, INTERRUPT_CLEAR).write(1);
}

/// Sets the instant of the next echo interrupt, and forgets any other. If `at` has passed it comes at once.
pub fn set_echo(at: Instant) {
    one_shot(TIMER1, at, pend_echo);
}

/// To be called by the echo interrupt's handler.
pub fn clear_echo() {
    Register::at(TIMER1, INTERRUPT_CLEAR).write(1);
}

/// A counter proportional to the instructions executed.
pub fn count() -> u32 {
    // It counts down.
    !Register::at(DUAL_TIMER, 0x4).read()
}
