//! Four HC-SR04 modules on an ESP32-C3. An interrupt stamps the edges of the echo lines with the time; the main loop
//! fires, listens, and says once a second over USB what it sees.
#![no_std]
#![no_main]

mod ring;

use core::cell::RefCell;
use core::convert::Infallible;
use core::fmt;

use critical_section::Mutex;
use eeruf_core::{
    Edge, EdgeQueue, Instant, Micros, Ring, RingConfig, RingEvent, SpeedOfSound,
    watch::{SensorState, SensorWatch},
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embedded_hal::digital::{ErrorType, InputPin};
use esp_backtrace as _;
use esp_hal::delay::Delay;
use esp_hal::gpio::{Event, Input, InputConfig, Io, Level, Output, OutputConfig, Pull};
use ring::RING;

const SENSORS: usize = 4;
/// Speed of sound in air at 20 degrees Celsius.
const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);
const SECOND: Micros = Micros::from_millis(1000);
/// A line is printed while nothing is due for so long.
const PRINTING: Micros = Micros::from_millis(5);

esp_bootloader_esp_idf::esp_app_desc!();

/// From the interrupt to the main loop.
static EDGES: EdgeQueue<32> = EdgeQueue::new();
/// The echo lines: the interrupt reads them at an edge, the driver before it fires.
static LINES: Mutex<RefCell<Option<[Input<'static>; SENSORS]>>> = Mutex::new(RefCell::new(None));

/// The low 32 bits of the clock.
fn now() -> Instant {
    Instant::from_micros(esp_hal::time::Instant::now().duration_since_epoch().as_micros() as u32)
}

#[esp_hal::handler]
fn on_edge() {
    let at = now();
    critical_section::with(|token| {
        let mut lines = LINES.borrow_ref_mut(token);
        for (sensor, line) in (0..).zip(lines.iter_mut().flatten()) {
            if line.is_interrupt_set() {
                line.clear_interrupt();
                EDGES.push(Edge { sensor, high: line.level() == Level::High, at });
            }
        }
    });
}

/// The echo line of a sensor, as the driver reads it.
struct Line(usize);

impl ErrorType for Line {
    type Error = Infallible;
}

impl InputPin for Line {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(critical_section::with(|token| {
            LINES.borrow_ref(token).as_ref().is_some_and(|lines| lines[self.0].level() == Level::High)
        }))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
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

#[esp_hal::main]
fn main() -> ! {
    let p = esp_hal::init(esp_hal::Config::default());
    Io::new(p.IO_MUX).set_interrupt_handler(on_edge);

    let down = InputConfig::default().with_pull(Pull::Down);
    let mut lines =
        [Input::new(p.GPIO4, down), Input::new(p.GPIO5, down), Input::new(p.GPIO6, down), Input::new(p.GPIO7, down)];
    critical_section::with(|token| {
        lines.iter_mut().for_each(|line| line.listen(Event::AnyEdge));
        LINES.borrow_ref_mut(token).replace(lines);
    });
    let triggers = [
        Output::new(p.GPIO0, Level::Low, OutputConfig::default()),
        Output::new(p.GPIO1, Level::Low, OutputConfig::default()),
        Output::new(p.GPIO3, Level::Low, OutputConfig::default()),
        Output::new(p.GPIO10, Level::Low, OutputConfig::default()),
    ];
    let mut sensors = 0..;
    let pins = triggers.map(|trigger| Pins { trigger, echo: Line(sensors.next().unwrap_or_default()) });

    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let ring = Ring::new(&RING, config, now()).expect("the table was verified for such a window");
    let settings = Settings::default();
    let mut ring =
        HcSr04Ring::with_edges(ring, pins, Delay::new(), settings, &EDGES).expect("the table lets modules rest");
    let mut watch = SensorWatch::<SENSORS>::new(0, now());
    let (mut said, mut latest) = (now(), Micros::ZERO);
    loop {
        while let Some(event) = ring.poll(now()) {
            watch.observe(&event, now());
            if let RingEvent::PeriodEnded(stats) = event {
                latest = latest.max(stats.max_late);
            }
        }
        let (now, deadline) = (now(), ring.next_deadline());
        let idle = !now.has_reached(deadline) && deadline.since(now) > PRINTING;
        if idle && now.since(said) >= SECOND {
            let distances = Distances { watch: &watch, now };
            esp_println::println!("{distances} mm; latest firing {} us late", latest.as_micros());
            (said, latest) = (now, Micros::ZERO);
        }
    }
}
