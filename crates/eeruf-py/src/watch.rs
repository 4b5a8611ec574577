//! Long work that Ctrl-C ends, with progress reports.

use std::{
    cell::RefCell,
    ops::ControlFlow,
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::{Duration, Instant},
};

use eeruf_sim::Stop;
use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyRuntimeError},
    prelude::*,
    types::PyBool,
};

/// Interval at which Python is asked whether work must stop.
const EVERY: Duration = Duration::from_millis(20);

/// Time to wait for stopped work, which checks far more often.
const PATIENCE: Duration = Duration::from_secs(3);

thread_local! {
    /// The stop flag of this thread's calls, like Ctrl-C in the main thread.
    static STOPPED_BY: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// A switch that ends a function run by :func:`_until_stopped`.
#[pyclass(frozen, name = "_Stop", module = "eeruf._eeruf")]
pub(crate) struct Switch(Stop);

#[pymethods]
impl Switch {
    #[new]
    fn new() -> Self {
        Self(Stop::default())
    }

    fn stop(&self) {
        self.0.stop();
    }
}

/// Calls a function with one argument; its calls of eeruf on this thread end when the switch is set.
#[pyfunction]
#[pyo3(name = "_until_stopped")]
pub(crate) fn until_stopped<'py>(
    switch: &Bound<'py, Switch>,
    function: &Bound<'py, PyAny>,
    argument: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let before = STOPPED_BY.replace(Some(switch.get().0.clone()));
    let result = function.call1((argument,));
    STOPPED_BY.set(before);
    result
}

/// Converts a watcher's answer, true to go on, for a search.
pub(crate) fn control_flow(go_on: bool) -> ControlFlow<()> {
    if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Asks Python from time to time, on the calling thread, whether work must stop.
pub(crate) struct Watch {
    progress: Option<Py<PyAny>>,
    stopped_by: Option<Stop>,
    last: Instant,
    error: Option<PyErr>,
}

impl Watch {
    /// A watch; `progress` is `None`, `True` for a progress bar, or a callable that takes the finished share (or
    /// `None`) and a text.
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
                    crate::arguments::shown(other),
                    "None, True or a callable (share, text)",
                ));
            }
        };
        let stopped_by = STOPPED_BY.with_borrow(Clone::clone);
        Ok(Self { progress: progress.map(Bound::unbind), stopped_by, last: Instant::now(), error: None })
    }

    /// Returns true to continue. It may be called often: it checks the clock first.
    pub(crate) fn go_on(&mut self, share: Option<f64>, text: impl FnOnce() -> String) -> bool {
        if self.error.is_some() {
            return false;
        }
        if self.last.elapsed() < EVERY {
            return true;
        }
        self.last = Instant::now();
        if self.stopped_by.as_ref().is_some_and(Stop::is_stopped) {
            self.error = Some(PyKeyboardInterrupt::new_err(()));
            return false;
        }
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

    /// The result of the work, or the reason why Python stopped it. Call it when all is done.
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

/// State shared by work on its own thread and the calling thread: progress and the stop flag.
#[derive(Default)]
pub(crate) struct Background {
    stop: Stop,
    /// The finished share, and a text.
    reached: Mutex<(Option<f64>, String)>,
}

impl Background {
    /// Reports progress, and returns true to continue; callable on any thread.
    pub(crate) fn go_on(&self, share: Option<f64>, text: impl FnOnce() -> String) -> bool {
        let mut reached = self.reached.lock().unwrap_or_else(PoisonError::into_inner);
        // Threads report their shares in any order.
        let share = share.map(|share| reached.0.map_or(share, |before| share.max(before)));
        *reached = (share, text());
        !self.stop.is_stopped()
    }

    /// The flag that ends the work.
    pub(crate) fn stop(&self) -> &Stop {
        &self.stop
    }

    fn reached(&self) -> (Option<f64>, String) {
        self.reached.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Runs work on its own thread, while the calling thread handles Ctrl-C and progress, since signals reach Python only
/// there. If Python stops the work, the caller waits until it has ended.
pub(crate) fn in_background<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Background) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let mut watch = Watch::new(progress)?;
    let result = py.detach(|| {
        let (ours, (send, receive)) = (Arc::new(Background::default()), mpsc::channel());
        let theirs = Arc::clone(&ours);
        let spawned = thread::Builder::new().spawn(move || drop(send.send(work(&theirs))));
        spawned.map_err(|error| PyRuntimeError::new_err(format!("no thread to work on: {error}")))?;
        loop {
            match receive.recv_timeout(EVERY) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Disconnected) => return Err(PyRuntimeError::new_err("the work ended early")),
                Err(RecvTimeoutError::Timeout) => {
                    let (share, text) = ours.reached();
                    if !watch.go_on(share, || text) {
                        ours.stop.stop();
                        // Wait until the ended work has stopped.
                        drop(receive.recv_timeout(PATIENCE));
                        // The watch keeps the reason.
                        return Err(PyKeyboardInterrupt::new_err(()));
                    }
                }
            }
        }
    });
    watch.outcome(result)
}
