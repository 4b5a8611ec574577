//! `eeruf-core` for C. Nothing allocates: schedule and ring live in memory of the caller, and all that a caller may do
//! wrong has an error code. A ring belongs to one context: hand echo edges of an interrupt over to the main loop, or
//! keep interrupts off around the calls.
#![cfg_attr(target_os = "none", no_std)]
// Names and documents are those of the header.
#![allow(non_camel_case_types, clippy::doc_markdown)]

#[cfg(target_os = "none")]
mod panic;

use core::mem::MaybeUninit;

use eeruf_core::{
    Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingError, RingEvent, Schedule,
    ScheduleError, ScheduledRing, SensorError,
};

/// The most sensors of a ring.
pub const EERUF_MAX_SENSORS: usize = 24;

/// What a call came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum EerufStatus {
    /// Fine.
    EERUF_OK = 0,
    /// Fine, and there is an event: handle it and poll again.
    EERUF_EVENT = 1,
    /// A pointer is null.
    EERUF_NULL = -1,
    /// A schedule or a ring was not set up, or its memory was overwritten.
    EERUF_NOT_SET_UP = -2,
    /// The number of sensors is not 1 to EERUF_MAX_SENSORS.
    EERUF_SENSORS = -3,
    /// The period is not 1 us to 268 s.
    EERUF_PERIOD = -4,
    /// A sensor would fire after its period has ended.
    EERUF_FIRE = -5,
    /// The window is longer than the shortest time between two firings of a sensor, or not longer than the blanking
    /// time or t_delta, or one of these two is longer than 65,535 us.
    EERUF_WINDOW = -6,
    /// The number of consecutive readings is not 2 to 8.
    EERUF_CONSECUTIVE = -7,
    /// There is no such sensor.
    EERUF_NO_SUCH_SENSOR = -8,
    /// The schedule does not meet what is asked of it.
    EERUF_NOT_MET = -9,
    /// The schedule was not verified, or for a smaller t_delta or a shorter window.
    EERUF_NOT_VERIFIED = -10,
}
use EerufStatus::*;

/// Memory for a schedule. Set it up with eeruf_schedule_init before any other use; do not copy or change it.
#[derive(Debug)]
#[repr(C)]
pub struct EerufSchedule {
    /// Not for the caller.
    private_words: [u64; 80],
}

/// Memory for a ring. Set it up with eeruf_ring_init before any other use; do not copy or change it.
#[derive(Debug)]
#[repr(C)]
pub struct EerufRing {
    /// Not for the caller.
    private_words: [u64; 72],
}

/// How a ring listens and compares.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct EerufConfig {
    /// Consecutive readings that differ by no more are near-identical.
    pub t_delta_us: u32,
    /// How long a sensor listens after it has fired.
    pub window_us: u32,
    /// Edges sooner than this after firing are no echoes.
    pub blanking_us: u32,
    /// How many readings running must agree, 2 to 8.
    pub consecutive: u8,
}

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum EerufEventKind {
    /// Fire the sensor, now.
    EERUF_FIRE_SENSOR = 0,
    /// What became of a firing of the sensor: see `reading`.
    EERUF_READING = 1,
    /// A period has ended.
    EERUF_PERIOD_ENDED = 2,
}

/// What came of a firing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum EerufReadingKind {
    /// An echo with nothing to compare it with.
    EERUF_FIRST = 0,
    /// Near-identical to the reading before: it counts.
    EERUF_ACCEPTED = 1,
    /// Not near-identical to the reading before.
    EERUF_REJECTED = 2,
    /// Near-identical, but not yet often enough.
    EERUF_REPEATED = 3,
    /// No echo, once.
    EERUF_NO_ECHO = 4,
    /// No echo several times running: nothing is in range.
    EERUF_CLEAR = 5,
    /// Nothing but an edge within the blanking time.
    EERUF_TOO_EARLY = 6,
    /// An edge after the window had ended.
    EERUF_LATE = 7,
    /// The echo line was stuck.
    EERUF_STUCK = 8,
}
use EerufReadingKind::*;

/// An event of a ring.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct EerufEvent {
    /// Which of the following count.
    pub kind: EerufEventKind,
    /// What came of the firing; for a reading.
    pub reading: EerufReadingKind,
    /// The sensor, from 0; for a firing and a reading.
    pub sensor: u8,
    /// The phase that its wait belongs to, 0 or 1, or which has ended.
    pub phase: u8,
    /// Whether the reading has an echo time.
    pub has_echo: bool,
    /// The echo time.
    pub t_echo_us: u32,
    /// The period in which the sensor fired, or which has ended; for a reading and a period.
    pub period: u32,
    /// When the sensor was due; for a firing.
    pub due_us: u32,
}

