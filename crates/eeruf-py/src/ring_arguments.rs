//! Settings of a new `Ring`, from Python's arguments.

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, RingConfig,
    flow::{BeliefSettings, TurnSettings},
};
use pyo3::prelude::*;

use crate::{
    arguments::{micros, micros_or, shown, whole_or, wrong},
    errors::EerufError,
    flow_settings::FlowSettings,
    moments::instant,
    needs::Needs,
    requirements::{self, Asked, each},
};

/// P and R, the limits of paths of sound, as given in Python.
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

/// Start of a ring, by default 0.
pub(crate) fn begins(now_us: Option<&Bound<'_, PyAny>>) -> PyResult<Instant> {
    now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))
}

/// Needs of a flow ring: its window, the needs of single sensors, and the reach of sound.
pub(crate) struct FlowNeeds<'a, 'py> {
    pub(crate) asked: Asked<'py>,
    pub(crate) blanking_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) reach_us: Option<&'a Bound<'py, PyAny>>,
}

/// The parts of a flow ring: sensors, belief, plan and times, and the limits of each sensor if they are not all alike.
type FlowRingOf = (usize, BeliefSettings, TurnSettings, RingConfig, EachSensor<MAX_SENSORS>);

impl<'py> FlowNeeds<'_, 'py> {
    /// Checks the arguments, and returns the parts of the ring; with a `Needs`, they come from its modules.
    pub(crate) fn of(&self, sensors: &Bound<'py, PyAny>, settings: Option<&Bound<'_, PyAny>>) -> PyResult<FlowRingOf> {
        let &Self { ref asked, blanking_us, reach_us } = self;
        let config = |window, blanking| RingConfig::new().with_window(window).with_blanking(blanking);
        if let Some(needs) = Needs::given(sensors)? {
            asked.none("")?;
            for (name, value) in [("blanking_us", blanking_us), ("reach_us", reach_us)] {
                value.map_or(Ok(()), |value| Err(wrong(name, shown(value), "none beside a Needs, which says it")))?;
            }
            let ring = needs.ring();
            let flow = ring.flow(1).map_err(EerufError::new_err)?;
            let settings = FlowSettings::over(settings, flow.belief)?;
            let (turns, belief) = (settings.turns_over(flow.turns), settings.belief_over(flow.belief));
            return Ok((ring.sensors, belief, turns, config(flow.window, flow.blanking), flow.limits));
        }
        let (sensors, settings) = (requirements::sensors(sensors)?, FlowSettings::of(settings)?);
        let belief = settings.belief();
        let window = each("window_us", &asked.must("window_us")?, 1)?;
        let ring = asked.spec(sensors, (belief.t_delta, vec![]), Micros::ZERO, window)?;
        let blanking = micros_or("blanking_us", blanking_us, Micros::ZERO)?;
        let reach = reach_us.map(|reach| micros("reach_us", reach)).transpose()?;
        let needs = ring.problem().requirements;
        let turns = settings.turns(ring.window, blanking, reach)?.keeping(&needs);
        let limits = TurnSettings::limits(sensors, &needs);
        let limits = limits.map_err(|error| EerufError::new_err(format!("{error:#}")))?;
        Ok((sensors, belief, turns, config(ring.window, blanking), limits))
    }
}
