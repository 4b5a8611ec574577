//! Eight HC-SR04 modules on a Raspberry Pi Pico without its PIOs, by flow: one task waits for their lines, and reports
//! over USB what each module sees.
#![no_std]
#![no_main]

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, SpeedOfSound};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embassy_executor::Spawner;
use embassy_rp::bind_interrupts;
use embassy_rp::clocks::RoscRng;
use embassy_rp::gpio::{Input, Level, Output, Pull};
use embassy_rp::peripherals::USB;
use embassy_rp::usb::{Driver, InterruptHandler};
use embassy_time::Delay;
use panic_halt as _;

bind_interrupts!(struct Irqs {
    USBCTRL_IRQ => InterruptHandler<USB>;
});

#[embassy_executor::task]
async fn log_over_usb(driver: Driver<'static, USB>) {
    embassy_usb_logger::run!(1024, log::LevelFilter::Info, driver);
}

/// The pins of modules: a trigger and an echo line.
macro_rules! modules {
    ($p:ident: $($trigger:ident $echo:ident),+) => {
        [$(Pins { trigger: Output::new($p.$trigger, Level::Low), echo: Input::new($p.$echo, Pull::Down) }),+]
    };
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let p = embassy_rp::init(Default::default());
    spawner.spawn(log_over_usb(Driver::new(p.USB, Irqs)).expect("it is spawned once"));
    let pins = modules!(p: PIN_0 PIN_8, PIN_1 PIN_9, PIN_2 PIN_10, PIN_3 PIN_11, PIN_4 PIN_12, PIN_5 PIN_13,
        PIN_6 PIN_14, PIN_7 PIN_15);
    let now = || Instant::from_micros(embassy_time::Instant::now().as_micros() as u32);
    // Robots that meet need seeds of their own: this one is drawn at each start, and not 0.
    let turns = TurnSettings::new(RoscRng.next_u32() | 1);
    let window = RingConfig::new().with_window(Micros::from_millis(37));
    let ring = FlowRing::<8>::flow(8, turns, BeliefSettings::DEFAULT, window, now());
    let ring = ring.expect("eight modules with such a window");
    let mut ring = HcSr04Ring::awaited(ring, pins, Delay, Settings::default(), now).expect("modules rest long enough");
    loop {
        let reading = ring.next().await;
        let mm = reading.t_echo.map(|t_echo| SpeedOfSound::at_celsius_tenths(200).distance_mm(t_echo));
        match (reading.kind, mm) {
            (ReadingKind::Accepted, Some(mm)) => log::info!("module {}: {mm} mm", reading.sensor + 1),
            (ReadingKind::Clear, _) => log::info!("module {}: free", reading.sensor + 1),
            (ReadingKind::Unanswered, _) => log::info!("module {} does not answer", reading.sensor + 1),
            _ => {}
        }
    }
}
