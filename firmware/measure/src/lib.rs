//! Common parts of the measured programs: a schedule of the paper's kind for any number of sensors, a ring in static
//! memory behind functions that are not inlined, one for each public function of `Ring`, and a counter of instructions.
#![no_std]

use core::hint::black_box;

use eeruf_board::{COUNTS_PER_1000_INSTRUCTIONS, say};
use eeruf_core::{Micros, Requirements, RingConfig, Schedule, VerifiedSchedule};

pub mod planned;

/// The paper's schedule for `K` sensors: groups of four, waits of `2 K` ms in phase a and 0, 2, 4, .. ms in phase b.
pub const fn plain<const K: usize>() -> VerifiedSchedule<K> {
    let longest = 2 * K as u32;
    let mut t_lag = [Micros::ZERO; K];
    let mut t_wait = [[Micros::from_millis(longest); K], [Micros::ZERO; K]];
    let mut x = 0;
    while x < K {
        t_lag[x] = Micros::from_millis((x as u32 % 4) * (longest + 1));
        t_wait[1][x] = Micros::from_millis(2 * x as u32);
        x += 1;
    }
    // Only ever evaluated when this crate is compiled.
    let Ok(schedule) = Schedule::new(Micros::from_millis(4 * (longest + 1)), t_lag, t_wait) else {
        panic!("not a schedule");
    };
    match schedule.verified(&Requirements::new(T_DELTA)) {
        Ok(verified) => verified,
        Err(_) => panic!("not a schedule for 999 us"),
    }
}

/// The `t_delta` of all measurements.
pub const T_DELTA: Micros = Micros::new(999);

/// The configuration of all measured rings.
pub const CONFIG: RingConfig = RingConfig::new().with_window(Micros::from_millis(36));

/// The fewest and the most instructions of one kind of call.
#[derive(Debug)]
pub struct Range {
    name: &'static str,
    fewest: u32,
    most: u32,
}

impl Range {
    /// Makes a range without a measurement.
    pub const fn new(name: &'static str) -> Self {
        Self { name, fewest: u32::MAX, most: 0 }
    }

    /// Adds a call that took this many counts of the board's counter.
    pub fn note(&mut self, counts: u32) {
        self.fewest = self.fewest.min(counts);
        self.most = self.most.max(counts);
    }

    /// Prints one line: name, fewest, most, without the cost of reading the counter.
    pub fn say(&self) {
        let nothing = (0..4).map(|_| counts(|| black_box(())).0).min().unwrap_or(0);
        let instructions = |counts: u32| {
            let thousandths = u64::from(counts.saturating_sub(nothing)) * 1000;
            let per_instruction = u64::from(COUNTS_PER_1000_INSTRUCTIONS);
            ((thousandths + per_instruction / 2) / per_instruction) as u32
        };
        say!(self.name, " ", instructions(self.fewest), " ", instructions(self.most));
    }
}

/// Returns the counts of the board's counter that a call takes, and its result.
pub fn counts<R>(call: impl FnOnce() -> R) -> (u32, R) {
    let before = eeruf_board::count();
    let result = call();
    // The timer of the Cortex-M3 board has 24 bits.
    (eeruf_board::count().wrapping_sub(before) & 0x00FF_FFFF, result)
}

/// Makes a program that contains only `Ring` for `K` sensors, in static memory. Its size minus that of the program
/// `size-bare` is the size of plan and filter.
#[macro_export]
macro_rules! ring_in_static_memory {
    ($k:literal) => {
        use core::cell::UnsafeCell;
        use core::hint::black_box;
        use core::mem::MaybeUninit;
        use eeruf_core::{Instant, Ring, RingError, RingEvent, ScheduledRing, SensorError, VerifiedSchedule};

        static SCHEDULE: VerifiedSchedule<$k> = $crate::plain();

        struct Memory(UnsafeCell<MaybeUninit<ScheduledRing<'static, $k>>>);
        // SAFETY: only `main` uses it.
        unsafe impl Sync for Memory {}
        static MEMORY: Memory = Memory(UnsafeCell::new(MaybeUninit::uninit()));

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_new(now: Instant) -> Result<ScheduledRing<'static, $k>, RingError> {
            Ring::new(&SCHEDULE, $crate::CONFIG, now)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_poll(ring: &mut ScheduledRing<'static, $k>, now: Instant) -> Option<RingEvent> {
            ring.poll(now)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_next_deadline(ring: &ScheduledRing<'static, $k>) -> Instant {
            ring.next_deadline()
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_echo(ring: &mut ScheduledRing<'static, $k>, sensor: u8, at: Instant) -> Result<(), SensorError> {
            ring.echo(sensor, at)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_stuck(ring: &mut ScheduledRing<'static, $k>, sensor: u8) -> Result<(), SensorError> {
            ring.stuck(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_disable(ring: &mut ScheduledRing<'static, $k>, sensor: u8) -> Result<(), SensorError> {
            ring.disable(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_enable(ring: &mut ScheduledRing<'static, $k>, sensor: u8) -> Result<(), SensorError> {
            ring.enable(sensor)
        }

        #[unsafe(no_mangle)]
        #[inline(never)]
        fn ring_restart(ring: &mut ScheduledRing<'static, $k>, now: Instant) {
            ring.restart(now);
        }

        fn ring_program() {
            // SAFETY: the only use of the memory.
            let memory = unsafe { &mut *MEMORY.0.get() };
            let Ok(ring) = ring_new(black_box(eeruf_board::now())) else { return };
            let ring = memory.write(ring);
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
                    _ => eeruf_board::set_alarm(ring_next_deadline(ring)),
                }
            }
        }
    };
}
