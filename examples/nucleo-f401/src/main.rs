//! Eight HC-SR04 modules on a Nucleo-F401RE, by flow: one task waits for their lines and reports what each module sees
//! through the debugger on the board.
#![no_std]
#![no_main]

use defmt_rtt as _;
use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, SpeedOfSound};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings};
use embassy_executor::Spawner;
use embassy_stm32::exti::{ExtiInput, InterruptHandler};
use embassy_stm32::gpio::{Level, Output, Pull, Speed};
use embassy_stm32::{Config, bind_interrupts, interrupt::typelevel};
use embassy_time::Delay;
use panic_probe as _;

bind_interrupts!(struct Irqs {
    EXTI0 => InterruptHandler<typelevel::EXTI0>;
    EXTI1 => InterruptHandler<typelevel::EXTI1>;
    EXTI2 => InterruptHandler<typelevel::EXTI2>;
    EXTI3 => InterruptHandler<typelevel::EXTI3>;
    EXTI4 => InterruptHandler<typelevel::EXTI4>;
    EXTI9_5 => InterruptHandler<typelevel::EXTI9_5>;
});

/// The pins of modules: a trigger, an echo line, and the interrupt for that line's number, which no other line may use.
macro_rules! modules {
    ($p:ident: $($trigger:ident $echo:ident $exti:ident),+) => {
        [$(Pins {
            trigger: Output::new($p.$trigger, Level::Low, Speed::Low),
            echo: ExtiInput::new($p.$echo, $p.$exti, Pull::Down, Irqs),
        }),+]
    };
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let p = embassy_stm32::init(Config::default());
    let pins = modules!(p: PA10 PC0 EXTI0, PB5 PC1 EXTI1, PB4 PC2 EXTI2, PB10 PC3 EXTI3, PA8 PC4 EXTI4, PA9 PC5 EXTI5,
        PB6 PC6 EXTI6, PB9 PC7 EXTI7);
    let now = || Instant::from_micros(embassy_time::Instant::now().as_micros() as u32);
    // Robots that meet need seeds of their own: this is the chip's number.
    let seed = embassy_stm32::uid::uid().iter().fold(1, |seed: u32, &byte| seed.rotate_left(5) ^ u32::from(byte));
    let window = RingConfig::new().with_window(Micros::from_millis(37));
    let ring = FlowRing::<8>::flow(8, TurnSettings::new(seed), BeliefSettings::DEFAULT, window, now());
    let ring = ring.expect("eight modules with such a window");
    let mut ring = HcSr04Ring::awaited(ring, pins, Delay, Settings::default(), now).expect("modules rest long enough");
    loop {
        let reading = ring.next().await;
        let mm = reading.t_echo.map(|t_echo| SpeedOfSound::at_celsius_tenths(200).distance_mm(t_echo));
        match (reading.kind, mm) {
            (ReadingKind::Accepted, Some(mm)) => defmt::println!("module {}: {} mm", reading.sensor + 1, mm),
            (ReadingKind::Clear, _) => defmt::println!("module {}: free", reading.sensor + 1),
            (ReadingKind::Unanswered, _) => defmt::println!("module {} does not answer", reading.sensor + 1),
            _ => {}
        }
    }
}
