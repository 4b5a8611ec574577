//! Declarations of `shim.c`.

use std::ffi::c_void;

unsafe extern "C" {
    pub(crate) fn shim_new() -> *mut c_void;
    pub(crate) fn shim_free(handle: *mut c_void);
    pub(crate) fn shim_schedule(
        handle: *mut c_void,
        period_us: u32,
        min_refire_us: u32,
        sensors: u8,
        phases: u8,
        order: *const u8,
        gap_us: *const u32,
    );
    pub(crate) fn shim_verified(handle: *mut c_void, number: u32, numbers: *const u32, own: *const u32) -> i32;
    pub(crate) fn shim_ring(
        handle: *mut c_void,
        schedule: u32,
        listening: *const u32,
        consecutive: u8,
        now_us: u32,
    ) -> i32;
    pub(crate) fn shim_upcoming(handle: *const c_void, number: u8, out: *mut u32) -> i32;
    pub(crate) fn shim_watch(handle: *mut c_void, sensors: u8, now_us: u32) -> i32;
    pub(crate) fn shim_state(handle: *const c_void, sensor: u8, now_us: u32, out: *mut u32) -> i32;
    pub(crate) fn shim_poll(handle: *mut c_void, now_us: u32, change_us: *const i32, out: *mut u32) -> i32;
    pub(crate) fn shim_deadline(handle: *const c_void) -> u32;
    pub(crate) fn shim_do(handle: *mut c_void, what: u32, sensor: u8, value: u32) -> i32;
    pub(crate) fn shim_between(handle: *mut c_void, what: u32, sensor: u8, least: u32, most: u32) -> i32;
    pub(crate) fn shim_modules(handle: *mut c_void, min_retrigger_us: u32, shortest_us: u16) -> i32;
    pub(crate) fn shim_flow(handle: *mut c_void, sensors: u8, numbers: *const u32, own: *const u32, now_us: u32)
    -> i32;
    pub(crate) fn shim_moving(handle: *mut c_void, speed_mm_s: u32, turn_mrad_s: u32, now_us: u32) -> i32;
    pub(crate) fn shim_quiet(handle: *const c_void, sensor: u8, out: *mut u32);
    pub(crate) fn shim_explain(handle: *mut c_void, explained_by: u8);
    pub(crate) fn shim_serial_event(handle: *mut c_void, sensors: u8, now_us: u32, frame: *mut u8) -> usize;
    pub(crate) fn shim_edges_new();
    pub(crate) fn shim_edges_push(sensor: u8, high: u8, at_us: u32) -> i32;
    pub(crate) fn shim_edges_pop(out: *mut u32) -> i32;
    pub(crate) fn eeruf_sound_mm_s(celsius_tenths: i16) -> u32;
    pub(crate) fn eeruf_distance_mm(t_echo_us: u32, c_mm_s: u32) -> u32;
}
