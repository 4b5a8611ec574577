//! QEMU's RISC-V `virt` machine, RV32IMAC. There is one timer with one compare register, which serves both alarm and
//! echo lines: it is set to the earlier of the two, and its handler determines which of them is due.

use core::cell::Cell;
use core::ptr::{read_volatile, write_volatile};

use critical_section::Mutex;
use eeruf_core::{Instant, Micros};

/// The name of this board.
pub const NAME: &str = "rv_virt";
/// [`count`] advances by this many thousandths per instruction when an instruction takes 1024 ns (`-icount shift=10`):
/// the emulated counter of instructions counts nanoseconds.
pub const COUNTS_PER_1000_INSTRUCTIONS: u32 = 1_024_000;

const TIME_COMPARE: *mut u32 = 0x0200_4000 as *mut u32;
const TIME: *const u32 = 0x0200_BFF8 as *const u32;
const TICKS_PER_US: u64 = 10;

struct Timers {
    alarm: Cell<Option<Instant>>,
    echo: Cell<Option<Instant>>,
}

static TIMERS: Mutex<Timers> = Mutex::new(Timers { alarm: Cell::new(None), echo: Cell::new(None) });

/// Gives the two interrupts of the board their handlers: `interrupts!(alarm, echo)`, both `fn()`.
#[macro_export]
macro_rules! interrupts {
    ($alarm:path, $echo:path) => {
        #[unsafe(no_mangle)]
        extern "C" fn MachineTimer() {
            let (alarm, echo) = $crate::due();
            if echo {
                $echo();
            }
            if alarm {
                $alarm();
            }
        }
    };
}

/// Starts clock and interrupts.
pub fn start() {
    critical_section::with(|token| TIMERS.borrow(token).set());
    // SAFETY: the handlers may run from here on.
    unsafe {
        riscv::register::mie::set_mtimer();
        riscv::interrupt::enable();
    }
}

fn ticks() -> u64 {
    // SAFETY: the address of the timer in this machine. The high word is read again in case the low one has wrapped.
    unsafe {
        loop {
            let high = read_volatile(TIME.add(1));
            let low = read_volatile(TIME);
            if read_volatile(TIME.add(1)) == high {
                return u64::from(high) << 32 | u64::from(low);
            }
        }
    }
}

/// Returns the time since the start.
pub(crate) fn running() -> Micros {
    Micros::new((ticks() / TICKS_PER_US) as u32)
}

impl Timers {
    fn set(&self) {
        let (ticks, now) = (ticks(), crate::now());
        let mut compare = u64::MAX;
        for at in [self.alarm.get(), self.echo.get()].into_iter().flatten() {
            let wait = if now.has_reached(at) { 0 } else { at.since(now).as_micros() };
            // Counted from the beginning of this microsecond.
            compare = compare.min(ticks - ticks % TICKS_PER_US + u64::from(wait) * TICKS_PER_US);
        }
        // SAFETY: the address of the compare register. While it is written its value is never too early.
        unsafe {
            write_volatile(TIME_COMPARE.add(1), u32::MAX);
            write_volatile(TIME_COMPARE, compare as u32);
            write_volatile(TIME_COMPARE.add(1), (compare >> 32) as u32);
        }
    }
}

/// Returns, for the handler, whether the alarm and the echo interrupt are due.
pub fn due() -> (bool, bool) {
    critical_section::with(|token| {
        let timers = TIMERS.borrow(token);
        let now = crate::now();
        let has_come = |timer: &Cell<Option<Instant>>| {
            let come = timer.get().is_some_and(|at| now.has_reached(at));
            if come {
                timer.set(None);
            }
            come
        };
        let due = (has_come(&timers.alarm), has_come(&timers.echo));
        timers.set();
        due
    })
}

/// Sets the alarm, replacing any other. If `at` has passed, it goes off at once.
pub fn set_alarm(at: Instant) {
    critical_section::with(|token| {
        let timers = TIMERS.borrow(token);
        timers.alarm.set(Some(at));
        timers.set();
    });
}

/// Clears the alarm for its handler; on this board [`due`] has already done so.
pub fn clear_alarm() {}

/// Sets the instant of the next echo interrupt, replacing any other. If `at` has passed, it comes at once.
pub fn set_echo(at: Instant) {
    critical_section::with(|token| {
        let timers = TIMERS.borrow(token);
        timers.echo.set(Some(at));
        timers.set();
    });
}

/// Clears the echo interrupt for its handler; on this board [`due`] has already done so.
pub fn clear_echo() {}

/// Reads the number of instructions executed.
pub fn count() -> u32 {
    riscv::register::minstret::read() as u32
}

/// Sleeps until the next interrupt, unless `awake` returns true. No interrupt can come between that call and the sleep:
/// it stays pending until the sleep instruction, which then returns at once.
pub fn sleep_unless(awake: impl FnOnce() -> bool) {
    riscv::interrupt::disable();
    if !awake() {
        riscv::asm::wfi();
    }
    // SAFETY: interrupts were on before.
    unsafe { riscv::interrupt::enable() };
}
