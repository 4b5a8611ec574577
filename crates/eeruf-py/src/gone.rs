//! Descriptors of removed members, which name their replacement.

use pyo3::{exceptions::PyAttributeError, prelude::*};

/// A descriptor of a removed member that names its replacement.
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct Gone {
    name: &'static str,
    instead: &'static str,
}

impl Gone {
    pub(crate) const fn new(name: &'static str, instead: &'static str) -> Self {
        Self { name, instead }
    }
}

#[pymethods]
impl Gone {
    fn __get__(&self, _instance: Option<&Bound<'_, PyAny>>, _owner: Option<&Bound<'_, PyAny>>) -> PyResult<Py<PyAny>> {
        let Self { name, instead } = self;
        Err(PyAttributeError::new_err(format!("eeruf.{name} is gone; eeruf.{instead} does it")))
    }
}
