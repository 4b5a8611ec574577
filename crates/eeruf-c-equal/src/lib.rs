//! The C library in `c/`, behind safe functions of numbers, and what compares it with the Rust crates: rings of each
//! kind that both run, given the same random numbers, and that must say the same. The tests draw the numbers from
//! seeds, the fuzz target from bytes.
//!
//! Nothing here is for others: firmware in Rust uses `eeruf-core`, firmware in C uses `c/eeruf.h`.

pub mod core_side;
pub mod flow;
pub mod line_faults;
pub mod modules;
mod random;
pub mod ring;
mod shim;
pub mod world;

use std::ffi::c_void;

pub use random::Random;

/// An event as numbers: kind, sensor, phase, then what the kind has.
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
    ChangeSchedule,
    SetTDelta,
    SetWindow,
    SetBlanking,
    Edge,
    FireModule,
    CannotRead,
    CannotWrite,
    ModuleFired,
    ChangeModules,
    Health,
    IsEnabled,
    Adapt,
    SetPathChange,
    SetAudible,
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

/// A value between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "named as the functions of eeruf.h")]
pub enum Between {
    Echo,
    Measured,
    Edge,
    Look,
}

/// A schedule's numbers after it was verified, or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "named as the fields of EerufSchedule")]
pub struct Numbers {
    pub min_refire_us: u32,
    pub window_us: u32,
    pub separation_us: u32,
    pub max_speed_mm_s: u32,
}

/// Requirements as numbers.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "named as the fields of EerufRequirements")]
pub struct Needs {
    pub t_delta_us: u32,
    pub min_interval_us: u32,
    pub window_us: u32,
    pub layout: u8,
    pub neighbours: u8,
    pub stale_echo: bool,
}

/// Needs of one sensor: `window_us`, `t_delta_us` and `group` of an EerufLimits.
pub type OwnNeeds = [u32; 3];

