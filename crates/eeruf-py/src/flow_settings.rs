//! Settings of flow: a dict of those that differ from the default.

use eeruf_core::{Micros, flow::FlowSettings};
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{shown, text, whole, wrong},
    errors::ArgumentError,
};

/// A setting that is a time.
type Time = (&'static str, fn(&mut FlowSettings) -> &mut Micros);

const TIMES: [Time; 10] = [
    ("step_us", |settings| &mut settings.step),
    ("shortest_gap_us", |settings| &mut settings.shortest_gap),
    ("masked_adds_us", |settings| &mut settings.masked_adds),
    ("believed_takes_us", |settings| &mut settings.believed_takes),
    ("unserved_adds_us", |settings| &mut settings.unserved_adds),
    ("shortest_cycle_us", |settings| &mut settings.shortest_cycle),
    ("rest_us", |settings| &mut settings.rest),
    ("lead_us", |settings| &mut settings.lead),
    ("longest_cycle_us", |settings| &mut settings.longest_cycle),
    ("travel_us", |settings| &mut settings.travel),
];
const UNSERVED_AFTER: &str = "unserved_after";

/// The settings that an argument gives, by default those of every robot.
pub(crate) fn of(value: Option<&Bound<'_, PyAny>>) -> PyResult<FlowSettings> {
    let mut settings = FlowSettings::DEFAULT;
    let Some(value) = value else { return Ok(settings) };
    let expected = "a dict such as {\"masked_adds_us\": 5_000}";
    for (key, value) in value.cast::<PyDict>().map_err(|_| wrong("settings", shown(value), expected))? {
        let key = text("key of settings", &key, "the name of a setting of flow")?;
        if key == UNSERVED_AFTER {
            settings.unserved_after = whole(&key, &value, 1..=u8::MAX)?;
        } else if let Some((_, field)) = TIMES.iter().find(|(name, _)| *name == key) {
            *field(&mut settings) = Micros::new(whole(&key, &value, 0..=u32::MAX)?);
        } else {
            let names = TIMES.map(|(name, _)| name).join(", ");
            return Err(ArgumentError::new_err(format!(
                "no setting {key} of flow; expected one of {names}, {UNSERVED_AFTER}"
            )));
        }
    }
    Ok(settings)
}
