//! The ring of twelve HC-SR04 sensors on RTIC 2. The alarm's task owns the ring; the echo interrupt, of higher
//! priority, only stamps edges and wakes that task.
#![no_std]
#![no_main]

eeruf_board::no_panic!();

#[rtic::app(device = eeruf_board::device, peripherals = false)]
mod app {
    use eeruf_board::fake_sensors::{self, Delay, Echo, Trigger};
    use eeruf_board::say::leave;
    use eeruf_board::{say, set_alarm};
    use eeruf_core::tables::PAPER_12;
    use eeruf_core::{EdgeQueue, Micros, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, Tally};
    use eeruf_hc_sr04::{HcSr04Ring, Settings};

    static EDGES: EdgeQueue<32> = EdgeQueue::new();

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        ring: HcSr04Ring<ScheduledRing<'static, 12>, Trigger, Echo, Delay, 12, &'static EdgeQueue<32>>,
        readings: Tally<u32>,
    }

    #[init]
    fn init(_: init::Context) -> (Shared, Local) {
        eeruf_board::start();
        for sensor in 0..12 {
            fake_sensors::put(sensor, Some(Micros::new(5_000 + 1_000 * sensor as u32)));
        }
        let config = RingConfig::new().with_window(Micros::from_millis(40));
        let Ok(ring) = Ring::new(&PAPER_12, config, eeruf_board::now()) else { leave(2) };
        let settings = Settings::default();
        let Ok(ring) = HcSr04Ring::with_edges(ring, fake_sensors::pins(), Delay, settings, &EDGES) else { leave(3) };
        set_alarm(ring.next_deadline());
        (Shared {}, Local { ring, readings: Tally::default() })
    }

    /// Sleeps while no task runs.
    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            rtic::export::wfi();
        }
    }

    #[task(binds = ECHO, priority = 2)]
    fn edge(_: edge::Context) {
        eeruf_board::clear_echo();
        while let Some(edge) = fake_sensors::edge() {
            EDGES.push(edge);
        }
        rtic::pend(eeruf_board::device::Interrupt::ALARM);
    }

    #[task(binds = ALARM, priority = 1, local = [ring, readings])]
    fn alarm(context: alarm::Context) {
        let alarm::LocalResources { ring, readings, .. } = context.local;
        eeruf_board::clear_alarm();
        while let Some(event) = ring.poll(eeruf_board::now()) {
            match event {
                RingEvent::Fire { .. } => {}
                RingEvent::Reading(reading) => readings.count(reading.kind),
                RingEvent::PeriodEnded(stats) => {
                    if stats.period == 99 {
                        say!("rtic on ", eeruf_board::NAME, ": accepted ", readings.of(ReadingKind::Accepted));
                        leave(0);
                    }
                }
            }
        }
        set_alarm(ring.next_deadline());
    }
}
