//! The ring of twelve HC-SR04 sensors on embassy. One task sleeps until the ring's next deadline or an echo edge; the
//! echo interrupt only stamps edges.
#![no_std]
#![no_main]

mod time_driver;

use eeruf_board::fake_sensors::{self, Delay};
use eeruf_board::say::leave;
use eeruf_core::tables::PAPER_12;
use eeruf_core::{EdgeQueue, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, Tally};
use eeruf_hc_sr04::{HcSr04Ring, Settings};
use embassy_executor::Spawner;
use embassy_futures::select::select;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::Timer;

eeruf_board::say_panic!();
eeruf_board::interrupts!(time_driver::alarm, echo_interrupt);

static EDGES: EdgeQueue<32> = EdgeQueue::new();
static EDGE: Signal<CriticalSectionRawMutex, ()> = Signal::new();

fn echo_interrupt() {
    eeruf_board::clear_echo();
    while let Some(edge) = fake_sensors::edge() {
        EDGES.push(edge);
    }
    EDGE.signal(());
}

/// Returns the low 32 bits of embassy's clock.
fn now() -> Instant {
    Instant::from_micros(embassy_time::Instant::now().as_micros() as u32)
}

async fn sleep_until(deadline: Instant) {
    let now = now();
    if !now.has_reached(deadline) {
        Timer::after_micros(deadline.since(now).as_micros().into()).await;
    }
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    eeruf_board::start();
    for sensor in 0..12 {
        fake_sensors::put(sensor, Some(Micros::new(5_000 + 1_000 * sensor as u32)));
    }
    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let Ok(ring) = Ring::new(&PAPER_12, config, now()) else { leave(2) };
    let settings = Settings::default();
    let Ok(mut ring) = HcSr04Ring::with_edges(ring, fake_sensors::pins(), Delay, settings, &EDGES) else { leave(3) };
    let mut readings = Tally::<u32>::default();
    loop {
        while let Some(event) = ring.poll(now()) {
            match event {
                RingEvent::Fire { .. } => {}
                RingEvent::Reading(reading) => readings.count(reading.kind),
                RingEvent::PeriodEnded(stats) => {
                    if stats.period == 99 {
                        let accepted = readings.of(ReadingKind::Accepted);
                        eeruf_board::say!("embassy on ", eeruf_board::NAME, ": accepted ", accepted);
                        leave(0);
                    }
                }
            }
        }
        select(sleep_until(ring.next_deadline()), EDGE.wait()).await;
    }
}
