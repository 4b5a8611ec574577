//! Four HC-SR04 modules on an ESP32-C3, by flow: one task waits for their lines and reports over USB what each module
//! sees.
#![no_std]
#![no_main]

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, SpeedOfSound};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embassy_executor::Spawner;
use embassy_time::Delay;
use esp_backtrace as _;
use esp_hal::gpio::{Input, InputConfig, Level, Output, OutputConfig, Pull};
use esp_hal::rng::Rng;
use esp_hal::timer::timg::TimerGroup;
use esp_println::println;

esp_bootloader_esp_idf::esp_app_desc!();

/// The pins of modules: a trigger and an echo line.
macro_rules! modules {
    ($p:ident: $($trigger:ident $echo:ident),+) => {
        [$(Pins {
            trigger: Output::new($p.$trigger, Level::Low, OutputConfig::default()),
            echo: Input::new($p.$echo, InputConfig::default().with_pull(Pull::Down)),
        }),+]
    };
}

#[esp_rtos::main]
async fn main(_spawner: Spawner) {
    let p = esp_hal::init(esp_hal::Config::default());
    esp_rtos::start(TimerGroup::new(p.TIMG0).timer0, p.FROM_CPU_INTR0);
    let pins = modules!(p: GPIO0 GPIO4, GPIO1 GPIO5, GPIO3 GPIO6, GPIO10 GPIO7);
    let now = || Instant::from_micros(embassy_time::Instant::now().as_micros() as u32);
    // Robots that meet need seeds of their own: this one is drawn at each start, and not 0.
    let turns = TurnSettings::new(Rng::new().random() | 1);
    let window = RingConfig::new().with_window(Micros::from_millis(37));
    let ring = FlowRing::<4>::flow(4, turns, BeliefSettings::DEFAULT, window, now());
    let ring = ring.expect("four modules with such a window");
    let mut ring = HcSr04Ring::awaited(ring, pins, Delay, Settings::default(), now).expect("modules rest long enough");
    loop {
        let reading = ring.next().await;
        let mm = reading.t_echo.map(|t_echo| SpeedOfSound::at_celsius_tenths(200).distance_mm(t_echo));
        match (reading.kind, mm) {
            (ReadingKind::Accepted, Some(mm)) => println!("module {}: {mm} mm", reading.sensor + 1),
            (ReadingKind::Clear, _) => println!("module {}: free", reading.sensor + 1),
            (ReadingKind::Unanswered, _) => println!("module {} does not answer", reading.sensor + 1),
            _ => {}
        }
    }
}
