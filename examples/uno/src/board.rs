//! Support for the ring on an ATmega328P at 16 MHz: pins, a clock in microseconds, a serial line, and its interrupts.
//! The registers stand where the data sheet puts them ("Register Summary"), as addresses in memory.

use core::cell::Cell;
use core::convert::Infallible;
use core::ptr::{read_volatile, write_volatile};
use core::sync::atomic::{Ordering, compiler_fence};

use eeruf_core::{Edge, EdgeQueue, Instant};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// An 8-bit register.
#[derive(Clone, Copy)]
struct Register(u16);

impl Register {
    fn read(self) -> u8 {
        // SAFETY: all registers of this file may be read at any time.
        unsafe { read_volatile(usize::from(self.0) as *const u8) }
    }

    fn write(self, value: u8) {
        // SAFETY: no register of this file moves memory under the program.
        unsafe { write_volatile(usize::from(self.0) as *mut u8, value) }
    }

    fn set(self, bits: u8, high: bool) {
        let value = self.read();
        self.write(if high { value | bits } else { value & !bits });
    }
}

/// A port: its registers for input, direction and output follow one another.
#[derive(Clone, Copy)]
struct Port(u16);

impl Port {
    const B: Self = Self(0x23);
    const C: Self = Self(0x26);
    const D: Self = Self(0x29);

    fn pins(self) -> Register {
        Register(self.0)
    }

    fn directions(self) -> Register {
        Register(self.0 + 1)
    }

    fn outputs(self) -> Register {
        Register(self.0 + 2)
    }
}

const TIFR1: Register = Register(0x36);
const SREG: Register = Register(0x5f);
const PCICR: Register = Register(0x68);
const PCMSK0: Register = Register(0x6b);
const PCMSK1: Register = Register(0x6c);
const TIMSK1: Register = Register(0x6f);
const TCCR1B: Register = Register(0x81);
const TCNT1L: Register = Register(0x84);
const TCNT1H: Register = Register(0x85);
const UCSR0A: Register = Register(0xc0);
const UCSR0B: Register = Register(0xc1);
const UBRR0L: Register = Register(0xc4);
const UDR0: Register = Register(0xc6);

/// The bit in `SREG` that enables interrupts.
const INTERRUPTS: u8 = 0x80;
/// The bit in `TIFR1` and in `TIMSK1` for an overflow of the timer.
const WRAPPED: u8 = 1;
/// The bit in `UCSR0A` that says `UDR0` can take a byte.
const SENT: u8 = 0x20;

/// Number of overflows of the timer, which counts half microseconds in 16 bits.
struct Wraps(Cell<u32>);

// SAFETY: there is one core, and the value is touched with interrupts off.
unsafe impl Sync for Wraps {}

static WRAPS: Wraps = Wraps(Cell::new(0));

/// Edges from the interrupts to the main loop.
pub(crate) static EDGES: EdgeQueue<16> = EdgeQueue::new();

/// The levels of the echo lines at the last interrupt, on port B and on port C.
struct Levels([Cell<u8>; 2]);

// SAFETY: only the two interrupts of the ports touch it, and neither interrupts the other.
unsafe impl Sync for Levels {}

static LEVELS: Levels = Levels([Cell::new(0), Cell::new(0)]);

/// Echoes 1 to 4 are on B2 to B5 (pins 10 to 13), 5 to 8 on C0 to C3 (A0 to A3).
const ECHOES_B: u8 = 0b11_1100;
const ECHOES_C: u8 = 0b00_1111;

/// Sets up pins, timer and serial line, then enables interrupts.
pub(crate) fn start() {
    Port::D.directions().set(0b1111_1100, true);
    Port::B.directions().set(0b0000_0011, true);
    PCMSK0.write(ECHOES_B);
    PCMSK1.write(ECHOES_C);
    PCICR.write(0b011);
    // 16 MHz by 8.
    TCCR1B.write(0b010);
    TIMSK1.write(WRAPPED);
    // 115,200 baud at double speed, 8 bits, no parity.
    UCSR0A.write(0b10);
    UBRR0L.write(16);
    UCSR0B.write(0b1000);
    SREG.set(INTERRUPTS, true);
}

