//! Rings that weigh readings by a tracker: what each call takes, and programs that have one in static memory.

use core::hint::black_box;

use eeruf_board::say::leave;
use eeruf_core::{
    Criterion, Instant, Micros, Requirements, Ring, RingEvent, SensorError,
    flow::{FlowRing, FlowSettings},
    hopping::{HoppingError, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    hopping_schedule,
    judge::Judge,
    plan::Plan,
};

use crate::{Range, counts};

const WINDOW: Micros = Micros::from_millis(36);

/// The hopping schedule of twelve sensors: 16 phases, 100 ms, even lags.
pub const HOPPING_12: HoppingSchedule<12> = hopping_schedule! {
    period_us: 100_000,
    step_us: 240,
    phases: 16,
    first_multiplier: 1,
    t_lag_us: [0, 8_000, 16_000, 24_000, 32_000, 40_000, 48_000, 56_000, 64_000, 72_000, 80_000, 88_000],
    meets: Requirements {
        criterion: Criterion::Margin(Micros::new(90)),
        min_interval: Micros::from_millis(4),
        window: WINDOW,
        ..Requirements::new(Micros::new(150))
    },
};

/// The hopping ring of all that is measured.
///
/// # Errors
/// As [`HoppingRing::hopping`].
#[inline(always)]
pub fn hopping<const K: usize>(schedule: &HoppingSchedule<K>, now: Instant) -> Result<HoppingRing<K>, HoppingError> {
    // Lags that are redrawn, so that it is measured what that costs.
    let settings = HoppingSettings::BALANCED.with_shift_after(5);
    HoppingRing::hopping(schedule, settings, HoppingListening::new(WINDOW), 1, now)
}

/// The flow ring of all that is measured.
///
/// # Errors
/// As [`FlowRing::flow`].
#[inline(always)]
pub fn flow<const K: usize>(now: Instant) -> Result<FlowRing<K>, HoppingError> {
    FlowRing::flow(K, FlowSettings::DEFAULT, HoppingListening::new(WINDOW), now)
}

/// A ring of twelve with the tracker's room of `HoppingRing` and `FlowRing`.
type Twelve<P, J> = Ring<P, J, 12, 1, 1>;

#[inline(never)]
fn poll<P: Plan, J: Judge>(ring: &mut Twelve<P, J>, now: Instant, change_us: &[i32; 12]) -> Option<RingEvent> {
    ring.poll_expecting(now, |sensor| change_us.get(usize::from(sensor)).copied().unwrap_or(0))
}

#[inline(never)]
fn echo<P: Plan, J: Judge>(ring: &mut Twelve<P, J>, sensor: u8, at: Instant) -> Result<(), SensorError> {
    ring.echo(sensor, at)
}

/// After how long a sensor hears something, if it does: of 12, four always see a wall, four are fooled in every second
/// period, three hear noise, and one hears nothing.
fn t_echo(sensor: u8, period: u32, noise: u32) -> Option<u32> {
    match sensor {
        0..4 => Some(9_000 + 1_000 * u32::from(sensor)),
        4..8 if period & 1 == 0 => Some(4_000 + 300 * (period % 13)),
        4..8 => Some(14_000),
        8..11 => Some(3_000 + noise % 30_000),
        _ => None,
    }
}

/// Instructions of each call, the fewest and the most over 400 periods in which sensors hear their own echoes,
/// crosstalk, noise and nothing. In the second half of the periods the robot moves to and fro, by `change_us` a period.
///
/// Prints one line per kind of call: name, fewest, most. `reading_moving` is one of the second half; `period_ended`
/// plans the next period, and is `new_lags` where that changes `lags`.
pub fn say_calls<P: Plan, J: Judge, L: PartialEq>(
    ring: &mut Twelve<P, J>,
    change_us: i32,
    lags: impl Fn(&Twelve<P, J>) -> Option<L>,
) {
    // Whatever the compiler knows of where it lies would count as part of the calls.
    let ring = black_box(ring);
    let mut idle = Range::new("idle_poll");
    let mut fire = Range::new("fire");
    let mut heard = Range::new("echo");
    let mut reading = Range::new("reading");
    let mut reading_moving = Range::new("reading_moving");
    let mut ended = Range::new("period_ended");
    let mut new_lags = Range::new("new_lags");
    let (mut periods, mut noise) = (0, 1_u32);
    while periods < 400 {
        let now = black_box(ring.next_deadline());
        let moves = periods >= 200;
        let change_us = if periods & 1 == 0 { change_us } else { -change_us };
        let change_us = black_box([if moves { change_us } else { 0 }; 12]);
        loop {
            let before = lags(ring);
            let (taken, event) = counts(|| poll(ring, now, &change_us));
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
                Some(RingEvent::Reading(_)) => if moves { &mut reading_moving } else { &mut reading }.note(taken),
                Some(RingEvent::PeriodEnded(_)) => {
                    if before != lags(ring) { &mut new_lags } else { &mut ended }.note(taken);
                    periods += 1;
                }
            }
        }
    }
    for range in [&idle, &fire, &heard, &reading, &reading_moving, &ended] {
        range.say();
    }
    if lags(ring).is_some() {
        new_lags.say();
    }
}

/// As [`ring_in_static_memory!`](crate::ring_in_static_memory), with all of a [`HoppingRing`](super::HoppingRing) or a
/// [`FlowRing`](super::FlowRing) of `k` sensors in it, which `new` makes for an instant.
#[macro_export]
macro_rules! planned_in_static_memory {
    ($ring:ty, $k:literal, $new:expr) => {
        use core::cell::UnsafeCell;
        use core::hint::black_box;
        use core::mem::MaybeUninit;
        use eeruf_core::{Instant, RingEvent, SensorError, hopping::HoppingError};

        struct Memory(UnsafeCell<MaybeUninit<$ring>>);
        // SAFETY: used by `main` alone.
        unsafe impl Sync for Memory {}
        static MEMORY: Memory = Memory(UnsafeCell::new(MaybeUninit::uninit()));

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_new(memory: &mut MaybeUninit<$ring>, now: Instant) -> Result<(), HoppingError> {
            memory.write($new(now)?);
            Ok(())
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_poll(ring: &mut $ring, now: Instant, change_us: &[i32; $k]) -> Option<RingEvent> {
            ring.poll_expecting(now, |sensor| change_us.get(usize::from(sensor)).copied().unwrap_or(0))
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
        fn ring_restart(ring: &mut $ring, now: Instant) {
            ring.restart(now);
        }

        fn ring_program() {
            // SAFETY: the only use of the memory.
            let memory = unsafe { &mut *MEMORY.0.get() };
            if ring_new(memory, black_box(eeruf_board::now())).is_err() {
                return;
            }
            // SAFETY: it has just been written.
            let ring = unsafe { memory.assume_init_mut() };
            loop {
                while let Some(event) = ring_poll(ring, eeruf_board::now(), black_box(&[0; $k])) {
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
                    _ => eeruf_board::set_alarm(ring_next_deadline(ring)),
                }
            }
        }
    };
}
