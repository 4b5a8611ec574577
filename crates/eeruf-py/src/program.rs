//! The program `eeruf` within the wheel, and its examples.

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::arguments;
use crate::errors::EerufError;

#[cfg(feature = "program")]
pub(crate) use eeruf::{Recording, examples, run};

/// Substitute for the program in packages built without it.
#[cfg(not(feature = "program"))]
mod without {
    use std::ffi::OsString;
    use std::path::Path;

    use eeruf_sim::{Readings, Simulation};

    /// A recording that cannot exist, since only the program writes them.
    pub(crate) enum Recording {}

    impl Recording {
        pub(crate) fn create(file: &Path, _: &Simulation) -> Result<Self, String> {
            Err(format!("{}: not written, as this package was built without the program", file.display()))
        }

        pub(crate) fn add(&mut self, _: &Simulation, _: &Readings) -> Result<(), String> {
            match *self {}
        }

        pub(crate) fn finish(self) -> Result<(), String> {
            match self {}
        }
    }

    pub(crate) fn run(_: Vec<OsString>) -> u8 {
        eprintln!("eeruf: this package was built without the program");
        2
    }

    pub(crate) mod examples {
        pub(crate) fn all() -> Vec<(String, &'static str)> {
            vec![]
        }

        pub(crate) fn text(_: &str) -> Option<&'static str> {
            None
        }
    }
}
#[cfg(not(feature = "program"))]
pub(crate) use without::{Recording, examples, run};

/// Runs the program with the words of a command line, its own name first, and returns its exit code.
#[pyfunction]
#[pyo3(name = "_run_program")]
pub(crate) fn run_program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| run(words))
}

/// The text of an example file: a scene for :meth:`sim.Scene.from_toml`, or a ring for the command ``eeruf design``.
///
/// ``eeruf examples DIR`` writes them all into a folder.
///
/// Args:
///     name: the example's name, such as ``"scenes/alcove.toml"``; the error for an unknown name lists them all.
///
/// Raises:
///     EerufError: there is no such example.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
///     <Scene: 3 walls, 0 poles, 1 robots>
#[pyfunction]
pub(crate) fn example(name: &Bound<'_, PyAny>) -> PyResult<&'static str> {
    let name = arguments::text("name", name, "the name of an example")?;
    examples::text(&name).ok_or_else(|| {
        let names: Vec<_> = examples::all().into_iter().map(|(name, _)| name).collect();
        if names.is_empty() {
            return EerufError::new_err("no examples: this package was built without the program");
        }
        EerufError::new_err(format!("name: {name:?}; expected one of {}", names.join(", ")))
    })
}