/// A ring in C, of either kind, with its schedules and modules, in memory of exactly the size that it needs.
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
    /// Nothing yet.
    pub fn new() -> Self {
        // SAFETY: takes nothing.
        Self(unsafe { shim::shim_new() })
    }

    /// `eeruf_schedule_make` of times by phase and sensor: its status. Schedules are numbered as they are made.
    pub fn schedule(&mut self, period_us: u32, sensors: u8, phases: u8, t_fire_us: &[u32]) -> i32 {
        assert_eq!(t_fire_us.len(), usize::from(sensors) * usize::from(phases));
        // SAFETY: as many times as there are sensors and phases.
        unsafe { shim::shim_schedule(self.0, period_us, sensors, phases, t_fire_us.as_ptr()) }
    }

    /// `eeruf_schedule_verify` of the schedule with this number, and `eeruf_schedule_check` if that is fine.
    pub fn verify(&mut self, schedule: u32, needs: Needs, own: &[OwnNeeds]) -> (i32, Numbers) {
        let Needs { t_delta_us, min_interval_us, window_us, layout, neighbours, stale_echo } = needs;
        let mut out = [0; 4];
        let stale_echo = stale_echo.into();
        let own = if own.is_empty() { std::ptr::null() } else { own.as_ptr().cast() };
        // SAFETY: a schedule that was made, three numbers for each of its sensors, and room for four numbers.
        let status = unsafe {
            shim::shim_verify(
                self.0,
                schedule,
                t_delta_us,
                min_interval_us,
                window_us,
                layout,
                neighbours,
                stale_echo,
                own,
                out.as_mut_ptr(),
            )
        };
        let [min_refire_us, window_us, separation_us, max_speed_mm_s] = out;
        (status, Numbers { min_refire_us, window_us, separation_us, max_speed_mm_s })
    }

    /// `eeruf_ring_init_unverified` with `t_delta_us`, `window_us`, `blanking_us`, `path_change_us`, `audible_us`.
    pub fn ring(&mut self, schedule: u32, listening: [u32; 5], consecutive: u8, now_us: u32) -> i32 {
        // SAFETY: a schedule that was made, and five numbers.
        unsafe { shim::shim_ring(self.0, schedule, listening.as_ptr(), consecutive, now_us) }
    }

    /// The next event, or the status of a poll without one.
    pub fn poll(&mut self, now_us: u32, change_us: Option<&[i32]>) -> Result<Flat, i32> {
        let mut flat = [0; 18];
        let change_us = change_us.map_or(std::ptr::null(), <[i32]>::as_ptr);
        // SAFETY: a number for each sensor, and room for an event.
        let status = unsafe { shim::shim_poll(self.0, now_us, change_us, flat.as_mut_ptr()) };
        if status == EVENT { Ok(flat) } else { Err(status) }
    }

    /// `eeruf_ring_upcoming` until there is none: sensors and instants.
    pub fn upcoming(&self) -> Vec<[u32; 2]> {
        let next = |number| {
            let mut out = [0; 2];
            // SAFETY: a ring that was made, and room for two numbers.
            let status = unsafe { shim::shim_upcoming(self.0, number, out.as_mut_ptr()) };
            (status == 0).then_some(out)
        };
        (0..=u8::MAX).map_while(next).collect()
    }

    /// `eeruf_watch_init`: the events of polls from now on are handed to it.
    pub fn watch(&mut self, sensors: u8, now_us: u32) -> i32 {
        // SAFETY: any numbers will do.
        unsafe { shim::shim_watch(self.0, sensors, now_us) }
    }

    /// `eeruf_watch_state`: kind, echo, age, why, explanation; or its status.
    pub fn state(&self, sensor: u8, now_us: u32) -> Result<[u32; 5], i32> {
        let mut out = [0; 5];
        // SAFETY: a watch that was made, and room for five numbers.
        let status = unsafe { shim::shim_state(self.0, sensor, now_us, out.as_mut_ptr()) };
        if status == 0 { Ok(out) } else { Err(status) }
    }

    /// `eeruf_ring_deadline`.
    pub fn deadline(&self) -> u32 {
        // SAFETY: a ring that was made.
        unsafe { shim::shim_deadline(self.0) }
    }

    /// One of the functions that take a sensor and a number.
    pub fn call(&mut self, what: Do, sensor: u8, value: u32) -> i32 {
        // SAFETY: a ring, or modules, that were made.
        unsafe { shim::shim_do(self.0, what as u32, sensor, value) }
    }

    /// One of the functions that take a sensor and two numbers.
    pub fn between(&mut self, what: Between, sensor: u8, least: u32, most: u32) -> i32 {
        // SAFETY: a ring, or modules, that were made.
        unsafe { shim::shim_between(self.0, what as u32, sensor, least, most) }
    }

    /// Makes the last event, a reading, an ambiguous one.
    pub fn explain(&mut self, explained_by: u8) {
        // SAFETY: an event that was polled.
        unsafe { shim::shim_explain(self.0, explained_by) }
    }

    /// The frame that `eeruf_serial_event` makes of the last poll's event, empty if it makes none.
    pub fn serial_event(&mut self, sensors: u8, now_us: u32) -> Vec<u8> {
        // As long as EERUF_FRAME.
        let mut frame = vec![0; 78];
        // SAFETY: a ring that was polled, and room for the longest frame.
        let size = unsafe { shim::shim_serial_event(self.0, sensors, now_us, frame.as_mut_ptr()) };
        frame.truncate(size);
        frame
    }

    /// `eeruf_hc_sr04_init`.
    pub fn modules(&mut self, min_retrigger_us: u32, shortest_us: u16) -> i32 {
        // SAFETY: a ring that was made.
        unsafe { shim::shim_modules(self.0, min_retrigger_us, shortest_us) }
    }

    /// `eeruf_adaptation_init` with all schedules made, and its settings.
    pub fn adaptation(&mut self, window: u8, patience: u8, noisy: u16, calm: u16) -> i32 {
        // SAFETY: schedules that were made.
        unsafe { shim::shim_adaptation(self.0, window, patience, noisy, calm) }
    }

    /// The adaptation's rung, and the rejection rate, 65,535 without one.
    pub fn rung(&self) -> (u32, u32) {
        let (mut rung, mut permille) = (0, 0);
        // SAFETY: room for both.
        unsafe { shim::shim_rung(self.0, &raw mut rung, &raw mut permille) };
        (rung, permille)
    }

    /// `eeruf_flow_init`, with the numbers in the order that `shim.c` names; `own` are the limits of each sensor, or
    /// empty.
    pub fn flow(&mut self, sensors: u8, numbers: &[u32], own: &[u32], now_us: u32) -> i32 {
        assert!(numbers.len() == 15 && (own.is_empty() || own.len() == 4 * usize::from(sensors)));
        let own = if own.is_empty() { std::ptr::null() } else { own.as_ptr() };
        // SAFETY: as many numbers as are read.
        unsafe { shim::shim_flow(self.0, sensors, numbers.as_ptr(), own, now_us) }
    }

    /// `eeruf_flow_moving`.
    pub fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now_us: u32) -> i32 {
        // SAFETY: a flow ring that was made.
        unsafe { shim::shim_moving(self.0, speed_mm_s, turn_mrad_s, now_us) }
    }

    /// `eeruf_flow_quiet_us` and `eeruf_flow_believed_us`.
    pub fn quiet_and_belief(&self, sensor: u8) -> [u32; 2] {
        let mut out = [0; 2];
        // SAFETY: a flow ring that was made, and room for two numbers.
        unsafe { shim::shim_quiet(self.0, sensor, out.as_mut_ptr()) };
        out
    }
}

