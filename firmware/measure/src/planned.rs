//! Flow rings: the cost of each call, and programs with a ring in static memory.

use core::hint::black_box;

use eeruf_board::say::leave;
use eeruf_core::{
    Instant, Micros, RingConfig, RingError, RingEvent, SensorError,
    flow::{BeliefSettings, FlowRing, TurnSettings},
};

use crate::{Range, counts};

/// Makes the flow ring of all measurements.
///
/// # Errors
/// See [`FlowRing::flow`].
#[inline(always)]
pub const fn flow<const K: usize>(now: Instant) -> Result<FlowRing<K>, RingError> {
    let config = RingConfig::new().with_window(Micros::from_millis(36));
    FlowRing::flow(K, TurnSettings::new(1), BeliefSettings::DEFAULT, config, now)
}

#[inline(never)]
fn poll(ring: &mut FlowRing<12>, now: Instant) -> Option<RingEvent> {
    ring.poll(now)
}

#[inline(never)]
fn echo(ring: &mut FlowRing<12>, sensor: u8, at: Instant) -> Result<(), SensorError> {
    ring.echo(sensor, at)
}

#[inline(never)]
fn moving(ring: &mut FlowRing<12>, speed_mm_s: u32, now: Instant) {
    ring.moving(speed_mm_s, 0, now);
}

/// Returns the echo time of a sensor, if it hears anything: of twelve sensors, four always see a wall, four hear
/// crosstalk in every second period, three hear noise, and one hears nothing.
fn t_echo(sensor: u8, period: u32, noise: u32) -> Option<u32> {
    match sensor {
        0..4 => Some(9_000 + 1_000 * u32::from(sensor)),
        4..8 if period & 1 == 0 => Some(4_000 + 300 * (period % 13)),
        4..8 => Some(14_000),
        8..11 => Some(3_000 + noise % 30_000),
        _ => None,
    }
}

/// Counts the instructions of each call: the fewest and the most over 400 rounds in which sensors hear their own
/// echoes, crosstalk, noise and nothing. In the second half the robot moves at 0.3 m/s.
///
/// Prints one line per kind of call: name, fewest, most; then the mean over all readings. `reading_moving` is a reading
/// of the second half; `period_ended` begins the next round.
pub fn say_calls(ring: &mut FlowRing<12>) {
    // Else the compiler's knowledge of its address would change the calls.
    let ring = black_box(ring);
    let mut idle = Range::new("idle_poll");
    let mut fire = Range::new("fire");
    let mut heard = Range::new("echo");
    let mut reading = Range::new("reading");
    let mut reading_moving = Range::new("reading_moving");
    let mut ended = Range::new("period_ended");
    let mut told = Range::new("moving");
    let (mut periods, mut noise) = (0, 1_u32);
    let (mut sum, mut readings) = (0, 0);
    while periods < 400 {
        let now = black_box(ring.next_deadline());
        loop {
            let (taken, event) = counts(|| poll(ring, now));
            match event {
                None => {
                    idle.note(taken);
                    break;
                }
                Some(RingEvent::Fire { sensor, .. }) => {
                    fire.note(taken);
                    noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    if let Some(t_echo) = t_echo(sensor, periods, noise >> 8) {
                        let at = now + Micros::new(black_box(t_echo));
                        let (taken, known) = counts(|| echo(ring, sensor, at));
                        if known.is_err() {
                            leave(4);
                        }
                        heard.note(taken);
                    }
                }
                Some(RingEvent::Reading(_)) => {
                    (sum, readings) = (sum + taken, readings + 1);
                    if periods >= 200 { &mut reading_moving } else { &mut reading }.note(taken);
                }
                Some(RingEvent::PeriodEnded(_)) => {
                    ended.note(taken);
                    periods += 1;
                    let speed = if periods >= 200 { 300 } else { 0 };
                    told.note(counts(|| moving(ring, black_box(speed), now)).0);
                }
            }
        }
    }
    for range in [&idle, &fire, &heard, &reading, &reading_moving, &ended, &told] {
        range.say();
    }
    let mut mean = Range::new("mean_reading");
    mean.note(u32::checked_div(sum, readings).unwrap_or(0));
    mean.say();
}

/// Makes a program like [`ring_in_static_memory!`](crate::ring_in_static_memory), with a flow ring that `made` makes at
/// compile time and that a restart begins.
#[macro_export]
macro_rules! planned_in_static_memory {
    ($ring:ty, $made:expr) => {
        use core::cell::UnsafeCell;
        use core::hint::black_box;
        use eeruf_core::{Instant, RingEvent, SensorError};

        struct Memory(UnsafeCell<$ring>);
        // SAFETY: only `main` uses it.
        unsafe impl Sync for Memory {}
        static MEMORY: Memory = Memory(UnsafeCell::new(match $made {
            Ok(ring) => ring,
            Err(_) => panic!("settings out of range"),
        }));

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_poll(ring: &mut $ring, now: Instant) -> Option<RingEvent> {
            ring.poll(now)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_next_deadline(ring: &$ring) -> Instant {
            ring.next_deadline()
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_echo(ring: &mut $ring, sensor: u8, at: Instant) -> Result<(), SensorError> {
            ring.echo(sensor, at)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_stuck(ring: &mut $ring, sensor: u8) -> Result<(), SensorError> {
            ring.stuck(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_disable(ring: &mut $ring, sensor: u8) -> Result<(), SensorError> {
            ring.disable(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_enable(ring: &mut $ring, sensor: u8) -> Result<(), SensorError> {
            ring.enable(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_moving(ring: &mut $ring, speed_mm_s: u32, now: Instant) {
            ring.moving(speed_mm_s, speed_mm_s, now);
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_restart(ring: &mut $ring, now: Instant) {
            ring.restart(now);
        }

        fn ring_program() {
            // SAFETY: the only use of the memory.
            let ring = unsafe { &mut *MEMORY.0.get() };
            ring_restart(ring, eeruf_board::now());
            loop {
                while let Some(event) = ring_poll(ring, eeruf_board::now()) {
                    if let RingEvent::Fire { sensor, .. } = black_box(event) {
                        _ = black_box(ring_echo(ring, sensor, eeruf_board::now()));
                    }
                }
                let sensor = black_box(1);
                match black_box(0) {
                    1 => _ = black_box(ring_stuck(ring, sensor)),
                    2 => _ = black_box(ring_disable(ring, sensor)),
                    3 => _ = black_box(ring_enable(ring, sensor)),
                    4 => ring_restart(ring, eeruf_board::now()),
                    5 => ring_moving(ring, black_box(100), eeruf_board::now()),
                    _ => eeruf_board::set_alarm(ring_next_deadline(ring)),
                }
            }
        }
    };
}
