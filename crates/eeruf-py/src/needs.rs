//! `Needs`: a ring's needs of its schedule, with the keys of a ring file.

use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eeruf_design::RingSpec;
use eeruf_files::Kind;
use pyo3::{
    prelude::*,
    types::{PyDict, PyString, PyTuple},
};

use crate::arguments::{self, shown, wrong};
use crate::errors::{EerufError, warn_of};
use crate::faults::table_of;

/// Needs of a ring in one value: made from the keys of a ring file, such as ``module`` and ``speed_m_s``, or read from
/// one. :func:`design`, :meth:`Schedule.verify`, ``Ring`` and ``Ring.flow`` take it in place of the single times.
///
/// Args:
///     keys: the keys of a ring file, listed in docs/reference/ring-files.md. ``sensors`` and ``module`` are
///         enough.
///
/// Raises:
///     EerufError: a key that no ring file has, or a value that is wrong.
///
/// Example:
///     >>> import eeruf
///     >>> needs = eeruf.Needs(sensors=8, module="hc-sr04", layout="ring")
///     >>> found = eeruf.design(needs)
///     >>> found.value_us, found.schedule.verify(needs).ok
///     (68000, True)
///     >>> ring = eeruf.Ring(found.schedule, needs)
///     >>> ring.window_us == needs.window_us
///     True
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone)]
pub(crate) struct Needs {
    text: String,
    /// The ring file, if it names a URDF, which is looked up beside it.
    file: Option<PathBuf>,
    ring: Arc<RingSpec>,
}

impl PartialEq for Needs {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Hash for Needs {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
    }
}

impl Needs {
    fn of_text(py: Python<'_>, file: &Path, text: String) -> PyResult<Self> {
        let ring = RingSpec::in_file(file, &text).map_err(|error| EerufError::new_err(error.to_string()))?;
        warn_of(py, file, &text)?;
        let file = (!ring.places.urdf_links.is_empty()).then(|| file.to_owned());
        Ok(Self { text, file, ring: Arc::new(ring) })
    }

    /// The needs in an argument: a `Needs`, or the path of a ring file.
    pub(crate) fn given(value: &Bound<'_, PyAny>) -> PyResult<Option<Self>> {
        if let Ok(needs) = value.cast::<Self>() {
            return Ok(Some(needs.get().clone()));
        }
        let is_path = value.is_instance_of::<PyString>() || value.hasattr("__fspath__")?;
        if is_path { Self::read_toml(value).map(Some) } else { Ok(None) }
    }

    pub(crate) fn ring(&self) -> &RingSpec {
        &self.ring
    }
}

#[pymethods]
impl Needs {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let said = PyDict::new(py);
        for (key, value) in keys.into_iter().flatten().filter(|(_, value)| !value.is_none()) {
            said.set_item(key, value)?;
        }
        let text = toml::to_string(&table_of("", &said)?);
        let text = text.map_err(|error| EerufError::new_err(error.to_string()))?;
        let ring = RingSpec::from_text(&text).map_err(|error| EerufError::new_err(error.message().to_owned()))?;
        Ok(Self { text, file: None, ring: Arc::new(ring) })
    }

    /// Read needs from the text of a ring file.
    ///
    /// Args:
    ///     text: the text, in TOML.
    ///
    /// Raises:
    ///     EerufError: not a string; a wrong line, with what is expected.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.Needs.from_toml('sensors = 8\nmodule = "hc-sr04"').sensors
    ///     8
    #[staticmethod]
    fn from_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let of = arguments::text("text", text, "a ring in TOML")?;
        Self::of_text(text.py(), Path::new(""), of)
    }

    /// Read needs from a ring file, such as those in the folder ``rings``.
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
    ///     >>> _ = file.write_text(eeruf.example("rings/hc-sr04-8.toml"))
    ///     >>> eeruf.Needs.read_toml(file).sensors
    ///     8
    #[staticmethod]
    fn read_toml(path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let file: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a ring file"))?;
        let text = Kind::Ring.read(&file).map_err(|error| EerufError::new_err(error.to_string()))?;
        Self::of_text(path.py(), &file, text)
    }

    /// Write a ring file with the given keys.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> needs = eeruf.Needs(sensors=8, module="hc-sr04")
    ///     >>> eeruf.Needs.from_toml(needs.to_toml()) == needs
    ///     True
    fn to_toml(&self) -> &str {
        &self.text
    }

    /// The number of sensors.
    #[getter]
    fn sensors(&self) -> usize {
        self.ring.sensors
    }

    /// The largest ``T_delta`` that a robot at rest needs, in microseconds.
    #[getter]
    fn t_delta_us(&self) -> u32 {
        self.ring.t_delta.as_micros()
    }

    /// The least time between the firings of two neighbours, in microseconds.
    #[getter]
    fn min_interval_us(&self) -> u32 {
        self.ring.min_interval.as_micros()
    }

    /// ``T_wind``: the longest time for which a sensor listens, in microseconds.
    #[getter]
    fn window_us(&self) -> u32 {
        self.ring.listening.as_micros()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Needs.from_toml({})", PyString::new(py, &self.text).repr()?))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, needs) = (slf.py(), slf.get());
        let (how, of) = match &needs.file {
            Some(file) => ("read_toml", PyTuple::new(py, [file])?),
            None => ("from_toml", PyTuple::new(py, [&needs.text])?),
        };
        Ok((py.get_type::<Self>().getattr(how)?, of))
    }
}
