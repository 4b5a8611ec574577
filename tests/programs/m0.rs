//! The crate of `eeruf design --program rust` on an emulated Cortex-M0 whose modules each stand before a wall of their
//! own, with other work: the readings after the first of each, how many are accepted, how many of them wrong.
#![no_std]
#![no_main]

use NAME::eeruf_core::{Instant, Micros, ReadingKind, RingEvent};
use NAME::{EDGES, Pace, SENSORS, sonar};
use eeruf_board::fake_sensors::{self, Delay};
use eeruf_board::say;
use eeruf_board::say::leave;

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, echo_interrupt);

fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = fake_sensors::edge() {
        EDGES.push(edge);
    }
}

fn wait_until(end: Instant) {
    while !eeruf_board::now().has_reached(end) {}
}

const fn wall_us(sensor: u8) -> u32 {
    2000 + sensor as u32 * 618 % 1000 * SPAN
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    for sensor in 0..SENSORS {
        fake_sensors::put(sensor, Some(Micros::new(wall_us(sensor as u8))));
    }
    let now = eeruf_board::now();
    let (end, mut next) = (now + Micros::from_millis(20_000), now);
    let Ok(mut ring) = sonar(fake_sensors::pins(), Delay, 7, now) else { leave(2) };
    ring.moving(0, 0, now);
    let (mut pace, mut is_slow) = (Pace::new(now), false);
    let (mut begun, mut counts) = ([false; SENSORS], [[0_u32; 3]; SENSORS]);
    while !eeruf_board::now().has_reached(end) {
        while let Some(event) = ring.poll(eeruf_board::now()) {
            pace.observe(&event);
            let RingEvent::Reading(reading) = event else { continue };
            let sensor = usize::from(reading.sensor);
            if core::mem::replace(&mut begun[sensor], true) {
                let accepted = reading.kind == ReadingKind::Accepted;
                let t_echo = reading.t_echo.map_or(0, Micros::as_micros);
                // 5 cm.
                let wrong = accepted && t_echo.abs_diff(wall_us(reading.sensor)) > 300;
                for (count, one) in counts[sensor].iter_mut().zip([true, accepted, wrong]) {
                    *count += u32::from(one);
                }
            }
        }
        let now = eeruf_board::now();
        is_slow |= pace.too_slow(ring.ring(), now);
        if now.has_reached(next) {
            if MASKED {
                critical_section::with(|_| wait_until(now + Micros::new(WORK)));
            } else {
                wait_until(now + Micros::new(WORK));
            }
            next = now + Micros::new(EVERY);
        }
    }
    for [readings, accepted, wrong] in counts {
        say!(readings, " ", accepted, " ", wrong);
    }
    if is_slow {
        say!("too slow");
    }
    leave(0)
}
