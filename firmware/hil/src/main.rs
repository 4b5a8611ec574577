//! A ring of eight HC-SR04 sensors whose surroundings are the simulator on the host, in lock step. The main loop is
//! that of any other ring, and also reports to the host everything that goes into the ring and everything that comes
//! out.
#![no_std]
#![no_main]

mod host;
mod lines;

use eeruf_board::fake_sensors::Delay;
use eeruf_board::say::leave;
use eeruf_core::{EdgeQueue, Micros, Ring, RingEvent};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use eeruf_hil::{CONFIG, Record, SCHEDULE};

use crate::host::Host;
use crate::lines::Pin;

eeruf_board::say_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, echo_interrupt);

/// From the echo interrupt to the main loop.
static EDGES: EdgeQueue<32> = EdgeQueue::new();

fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = lines::edge() {
        EDGES.push(edge);
    }
}

#[eeruf_board::entry]
fn main() -> ! {
    let (host, orders) = Host::open();
    eeruf_board::begin_clock_at(orders.start);
    eeruf_board::start();
    let now = eeruf_board::now();
    lines::begin(now);
    host.say(Record::deadline(now));
    let Ok(ring) = Ring::new(&SCHEDULE, CONFIG, now) else { leave(2) };
    let pin = |x| Pin { host: &host, sensor: x as u8 };
    let pins = core::array::from_fn(|x| Pins { trigger: pin(x), echo: pin(x) });
    let Ok(mut ring) = HcSr04Ring::new(ring, pins, Delay, Settings::default()) else { leave(3) };
    loop {
        loop {
            // As `HcSr04Ring::poll_with_edges` does.
            let now = eeruf_board::now();
            while let Some(edge) = EDGES.pop() {
                host.say(Record::edge(edge));
                // Of a line that the ring has, as all of this board are.
                _ = ring.edge(edge);
            }
            host.say(Record::poll(now));
            let event = ring.poll(now);
            host.say(Record::event(event.as_ref()));
            match event {
                None => break,
                Some(RingEvent::PeriodEnded(stats)) => {
                    host.say(Record::state(core::array::from_fn(|x| ring.health(x as u8)), EDGES.lost()));
                    if stats.period + 1 == orders.periods {
                        host.flush();
                        leave(0);
                    }
                    if stats.period == orders.stall_after {
                        stall(orders.stall);
                    }
                }
                Some(_) => {}
            }
        }
        let deadline = ring.next_deadline();
        host.say(Record::deadline(deadline));
        eeruf_board::set_alarm(deadline);
        // The alarm may have gone off before we sleep, and then wakes nobody.
        eeruf_board::sleep_unless(|| !EDGES.is_empty() || eeruf_board::now().has_reached(deadline));
    }
}

/// Delays the main loop, as other work in it might.
fn stall(time: Micros) {
    let end = eeruf_board::now() + time;
    while !eeruf_board::now().has_reached(end) {}
}
