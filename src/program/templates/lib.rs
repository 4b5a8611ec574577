#![no_std]

mod ring;

use eeruf_core::{EdgeQueue, Instant, Micros};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings, SetupError};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

pub use eeruf_core;
/// Takes in each event, and says once a second whether the loop is too slow: `pace.too_slow(sonar.ring(), now)`.
pub use eeruf_hc_sr04::Pace;
pub use ring::SENSORS;  //@flow

pub const SENSORS: usize = @sensors@;  //@table

/// Edges of the echo lines: the interrupt of any change pushes sensor, level and instant.
pub static EDGES: EdgeQueue<32> = EdgeQueue::new();

/// The ring on its pins. `poll(now)` fires what is due and returns readings; `next_deadline()` says until when to
/// sleep; call `moving(speed_mm_s, turn_mrad_s, now)` once a control cycle with the robot's motion, else the  //@flow
/// ring file's speed counts.  //@flow
/// sleep.  //@table
pub type Sonar<T, I, D> =
    HcSr04Ring<@ring@, T, I, D, SENSORS, &'static EdgeQueue<32>>;

/// Begins. The seed is the chip's number, or another that each robot has of its own, not 0.  //@flow
/// Begins.  //@table
///
/// # Errors
/// [`SetupError`]: none for these settings, but for a seed of 0.  //@flow
/// [`SetupError`]: none for this table.  //@table
pub fn sonar<T: OutputPin, I: InputPin, D: DelayNs>(
    pins: [Pins<T, I>; SENSORS],
    delay: D,
    seed: u32,  //@flow
    now: Instant,
) -> Result<Sonar<T, I, D>, SetupError> {
    let ring = eeruf_core::flow::FlowRing::@begin@ring::turns(seed), ring::BELIEF, ring::CONFIG, now)?;  //@flow
    let ring = eeruf_core::Ring::new(&ring::RING, ring::CONFIG, now)?;  //@table
    let mut settings = Settings::default();
    settings.trigger = Micros::new(@trigger_us@);
    settings.deaf = Micros::new(@deaf_us@);
    settings.shortest = Micros::new(@shortest_us@);
    settings.latest_rise = Micros::new(@latest_rise_us@);
    settings.longest = Micros::new(@longest_us@);
    settings.longest_hold = Micros::new(@longest_hold_us@);
    settings.min_retrigger = Micros::new(@rest_us@);
    HcSr04Ring::with_edges(ring, pins, delay, settings, &EDGES)
}
