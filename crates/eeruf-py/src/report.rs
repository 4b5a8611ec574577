//! `Report`, the result of `Schedule.verify`, with its `Violation`s.

use eeruf_core::{MAX_SENSORS, Micros, conditions::Verification};
use pyo3::{prelude::*, types::PyTuple};

use crate::fields::record;

/// Findings of `Schedule.verify`, in Python's form.
pub(crate) fn report<'py>(py: Python<'py>, found: &Verification<'_, MAX_SENSORS>) -> PyResult<Bound<'py, PyAny>> {
    let violations = found.violations().map(|violation| {
        let (kind, source) = (violation.kind.as_str(), violation.kind.source());
        let phases = (violation.phases.0.to_string(), violation.phases.1.to_string());
        let [value_us, required_us] = [violation.value, violation.required].map(Micros::as_micros);
        record(py, "Violation", (kind, violation.sensors, phases, value_us, required_us, source))
    });
    let violations = PyTuple::new(py, violations.collect::<PyResult<Vec<_>>>()?)?;
    let separation_us = found.separation().map(|separation| separation.value.as_micros());
    let min_interval_us = found.min_interval().map(|interval| interval.value.as_micros());
    let (max_t_delta_us, min_refire_us) = (found.max_t_delta().map(Micros::as_micros), found.min_refire().as_micros());
    record(py, "Report", (separation_us, max_t_delta_us, min_interval_us, min_refire_us, violations))
}
