//! Settings that a `Ring` is made with, from Python's arguments.

use eeruf_core::{Instant, Micros, RingConfig, hopping::HoppingListening};
use pyo3::prelude::*;

use crate::{
    arguments::{micros, micros_or, whole_or},
    moments::instant,
    requirements::each,
};

/// Limits of sound, as Python gives them.
pub(crate) struct Sound<'a, 'py> {
    pub(crate) path_change_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) audible_us: Option<&'a Bound<'py, PyAny>>,
}

pub(crate) fn config(
    t_delta: Micros,
    window: Micros,
    blanking_us: Option<&Bound<'_, PyAny>>,
    consecutive: Option<&Bound<'_, PyAny>>,
    sound: &Sound<'_, '_>,
) -> PyResult<RingConfig> {
    let given = |name, value: Option<&Bound<'_, PyAny>>| value.map(|value| micros(name, value)).transpose();
    let mut config = RingConfig::new()
        .with_blanking(micros_or("blanking_us", blanking_us, Micros::ZERO)?)
        .with_consecutive(whole_or("consecutive", consecutive, 2, 0..=u8::MAX)?)
        .with_t_delta(t_delta)
        .with_window(window);
    config.path_change = given("path_change_us", sound.path_change_us)?;
    config.audible = given("audible_us", sound.audible_us)?;
    Ok(config)
}

/// When a ring begins, by default at 0.
pub(crate) fn begins(now_us: Option<&Bound<'_, PyAny>>) -> PyResult<Instant> {
    now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))
}

/// Window, the longest where there is one for each sensor, blanking time and reach of a ring that hops or flows.
pub(crate) fn listening(
    window_us: &Bound<'_, PyAny>,
    blanking_us: Option<&Bound<'_, PyAny>>,
    reach_us: Option<&Bound<'_, PyAny>>,
) -> PyResult<HoppingListening> {
    let (window, _) = each("window_us", window_us, 0)?;
    Ok(HoppingListening::new(window)
        .with_blanking(micros_or("blanking_us", blanking_us, Micros::ZERO)?)
        .with_reach(micros_or("reach_us", reach_us, window)?))
}
