//! Settings that a `Ring` is made with, from Python's arguments.

use eeruf_core::{EachSensor, Instant, MAX_SENSORS, Micros, RingConfig, flow::TurnSettings};
use pyo3::prelude::*;

use crate::{
    arguments::{micros, micros_or, whole_or},
    errors::ArgumentError,
    flow_settings::FlowSettings,
    moments::instant,
    requirements::{RequirementArguments, UnevenArguments},
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

/// Needs of a ring by flow: its window, what its sensors need of their own, and how far they hear.
pub(crate) struct FlowNeeds<'a, 'py> {
    pub(crate) window_us: &'a Bound<'py, PyAny>,
    pub(crate) uneven: UnevenArguments<'a, 'py>,
    pub(crate) blanking_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) reach_us: Option<&'a Bound<'py, PyAny>>,
}

impl FlowNeeds<'_, '_> {
    /// Checked, with the gaps of the ring, and with the limits of each sensor where they are not all alike.
    pub(crate) fn of(
        &self,
        sensors: usize,
        settings: &FlowSettings,
    ) -> PyResult<(TurnSettings, RingConfig, EachSensor<MAX_SENSORS>)> {
        let &Self { window_us, uneven, blanking_us, reach_us } = self;
        let needs = RequirementArguments {
            uneven,
            ..RequirementArguments::alike(None, None, None, None, None, (Some(window_us), None))
        };
        let needs = needs.of(sensors, settings.belief().t_delta)?;
        let [_, window] = needs.most();
        let blanking = micros_or("blanking_us", blanking_us, Micros::ZERO)?;
        let reach = reach_us.map(|reach| micros("reach_us", reach)).transpose()?;
        let turns = settings.turns(window, blanking, reach)?.keeping(&needs.requirements());
        let limits = TurnSettings::limits(sensors, &needs.requirements());
        let limits = limits.map_err(|error| ArgumentError::new_err(format!("{error:#}")))?;
        Ok((turns, RingConfig::new().with_window(window).with_blanking(blanking), limits))
    }
}
