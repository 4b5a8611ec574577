//! Eight HC-SR04 modules on an Arduino Uno. Interrupts stamp the edges of the echo lines with the time; the main loop
//! fires, listens, and says over the serial line what was accepted.
#![no_std]
#![no_main]
#![feature(abi_avr_interrupt)]

mod board;
mod ring;

use board::{EDGES, Pin, Wait, now, send};
use eeruf_core::plan::ScheduledFiring;
use eeruf_core::{Micros, ReadingKind, Ring, RingConfig, RingEvent, SpeedOfSound};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use ring::RING;

/// Speed of sound in air at 20 degrees Celsius.
const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);

const PINS: [Pins<Pin, Pin>; 8] = {
    const fn pins(sensor: u8) -> Pins<Pin, Pin> {
        Pins { trigger: Pin::trigger(sensor), echo: Pin::echo(sensor) }
    }
    [pins(0), pins(1), pins(2), pins(3), pins(4), pins(5), pins(6), pins(7)]
};

/// Bytes still to be sent.
struct Outbox {
    bytes: [u8; Self::SIZE],
    /// Number of bytes ever queued, and number sent; both wrap.
    put: u8,
    sent: u8,
}

impl Outbox {
    /// A power of two, so that a mask keeps every index in range.
    const SIZE: usize = 16;
    /// The longest line, `8 99999`, with its end.
    const LINE: u8 = 8;
    const EMPTY: Self = Self { bytes: [0; Self::SIZE], put: 0, sent: 0 };

    /// Queues sensor and distance, as `3 1234`. Text that does not fit, on a line that is too slow, is dropped.
    fn say(&mut self, sensor: u8, mm: u32) {
        if Self::SIZE as u8 - self.put.wrapping_sub(self.sent) < Self::LINE {
            return;
        }
        self.push(b'1' + sensor);
        self.push(b' ');
        let (mm, mut power) = (mm.min(99_999), 10_000);
        while power > mm && power > 1 {
            power /= 10;
        }
        while power > 0 {
            self.push(b'0' + (mm / power % 10) as u8);
            power /= 10;
        }
        self.push(b'\n');
    }

    fn push(&mut self, byte: u8) {
        self.bytes[usize::from(self.put) % Self::SIZE] = byte;
        self.put = self.put.wrapping_add(1);
    }

    /// Sends a byte, if there is one and the line is free.
    fn go_on(&mut self) {
        if self.put != self.sent && send(self.bytes[usize::from(self.sent) % Self::SIZE]) {
            self.sent = self.sent.wrapping_add(1);
        }
    }
}

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    board::start();
    let mut outbox = Outbox::EMPTY;
    let config = RingConfig::new().with_window(Micros::from_millis(40));
    // Three firings of each sensor are remembered instead of four, for want of memory.
    let plan = ScheduledFiring::verified(&RING, now());
    let ring = Ring::<_, _, 8, 1, 3>::remembering(plan, config, now()).map_err(Into::into);
    // It stays where it was made: moved out of the result it would be on the stack twice.
    let mut made = ring.and_then(|ring| HcSr04Ring::with_edges(ring, PINS, Wait, Settings::default(), &EDGES));
    let Ok(ring) = &mut made else {
        // The table was verified for such a window, and lets modules rest; change it, and it may be this.
        outbox.say(0, 99_999);
        loop {
            outbox.go_on();
        }
    };
    loop {
        while let Some(event) = ring.poll(now()) {
            if let RingEvent::Reading(reading) = event
                && reading.kind == ReadingKind::Accepted
                && let Some(t_echo) = reading.t_echo
            {
                outbox.say(reading.sensor, SOUND.distance_mm(t_echo));
            }
        }
        outbox.go_on();
    }
}
