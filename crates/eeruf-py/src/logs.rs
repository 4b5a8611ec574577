//! Logs of robots: ranges, firings, and diagnoses. `python/eeruf/logs.py` is its public form.

use std::path::{Path, PathBuf};

use eeruf_core::ReadingKind;
use eeruf_logs::{Diagnosis, Firing, FiringLog, FoundPath, PathSettings, Settings};
use numpy::PyReadonlyArray1;
use pyo3::{create_exception, prelude::*, types::PyDict};

use crate::{
    arguments::{in_microseconds, micros, shown, wrong},
    columns::read_only,
    errors::{EerufError, warn},
    file_object::Work,
    watch::in_background,
};

create_exception!(
    eeruf,
    LogError,
    EerufError,
    "A log that cannot be read, with its file, its line, and what is expected.

Example:
    >>> import eeruf
    >>> eeruf.logs.read_log(\"no.bag\")
    Traceback (most recent call last):
    eeruf.LogError: no.bag: No such file or directory (os error 2); expected a file that exists
"
);

pub(crate) fn raise(error: impl std::fmt::Display) -> PyErr {
    LogError::new_err(error.to_string())
}

/// A path, or a file object under a name.
pub(crate) enum Source<'py> {
    Path(PathBuf),
    Object(Bound<'py, PyAny>, PathBuf),
}

impl<'py> Source<'py> {
    /// A path, or a named file object that Python's `_source` makes from anything else.
    pub(crate) fn of(source: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok((object, name)) = source.extract::<(Bound<'py, PyAny>, String)>() {
            return Ok(Self::Object(object, name.into()));
        }
        source.extract().map(Self::Path).map_err(|_| wrong("log", shown(source), "the path of a log"))
    }

    /// The log of firings.
    fn firings(self, py: Python<'_>) -> PyResult<FiringLog> {
        let log = match self {
            Self::Path(path) => in_background(py, None, move |_| FiringLog::read(&path).map_err(raise))?,
            Self::Object(object, name) => {
                let mut work = Work::begin(py, Some(&object), move |file, results| {
                    let Some(file) = file else { return };
                    results.hand_in(FiringLog::read_from(file, &name));
                })?;
                work.next(py)?.map_err(raise)?
            }
        };
        warn_of_each(py, log.doubts())?;
        Ok(log)
    }

    pub(crate) fn name(&self) -> &Path {
        match self {
            Self::Path(name) | Self::Object(_, name) => name,
        }
    }
}

pub(crate) fn warn_of_each(py: Python<'_>, warnings: Vec<String>) -> PyResult<()> {
    warnings.into_iter().try_for_each(|warning| warn(py, warning))
}

/// The columns common to all tables of firings.
fn fired<'a, 'py>(
    py: Python<'py>,
    firings: impl ExactSizeIterator<Item = &'a Firing> + Clone,
) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let column = |of: fn(&Firing) -> i64| read_only(py, firings.clone().map(of));
    out.set_item("sensor", column(|row| row.sensor.into())?)?;
    out.set_item("fired_us", column(|row| row.fired_us)?)?;
    out.set_item("period", column(|row| row.period.into())?)?;
    out.set_item("phase", column(|row| row.phase.into())?)?;
    let echo = |row: &Firing| row.t_echo_us.map_or(f64::NAN, f64::from);
    out.set_item("t_echo_us", read_only(py, firings.map(echo))?)?;
    Ok(out)
}

/// The firings of a log, as columns, with the clock and the damage.
#[pyfunction]
#[pyo3(name = "_read_firings")]
pub(crate) fn read_firings<'py>(source: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
    let py = source.py();
    let log = Source::of(source)?.firings(py)?;
    let rows = log.firings.iter().map(|row| (row, true)).chain(log.listened.iter().map(|row| (row, false)));
    let rows: Vec<_> = rows.collect();
    let out = fired(py, rows.iter().map(|row| row.0))?;
    let rejected = |row: &Firing| row.reading.map_or(-1, |kind| i64::from(kind.is_rejected()));
    out.set_item("rejected", read_only(py, rows.iter().map(|row| rejected(row.0)))?)?;
    out.set_item("sends", read_only(py, rows.iter().map(|row| row.1))?)?;
    out.set_item("clock", log.clock)?;
    out.set_item("damage", log.damage)?;
    Ok(out)
}

