//! Eight HC-SR04 modules on a Raspberry Pi Pico. Interrupts stamp the edges of the echo lines with the time; the main
//! task fires, listens, and says once a second over USB what it sees.
#![no_std]
#![no_main]

mod ring;

use core::fmt;

use eeruf_core::{
    Edge, EdgeQueue, Instant, Micros, Ring, RingConfig, RingEvent, SpeedOfSound,
    watch::{SensorState, SensorWatch},
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_futures::select::select;
use embassy_rp::gpio::{AnyPin, Input, Level, Output, Pull};
use embassy_rp::interrupt::{self, InterruptExt, Priority};
use embassy_rp::peripherals::USB;
use embassy_rp::usb::{Driver, InterruptHandler};
use embassy_rp::{Peri, bind_interrupts};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Delay, Timer};
use panic_halt as _;
use ring::RING;

const SENSORS: usize = 8;
/// Of air at 20 degrees Celsius.
const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);
const SECOND: Micros = Micros::from_millis(1000);

bind_interrupts!(struct Irqs {
    USBCTRL_IRQ => InterruptHandler<USB>;
});

/// From the tasks that stamp edges to the main task.
static EDGES: EdgeQueue<32> = EdgeQueue::new();
static EDGE: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// Runs the tasks that stamp edges, in an interrupt, so that nothing the main task does makes a stamp late.
static STAMPS: InterruptExecutor = InterruptExecutor::new();

#[embassy_rp::interrupt]
unsafe fn SWI_IRQ_1() {
    // SAFETY: this is the interrupt that the executor was started with.
    unsafe { STAMPS.on_interrupt() }
}

/// The low 32 bits of embassy's clock.
fn now() -> Instant {
    Instant::from_micros(embassy_time::Instant::now().as_micros() as u32)
}

async fn sleep_until(deadline: Instant) {
    let now = now();
    if !now.has_reached(deadline) {
        Timer::after_micros(deadline.since(now).as_micros().into()).await;
    }
}

/// Stamps the edges of one echo line.
#[embassy_executor::task(pool_size = SENSORS)]
async fn stamp(sensor: u8, mut line: Input<'static>) {
    loop {
        line.wait_for_any_edge().await;
        EDGES.push(Edge { sensor, high: line.is_high(), at: now() });
        EDGE.signal(());
    }
}

/// Sends what is logged to the computer at the other end of the USB cable.
#[embassy_executor::task]
async fn usb(driver: Driver<'static, USB>) {
    embassy_usb_logger::run!(1024, log::LevelFilter::Info, driver);
}

/// The distances of what stood before each sensor within the last second, in millimetres; `free` where nothing is in
/// range, `x` where a module does not answer, `-` where nothing is known.
struct Distances<'w> {
    watch: &'w SensorWatch<SENSORS>,
    now: Instant,
}

impl fmt::Display for Distances<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for sensor in 0..SENSORS as u8 {
            match self.watch.state(sensor, self.now) {
                Ok(SensorState::Obstacle { t_echo, age }) if age < SECOND => {
                    write!(f, "{:6}", SOUND.distance_mm(t_echo))?;
                }
                Ok(SensorState::Clear { age }) if age < SECOND => f.write_str("  free")?,
                Ok(SensorState::Unanswered { .. }) => f.write_str("     x")?,
                _ => f.write_str("     -")?,
            }
        }
        Ok(())
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let p = embassy_rp::init(Default::default());
    spawner.spawn(usb(Driver::new(p.USB, Irqs)).expect("it is spawned once"));

    let triggers: [Peri<'static, AnyPin>; SENSORS] = [
        p.PIN_0.into(),
        p.PIN_1.into(),
        p.PIN_2.into(),
        p.PIN_3.into(),
        p.PIN_4.into(),
        p.PIN_5.into(),
        p.PIN_6.into(),
        p.PIN_7.into(),
    ];
    let echoes: [Peri<'static, AnyPin>; SENSORS] = [
        p.PIN_8.into(),
        p.PIN_9.into(),
        p.PIN_10.into(),
        p.PIN_11.into(),
        p.PIN_12.into(),
        p.PIN_13.into(),
        p.PIN_14.into(),
        p.PIN_15.into(),
    ];

    interrupt::SWI_IRQ_1.set_priority(Priority::P2);
    let stamps = STAMPS.start(interrupt::SWI_IRQ_1);
    let lines = echoes.map(|pin| {
        // SAFETY: the driver and the task that stamps both only read the line.
        let same = unsafe { pin.clone_unchecked() };
        (Input::new(same, Pull::Down), Input::new(pin, Pull::Down))
    });
    let mut sensor = 0;
    let lines = lines.map(|(stamped, read)| {
        stamps.spawn(stamp(sensor, stamped).expect("there is a task for each sensor"));
        sensor += 1;
        read
    });
    let mut lines = lines.into_iter();
    let pins = triggers.map(|trigger| Pins {
        trigger: Output::new(trigger, Level::Low),
        echo: lines.next().expect("there are as many lines as triggers"),
    });

    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let ring = Ring::new(&RING, config, now()).expect("the table was verified for such a window");
    let mut ring = HcSr04Ring::new(ring, pins, Delay, Settings::default()).expect("the table lets modules rest");
    let mut watch = SensorWatch::<SENSORS>::new(0, now());
    let (mut said, mut latest) = (now(), Micros::ZERO);
    loop {
        while let Some(event) = ring.poll_with_edges(&EDGES, now()) {
            let now = now();
            watch.observe(&event, now);
            if let RingEvent::PeriodEnded(stats) = event {
                latest = latest.max(stats.max_late);
                if now.since(said) >= SECOND {
                    log::info!("{} mm; latest firing {} us late", Distances { watch: &watch, now }, latest.as_micros());
                    (said, latest) = (now, Micros::ZERO);
                }
            }
        }
        select(sleep_until(ring.next_deadline()), EDGE.wait()).await;
    }
}
