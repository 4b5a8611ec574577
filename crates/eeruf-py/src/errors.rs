//! One exception for each enum of errors in Rust, with the same messages, all of them `EerufError`, which is a `ValueError`.

use pyo3::{create_exception, exceptions::PyValueError, prelude::*};

create_exception!(eeruf, EerufError, PyValueError, "Something eeruf cannot do with what it was given.");

macro_rules! errors {
    ($($name:ident $doc:literal $(from $($rust:ty),+)?;)*) => {$(
        create_exception!(eeruf, $name, EerufError, $doc);
        $($(impl Raise for $rust {
            fn raise(self) -> PyErr {
                $name::new_err(self.to_string())
            }
        })+)?
    )*};
}

/// Turns an error of Rust into its exception.
pub(crate) trait Raise {
    fn raise(self) -> PyErr;
}

errors! {
    ArgumentError "An argument of the wrong type, shape or range, which it names.";
    ScheduleError "Numbers that make no schedule." from eeruf_core::ScheduleError;
    FilterError "A filter that cannot compare as asked." from eeruf_core::FilterError;
    RingError "A ring that cannot listen as asked." from eeruf_core::RingError;
    SearchError "Needs that make no sense or are too large to search." from eeruf_core::search::SearchError;
    SceneError "Walls, poles, robots or noise that make no scene."
        from eeruf_sim::SceneError, eeruf_sim::WorldError, eeruf_sim::WorldFileError;
    PathsError "Paths that cannot be found." from eeruf_sim::PathsError;
    SimulationError "A simulation that cannot be run." from eeruf_sim::SimulationError;
    ExperimentError "An experiment that cannot be run." from eeruf_sim::experiments::ExperimentError;
}