/// `eeruf_filter_push` of a filter that holds these three numbers: kind, echo, previous echo, age, explanation.
pub fn filter(held: &mut [u32; 3], t_delta_us: u32, consecutive: u8, t_echo_us: u32, change_us: i32) -> [u32; 5] {
    let mut out = [0; 5];
    // SAFETY: room for what is held and for what comes out.
    let status = unsafe {
        shim::shim_filter(held.as_mut_ptr(), t_delta_us, consecutive, t_echo_us, change_us, out.as_mut_ptr())
    };
    assert_eq!(status, 0);
    out
}

/// `eeruf_sound_mm_s`.
pub fn sound_mm_s(celsius_tenths: i16) -> u32 {
    // SAFETY: any number will do, here and below.
    unsafe { shim::eeruf_sound_mm_s(celsius_tenths) }
}

/// `eeruf_distance_mm`.
pub fn distance_mm(t_echo_us: u32, c_mm_s: u32) -> u32 {
    // SAFETY: see above.
    unsafe { shim::eeruf_distance_mm(t_echo_us, c_mm_s) }
}

/// `eeruf_echo_time_us`.
pub fn echo_time_us(distance_mm: u32, c_mm_s: u32) -> u32 {
    // SAFETY: see above.
    unsafe { shim::eeruf_echo_time_us(distance_mm, c_mm_s) }
}

/// A queue of eight edges; there is one, so only one test uses it.
#[derive(Debug)]
pub struct Edges;

impl Edges {
    /// Empties it.
    pub fn new() -> Self {
        // SAFETY: its memory is C's own.
        unsafe { shim::shim_edges_new() };
        Self
    }

    /// `eeruf_edges_push`.
    pub fn push(&mut self, sensor: u8, high: bool, at_us: u32) {
        // SAFETY: it was made.
        unsafe { shim::shim_edges_push(sensor, high.into(), at_us) };
    }

    /// `eeruf_edges_pop`: sensor, level and instant, if there is one; and how many were lost.
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
