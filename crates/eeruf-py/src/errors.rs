//! One exception for each enum of errors in Rust, with the same messages. All are subclasses of `EerufError`, which is
//! a `ValueError`.

use std::ffi::CString;
use std::fmt::Display;
use std::path::Path;

use eeruf_sim::SimulationError as SimulatorError;
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

macro_rules! errors {
    ($($name:ident $doc:literal $(from $($rust:ty),+)?;)*) => {$(
        create_exception!(eeruf, $name, EerufError, $doc);
        $($(impl Raise for $rust {
            fn raise(self) -> PyErr {
                $name::new_err(from_zero(&self))
            }
        })+)?
    )*};
}

/// Converts an error of Rust to its exception.
pub(crate) trait Raise {
    fn raise(self) -> PyErr;
}

/// An error with sensors counted from 0, as in code, while the program prints them from 1.
fn from_zero(error: &impl Display) -> String {
    format!("{error:#}")
}

impl Raise for eeruf_core::RingError {
    fn raise(self) -> PyErr {
        RingError::new_err(from_zero(&self))
    }
}

impl Raise for SimulatorError {
    fn raise(self) -> PyErr {
        match self {
            Self::Memory { .. } => PyMemoryError::new_err(from_zero(&self)),
            _ => SimulationError::new_err(from_zero(&self)),
        }
    }
}

errors! {
    ArgumentError "An argument of the wrong type, shape or range, which it names.

Example:
    >>> import eeruf
    >>> eeruf.EchoFilter(sensors=0, t_delta_us=500)
    Traceback (most recent call last):
    eeruf.ArgumentError: sensors = 0; expected a whole number from 1 to 64
" from eeruf_core::SensorError;
    ScheduleError "Numbers that make no schedule.

Example:
    >>> import eeruf
    >>> eeruf.Schedule.from_firing(40_000, [0, 50_000], [0, 2_000])
    Traceback (most recent call last):
    eeruf.ScheduleError: sensor 1 fires 50 ms into phase a; expected less than the period of 40 ms
" from eeruf_core::ScheduleError;
    FilterError "A filter that cannot compare as asked.

Example:
    >>> import eeruf
    >>> eeruf.EchoFilter(4, 500, consecutive=9)
    Traceback (most recent call last):
    eeruf.FilterError: 9 consecutive readings; expected 2 to 8
";
    RingError "A ring that cannot listen as asked.

Example:
    >>> import eeruf
    >>> eeruf.Ring(eeruf.tables.TABLE_I_D, 500, window_us=0)
    Traceback (most recent call last):
    eeruf.RingError: a blanking time of 0 us; expected less than the window of 0 us, and at most 65.535 ms
" from eeruf_core::conditions::Violation;
    SearchError "Needs that make no sense or are too large to search.

Example:
    >>> import eeruf
    >>> eeruf.WaitSearch(4, 40_000, 8_000, tick_us=3_000, t_delta_us=999)
    Traceback (most recent call last):
    eeruf.SearchError: a lag of 10 ms; expected a whole number of ticks of 3 ms
" from eeruf_core::search::SearchError, eeruf_design::NoDesign;
    CertificateError "A certificate that proves nothing, or not that a period is the shortest; the message says why.

Example:
    >>> import eeruf
    >>> eeruf.check_certificate(\"\")
    Traceback (most recent call last):
    eeruf.CertificateError: line 1: found '', expected a line eeruf-certificate
";
    SceneError "Walls, poles, robots or noise that make no scene.

Example:
    >>> import eeruf
    >>> eeruf.sim.Scene([[0, 0, 0, 0]])
    Traceback (most recent call last):
    eeruf.SceneError: wall 0 is 0 m long; expected at least 0.000001 m
" from eeruf_sim::SceneError, eeruf_sim::WorldError, eeruf_files::FileError;
    PathsError "Paths that cannot be found.

Example:
    >>> import eeruf
    >>> eeruf.sim.Scene([[5, 2, -5, 2]]).paths((0, 0), (1, 0), max_order=1001)
    Traceback (most recent call last):
    eeruf.PathsError: paths up to order 1001; expected at most 1000
" from eeruf_sim::PathsError;
    SimulationError "A simulation that cannot be run.

Example:
    >>> import eeruf
    >>> robot = eeruf.sim.Robot((0, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3, window_us=90_000)
    >>> scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[robot])
    >>> eeruf.sim.simulate(scene)
    Traceback (most recent call last):
    eeruf.SimulationError: robot 0, method eeruf: a listening window of 90 ms; expected at most 45.6 ms, \
    after which a sensor of this schedule fires again (T_wind)
";
    ExperimentError "An experiment that cannot be run.

Example:
    >>> import eeruf
    >>> eeruf.experiments.set_one(seeds=1, methods=[])
    Traceback (most recent call last):
    eeruf.ExperimentError: no methods; expected at least one
" from eeruf_sim::experiments::ExperimentError;
}