/// The path of a file to write.
pub(crate) fn out_file(out: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
    out.extract().map_err(|_| wrong("out", shown(out), "the path of an MCAP file to write, or None"))
}

/// Largest time, thirty years, so that differences of moments do not overflow.
const MOST_US: u64 = 1_000_000_000_000_000;

/// Columns of `eeruf.logs.Firings`.
#[derive(FromPyObject)]
pub(crate) struct Columns<'py> {
    sensor: PyReadonlyArray1<'py, i64>,
    fired_us: PyReadonlyArray1<'py, i64>,
    period: PyReadonlyArray1<'py, i64>,
    phase: PyReadonlyArray1<'py, i64>,
    t_echo_us: PyReadonlyArray1<'py, f64>,
    rejected: PyReadonlyArray1<'py, i64>,
    sends: PyReadonlyArray1<'py, bool>,
}

fn columns<'py>(firings: &Bound<'py, PyAny>) -> PyResult<Columns<'py>> {
    let expected = "an eeruf.logs.Firings of arrays with one dimension, as Firings.of makes it";
    firings.extract().map_err(|_| wrong("log", shown(firings), expected))
}

/// A log from columns of equal length, and the places of its firings, in order, in the columns.
fn log_of(columns: &Columns<'_>) -> PyResult<(FiringLog, Vec<usize>)> {
    let (sensor, fired_us, period) =
        (columns.sensor.as_array(), columns.fired_us.as_array(), columns.period.as_array());
    let (phase, t_echo_us) = (columns.phase.as_array(), columns.t_echo_us.as_array());
    let (rejected, sends) = (columns.rejected.as_array(), columns.sends.as_array());
    let length = sensor.len();
    let lengths = [fired_us.len(), period.len(), phase.len(), rejected.len(), t_echo_us.len(), sends.len()];
    if lengths.iter().any(|&other| other != length) {
        return Err(EerufError::new_err(format!("columns of {length} and {lengths:?} rows; expected equal lengths")));
    }
    let (mut firings, mut listened) = (Vec::new(), Vec::new());
    for row in 0..length {
        let bad = |name: &str, value: &dyn std::fmt::Display, expected: &str| {
            EerufError::new_err(format!("{name}[{row}] = {value}; expected {expected}"))
        };
        let echo = t_echo_us[row];
        if !(echo.is_nan() || (0.0..4e9).contains(&echo)) {
            return Err(bad("t_echo_us", &echo, "0 to 4e9, or NaN"));
        }
        if fired_us[row].unsigned_abs() > MOST_US {
            return Err(bad("fired_us", &fired_us[row], "at most 10^15 from 0"));
        }
        let known = u8::try_from(sensor[row]).ok().filter(|&sensor| sensor < 64);
        let firing = Firing {
            sensor: known.ok_or_else(|| bad("sensor", &sensor[row], "0 to 63"))?,
            fired_us: fired_us[row],
            period: u32::try_from(period[row]).map_err(|_| bad("period", &period[row], "0 to 4294967295"))?,
            phase: u8::try_from(phase[row]).map_err(|_| bad("phase", &phase[row], "0 to 255"))?,
            t_echo_us: (!echo.is_nan()).then(|| echo.round() as u32),
            reading: (rejected[row] == 1).then_some(ReadingKind::Rejected),
            g_us_ms: None,
        };
        if sends[row] {
            firings.push((row, firing));
        } else {
            listened.push(firing);
        }
    }
    in_microseconds("t_echo_us", t_echo_us.iter().copied())?;
    firings.sort_by_key(|firing| firing.1.fired_us);
    let (places, firings) = firings.into_iter().unzip();
    Ok((FiringLog { listened, ..FiringLog::new("columns", firings) }, places))
}