const K: usize = EERUF_MAX_SENSORS;
const SCHEDULE_READY: u32 = 0x4545_5346;
const RING_READY: u32 = 0x4545_5247;

/// What is in the caller's memory.
struct Ready<T> {
    ready: u32,
    value: T,
}
type ReadySchedule = Ready<Schedule<K>>;
type ReadyRing = Ready<ScheduledRing<'static, K>>;

const _: () = {
    assert!(size_of::<ReadySchedule>() <= size_of::<EerufSchedule>(), "EerufSchedule is too small");
    assert!(align_of::<ReadySchedule>() <= align_of::<EerufSchedule>(), "EerufSchedule is not aligned");
    assert!(size_of::<ReadyRing>() <= size_of::<EerufRing>(), "EerufRing is too small");
    assert!(align_of::<ReadyRing>() <= align_of::<EerufRing>(), "EerufRing is not aligned");
};

unsafe fn schedule_in<'a>(schedule: *const EerufSchedule) -> Result<&'a Schedule<K>, EerufStatus> {
    // SAFETY: the caller hands in null or memory of the asserted size; `ready` says whether it was set up.
    match unsafe { schedule.cast::<ReadySchedule>().as_ref() } {
        None => Err(EERUF_NULL),
        Some(memory) if memory.ready != SCHEDULE_READY => Err(EERUF_NOT_SET_UP),
        Some(memory) => Ok(&memory.value),
    }
}

unsafe fn ring_in<'a>(ring: *mut EerufRing) -> Result<&'a mut ScheduledRing<'static, K>, EerufStatus> {
    // SAFETY: as in `schedule_in`.
    match unsafe { ring.cast::<ReadyRing>().as_mut() } {
        None => Err(EERUF_NULL),
        Some(memory) if memory.ready != RING_READY => Err(EERUF_NOT_SET_UP),
        Some(memory) => Ok(&mut memory.value),
    }
}

/// Makes a schedule of the firing times of each sensor in phases a and b, `sensors` times each, in microseconds from
/// the start of the period.
///
/// # Safety
/// `schedule` is null or memory for a schedule; `fire_a_us` and `fire_b_us` are null or `sensors` long.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_schedule_init(
    schedule: *mut EerufSchedule,
    period_us: u32,
    sensors: usize,
    fire_a_us: *const u32,
    fire_b_us: *const u32,
) -> EerufStatus {
    if schedule.is_null() || fire_a_us.is_null() || fire_b_us.is_null() {
        return EERUF_NULL;
    }
    if sensors == 0 || sensors > K {
        return EERUF_SENSORS;
    }
    let mut times = [[Micros::ZERO; K]; 2];
    for (times, from) in times.iter_mut().zip([fire_a_us, fire_b_us]) {
        // SAFETY: the caller says that there are so many.
        let from = unsafe { core::slice::from_raw_parts(from, sensors) };
        for (time, &us) in times.iter_mut().zip(from) {
            *time = Micros::new(us);
        }
    }
    let lags = [Micros::ZERO; K];
    let [a, b] = &times;
    let (Some(lags), Some(a), Some(b)) = (lags.get(..sensors), a.get(..sensors), b.get(..sensors)) else {
        return EERUF_SENSORS;
    };
    match Schedule::from_slices(Micros::new(period_us), lags, [a, b]) {
        Ok(value) => {
            // SAFETY: memory of the asserted size, for the caller says so.
            let memory = unsafe { &mut *schedule.cast::<MaybeUninit<ReadySchedule>>() };
            memory.write(Ready { ready: SCHEDULE_READY, value });
            EERUF_OK
        }
        Err(ScheduleError::Period { .. }) => EERUF_PERIOD,
        Err(ScheduleError::Fire { .. }) => EERUF_FIRE,
        Err(_) => EERUF_SENSORS,
    }
}

