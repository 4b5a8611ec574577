//! Common parts of the three Cortex-M boards.

use core::ptr::{read_volatile, write_volatile};

use crate::chip::{ALARM_IRQ, ECHO_IRQ, SPARE_IRQ};

/// Gives the two interrupts of the board their handlers: `interrupts!(alarm, echo)`, both `fn()`.
#[macro_export]
macro_rules! interrupts {
    ($alarm:path, $echo:path) => {
        #[unsafe(no_mangle)]
        extern "C" fn ALARM() {
            $alarm();
        }
        #[unsafe(no_mangle)]
        extern "C" fn ECHO() {
            $echo();
        }
    };
}

/// An entry of the interrupt vector table.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) union Vector {
    handler: unsafe extern "C" fn(),
    reserved: usize,
}

unsafe extern "C" {
    fn DefaultHandler();
    fn ALARM();
    fn ECHO();
    fn SPARE();
}

/// The vectors of all interrupts up to the last one in use.
pub(crate) const fn vectors<const N: usize>() -> [Vector; N] {
    let mut vectors = [Vector { handler: DefaultHandler }; N];
    vectors[ALARM_IRQ as usize] = Vector { handler: ALARM };
    vectors[ECHO_IRQ as usize] = Vector { handler: ECHO };
    vectors[SPARE_IRQ as usize] = Vector { handler: SPARE };
    vectors
}

#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
static __INTERRUPTS: [Vector; crate::chip::VECTORS] = vectors();

/// A device register.
pub(crate) struct Register(pub(crate) *mut u32);

impl Register {
    /// Returns the register at this offset of a peripheral.
    pub(crate) const fn at(base: usize, offset: usize) -> Self {
        Self((base + offset) as *mut u32)
    }

    pub(crate) fn write(&self, value: u32) {
        // SAFETY: only the board modules make registers, from addresses in the data sheet.
        unsafe { write_volatile(self.0, value) }
    }

    pub(crate) fn read(&self) -> u32 {
        // SAFETY: as for `write`.
        unsafe { read_volatile(self.0) }
    }
}

const NVIC_SET_ENABLE: usize = 0xE000_E100;
const NVIC_SET_PENDING: usize = 0xE000_E200;

fn nvic(base: usize, irq: u16) {
    Register::at(base, 4 * usize::from(irq / 32)).write(1 << (irq % 32));
}

pub(crate) fn enable_interrupts() {
    nvic(NVIC_SET_ENABLE, ALARM_IRQ);
    nvic(NVIC_SET_ENABLE, ECHO_IRQ);
}

/// Raises the alarm's interrupt at once.
pub(crate) fn pend_alarm() {
    nvic(NVIC_SET_PENDING, ALARM_IRQ);
}

/// Raises the echo interrupt at once.
pub(crate) fn pend_echo() {
    nvic(NVIC_SET_PENDING, ECHO_IRQ);
}

/// Sleeps until the next interrupt, unless `awake` returns true. No interrupt can come between that call and the sleep:
/// it stays pending until the sleep instruction, which then returns at once.
pub fn sleep_unless(awake: impl FnOnce() -> bool) {
    cortex_m::interrupt::disable();
    if !awake() {
        cortex_m::asm::wfi();
    }
    // SAFETY: interrupts were on before.
    unsafe { cortex_m::interrupt::enable() };
}

/// Facts about a device that frameworks ask for.
pub mod device {
    use cortex_m::interrupt::InterruptNumber;

    use crate::chip::{ALARM_IRQ, ECHO_IRQ, SPARE_IRQ};

    /// Number of significant bits of an interrupt's priority.
    pub const NVIC_PRIO_BITS: u8 = crate::chip::NVIC_PRIO_BITS;

    /// The interrupts in use.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[allow(clippy::upper_case_acronyms)]
    #[repr(u16)]
    pub enum Interrupt {
        /// The alarm.
        ALARM = ALARM_IRQ,
        /// An edge on an echo line.
        ECHO = ECHO_IRQ,
        /// Not used by this crate; a framework may raise it.
        SPARE = SPARE_IRQ,
    }

    // SAFETY: these are the numbers of the interrupts in the vector table.
    unsafe impl InterruptNumber for Interrupt {
        fn number(self) -> u16 {
            self as u16
        }
    }

    /// The interrupts under the name that RTIC expects.
    pub use Interrupt as interrupt;
    /// The peripherals under the name that frameworks expect; no others exist to hand out.
    pub use cortex_m::Peripherals;
}
