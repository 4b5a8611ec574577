//! `Report` and its `Violation`s.

use eeruf_core::{MAX_SENSORS, Micros};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{instance, items, shown, text, whole, whole_or_none, wrong},
    fields::{Reduced, reduce, repr, to_dict},
};

/// One condition that a schedule does not meet.
///
/// Example:
///     >>> from eeruf.tables import TABLE_I_B
///     >>> violation = TABLE_I_B.verify(t_delta_us=999, min_interval_us=15_000).violations[0]
///     >>> violation.kind, violation.value_us < violation.required_us, violation.source
///     ('interval', True, 'Sec. 3.1 c')
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Violation {
    /// The condition: ``"crosstalk_a"``, ``"crosstalk_b"``, ``"stale_echo"``, ``"interval"``, ``"window"``; where
    /// sensors are not all alike also ``"shared_line"``, ``"refire"`` or ``"together"``.
    kind: String,
    /// The two sensors, from 0; the same one twice where a condition is about one alone.
    sensors: (u8, u8),
    /// The phases in which they fire, each ``"a"`` or ``"b"``.
    phases: (String, String),
    /// Value of the schedule, in microseconds.
    value_us: u32,
    /// Value that the condition asks for, in microseconds.
    required_us: u32,
    /// Where the condition comes from, such as ``"Eq. (13a)"``.
    source: String,
}

const VIOLATION: [&str; 6] = ["kind", "sensors", "phases", "value_us", "required_us", "source"];

#[pymethods]
impl Violation {
    #[new]
    fn new(
        kind: &Bound<'_, PyAny>,
        sensors: &Bound<'_, PyAny>,
        phases: &Bound<'_, PyAny>,
        value_us: &Bound<'_, PyAny>,
        required_us: &Bound<'_, PyAny>,
        source: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let refused = |name, value| wrong(name, shown(value), "a pair");
        Ok(Self {
            kind: text("kind", kind, "the name of a condition")?,
            sensors: sensors.extract().map_err(|_| refused("sensors", sensors))?,
            phases: phases.extract().map_err(|_| refused("phases", phases))?,
            value_us: whole("value_us", value_us, 0..=u32::MAX)?,
            required_us: whole("required_us", required_us, 0..=u32::MAX)?,
            source: text("source", source, "a place in the paper")?,
        })
    }

    /// Its fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.Violation("window", (0, 0), ("a", "b"), 20_000, 36_000, "Sec. 3.1").to_dict()["sensors"]
    ///     [0, 0]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &VIOLATION)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &VIOLATION)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &VIOLATION)
    }
}

/// Findings of ``Schedule.verify``. It is true if all conditions hold.
///
/// Example:
///     >>> from eeruf.tables import TABLE_I_D
///     >>> bool(TABLE_I_D.verify(t_delta_us=999)), bool(TABLE_I_D.verify(t_delta_us=1_000))
///     (True, False)
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Report {
    /// The smaller left side of (13a), (13b) of the pair that is closest to failing, in microseconds; None for a single
    /// sensor.
    #[pyo3(get)]
    separation_us: Option<u32>,
    /// The largest ``T_delta`` at which (13a), (13b) (and the stale echo condition, if asked for) hold, in
    /// microseconds; None if none does.
    #[pyo3(get)]
    max_t_delta_us: Option<u32>,
    /// The smallest time between the firings of two neighbours, in microseconds; None without neighbours.
    #[pyo3(get)]
    min_interval_us: Option<u32>,
    /// The shortest time between two firings of one sensor, in microseconds.
    #[pyo3(get)]
    min_refire_us: u32,
    violations: Vec<Violation>,
}

impl Report {
    pub(crate) fn of(report: &eeruf_core::conditions::Verification<'_, MAX_SENSORS>) -> Self {
        let violations = report.violations().map(|violation| Violation {
            kind: violation.kind.as_str().to_owned(),
            sensors: violation.sensors,
            phases: (violation.phases.0.to_string(), violation.phases.1.to_string()),
            value_us: violation.value.as_micros(),
            required_us: violation.required.as_micros(),
            source: violation.kind.source().to_owned(),
        });
        Self {
            separation_us: report.separation().map(|separation| separation.value.as_micros()),
            max_t_delta_us: report.max_t_delta().map(Micros::as_micros),
            min_interval_us: report.min_interval().map(|interval| interval.value.as_micros()),
            min_refire_us: report.min_refire().as_micros(),
            violations: violations.collect(),
        }
    }
}

const REPORT: [&str; 5] = ["separation_us", "max_t_delta_us", "min_interval_us", "min_refire_us", "violations"];

#[pymethods]
impl Report {
    #[new]
    #[pyo3(signature = (separation_us, max_t_delta_us, min_interval_us, min_refire_us, violations))]
    fn new(
        separation_us: Option<&Bound<'_, PyAny>>,
        max_t_delta_us: Option<&Bound<'_, PyAny>>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        min_refire_us: &Bound<'_, PyAny>,
        violations: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let expected = "a sequence of eeruf.Violation";
        let of = items("violations", violations, expected)?;
        let one = |violation| instance::<Violation>("violations", violation, expected).map(|one| one.get().clone());
        Ok(Self {
            separation_us: whole_or_none("separation_us", separation_us, 0..=u32::MAX)?,
            max_t_delta_us: whole_or_none("max_t_delta_us", max_t_delta_us, 0..=u32::MAX)?,
            min_interval_us: whole_or_none("min_interval_us", min_interval_us, 0..=u32::MAX)?,
            min_refire_us: whole("min_refire_us", min_refire_us, 0..=u32::MAX)?,
            violations: of.iter().map(one).collect::<PyResult<_>>()?,
        })
    }

    /// Returns true if every condition holds.
    #[getter]
    fn ok(&self) -> bool {
        self.violations.is_empty()
    }

    /// Every violation, as a tuple of ``Violation``: first (13a), then (13b), stale echoes, intervals and windows.
    #[getter]
    fn violations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.violations.iter().cloned())
    }

    /// Its fields by their names, violations as dicts too: a dict of plain values.
    ///
    /// Example:
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> report = TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000).to_dict()
    ///     >>> report["ok"], report["min_interval_us"]
    ///     (True, 17000)
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let most = ["ok", "separation_us", "max_t_delta_us", "min_interval_us", "min_refire_us", "violations"];
        to_dict(slf, &most)
    }

    fn __bool__(&self) -> bool {
        self.ok()
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &REPORT)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &REPORT)
    }
}
