//! `Schedule`: the firing times of a ring's sensors.

use std::path::{Path, PathBuf};

use eeruf_core::{Micros, Phase};
use eeruf_files::{Kind, build, emit::Emit as _, explain_json};
use eeruf_sim::{AnySchedule, ScheduleFile};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::{
    arguments::{self, micros, shown, times, whole, wrong},
    errors::{EerufError, Raise, warn_of},
    fields::{Reduced, attributes, call, reduce, repr, to_dict},
    report::report,
    requirements::{ALIKE, Asked, UNEVEN},
};

/// The firing times of a ring's sensors, in the two phases that alternate from period to period. Immutable; schedules
/// are equal if all their times are.
///
/// Sensor ``x`` fires ``t_lag_us[x] + t_wait_a_us[x]`` after the beginning of an even period (phase a) and
/// ``t_lag_us[x] + t_wait_b_us[x]`` after that of an odd one (phase b). Times are whole microseconds below 2^32;
/// sensors count from 0, and are printed from 1. Schedules compare, hash and pickle, and their ``repr`` can be pasted
/// back.
///
/// Args:
///     period_us: the period, ``T_p``.
///     t_lag_us: ``T_lag`` of each sensor, 1 to 64 of them.
///     t_wait_a_us: ``T_wait`` of each sensor in phase a.
///     t_wait_b_us: ``T_wait`` of each sensor in phase b.
///
/// Raises:
///     EerufError: a time is not a whole number of microseconds, or negative; the lengths differ, there are no or
///         more than 64 sensors, or one would fire after its period's end.
///
/// Example:
///     >>> import eeruf
///     >>> two = eeruf.Schedule(40_000, t_lag_us=[0, 20_000], t_wait_a_us=[0, 0], t_wait_b_us=[2_000, 5_000])
///     >>> two.t_fire_b_us
///     (2000, 25000)
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq, Hash)]
pub(crate) struct Schedule(pub(crate) AnySchedule);

fn tuple<'py>(py: Python<'py>, times: &[Micros]) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, times.iter().map(|time| time.as_micros()))
}

const WAITS: [&str; 4] = ["period_us", "t_lag_us", "t_wait_a_us", "t_wait_b_us"];

impl Schedule {
    /// Firing time of each sensor in a phase, in microseconds.
    fn t_fire<'py>(&self, py: Python<'py>, phase: Phase) -> PyResult<Bound<'py, PyTuple>> {
        let fire = |sensor| self.0.t_fire(phase, sensor).unwrap_or_default().as_micros();
        PyTuple::new(py, (0..self.0.sensors()).map(fire))
    }

    /// The needs to check.
    fn asked<'py>(
        py: Python<'py>,
        call: &str,
        [t_delta_us, min_interval_us]: [Option<&Bound<'py, PyAny>>; 2],
        needs: Option<&Bound<'py, PyDict>>,
        more: &[&str],
    ) -> PyResult<Asked<'py>> {
        let placed = [("t_delta_us", t_delta_us), ("min_interval_us", min_interval_us)];
        Asked::of(py, call, placed, needs, &[&["criterion", "window_us"], &ALIKE, more])
    }

    /// Reads a schedule from a text; the path is for messages.
    fn of_text(py: Python<'_>, file: &Path, text: &str) -> PyResult<Self> {
        let schedule = build(text, |file: ScheduleFile| file.schedule());
        let schedule = schedule.map_err(|error| EerufError::new_err(error.in_file(file).to_string()))?;
        warn_of(py, file, text)?;
        Ok(Self(schedule))
    }
}

#[pymethods]
impl Schedule {
    #[new]
    fn new(
        period_us: &Bound<'_, PyAny>,
        t_lag_us: &Bound<'_, PyAny>,
        t_wait_a_us: &Bound<'_, PyAny>,
        t_wait_b_us: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let period = micros("period_us", period_us)?;
        let lag = times("t_lag_us", t_lag_us)?;
        let (a, b) = (times("t_wait_a_us", t_wait_a_us)?, times("t_wait_b_us", t_wait_b_us)?);
        AnySchedule::from_slices(period, &lag, [&a, &b]).map(Self).map_err(Raise::raise)
    }

