//! Safe wrappers of the C library in `c/`, and its comparison with the Rust crates: rings of each kind run in both
//! languages on the same random numbers and must give the same results. Tests draw these from seeds, the fuzz target
//! from bytes.
//!
//! For tests only: firmware in Rust uses `eeruf-core`, firmware in C uses `c/eeruf.h`.

pub mod core_side;
pub mod flow;
pub mod line_faults;
pub mod modules;
mod random;
pub mod ring;
mod shim;
pub mod world;

use std::ffi::c_void;

use eeruf_core::{Micros, Phase, Schedule, VerifiedSchedule, conditions::VerifiedFor};

pub use random::Random;

/// An event as numbers: kind, sensor, phase, then the fields of that kind.
pub type Flat = [u32; 18];
/// The number that stands for no echo, on both sides.
pub const NO_ECHO: u32 = u32::MAX;
/// The status of a poll that had an event.
pub const EVENT: i32 = 1;

/// Operations of a ring while it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "named as the functions of eeruf.h")]
pub enum Do {
    Echo,
    Fired,
    Stuck,
    Enable,
    Pause,
    Restart,
    Edge,
    FireModule,
    CannotRead,
    CannotWrite,
    ModuleFired,
    Health,
    IsEnabled,
    FiredAt,
    SetSilence,
    Answered,
    Unanswered,
    Forget,
    Measured,
    Triggered,
    Pulse,
    Holds,
    SetReportAfter,
}

/// Functions that take an echo or edge between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "named as the functions of eeruf.h")]
pub enum Between {
    Echo,
    Measured,
    Edge,
    Look,
}

/// The requirements that a schedule is to be verified for, as the fields of an EerufSchedule.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "named as the fields of EerufSchedule")]
pub struct Claim {
    pub verified_for: [u32; 6],
    pub layout: u8,
    pub neighbours: u8,
    pub stale_echo: bool,
}

impl Claim {
    /// Returns the claim of a verified schedule, without its layout.
    pub fn of(verified_for: VerifiedFor) -> Self {
        let VerifiedFor { t_delta, min_interval, window, separation, path_change, audible, .. } = verified_for;
        let path_change = path_change.map_or(u32::MAX, Micros::as_micros);
        let [t_delta, min_interval, window, separation, audible] =
            [t_delta, min_interval, window, separation, audible].map(Micros::as_micros);
        let verified_for = [t_delta, min_interval, window, separation, path_change, audible];
        Self { verified_for, layout: 3, neighbours: 0, stale_echo: false }
    }
}

/// Needs of one sensor: `window_us`, `t_delta_us` and `group` of an EerufLimits.
pub type OwnNeeds = [u32; 3];

/// A ring in C, by tables or by flow, with its schedules and modules, in memory of exactly the required size.
#[derive(Debug)]
pub struct C(*mut c_void);

impl Default for C {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for C {
    fn drop(&mut self) {
        // SAFETY: made by `shim_new`, and freed once.
        unsafe { shim::shim_free(self.0) }
    }
}

impl C {
    /// Makes a C side without a ring or schedules.
    pub fn new() -> Self {
        // SAFETY: takes nothing.
        Self(unsafe { shim::shim_new() })
    }

    /// Adds a schedule as an unverified table. Schedules are numbered in order.
    pub fn schedule<const K: usize, const M: usize>(&mut self, schedule: &Schedule<K, M>) {
        let (mut order, mut gaps) = (vec![], vec![]);
        for phase in (0..M as u8).map(Phase) {
            let mut before = Micros::ZERO;
            let fired = schedule.firing_order(phase).iter().map(|&x| schedule.t_fire(phase, x.into()));
            for at in fired.map(|at| at.expect("one of its sensors")).chain([schedule.period()]) {
                gaps.push(at.saturating_sub(before).as_micros());
                before = at;
            }
            order.extend_from_slice(schedule.firing_order(phase));
        }
        let [period, min_refire] = [schedule.period(), schedule.min_refire()].map(Micros::as_micros);
        let (sensors, order, gaps) = (schedule.sensors() as u8, order.as_ptr(), gaps.as_ptr());
        // SAFETY: as many numbers as sensors and phases need.
        unsafe { shim::shim_schedule(self.0, period, min_refire, sensors, M as u8, order, gaps) }
    }

