//! A ring of twelve HC-SR04 sensors on bare metal. The echo interrupt only stamps edges; the main loop is in the
//! library.
#![no_std]
#![no_main]

use eeruf_board::fake_sensors::{self, Delay};
use eeruf_board::say;
use eeruf_board::say::leave;
use eeruf_core::tables::PAPER_12;
use eeruf_core::{EdgeQueue, Micros, ReadingKind, Ring, RingConfig, RingEvent, Tally};
use eeruf_hc_sr04::{HcSr04Ring, Health, Settings};
use eeruf_ring::run;

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, echo_interrupt);

/// Edges from the echo interrupt to the main loop.
static EDGES: EdgeQueue<32> = EdgeQueue::new();

fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = fake_sensors::edge() {
        EDGES.push(edge);
    }
}

const PERIODS: u32 = 100;

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    for sensor in 0..12 {
        // Walls are 0.9 m to 2.8 m away; sensor 6 is missing.
        fake_sensors::put(sensor, (sensor != 5).then_some(Micros::new(5_000 + 1_000 * sensor as u32)));
    }
    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let Ok(ring) = Ring::new(&PAPER_12, config, eeruf_board::now()) else { leave(2) };
    let settings = Settings::default();
    let Ok(ring) = HcSr04Ring::with_edges(ring, fake_sensors::pins(), Delay, settings, &EDGES) else { leave(3) };

    let mut readings = Tally::<u32>::default();
    let mut max_late = Micros::ZERO;
    run(ring, &EDGES, |ring, event| match event {
        RingEvent::Fire { .. } => {}
        RingEvent::Reading(reading) => readings.count(reading.kind),
        RingEvent::PeriodEnded(stats) => {
            max_late = max_late.max(stats.max_late);
            if stats.period + 1 == PERIODS {
                say!(eeruf_board::NAME, ": ", PERIODS, " periods");
                for kind in ReadingKind::ALL {
                    say!("  ", kind.as_str(), " ", readings.of(kind));
                }
                for sensor in 0..12 {
                    if ring.health(sensor) != Health::Well {
                        say!("  sensor ", sensor + 1, " is not well");
                    }
                }
                say!("  latest firing ", max_late.as_micros(), " us, edges lost ", EDGES.lost());
                leave(0);
            }
        }
    })
}
