//! Common parts of the Cortex-M3 and the Cortex-M4 board: SysTick is the clock, and two timers that run down are the
//! alarm and the echo lines.
//!
//! SysTick has 24 bits and counts down, so the clock sums the differences between its readings: it must be read at
//! least once before each wrap.

use core::cell::Cell;

use critical_section::Mutex;
use eeruf_core::{Instant, Micros};

use crate::chip::{
    ALARM_TIMER, CONTROL, ECHO_TIMER, INTERRUPT_CLEAR, SYSTICK_LOG2_TICKS_PER_US, SYSTICK_SOURCE, TIMER_TICKS_PER_US,
    run_down,
};
use crate::cortex_m_common::{Register, pend_alarm, pend_echo};

const SYSTICK_CONTROL: Register = Register::at(0xE000_E010, 0x0);
const SYSTICK_RELOAD: Register = Register::at(0xE000_E010, 0x4);
const SYSTICK_CURRENT: Register = Register::at(0xE000_E010, 0x8);

struct Clock {
    ticks: Cell<u32>,
    wraps: Cell<u32>,
}

/// SysTick at the last reading, and its number of wraps.
static CLOCK: Mutex<Clock> = Mutex::new(Clock { ticks: Cell::new(0), wraps: Cell::new(0) });

pub(crate) fn start() {
    SYSTICK_RELOAD.write(0x00FF_FFFF);
    SYSTICK_CURRENT.write(0);
    SYSTICK_CONTROL.write(SYSTICK_SOURCE | 1);
}

pub(crate) fn ticks() -> u32 {
    0x00FF_FFFF_u32.wrapping_sub(SYSTICK_CURRENT.read()) & 0x00FF_FFFF
}

/// Returns the time since the start.
pub(crate) fn running() -> Micros {
    critical_section::with(|token| {
        let clock = CLOCK.borrow(token);
        let ticks = ticks();
        if ticks < clock.ticks.replace(ticks) {
            clock.wraps.set(clock.wraps.get().wrapping_add(1));
        }
        Micros::new(clock.wraps.get() << (24 - SYSTICK_LOG2_TICKS_PER_US) | ticks >> SYSTICK_LOG2_TICKS_PER_US)
    })
}

fn one_shot(timer: usize, at: Instant, pend: fn()) {
    let now = crate::now();
    Register::at(timer, CONTROL).write(0);
    Register::at(timer, INTERRUPT_CLEAR).write(1);
    if now.has_reached(at) {
        pend();
        return;
    }
    run_down(timer, at.since(now).as_micros().saturating_mul(TIMER_TICKS_PER_US));
}

/// Sets the alarm, replacing any other. If `at` has passed, it goes off at once.
pub fn set_alarm(at: Instant) {
    one_shot(ALARM_TIMER, at, pend_alarm);
}

/// Clears the alarm; its handler calls this.
pub fn clear_alarm() {
    Register::at(ALARM_TIMER, INTERRUPT_CLEAR).write(1);
}

/// Sets the instant of the next echo interrupt, replacing any other. If `at` has passed, it comes at once.
pub fn set_echo(at: Instant) {
    one_shot(ECHO_TIMER, at, pend_echo);
}

/// Clears the echo interrupt; its handler calls this.
pub fn clear_echo() {
    Register::at(ECHO_TIMER, INTERRUPT_CLEAR).write(1);
}