    /// Adds a verified schedule as a table.
    ///
    /// # Panics
    /// If C does not verify it.
    pub fn verified_schedule<const K: usize>(&mut self, number: u32, schedule: &VerifiedSchedule<K>) {
        self.schedule(schedule.schedule());
        assert_eq!(self.verified(number, Claim::of(schedule.verified_for()), &[]), 0);
    }

    /// Calls `eeruf_schedule_check` for this schedule and claim, and stores the claim if that succeeds.
    pub fn verified(&mut self, number: u32, claim: Claim, own: &[OwnNeeds]) -> i32 {
        let Claim { verified_for: [t_delta, interval, window, separation, path_change, audible], .. } = claim;
        let [layout, neighbours, stale] = [claim.layout, claim.neighbours, claim.stale_echo.into()].map(u32::from);
        let numbers = [t_delta, interval, window, separation, path_change, audible, layout, neighbours, stale];
        let own = if own.is_empty() { std::ptr::null() } else { own.as_ptr().cast() };
        // SAFETY: a schedule that was made, three numbers for each of its sensors, and nine numbers.
        unsafe { shim::shim_verified(self.0, number, numbers.as_ptr(), own) }
    }

    /// Calls `eeruf_ring_init_unverified`; `listening`: `t_delta`, window, blanking, path change, audible time.
    pub fn ring(&mut self, schedule: u32, listening: [u32; 5], consecutive: u8, now_us: u32) -> i32 {
        // SAFETY: a schedule that was made, and five numbers.
        unsafe { shim::shim_ring(self.0, schedule, listening.as_ptr(), consecutive, now_us) }
    }

    /// Returns the next event, or the status of a poll without one.
    pub fn poll(&mut self, now_us: u32, change_us: Option<&[i32]>) -> Result<Flat, i32> {
        let mut flat = [0; 18];
        let change_us = change_us.map_or(std::ptr::null(), <[i32]>::as_ptr);
        // SAFETY: a number for each sensor, and room for an event.
        let status = unsafe { shim::shim_poll(self.0, now_us, change_us, flat.as_mut_ptr()) };
        if status == EVENT { Ok(flat) } else { Err(status) }
    }

    /// Calls `eeruf_ring_upcoming` until it returns nothing; lists sensors and instants.
    pub fn upcoming(&self) -> Vec<[u32; 2]> {
        let next = |number| {
            let mut out = [0; 2];
            // SAFETY: a ring that was made, and room for two numbers.
            let status = unsafe { shim::shim_upcoming(self.0, number, out.as_mut_ptr()) };
            (status == 0).then_some(out)
        };
        (0..=u8::MAX).map_while(next).collect()
    }

    /// Calls `eeruf_watch_init`; later polls pass their events to the watch.
    pub fn watch(&mut self, sensors: u8, now_us: u32) -> i32 {
        // SAFETY: any numbers will do.
        unsafe { shim::shim_watch(self.0, sensors, now_us) }
    }

    /// Calls `eeruf_watch_state`: kind, echo, age, why, explanation; or its status.
    pub fn state(&self, sensor: u8, now_us: u32) -> Result<[u32; 5], i32> {
        let mut out = [0; 5];
        // SAFETY: a watch that was made, and room for five numbers.
        let status = unsafe { shim::shim_state(self.0, sensor, now_us, out.as_mut_ptr()) };
        if status == 0 { Ok(out) } else { Err(status) }
    }

    /// Calls `eeruf_ring_deadline`.
    pub fn deadline(&self) -> u32 {
        // SAFETY: a ring that was made.
        unsafe { shim::shim_deadline(self.0) }
    }

    /// Calls a function that takes a sensor and a number.
    pub fn call(&mut self, what: Do, sensor: u8, value: u32) -> i32 {
        // SAFETY: a ring, or modules, that were made.
        unsafe { shim::shim_do(self.0, what as u32, sensor, value) }
    }

