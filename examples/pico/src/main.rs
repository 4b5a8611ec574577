//! Eight HC-SR04 modules on a Raspberry Pi Pico, one on each state machine of its two PIOs. These fire and time the
//! echoes by themselves; the main task schedules them and reports over USB what each module sees.
#![no_std]
#![no_main]

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, ReadingKind, RingConfig, RingEvent, SpeedOfSound};
use eeruf_hc_sr04::Settings;
use eeruf_hc_sr04::capture::{CaptureRing, Captures, LineEdge, PIO_HZ, PIO_PROGRAM, PioLine};
use embassy_executor::Spawner;
use embassy_rp::Peri;
use embassy_rp::bind_interrupts;
use embassy_rp::clocks::RoscRng;
use embassy_rp::gpio::Pull;
use embassy_rp::peripherals::{PIO0, PIO1, USB};
use embassy_rp::pio::program::{ArrayVec, PioVersion, Program, SideSet, Wrap};
use embassy_rp::pio::{self, Common, Config, Direction, Instance, LoadedProgram, Pio, PioPin, StateMachine};
use embassy_rp::pio_programs::clock_divider::calculate_pio_clock_divider;
use embassy_rp::usb::{self, Driver};
use embassy_time::Timer;
use panic_halt as _;

const SENSORS: usize = 8;
/// Speed of sound in air at 20 degrees Celsius.
const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);
/// Time for which a line is watched: more than the window, and 11 ms less than the 60 ms after which a module may fire
/// again.
const LISTENS: Micros = Micros::from_millis(45);

bind_interrupts!(struct Irqs {
    USBCTRL_IRQ => usb::InterruptHandler<USB>;
    PIO0_IRQ_0 => pio::InterruptHandler<PIO0>;
    PIO1_IRQ_0 => pio::InterruptHandler<PIO1>;
});

/// The low 32 bits of embassy's clock.
fn now() -> Instant {
    Instant::from_micros(embassy_time::Instant::now().as_micros() as u32)
}

/// Sends log messages to the computer at the other end of the USB cable.
#[embassy_executor::task]
async fn log_over_usb(driver: Driver<'static, USB>) {
    embassy_usb_logger::run!(1024, log::LevelFilter::Info, driver);
}

/// The FIFOs of any state machine.
trait Fifos {
    fn push(&mut self, word: u32);
    fn pull(&mut self) -> Option<u32>;
}

impl<P: Instance, const N: usize> Fifos for StateMachine<'_, P, N> {
    fn push(&mut self, word: u32) {
        // It takes two words per firing, and has room for four.
        self.tx().push(word);
    }

    fn pull(&mut self) -> Option<u32> {
        self.rx().try_pull()
    }
}

/// The state machines, one for each module.
struct Modules<'m> {
    machines: [&'m mut dyn Fifos; SENSORS],
    lines: [PioLine; SENSORS],
}

impl Captures for Modules<'_> {
    fn fire(&mut self, sensor: u8, at: Instant, _: Instant) -> Option<Instant> {
        let (machine, line) = (self.machines.get_mut(usize::from(sensor))?, self.lines.get_mut(usize::from(sensor))?);
        // No interrupt may come between the clock and the words that count from it.
        critical_section::with(|_| {
            let (words, at) = line.fire(at, now())?;
            words.into_iter().for_each(|word| machine.push(word));
            Some(at)
        })
    }

    fn edge(&mut self, sensor: u8, _: Instant) -> Option<LineEdge> {
        let (machine, line) = (self.machines.get_mut(usize::from(sensor))?, self.lines.get_mut(usize::from(sensor))?);
        loop {
            if let Some(edge) = line.edge(machine.pull()?) {
                return Some(edge);
            }
        }
    }
}

