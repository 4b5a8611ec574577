//! Instructions of each call of a hopping ring of twelve sensors, the fewest and the most over 400 periods in which
//! sensors hear their own echoes, crosstalk, noise and nothing, so that there are solo periods and new lags. To be run
//! with `-icount shift=10`, as `instructions`. In the second half of the periods its robot moves to and fro.
//!
//! Prints one line per kind of call: name, fewest, most. Call and return count; reading the timer does not.
//! `reading_moving` is one of the second half; `period_ended` plans the next period; `new_lags` does where lags change.
#![no_std]
#![no_main]

use core::hint::black_box;

use eeruf_board::say::leave;
use eeruf_core::{Instant, Micros, RingEvent, SensorError, hopping::HoppingRing};
use eeruf_measure::{HOPPING_12, Range, counts, hopping};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[inline(never)]
fn poll(ring: &mut HoppingRing<12>, now: Instant, change_us: &[i32; 12]) -> Option<RingEvent> {
    ring.poll_expecting(now, |sensor| change_us.get(usize::from(sensor)).copied().unwrap_or(0))
}

#[inline(never)]
fn echo(ring: &mut HoppingRing<12>, sensor: u8, at: Instant) -> Result<(), SensorError> {
    ring.echo(sensor, at)
}

/// After how long a sensor hears something, if it does: of 12, four always see a wall, four are fooled in every second
/// period, three hear noise, and one hears nothing.
fn t_echo(sensor: u8, period: u32, noise: u32) -> Option<u32> {
    match sensor {
        0..4 => Some(9_000 + 1_000 * u32::from(sensor)),
        4..8 if period & 1 == 0 => Some(4_000 + 300 * (period % 13)),
        4..8 => Some(14_000),
        8..11 => Some(3_000 + noise % 30_000),
        _ => None,
    }
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let Ok(mut ring) = hopping(&HOPPING_12, Instant::from_micros(0)) else { leave(2) };
    // Whatever the compiler knows of where it lies would count as part of the calls.
    let ring = black_box(&mut ring);
    let mut idle = Range::new("idle_poll");
    let mut fire = Range::new("fire");
    let mut heard = Range::new("echo");
    let mut reading = Range::new("reading");
    let mut reading_moving = Range::new("reading_moving");
    let mut ended = Range::new("period_ended");
    let mut new_lags = Range::new("new_lags");
    let (mut periods, mut noise) = (0, 1_u32);
    while periods < 400 {
        let now = black_box(ring.next_deadline());
        let moves = periods >= 200;
        let change_us = if periods & 1 == 0 { 100 } else { -100 };
        let change_us = black_box([if moves { change_us } else { 0 }; 12]);
        loop {
            let lags: [Option<Micros>; 12] = core::array::from_fn(|sensor| ring.plan().t_lag(sensor));
            let (taken, event) = counts(|| poll(ring, now, &change_us));
            match event {
                None => {
                    idle.note(taken);
                    break;
                }
                Some(RingEvent::Fire { sensor, .. }) => {
                    fire.note(taken);
                    noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    if let Some(t_echo) = t_echo(sensor, periods, noise >> 8) {
                        let at = now + Micros::new(black_box(t_echo));
                        let (taken, known) = counts(|| echo(ring, sensor, at));
                        if known.is_err() {
                            leave(4);
                        }
                        heard.note(taken);
                    }
                }
                Some(RingEvent::Reading(_)) => if moves { &mut reading_moving } else { &mut reading }.note(taken),
                Some(RingEvent::PeriodEnded(_)) => {
                    let changed = (0..12).any(|sensor| lags.get(sensor) != Some(&ring.plan().t_lag(sensor)));
                    if changed { &mut new_lags } else { &mut ended }.note(taken);
                    periods += 1;
                }
            }
        }
    }
    for range in [&idle, &fire, &heard, &reading, &reading_moving, &ended, &new_lags] {
        range.say();
    }
    leave(0)
}
