//! Eight HC-SR04 modules on a Nucleo-F401RE. Interrupts stamp the edges of the echo lines with the time; the main task
//! fires, listens, and says once a second through the debugger on the board what it sees.
#![no_std]
#![no_main]

mod ring;

use core::fmt;

use defmt_rtt as _;
use eeruf_core::{
    Edge, EdgeQueue, Instant, Micros, Ring, RingConfig, RingEvent, SpeedOfSound,
    watch::{SensorState, SensorWatch},
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_futures::select::select;
use embassy_stm32::exti::{ExtiInput, InterruptHandler};
use embassy_stm32::gpio::{AnyPin, Input, Level, Output, Pin, Pull, Speed};
use embassy_stm32::interrupt::{self, InterruptExt, Priority, typelevel};
use embassy_stm32::mode::Async;
use embassy_stm32::{Config, Peri, bind_interrupts, rcc};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Delay, Timer};
use panic_probe as _;
use ring::RING;

const SENSORS: usize = 8;
/// Speed of sound in air at 20 degrees Celsius.
const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);
const SECOND: Micros = Micros::from_millis(1000);

bind_interrupts!(struct Irqs {
    EXTI0 => InterruptHandler<typelevel::EXTI0>;
    EXTI1 => InterruptHandler<typelevel::EXTI1>;
    EXTI2 => InterruptHandler<typelevel::EXTI2>;
    EXTI3 => InterruptHandler<typelevel::EXTI3>;
    EXTI4 => InterruptHandler<typelevel::EXTI4>;
    EXTI9_5 => InterruptHandler<typelevel::EXTI9_5>;
});

/// From the tasks that stamp edges to the main task.
static EDGES: EdgeQueue<32> = EdgeQueue::new();
static EDGE: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// Runs the tasks that stamp edges, in the interrupt of a serial port that is not used, so that nothing the main task
/// does makes a stamp late.
static STAMPS: InterruptExecutor = InterruptExecutor::new();

#[embassy_stm32::interrupt]
unsafe fn USART6() {
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
async fn stamp(sensor: u8, mut line: ExtiInput<'static, Async>) {
    loop {
        line.wait_for_any_edge().await;
        EDGES.push(Edge { sensor, high: line.is_high(), at: now() });
        EDGE.signal(());
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

/// 84 MHz from the internal oscillator.
fn clocks() -> Config {
    let mut config = Config::default();
    config.rcc.pll_src = rcc::PllSource::HSI;
    config.rcc.pll = Some(rcc::Pll {
        prediv: rcc::PllPreDiv::DIV16,
        mul: rcc::PllMul::MUL336,
        divp: Some(rcc::PllPDiv::DIV4),
        divq: Some(rcc::PllQDiv::DIV7),
        divr: None,
    });
    config.rcc.sys = rcc::Sysclk::PLL1_P;
    config.rcc.apb1_pre = rcc::APBPrescaler::DIV2;
    config
}

/// Returns the line for the driver, which looks at it before it fires.
fn look<P: Pin>(pin: &Peri<'static, P>) -> Input<'static> {
    // SAFETY: the driver and the task that stamps both only read the line.
    Input::new(unsafe { pin.clone_unchecked() }, Pull::Down)
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let p = embassy_stm32::init(clocks());
    let triggers: [Peri<'static, AnyPin>; SENSORS] = [
        p.PA10.into(),
        p.PB5.into(),
        p.PB4.into(),
        p.PB10.into(),
        p.PA8.into(),
        p.PA9.into(),
        p.PB6.into(),
        p.PB9.into(),
    ];
    let looks = [
        look(&p.PC0),
        look(&p.PC1),
        look(&p.PC2),
        look(&p.PC3),
        look(&p.PC4),
        look(&p.PC5),
        look(&p.PC6),
        look(&p.PC7),
    ];
    // Each line on an interrupt of its own: no two of these pins have the same number.
    let lines = [
        ExtiInput::new(p.PC0, p.EXTI0, Pull::Down, Irqs),
        ExtiInput::new(p.PC1, p.EXTI1, Pull::Down, Irqs),
        ExtiInput::new(p.PC2, p.EXTI2, Pull::Down, Irqs),
        ExtiInput::new(p.PC3, p.EXTI3, Pull::Down, Irqs),
        ExtiInput::new(p.PC4, p.EXTI4, Pull::Down, Irqs),
        ExtiInput::new(p.PC5, p.EXTI5, Pull::Down, Irqs),
        ExtiInput::new(p.PC6, p.EXTI6, Pull::Down, Irqs),
        ExtiInput::new(p.PC7, p.EXTI7, Pull::Down, Irqs),
    ];

    interrupt::USART6.set_priority(Priority::P6);
    let stamps = STAMPS.start(interrupt::USART6);
    for (sensor, line) in (0..).zip(lines) {
        stamps.spawn(stamp(sensor, line).expect("there is a task for each sensor"));
    }
    let mut looks = looks.into_iter();
    let pins = triggers.map(|trigger| Pins {
        trigger: Output::new(trigger, Level::Low, Speed::Low),
        echo: looks.next().expect("there are as many lines as triggers"),
    });

    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let ring = Ring::new(&RING, config, now()).expect("the table was verified for such a window");
    let settings = Settings::default();
    let mut ring = HcSr04Ring::with_edges(ring, pins, Delay, settings, &EDGES).expect("the table lets modules rest");
    let mut watch = SensorWatch::<SENSORS>::new(0, now());
    let (mut said, mut latest) = (now(), Micros::ZERO);
    loop {
        while let Some(event) = ring.poll(now()) {
            let now = now();
            watch.observe(&event, now);
            if let RingEvent::PeriodEnded(stats) = event {
                latest = latest.max(stats.max_late);
                if now.since(said) >= SECOND {
                    let distances = Distances { watch: &watch, now };
                    defmt::println!(
                        "{} mm; latest firing {} us late",
                        defmt::Display2Format(&distances),
                        latest.as_micros()
                    );
                    (said, latest) = (now, Micros::ZERO);
                }
            }
        }
        select(sleep_until(ring.next_deadline()), EDGE.wait()).await;
    }
}