    /// Make a schedule from firing times instead of lags and waits.
    ///
    /// Args:
    ///     period_us: the period, ``T_p``.
    ///     t_fire_a_us: the firing time of each sensor in phase a, 1 to 64 times below the period.
    ///     t_fire_b_us: the firing time of each sensor in phase b.
    ///
    /// Raises:
    ///     EerufError: a time is not a whole number of microseconds, or negative; as for ``Schedule``.
    ///
    /// Example:
    ///     >>> from eeruf import Schedule
    ///     >>> Schedule.from_firing(40_000, [0, 20_000], [2_000, 25_000]).sensors
    ///     2
    #[staticmethod]
    fn from_firing(
        period_us: &Bound<'_, PyAny>,
        t_fire_a_us: &Bound<'_, PyAny>,
        t_fire_b_us: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let period = micros("period_us", period_us)?;
        let (a, b) = (times("t_fire_a_us", t_fire_a_us)?, times("t_fire_b_us", t_fire_b_us)?);
        AnySchedule::from_slices(period, &vec![Micros::ZERO; a.len()], [&a, &b]).map(Self).map_err(Raise::raise)
    }

    /// Read a schedule as ``eeruf design --emit toml`` and :meth:`to_toml` write it.
    ///
    /// Args:
    ///     text: the contents of a file: ``period_us``, and ``t_lag_us``, ``t_wait_a_us``, ``t_wait_b_us`` or
    ///         ``t_fire_a_us``, ``t_fire_b_us``.
    ///
    /// Raises:
    ///     EerufError: not a string; the text is not TOML, a key is missing, or the numbers make no valid schedule.
    ///
    /// Example:
    ///     >>> from eeruf import Schedule
    ///     >>> Schedule.from_toml("period_us = 40000\nt_fire_a_us = [0]\nt_fire_b_us = [2000]").period_us
    ///     40000
    #[staticmethod]
    fn from_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = text.py();
        let text = arguments::text("text", text, "a schedule in TOML")?;
        Self::of_text(py, Path::new(""), &text)
    }

    /// Read a schedule file, such as those in the folder ``rings``.
    ///
    /// Args:
    ///     path: the path of the file.
    ///
    /// Raises:
    ///     EerufError: not a path; no such file, a file of another kind, or as for :meth:`from_toml`.
    ///
    /// Example:
    ///     >>> import eeruf, pathlib, tempfile
    ///     >>> file = pathlib.Path(tempfile.mkdtemp(), "ring.toml")
    ///     >>> _ = file.write_text(eeruf.tables.TABLE_I_D.to_toml())
    ///     >>> eeruf.Schedule.read_toml(file) == eeruf.tables.TABLE_I_D
    ///     True
    #[staticmethod]
    fn read_toml(path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = path.py();
        let path: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a schedule in TOML"))?;
        let text = Kind::Schedule.read(&path).map_err(|error| EerufError::new_err(error.to_string()))?;
        Self::of_text(py, &path, &text)
    }

    /// Read a schedule as :meth:`to_json` writes it, with the keys of :meth:`from_toml`.
    ///
    /// Args:
    ///     text: one JSON object.
    ///
    /// Raises:
    ///     EerufError: not a string; the text is not JSON, a key is missing, or the numbers make no valid schedule.
    ///
    /// Example:
    ///     >>> from eeruf import Schedule
    ///     >>> Schedule.from_json('{"period_us": 40000, "t_fire_a_us": [0], "t_fire_b_us": [2000]}').sensors
    ///     1
    #[staticmethod]
    fn from_json(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a schedule in JSON")?;
        let bad = |error: serde_json::Error| EerufError::new_err(explain_json(&error.to_string()).to_string());
        let file: ScheduleFile = serde_json::from_str(&text).map_err(bad)?;
        file.schedule().map(Self).map_err(EerufError::new_err)
    }

    /// The period ``T_p``, in microseconds.
    #[getter]
    fn period_us(&self) -> u32 {
        self.0.period().as_micros()
    }

    /// Number of sensors that fire.
    #[getter]
    fn sensors(&self) -> usize {
        self.0.sensors()
    }

    /// ``T_lag`` of each sensor, in microseconds; zeros if the schedule was made from firing times.
    #[getter]
    fn t_lag_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_lag())
    }

    /// ``T_wait`` of each sensor in phase a, in microseconds.
    #[getter]
    fn t_wait_a_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_wait(Phase::A))
    }

    /// ``T_wait`` of each sensor in phase b, in microseconds.
    #[getter]
    fn t_wait_b_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_wait(Phase::B))
    }

    /// Firing time of each sensor in phase a, in microseconds from the beginning of the period.
    #[getter]
    fn t_fire_a_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.t_fire(py, Phase::A)
    }

    /// Firing time of each sensor in phase b, in microseconds from the beginning of the period.
    #[getter]
    fn t_fire_b_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.t_fire(py, Phase::B)
    }

    /// Multiply all times by ``num / den`` (Sec. 3.1, proportional scaling), rounded to whole microseconds.
    ///
    /// Args:
    ///     num: the numerator, 1 to 2^32 - 1.
    ///     den: the denominator, 1 to 2^32 - 1.
    ///
    /// Returns:
    ///     The schedule; verify it again, since ``T_delta`` and the intervals scale as well.
    ///
    /// Raises:
    ///     EerufError: not whole numbers; one is zero, or the times become too long.
    ///
    /// Example:
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> TABLE_I_D.scaled(3, 5).period_us
    ///     60000
    fn scaled(&self, num: &Bound<'_, PyAny>, den: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (num, den) = (whole("num", num, 0..=u32::MAX)?, whole("den", den, 0..=u32::MAX)?);
        self.0.scaled(num, den).map(Self).map_err(Raise::raise)
    }

    /// Check every condition of the paper, sensor by sensor.
    ///
    /// Args:
    ///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for
    ///         all sensors or a sequence of one for each; two sensors need the separation of the larger. Or a
    ///         :class:`Needs`, or the path of a ring file, in place of all needs.
    ///     min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
    ///     neighbours: how many sensors in a row count as neighbours, 1 to 64.
    ///     layout: how they stand: ``"line"``, ``"ring"`` (the last beside the first), ``"blocks"`` of ``neighbours``,
    ///         or pairs of neighbours such as ``[(0, 1), (1, 2)]``.
    ///     criterion: how to read Eqs. (13a), (13b): ``"exact"``, or as the ``"paper"`` prints them.
    ///     window_us: ``T_wind``, for which a sensor listens: it must not fire again earlier. One for all, or a
    ///         sequence.
    ///     stale_echo: whether a sensor's own echo from the previous period must be rejected too.
    ///     refire_us: how soon a sensor may be triggered again, where that is later. One for all, or a sequence.
    ///     intervals_us: pairs of sensors with the least time between their firings, whatever the layout says:
    ///         ``[(0, 4, 9000)]``; 0 for none.
    ///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
    ///     together: groups of sensors that must fire at the same instants. No separation is required between them.
    ///
    /// Returns:
    ///     The report, which is true if all conditions hold.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type or out of range.
    ///
    /// Example:
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> report = TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000)
    ///     >>> report.ok, report.min_interval_us, report.max_t_delta_us
    ///     (True, 17000, 999)
    #[pyo3(signature = (t_delta_us, min_interval_us=None, **needs))]
    #[pyo3(text_signature = "($self, t_delta_us, min_interval_us=0, *, neighbours=4, layout=\"line\", \
            criterion=\"exact\", window_us=0, stale_echo=False, refire_us=None, intervals_us=None, \
            shared_lines=None, together=None)")]
    fn verify<'py>(
        &self,
        t_delta_us: &Bound<'py, PyAny>,
        min_interval_us: Option<&Bound<'py, PyAny>>,
        needs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = t_delta_us.py();
        let asked = Self::asked(py, "verify", [Some(t_delta_us), min_interval_us], needs, &UNEVEN)?;
        asked.check(&self.0, |needs| report(py, &self.0.verify(needs)))?
    }

    /// Write a schedule file, as the program reads it.
    ///
    /// Example:
    ///     >>> from eeruf import Schedule, tables
    ///     >>> Schedule.from_toml(tables.TABLE_I_D.to_toml()) == tables.TABLE_I_D
    ///     True
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// Write one JSON object with the keys of the schedule file.
    ///
    /// Example:
    ///     >>> import json
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> json.loads(TABLE_I_D.to_json())["period_us"]
    ///     100000
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&ScheduleFile::from(&self.0)).map_err(|error| EerufError::new_err(error.to_string()))
    }

    /// Write a Rust constant for firmware, which is checked when it is compiled.
    ///
    /// Args:
    ///     t_delta_us: the ``T_delta`` the constant is checked for; by default the largest that the schedule allows.
    ///     min_interval_us: as in :meth:`verify`.
    ///     neighbours: as in :meth:`verify`.
    ///     layout: as in :meth:`verify`.
    ///     criterion: as in :meth:`verify`.
    ///     window_us: as in :meth:`verify`.
    ///     stale_echo: as in :meth:`verify`.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type or out of range.
    ///
    /// Example:
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> "schedule!" in TABLE_I_D.to_rust(min_interval_us=15_000)
    ///     True
    #[pyo3(signature = (t_delta_us=None, min_interval_us=None, **needs))]
    #[pyo3(text_signature = "($self, t_delta_us=None, min_interval_us=0, *, neighbours=4, layout=\"line\", \
            criterion=\"exact\", window_us=0, stale_echo=False)")]
    fn to_rust<'py>(
        &self,
        py: Python<'py>,
        t_delta_us: Option<&Bound<'py, PyAny>>,
        min_interval_us: Option<&Bound<'py, PyAny>>,
        needs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<String> {
        let asked = Self::asked(py, "to_rust", [t_delta_us, min_interval_us], needs, &[])?;
        asked.check(&self.0, |needs| self.0.to_rust(needs))
    }

    /// Write a C99 header with the firing times and the requirements for which they were verified.
    ///
    /// Args:
    ///     t_delta_us: the ``T_delta`` the times were verified for; by default the largest that the schedule allows.
    ///     min_interval_us: as in :meth:`verify`.
    ///     neighbours: as in :meth:`verify`.
    ///     layout: as in :meth:`verify`.
    ///     criterion: as in :meth:`verify`.
    ///     window_us: as in :meth:`verify`.
    ///     stale_echo: as in :meth:`verify`.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type or out of range.
    ///
    /// Example:
    ///     >>> from eeruf.tables import TABLE_I_D
    ///     >>> "#include <stdint.h>" in TABLE_I_D.to_c(min_interval_us=15_000)
    ///     True
    #[pyo3(signature = (t_delta_us=None, min_interval_us=None, **needs))]
    #[pyo3(text_signature = "($self, t_delta_us=None, min_interval_us=0, *, neighbours=4, layout=\"line\", \
            criterion=\"exact\", window_us=0, stale_echo=False)")]
    fn to_c<'py>(
        &self,
        py: Python<'py>,
        t_delta_us: Option<&Bound<'py, PyAny>>,
        min_interval_us: Option<&Bound<'py, PyAny>>,
        needs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<String> {
        let asked = Self::asked(py, "to_c", [t_delta_us, min_interval_us], needs, &[])?;
        asked.check(&self.0, |needs| self.0.to_c(needs))
    }

    /// The times by name, like the arguments of ``Schedule``: a dict of plain values.
    ///
    /// Example:
    ///     >>> from eeruf import Schedule, tables
    ///     >>> Schedule(**tables.TABLE_I_D.to_dict()) == tables.TABLE_I_D
    ///     True
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &WAITS)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        // Without lags, the firing times are enough.
        if slf.get().0.t_lag().iter().any(|&lag| lag != Micros::ZERO) {
            return repr(slf, &WAITS);
        }
        call("Schedule.from_firing", &attributes(slf, &["period_us", "t_fire_a_us", "t_fire_b_us"])?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &WAITS)
    }
}
