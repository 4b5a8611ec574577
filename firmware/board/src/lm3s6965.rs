//! Stellaris LM3S6965 evaluation board: Cortex-M3. SysTick is the clock, GPTM 0 the alarm, GPTM 1 the echo lines.
//!
//! The general-purpose timers of the emulated chip cannot be read while they run, hence SysTick. It has 24 bits and
//! counts down, so the clock is put together from the differences of its readings; it must be read every 4 s.

use core::cell::Cell;

use critical_section::Mutex;
use eeruf_core::Instant;

use crate::cortex_m_common::{Register, enable_interrupts, pend_alarm, pend_echo};

/// The name of this board.
pub const NAME: &str = "lm3s6965";
pub(crate) const ALARM_IRQ: u16 = 19;
pub(crate) const ECHO_IRQ: u16 = 21;
pub(crate) const SPARE_IRQ: u16 = 5;
pub(crate) const NVIC_PRIO_BITS: u8 = 3;
pub(crate) const VECTORS: usize = 44;
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`).
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 4_096;

const RCC2: Register = Register::at(0x400F_E000, 0x070);
const SYSTICK_CONTROL: Register = Register::at(0xE000_E010, 0x0);
const SYSTICK_RELOAD: Register = Register::at(0xE000_E010, 0x4);
const SYSTICK_CURRENT: Register = Register::at(0xE000_E010, 0x8);
const GPTM0: usize = 0x4003_0000;
const GPTM1: usize = 0x4003_1000;
const CONFIG: usize = 0x000;
const MODE_A: usize = 0x004;
const CONTROL: usize = 0x00C;
const INTERRUPT_MASK: usize = 0x018;
const INTERRUPT_CLEAR: usize = 0x024;
const LOAD_A: usize = 0x028;

/// 200 MHz / 50.
const TICKS_PER_US: u32 = 4;

struct Clock {
    ticks: Cell<u32>,
    wraps: Cell<u32>,
}

/// SysTick at the last reading, and how often it had wrapped.
static CLOCK: Mutex<Clock> = Mutex::new(Clock { ticks: Cell::new(0), wraps: Cell::new(0) });

/// Starts clock and interrupts.
pub fn start() {
    RCC2.write(1 << 31 | (200 / TICKS_PER_US - 1) << 23);
    SYSTICK_RELOAD.write(0x00FF_FFFF);
    SYSTICK_CURRENT.write(0);
    SYSTICK_CONTROL.write(0b101);
    for timer in [GPTM0, GPTM1] {
        Register::at(timer, CONTROL).write(0);
        Register::at(timer, CONFIG).write(0);
        Register::at(timer, MODE_A).write(1);
        Register::at(timer, INTERRUPT_MASK).write(1);
    }
    enable_interrupts();
}

/// The clock.
pub fn now() -> Instant {
    critical_section::with(|token| {
        let clock = CLOCK.borrow(token);
        let ticks = count() & 0x00FF_FFFF;
        if ticks < clock.ticks.replace(ticks) {
            clock.wraps.set(clock.wraps.get().wrapping_add(1));
        }
        // 2^24 ticks are 2^22 us.
        Instant::from_micros(clock.wraps.get() << 22 | ticks / TICKS_PER_US)
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
    Register::at(timer, LOAD_A).write(at.since(now).as_micros().saturating_mul(TICKS_PER_US));
    Register::at(timer, CONTROL).write(1);
}

/// Sets the alarm, and forgets any other. If `at` has passed it goes off at once.
pub fn set_alarm(at: Instant) {
    one_shot(GPTM0, at, pend_alarm);
}

/// To be called by the alarm's handler.
pub fn clear_alarm() {
    Register::at(GPTM0, INTERRUPT_CLEAR).write(1);
}

/// Sets the instant of the next echo interrupt, and forgets any other. If `at` has passed it comes at once.
pub fn set_echo(at: Instant) {
    one_shot(GPTM1, at, pend_echo);
}

/// To be called by the echo interrupt's handler.
pub fn clear_echo() {
    Register::at(GPTM1, INTERRUPT_CLEAR).write(1);
}

/// A counter proportional to the instructions executed; it has 24 bits.
pub fn count() -> u32 {
    // SysTick counts down.
    0x00FF_FFFF_u32.wrapping_sub(SYSTICK_CURRENT.read())
}