fn paths<'py>(py: Python<'py>, paths: &[FoundPath]) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let whole = |of: fn(&FoundPath) -> i64| read_only(py, paths.iter().map(of));
    let number = |of: fn(&FoundPath) -> f64| read_only(py, paths.iter().map(of));
    out.set_item("sender", whole(|path| path.sender.into())?)?;
    out.set_item("receiver", whole(|path| path.receiver.into())?)?;
    out.set_item("travel_us", number(|path| path.travel_us)?)?;
    out.set_item("travel_error_us", number(|path| path.travel_error_us)?)?;
    out.set_item("scatter_us", number(|path| path.scatter_us)?)?;
    out.set_item("supported", whole(|path| path.offsets.0.into())?)?;
    out.set_item("offsets", whole(|path| path.offsets.1.into())?)?;
    out.set_item("accidents", number(|path| path.accidents)?)?;
    out.set_item("readings", whole(|path| path.readings.into())?)?;
    out.set_item("heard", number(|path| path.heard)?)?;
    out.set_item("first_period", whole(|path| path.periods.0.into())?)?;
    out.set_item("last_period", whole(|path| path.periods.1.into())?)?;
    Ok(out)
}

/// Finds from columns which sensors fool each other.
#[pyfunction]
#[pyo3(name = "_diagnose")]
pub(crate) fn diagnose<'py>(
    firings: &Bound<'py, PyAny>,
    tolerance_us: &Bound<'py, PyAny>,
    max_travel_us: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let (py, firings) = (firings.py(), columns(firings)?);
    let tolerance_us = micros("tolerance_us", tolerance_us)?.as_micros();
    let max_travel_us = micros("max_travel_us", max_travel_us)?.as_micros();
    let rows = firings.sensor.as_array().len();
    let (log, places) = log_of(&firings)?;
    let settings = Settings { tolerance_us, max_travel_us, ..Settings::default() };
    let found: Diagnosis = in_background(py, None, move |background| {
        Ok(eeruf_logs::diagnose_while(&log, &settings, &|| !background.stop().is_stopped()))
    })?;
    let (mut sender, mut travel_us, mut sure) = (vec![-1_i64; rows], vec![f64::NAN; rows], vec![f64::NAN; rows]);
    for (&place, named) in places.iter().zip(&found.named) {
        if let Some(named) = named {
            (sender[place], travel_us[place], sure[place]) = (named.sender.into(), named.travel_us, named.sure);
        }
    }
    let out = PyDict::new(py);
    // A `Vec<u8>` would become `bytes`.
    let whole = |sensors: Vec<u8>| sensors.into_iter().map(u32::from).collect::<Vec<_>>();
    out.set_item("paths", paths(py, &found.paths)?)?;
    out.set_item("sender", read_only(py, sender.into_iter())?)?;
    out.set_item("travel_us", read_only(py, travel_us.into_iter())?)?;
    out.set_item("sure", read_only(py, sure.into_iter())?)?;
    let faults = found.faults.iter().map(|fault| (fault.symptom.as_str(), [fault.sensor]));
    out.set_item("faults", faults.collect::<Vec<_>>())?;
    out.set_item("silent", whole(found.silent()))?;
    out.set_item("moved", found.moved)?;
    out.set_item("most_offsets", found.most_offsets)?;
    Ok(out)
}

/// Finds from the columns of a measuring run which sensors hear each other.
#[pyfunction]
#[pyo3(name = "_survey")]
pub(crate) fn survey<'py>(
    firings: &Bound<'py, PyAny>,
    tolerance_us: &Bound<'py, PyAny>,
    until_us: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let py = firings.py();
    let (log, _) = log_of(&columns(firings)?)?;
    let tolerance_us = micros("tolerance_us", tolerance_us)?.as_micros();
    let until_us = micros("until_us", until_us)?.as_micros();
    let settings = PathSettings { tolerance_us, ..PathSettings::default() };
    let found = in_background(py, None, move |background| {
        Ok(eeruf_logs::survey_while(&log, &settings, &|| !background.stop().is_stopped()))
    })?;
    let out = PyDict::new(py);
    out.set_item("paths", paths(py, &found.paths)?)?;
    out.set_item("conflicts", found.conflicts(until_us))?;
    Ok(out)
}