/// Reads the clock.
pub(crate) fn now() -> Instant {
    let before = SREG.read();
    SREG.write(before & !INTERRUPTS);
    compiler_fence(Ordering::SeqCst);
    let time = stamp();
    compiler_fence(Ordering::SeqCst);
    SREG.write(before);
    time
}

/// Reads the clock with interrupts disabled.
fn stamp() -> Instant {
    // Reading the lower half keeps the upper one.
    let low = TCNT1L.read();
    let count = u16::from_le_bytes([low, TCNT1H.read()]);
    // A wrap whose interrupt has not been served, unless it came after the timer was read.
    let unserved = TIFR1.read() & WRAPPED != 0 && count < 0x8000;
    let wraps = WRAPS.0.get().wrapping_add(u32::from(unserved));
    Instant::from_micros(wraps << 15 | u32::from(count >> 1))
}

/// Queues an edge for each line of a port whose level has changed; the first line is this sensor's.
fn edges(port: Port, lines: u8, levels: &Cell<u8>, first: u8) {
    let at = stamp();
    let now = port.pins().read() & lines;
    let mut changed = now ^ levels.replace(now);
    let (mut line, mut sensor) = (lines & lines.wrapping_neg(), first);
    while changed != 0 {
        if changed & line != 0 {
            EDGES.push(Edge { sensor, high: now & line != 0, at });
            changed &= !line;
        }
        line <<= 1;
        sensor += 1;
    }
}

/// Handles an edge on port B.
#[unsafe(no_mangle)]
extern "avr-interrupt" fn __vector_3() {
    edges(Port::B, ECHOES_B, &LEVELS.0[0], 0);
}

/// Handles an edge on port C.
#[unsafe(no_mangle)]
extern "avr-interrupt" fn __vector_4() {
    edges(Port::C, ECHOES_C, &LEVELS.0[1], 4);
}

/// Handles an overflow of the timer.
#[unsafe(no_mangle)]
extern "avr-interrupt" fn __vector_13() {
    WRAPS.0.set(WRAPS.0.get().wrapping_add(1));
}

/// Sends a byte, if the line is free.
pub(crate) fn send(byte: u8) -> bool {
    let free = UCSR0A.read() & SENT != 0;
    if free {
        UDR0.write(byte);
    }
    free
}

/// A pin of a port.
pub(crate) struct Pin {
    port: Port,
    bit: u8,
}

impl Pin {
    /// Returns the trigger pin of a sensor: pins 2 to 9.
    pub(crate) const fn trigger(sensor: u8) -> Self {
        if sensor < 6 {
            Self { port: Port::D, bit: 4 << sensor }
        } else {
            Self { port: Port::B, bit: 1 << (sensor - 6) }
        }
    }

    /// Returns the echo line of a sensor.
    pub(crate) const fn echo(sensor: u8) -> Self {
        if sensor < 4 {
            Self { port: Port::B, bit: 4 << sensor }
        } else {
            Self { port: Port::C, bit: 1 << (sensor - 4) }
        }
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.port.outputs().set(self.bit, false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.port.outputs().set(self.bit, true);
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.port.pins().read() & self.bit != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// A delay that waits by the clock.
pub(crate) struct Wait;

impl DelayNs for Wait {
    fn delay_ns(&mut self, ns: u32) {
        self.delay_us(ns.div_ceil(1000));
    }

    fn delay_us(&mut self, us: u32) {
        let begin = now();
        // The first microsecond may be a part of one.
        while now().since(begin).as_micros() <= us {}
    }
}

/// Proof that the program cannot panic: the function does not exist, so it links only if the optimiser has left no
/// path to a panic.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        fn a_path_to_a_panic_is_left_in_this_image() -> !;
    }
    // SAFETY: never executed; an image that could execute it does not link.
    unsafe { a_path_to_a_panic_is_left_in_this_image() }
}
