//! Counts the instructions of each call of a ring of twelve sensors: the fewest and the most over forty periods on time
//! and forty in which every firing is late. Run it with `-icount shift=10`: every instruction then takes 1024 ns, and a
//! hardware timer counts instructions.
//!
//! Prints one line per kind of call: name, fewest, most. Calls and returns count; reading the timer does not.
#![no_std]
#![no_main]

use core::hint::black_box;

use eeruf_board::say::leave;
use eeruf_core::tables::PAPER_12;
use eeruf_core::{Edge, EdgeQueue, Instant, Micros, ReadingKind, Ring, RingEvent, ScheduledRing, SensorError};
use eeruf_measure::{CONFIG, Range, counts};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

static EDGES: EdgeQueue<32> = EdgeQueue::new();

#[inline(never)]
fn poll(ring: &mut ScheduledRing<'static, 12>, now: Instant) -> Option<RingEvent> {
    ring.poll(now)
}

#[inline(never)]
fn echo(ring: &mut ScheduledRing<'static, 12>, sensor: u8, at: Instant) -> Result<(), SensorError> {
    ring.echo(sensor, at)
}

/// Stamps and stores an edge, as in the interrupt.
#[inline(never)]
fn stamp(sensor: u8, at: Instant) {
    EDGES.push(Edge { sensor, high: true, at });
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let start = Instant::from_micros(0);
    let Ok(mut ring) = Ring::new(&PAPER_12, CONFIG, start) else { leave(2) };
    // Else the compiler's knowledge of its address would change the calls.
    let ring = black_box(&mut ring);
    let mut idle = Range::new("idle_poll");
    let mut fire = Range::new("fire");
    let mut heard = Range::new("echo");
    let mut stamped = Range::new("stamp");
    let mut reading = Range::new("reading");
    let mut ended = Range::new("period_ended");
    // From period 40 on every firing is late, each by a different time.
    let mut fire_late = Range::new("fire_late");
    let mut reading_late = Range::new("reading_late");
    let mut ended_late = Range::new("period_ended_late");

    let mut periods = 0;
    while periods < 80 {
        let on_time = periods < 40;
        let late = if on_time { 0 } else { 20 + 37 * periods % 100 };
        let now = black_box(ring.next_deadline() + Micros::new(late));
        loop {
            let (taken, event) = counts(|| poll(ring, now));
            match event {
                None => {
                    idle.note(taken);
                    break;
                }
                Some(RingEvent::Fire { sensor, .. }) => {
                    if on_time { &mut fire } else { &mut fire_late }.note(taken);
                    // Every kind of reading: near and far, moving, and none at all.
                    let t_echo = match (sensor, periods % 4) {
                        (0, _) | (2, 1) => None,
                        (1, phase) => Some(5_000 + 3_000 * phase),
                        _ => Some(4_000 + 2_500 * u32::from(sensor)),
                    };
                    if let Some(t_echo) = t_echo {
                        let at = now + Micros::new(black_box(t_echo));
                        let (taken, known) = counts(|| echo(ring, sensor, at));
                        if known.is_err() {
                            leave(4);
                        }
                        heard.note(taken);
                        stamped.note(counts(|| stamp(sensor, at)).0);
                        EDGES.pop();
                    }
                }
                Some(RingEvent::Reading(emitted)) => {
                    if on_time { &mut reading } else { &mut reading_late }.note(taken);
                    if emitted.kind == ReadingKind::Stuck {
                        leave(3);
                    }
                }
                Some(RingEvent::PeriodEnded(_)) => {
                    if on_time { &mut ended } else { &mut ended_late }.note(taken);
                    periods += 1;
                }
            }
        }
    }
    for range in [&idle, &fire, &fire_late, &heard, &stamped, &reading, &reading_late, &ended, &ended_late] {
        range.say();
    }
    leave(0)
}