/// Verifies a schedule on a line of sensors: EERUF_OK if crosstalk is rejected at this `t_delta_us` (Eqs. 13a, 13b),
/// any `neighbours` adjacent sensors fire at least `min_interval_us` apart, and no sensor fires again within
/// `window_us`; the schedule then remembers it. EERUF_NOT_MET if not; the schedule is then as before. Not for a
/// schedule that a ring uses.
///
/// # Safety
/// `schedule` is null or memory for a schedule, and no ring uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_schedule_verify(
    schedule: *mut EerufSchedule,
    t_delta_us: u32,
    min_interval_us: u32,
    neighbours: u8,
    window_us: u32,
) -> EerufStatus {
    // SAFETY: as for the caller.
    let found = match unsafe { schedule_in(schedule) } {
        Ok(found) => found,
        Err(status) => return status,
    };
    let requirements = Requirements {
        min_interval: Micros::new(min_interval_us),
        layout: Layout::Line(neighbours),
        window: Micros::new(window_us),
        ..Requirements::new(Micros::new(t_delta_us))
    };
    let Ok(verified) = found.verify(&requirements).verified() else { return EERUF_NOT_MET };
    // SAFETY: memory of the asserted size, for the caller says so; nothing else refers to it.
    let memory = unsafe { &mut *schedule.cast::<MaybeUninit<ReadySchedule>>() };
    memory.write(Ready { ready: SCHEDULE_READY, value: verified.into_schedule() });
    EERUF_OK
}

/// Makes a ring that fires by a verified schedule from `now_us` on. It may ask for a smaller `t_delta_us` and a shorter
/// window than the schedule was verified for. The schedule must stay where it is as long as the ring is used.
///
/// # Safety
/// `ring`, `schedule` and `config` are null or memory of their types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_init(
    ring: *mut EerufRing,
    schedule: *const EerufSchedule,
    config: *const EerufConfig,
    now_us: u32,
) -> EerufStatus {
    // SAFETY: as for the caller.
    match unsafe { schedule_in(schedule) } {
        Ok(found) if !found.is_verified() => EERUF_NOT_VERIFIED,
        // SAFETY: as for the caller.
        Ok(_) => unsafe { eeruf_ring_init_unverified(ring, schedule, config, now_us) },
        Err(status) => status,
    }
}

/// As eeruf_ring_init, by a schedule that need not be verified: the conventional method, for comparison. Crosstalk may
/// be accepted.
///
/// # Safety
/// As for eeruf_ring_init.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_init_unverified(
    ring: *mut EerufRing,
    schedule: *const EerufSchedule,
    config: *const EerufConfig,
    now_us: u32,
) -> EerufStatus {
    // SAFETY: as for the caller.
    let schedule = match unsafe { schedule_in(schedule) } {
        Ok(schedule) => schedule,
        Err(status) => return status,
    };
    // SAFETY: as for the caller.
    let Some(config) = (unsafe { config.as_ref() }) else { return EERUF_NULL };
    if ring.is_null() {
        return EERUF_NULL;
    }
    let config = RingConfig::new()
        .with_t_delta(Micros::new(config.t_delta_us))
        .with_window(Micros::new(config.window_us))
        .with_blanking(Micros::new(config.blanking_us))
        .with_consecutive(config.consecutive);
    match Ring::unverified(schedule, config, Instant::from_micros(now_us)) {
        Ok(value) => {
            // SAFETY: memory of the asserted size, for the caller says so.
            let memory = unsafe { &mut *ring.cast::<MaybeUninit<ReadyRing>>() };
            memory.write(Ready { ready: RING_READY, value });
            EERUF_OK
        }
        Err(RingError::Filter(_)) => EERUF_CONSECUTIVE,
        Err(RingError::TDelta { .. } | RingError::VerifiedWindow { .. }) => EERUF_NOT_VERIFIED,
        Err(_) => EERUF_WINDOW,
    }
}

