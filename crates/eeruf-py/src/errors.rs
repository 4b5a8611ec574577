//! Errors of Rust as exceptions, with the same messages: `EerufError`, a `ValueError`, with two subclasses that
//! programs catch separately, for logs and for certificates.

use std::ffi::CString;
use std::fmt::Display;
use std::path::Path;

use eeruf_sim::SimulationError;
use pyo3::{
    create_exception,
    exceptions::{PyMemoryError, PyUserWarning, PyValueError},
    prelude::*,
};

create_exception!(
    eeruf,
    EerufError,
    PyValueError,
    "Something eeruf cannot do with what it was given; a ``ValueError``, and the base of all others.

Example:
    >>> import eeruf
    >>> try:
    ...     eeruf.design(sensors=65, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
    ... except eeruf.EerufError as error:
    ...     print(error)
    sensors = 65; expected a whole number from 1 to 64
"
);

create_exception!(
    eeruf,
    EerufWarning,
    PyUserWarning,
    "Input that is legal and implausible, such as milliseconds for microseconds; a ``UserWarning``.

Example:
    >>> import eeruf, warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter(\"error\", eeruf.EerufWarning)
    ...     eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36)
    Traceback (most recent call last):
    eeruf.EerufWarning: window_us = 36; expected 1000 to 1000000; likely milliseconds: times are microseconds
"
);

/// Warns about something implausible; an error if the user turned warnings into errors.
pub(crate) fn warn(py: Python<'_>, message: impl Display) -> PyResult<()> {
    // Reports escape control characters, so that a zero is rare.
    let message = CString::new(message.to_string().replace('\0', "?")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<EerufWarning>(), &message, 1)
}

/// Warns about the implausible values of a file.
pub(crate) fn warn_of(py: Python<'_>, file: &Path, text: &str) -> PyResult<()> {
    eeruf_files::doubts_in(text).into_iter().try_for_each(|found| warn(py, found.in_file(file)))
}

create_exception!(
    eeruf,
    CertificateError,
    EerufError,
    "A certificate that proves nothing, or not that a period is the shortest; the message says why.

Example:
    >>> import eeruf
    >>> eeruf.check_certificate(\"\")
    Traceback (most recent call last):
    eeruf.CertificateError: line 1: found '', expected a line eeruf-certificate
"
);

/// Converts an error of Rust to its exception.
pub(crate) trait Raise {
    fn raise(self) -> PyErr;
}

macro_rules! raised {
    ($($rust:ty),+ $(,)?) => {$(
        impl Raise for $rust {
            fn raise(self) -> PyErr {
                EerufError::new_err(from_zero(&self))
            }
        }
    )+};
}

/// Formats an error with sensors counted from 0, as in code.
fn from_zero(error: &impl Display) -> String {
    format!("{error:#}")
}

raised! {
    eeruf_core::conditions::Violation,
    eeruf_core::RingError,
    eeruf_core::ScheduleError,
    eeruf_core::search::SearchError,
    eeruf_core::SensorError,
    eeruf_design::NoDesign,
    eeruf_files::FileError,
    eeruf_sim::experiments::ExperimentError,
    eeruf_sim::PathsError,
    eeruf_sim::SceneError,
    eeruf_sim::WorldError,
}

impl Raise for SimulationError {
    fn raise(self) -> PyErr {
        match self {
            Self::Memory { .. } => PyMemoryError::new_err(from_zero(&self)),
            _ => EerufError::new_err(from_zero(&self)),
        }
    }
}