    /// Calls a function that takes a sensor and two numbers.
    pub fn between(&mut self, what: Between, sensor: u8, least: u32, most: u32) -> i32 {
        // SAFETY: a ring, or modules, that were made.
        unsafe { shim::shim_between(self.0, what as u32, sensor, least, most) }
    }

    /// Marks the last event, a reading, as ambiguous.
    pub fn explain(&mut self, explained_by: u8) {
        // SAFETY: an event that was polled.
        unsafe { shim::shim_explain(self.0, explained_by) }
    }

    /// The frame that `eeruf_serial_event` makes from the last poll's event; empty if there is none.
    pub fn serial_event(&mut self, sensors: u8, now_us: u32) -> Vec<u8> {
        // As long as EERUF_FRAME.
        let mut frame = vec![0; 78];
        // SAFETY: a ring that was polled, and room for the longest frame.
        let size = unsafe { shim::shim_serial_event(self.0, sensors, now_us, frame.as_mut_ptr()) };
        frame.truncate(size);
        frame
    }

    /// Calls `eeruf_hc_sr04_init` for the ring.
    pub fn modules(&mut self, min_retrigger_us: u32, shortest_us: u16) -> i32 {
        // SAFETY: a ring that was made.
        unsafe { shim::shim_modules(self.0, min_retrigger_us, shortest_us) }
    }

    /// Calls `eeruf_flow_init`, with the numbers in the order of `shim.c`; `own` has the limits of each sensor, or
    /// nothing.
    pub fn flow(&mut self, sensors: u8, numbers: &[u32], own: &[u32], now_us: u32) -> i32 {
        assert!(numbers.len() == 15 && (own.is_empty() || own.len() == 4 * usize::from(sensors)));
        let own = if own.is_empty() { std::ptr::null() } else { own.as_ptr() };
        // SAFETY: as many numbers as are read.
        unsafe { shim::shim_flow(self.0, sensors, numbers.as_ptr(), own, now_us) }
    }

    /// Calls `eeruf_flow_moving`.
    pub fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now_us: u32) -> i32 {
        // SAFETY: a flow ring that was made.
        unsafe { shim::shim_moving(self.0, speed_mm_s, turn_mrad_s, now_us) }
    }

    /// Calls `eeruf_flow_quiet_us` and `eeruf_flow_believed_us`.
    pub fn quiet_and_belief(&self, sensor: u8) -> [u32; 2] {
        let mut out = [0; 2];
        // SAFETY: a flow ring that was made, and room for two numbers.
        unsafe { shim::shim_quiet(self.0, sensor, out.as_mut_ptr()) };
        out
    }
}

/// Calls `eeruf_sound_mm_s`.
pub fn sound_mm_s(celsius_tenths: i16) -> u32 {
    // SAFETY: any number will do, here and below.
    unsafe { shim::eeruf_sound_mm_s(celsius_tenths) }
}

/// Calls `eeruf_distance_mm`.
pub fn distance_mm(t_echo_us: u32, c_mm_s: u32) -> u32 {
    // SAFETY: see above.
    unsafe { shim::eeruf_distance_mm(t_echo_us, c_mm_s) }
}

/// A queue of eight edges; there is one, so only one test uses it.
#[derive(Debug)]
pub struct Edges;

impl Edges {
    /// Empties the queue.
    pub fn new() -> Self {
        // SAFETY: its memory is C's own.
        unsafe { shim::shim_edges_new() };
        Self
    }

    /// Calls `eeruf_edges_push`.
    pub fn push(&mut self, sensor: u8, high: bool, at_us: u32) {
        // SAFETY: it was made.
        unsafe { shim::shim_edges_push(sensor, high.into(), at_us) };
    }

    /// Calls `eeruf_edges_pop`: sensor, level and instant, if there is one; and how many were lost.
    pub fn pop(&mut self) -> (Option<[u32; 3]>, u32) {
        let mut out = [0; 4];
        // SAFETY: room for four numbers.
        let status = unsafe { shim::shim_edges_pop(out.as_mut_ptr()) };
        let [sensor, high, at, lost] = out;
        ((status == 0).then_some([sensor, high, at]), lost)
    }
}

impl Default for Edges {
    fn default() -> Self {
        Self::new()
    }
}

/// Doctest of the project's README, here because published crates cannot include that file.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