/// Starts a state machine with the pins of a module.
fn start<'d, P: Instance, const N: usize>(
    machine: &mut StateMachine<'d, P, N>,
    common: &mut Common<'d, P>,
    program: &LoadedProgram<'d, P>,
    trigger: Peri<'d, impl PioPin + 'd>,
    echo: Peri<'d, impl PioPin + 'd>,
) {
    let (trigger, mut echo) = (common.make_pio_pin(trigger), common.make_pio_pin(echo));
    echo.set_pull(Pull::Down);
    let mut config = Config::default();
    config.use_program(program, &[]);
    config.set_set_pins(&[&trigger]);
    config.set_in_pins(&[&echo]);
    config.set_jmp_pin(&echo);
    config.shift_out.direction = pio::ShiftDirection::Right;
    config.shift_in.direction = pio::ShiftDirection::Left;
    config.clock_divider = calculate_pio_clock_divider(PIO_HZ);
    machine.set_pin_dirs(Direction::Out, &[&trigger]);
    machine.set_pin_dirs(Direction::In, &[&echo]);
    machine.set_config(&config);
    machine.set_enable(true);
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let p = embassy_rp::init(Default::default());
    spawner.spawn(log_over_usb(Driver::new(p.USB, Irqs)).expect("it is spawned once"));

    let program = Program {
        code: ArrayVec::from(PIO_PROGRAM),
        origin: None,
        wrap: Wrap { source: PIO_PROGRAM.len() as u8 - 1, target: 0 },
        side_set: SideSet::default(),
        version: PioVersion::V0,
    };
    let (mut one, mut two) = (Pio::new(p.PIO0, Irqs), Pio::new(p.PIO1, Irqs));
    let (in_one, in_two) = (one.common.load_program(&program), two.common.load_program(&program));
    start(&mut one.sm0, &mut one.common, &in_one, p.PIN_0, p.PIN_8);
    start(&mut one.sm1, &mut one.common, &in_one, p.PIN_1, p.PIN_9);
    start(&mut one.sm2, &mut one.common, &in_one, p.PIN_2, p.PIN_10);
    start(&mut one.sm3, &mut one.common, &in_one, p.PIN_3, p.PIN_11);
    start(&mut two.sm0, &mut two.common, &in_two, p.PIN_4, p.PIN_12);
    start(&mut two.sm1, &mut two.common, &in_two, p.PIN_5, p.PIN_13);
    start(&mut two.sm2, &mut two.common, &in_two, p.PIN_6, p.PIN_14);
    start(&mut two.sm3, &mut two.common, &in_two, p.PIN_7, p.PIN_15);
    let modules = Modules {
        machines: [
            &mut one.sm0,
            &mut one.sm1,
            &mut one.sm2,
            &mut one.sm3,
            &mut two.sm0,
            &mut two.sm1,
            &mut two.sm2,
            &mut two.sm3,
        ],
        lines: [PioLine::new(LISTENS); SENSORS],
    };

    let window = RingConfig::new().with_window(Micros::from_millis(37));
    // Robots that meet need seeds of their own: this one is drawn at each start, and not 0.
    let turns = TurnSettings::new(RoscRng.next_u32() | 1);
    let ring = FlowRing::<SENSORS>::flow(SENSORS, turns, BeliefSettings::DEFAULT, window, now());
    let ring = ring.expect("eight modules with such a window");
    let mut ring = CaptureRing::new(ring, Settings::default(), modules).expect("modules rest long enough");
    loop {
        while let Some(event) = ring.poll(now()) {
            let RingEvent::Reading(reading) = event else { continue };
            match (reading.kind, reading.t_echo.map(|t_echo| SOUND.distance_mm(t_echo))) {
                (ReadingKind::Accepted, Some(mm)) => log::info!("module {}: {mm} mm", reading.sensor + 1),
                (ReadingKind::Clear, _) => log::info!("module {}: free", reading.sensor + 1),
                (ReadingKind::Unanswered, _) => log::info!("module {} does not answer", reading.sensor + 1),
                _ => {}
            }
        }
        // Edges wait for nobody; firings wait for this.
        Timer::after_micros(500).await;
    }
}