/// EERUF_EVENT with the next thing to do or to know, or EERUF_OK if there is none at `now_us`: then sleep until the
/// next deadline.
///
/// # Safety
/// `ring` and `event` are null or memory of their types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_poll(ring: *mut EerufRing, now_us: u32, event: *mut EerufEvent) -> EerufStatus {
    if event.is_null() {
        return EERUF_NULL;
    }
    // SAFETY: as for the caller.
    let ring = match unsafe { ring_in(ring) } {
        Ok(ring) => ring,
        Err(status) => return status,
    };
    let mut written = EerufEvent {
        kind: EerufEventKind::EERUF_FIRE_SENSOR,
        reading: EERUF_FIRST,
        sensor: 0,
        phase: 0,
        has_echo: false,
        t_echo_us: 0,
        period: 0,
        due_us: 0,
    };
    match ring.poll(Instant::from_micros(now_us)) {
        None => return EERUF_OK,
        Some(RingEvent::Fire { sensor, phase, due }) => {
            (written.sensor, written.phase, written.due_us) = (sensor, phase.0, due.as_micros());
        }
        Some(RingEvent::Reading(reading)) => {
            written.kind = EerufEventKind::EERUF_READING;
            (written.sensor, written.phase) = (reading.sensor, reading.phase.0);
            written.period = reading.period;
            written.has_echo = reading.t_echo.is_some();
            written.t_echo_us = reading.t_echo.map_or(0, Micros::as_micros);
            written.reading = match reading.kind {
                ReadingKind::First => EERUF_FIRST,
                ReadingKind::Accepted => EERUF_ACCEPTED,
                ReadingKind::Rejected => EERUF_REJECTED,
                ReadingKind::Repeated => EERUF_REPEATED,
                ReadingKind::NoEcho => EERUF_NO_ECHO,
                ReadingKind::Clear => EERUF_CLEAR,
                ReadingKind::TooEarly => EERUF_TOO_EARLY,
                ReadingKind::Late => EERUF_LATE,
                // The last there is.
                _ => EERUF_STUCK,
            };
        }
        Some(RingEvent::PeriodEnded(stats)) => {
            written.kind = EerufEventKind::EERUF_PERIOD_ENDED;
            (written.phase, written.period) = (stats.phase.0, stats.period);
        }
    }
    // SAFETY: not null, and the caller's.
    unsafe { event.write(written) };
    EERUF_EVENT
}

/// When to poll next, on the caller's clock of microseconds, which may wrap.
///
/// # Safety
/// `ring` and `deadline_us` are null or memory of their types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_next_deadline(ring: *mut EerufRing, deadline_us: *mut u32) -> EerufStatus {
    if deadline_us.is_null() {
        return EERUF_NULL;
    }
    // SAFETY: as for the caller; not null.
    match unsafe { ring_in(ring) } {
        Ok(ring) => {
            // SAFETY: not null, and the caller's.
            unsafe { deadline_us.write(ring.next_deadline().as_micros()) };
            EERUF_OK
        }
        Err(status) => status,
    }
}

unsafe fn with_sensor(
    ring: *mut EerufRing,
    call: impl FnOnce(&mut ScheduledRing<'static, K>) -> Result<(), SensorError>,
) -> EerufStatus {
    // SAFETY: as for the caller.
    match unsafe { ring_in(ring) }.map(call) {
        Ok(Ok(())) => EERUF_OK,
        Ok(Err(_)) => EERUF_NO_SUCH_SENSOR,
        Err(status) => status,
    }
}

/// An edge on the echo line of a sensor, at this reading of the clock.
///
/// # Safety
/// `ring` is null or memory for a ring.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_echo(ring: *mut EerufRing, sensor: u8, at_us: u32) -> EerufStatus {
    // SAFETY: as for the caller.
    unsafe { with_sensor(ring, |ring| ring.echo(sensor, Instant::from_micros(at_us))) }
}

/// The sensor that was to be fired last has really fired at this reading of the clock, later than the poll said.
/// Optional; call it before the next poll. Echo times count from then, and all later firings move by as much.
///
/// # Safety
/// `ring` is null or memory for a ring.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_fired(ring: *mut EerufRing, sensor: u8, at_us: u32) -> EerufStatus {
    // SAFETY: as for the caller.
    unsafe { with_sensor(ring, |ring| ring.fired(sensor, Instant::from_micros(at_us))) }
}

/// The echo line of a sensor was high when it was to be fired.
///
/// # Safety
/// `ring` is null or memory for a ring.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_stuck(ring: *mut EerufRing, sensor: u8) -> EerufStatus {
    // SAFETY: as for the caller.
    unsafe { with_sensor(ring, |ring| ring.stuck(sensor)) }
}

/// Has a sensor fire, or no more.
///
/// # Safety
/// `ring` is null or memory for a ring.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eeruf_ring_enable(ring: *mut EerufRing, sensor: u8, enabled: bool) -> EerufStatus {
    let call = |ring: &mut ScheduledRing<'static, K>| if enabled { ring.enable(sensor) } else { ring.disable(sensor) };
    // SAFETY: as for the caller.
    unsafe { with_sensor(ring, call) }
}
