//! The ring and its main loop.

use eeruf_board::fake_sensors::Delay;
use eeruf_board::say::leave;
use eeruf_core::{EdgeQueue, Instant, Micros, Ring, RingEvent, judge::Judge, plan::Plan};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings};
use eeruf_hil::{Record, SENSORS};

use crate::host::Host;
use crate::lines::{self, Pin};

/// Edges from the echo interrupt to the main loop.
static EDGES: EdgeQueue<32> = EdgeQueue::new();

pub(crate) fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = lines::edge() {
        EDGES.push(edge);
    }
}

/// Makes a ring and runs it for as many periods as the host orders. `on_event` is called with each event, the instant
/// of its poll, the health of the sensors, and the number of lost edges.
pub(crate) fn run<P: Plan, J: Judge, const H: usize, E>(
    make: impl FnOnce(Instant) -> Result<Ring<P, J, SENSORS, 1, H>, E>,
    mut on_event: impl FnMut(&RingEvent, Instant, &dyn Fn(u8) -> Health, u8),
) -> ! {
    let (host, orders) = Host::open();
    eeruf_board::begin_clock_at(orders.start);
    eeruf_board::start();
    let now = eeruf_board::now();
    lines::begin(now);
    host.say(Record::deadline(now));
    let Ok(ring) = make(now) else { leave(2) };
    let pin = |x| Pin { host: &host, sensor: x as u8 };
    let pins = core::array::from_fn(|x| Pins { trigger: pin(x), echo: pin(x) });
    let Ok(mut ring) = HcSr04Ring::new(ring, pins, Delay, Settings::default()) else { leave(3) };
    loop {
        loop {
            // Like a driver with a queue.
            let now = eeruf_board::now();
            while let Some(edge) = EDGES.pop() {
                host.say(Record::edge(edge));
                // The ring has all lines of this board.
                _ = ring.edge(edge);
            }
            host.say(Record::poll(now));
            let event = ring.poll(now);
            host.say(Record::event(event.as_ref()));
            if let Some(event) = &event {
                on_event(event, now, &|sensor| ring.health(sensor), EDGES.lost());
            }
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
        // If the alarm goes off before we sleep, it does not wake us.
        eeruf_board::sleep_unless(|| !EDGES.is_empty() || eeruf_board::now().has_reached(deadline));
    }
}

/// Delays the main loop, as other work might.
fn stall(time: Micros) {
    let end = eeruf_board::now() + time;
    while !eeruf_board::now().has_reached(end) {}
}
