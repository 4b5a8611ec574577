//! What a `Ring` is made with, from Python's arguments.

use eeruf_core::{Instant, Micros, RingConfig};
use pyo3::prelude::*;

use crate::{
    arguments::{micros, whole_or},
    moments::instant,
};

pub(crate) fn config(
    t_delta: Micros,
    window: Micros,
    blanking_us: Option<&Bound<'_, PyAny>>,
    consecutive: Option<&Bound<'_, PyAny>>,
) -> PyResult<RingConfig> {
    Ok(RingConfig::new()
        .with_blanking(blanking_us.map_or(Ok(Micros::ZERO), |value| micros("blanking_us", value))?)
        .with_consecutive(whole_or("consecutive", consecutive, 2, 0..=u8::MAX)?)
        .with_t_delta(t_delta)
        .with_window(window))
}

/// When a ring begins, by default at 0.
pub(crate) fn begins(now_us: Option<&Bound<'_, PyAny>>) -> PyResult<Instant> {
    now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))
}
