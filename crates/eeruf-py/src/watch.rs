//! Long work: Ctrl-C ends it, and who wants to may follow it.

use std::time::{Duration, Instant};

use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*, types::PyBool};

/// How often Python is asked whether to go on.
const EVERY: Duration = Duration::from_millis(50);

/// Asks Python now and then, from the thread that called, whether to go on.
pub(crate) struct Watch {
    progress: Option<Py<PyAny>>,
    last: Instant,
    error: Option<PyErr>,
}

impl Watch {
    /// `progress` is `None`, `True` for a progress bar, or a callable that takes the share done (or `None`) and a text.
    pub(crate) fn new(progress: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let progress = match progress {
            None => None,
            Some(flag) if flag.is_instance_of::<PyBool>() => {
                let module = flag.py().import("eeruf._progress")?;
                flag.is_truthy()?.then(|| module.call_method0("bar")).transpose()?
            }
            Some(call) if call.is_callable() => Some(call.clone()),
            Some(other) => {
                return Err(crate::arguments::wrong(
                    "progress",
                    other.repr()?,
                    "None, True or a callable (share, text)",
                ));
            }
        };
        Ok(Self { progress: progress.map(Bound::unbind), last: Instant::now(), error: None })
    }

    /// Whether to go on. Called as often as one likes: it looks at the clock first.
    pub(crate) fn go_on(&mut self, share: Option<f64>, text: impl FnOnce() -> String) -> bool {
        if self.error.is_some() {
            return false;
        }
        if self.last.elapsed() < EVERY {
            return true;
        }
        self.last = Instant::now();
        let asked = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (share, text())).map(drop),
                None => Ok(()),
            }
        });
        self.error = asked.err();
        self.error.is_none()
    }

    /// The result of the work, unless Python wanted it to end: then why. To be asked when all is done.
    pub(crate) fn outcome<T>(self, result: PyResult<T>) -> PyResult<T> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if let (Some(progress), true) = (self.progress, result.is_ok()) {
            Python::attach(|py| progress.call1(py, (Some(1.0), "done")).map(drop))?;
        }
        result
    }
}

/// What is raised where work was stopped and nobody says why.
pub(crate) fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}
