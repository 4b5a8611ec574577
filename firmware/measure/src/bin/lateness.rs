//! Measures the lateness of firings under echo interrupts: twelve sensors, all with an echo, 200 periods. Prints the
//! lateness and the resulting shift of crosstalk. Run it at several speeds of the core (`-icount shift=N`: 2^N ns per
//! instruction).
#![no_std]
#![no_main]

use eeruf_board::fake_sensors::{self, Delay};
use eeruf_board::say;
use eeruf_board::say::leave;
use eeruf_core::tables::PAPER_12;
use eeruf_core::{EdgeQueue, Micros, ReadingKind, Ring, RingConfig, RingEvent, Tally};
use eeruf_hc_sr04::{HcSr04Ring, Settings};
use eeruf_ring::run;

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, echo_interrupt);

static EDGES: EdgeQueue<32> = EdgeQueue::new();

fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = fake_sensors::edge() {
        EDGES.push(edge);
    }
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    for sensor in 0..12 {
        // The worst case: all echoes of a group come together, when the next group fires.
        fake_sensors::put(sensor, Some(Micros::new(24_500)));
    }
    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let Ok(ring) = Ring::new(&PAPER_12, config, eeruf_board::now()) else { leave(2) };
    let settings = Settings::default();
    let Ok(ring) = HcSr04Ring::with_edges(ring, fake_sensors::pins(), Delay, settings, &EDGES) else { leave(3) };
    let mut readings = Tally::<u32>::default();
    let (mut most, mut sum) = (0, 0);
    run(ring, &EDGES, |_, event| match event {
        RingEvent::Fire { .. } => {}
        RingEvent::Reading(reading) => readings.count(reading.kind),
        RingEvent::PeriodEnded(stats) => {
            most = stats.max_late.as_micros().max(most);
            sum += stats.max_late.as_micros();
            if stats.period == 199 {
                say!(
                    "latest_us ",
                    most,
                    " mean_of_latest_us ",
                    sum / 200,
                    " edges_lost ",
                    EDGES.lost(),
                    " accepted ",
                    readings.of(ReadingKind::Accepted),
                    " rejected ",
                    readings.of(ReadingKind::Rejected),
                    " ambiguous ",
                    readings.of(ReadingKind::Ambiguous)
                );
                leave(0);
            }
        }
    })
}
