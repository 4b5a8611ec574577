//! The paper's experiments. Their tables come as JSON, with the names that `eeruf experiment --json` uses.

use std::sync::{
    Mutex,
    atomic::{AtomicBool, Ordering},
};
use std::time::Duration;

use eeruf_sim::{
    Method,
    best::best_for,
    experiments::set_one::{Alcove, READINGS, set_one as table_of},
};
use pyo3::prelude::*;

use crate::{
    arguments::whole_or,
    errors::{ArgumentError, Raise},
    readings::method,
    watch::Watch,
};

/// How many nodes the schedule of `eeruf_best` may cost, as in the program.
const BEST_BUDGET: u64 = 2_000_000;

/// Runs work that uses all cores on a thread of its own, while the thread that called looks after Ctrl-C and progress:
/// signals reach Python only there.
pub(crate) fn beside<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    text: &str,
    work: impl FnOnce(&(dyn Fn(f64) -> bool + Sync)) -> PyResult<T> + Send,
) -> PyResult<T> {
    let mut watch = Watch::new(progress)?;
    let result = py.detach(|| {
        let (stopped, share) = (AtomicBool::new(false), Mutex::new(0.0_f64));
        let keep_going = |done: f64| {
            if let Ok(mut share) = share.lock() {
                *share = share.max(done);
            }
            !stopped.load(Ordering::Relaxed)
        };
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| work(&keep_going));
            while !worker.is_finished() {
                std::thread::sleep(Duration::from_millis(10));
                let done = share.lock().map_or(0.0, |share| *share);
                if !watch.go_on(Some(done), || text.to_owned()) {
                    stopped.store(true, Ordering::Relaxed);
                }
            }
            worker.join().unwrap_or_else(|_| Err(ArgumentError::new_err("the experiment ended early")))
        })
    });
    watch.outcome(result)
}

/// Set I over many geometries.
#[pyfunction]
#[pyo3(name = "_set_one", signature = (seeds, readings, methods, progress))]
pub(crate) fn set_one(
    py: Python<'_>,
    seeds: &Bound<'_, PyAny>,
    readings: Option<&Bound<'_, PyAny>>,
    methods: Option<Vec<String>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let seeds = whole_or("seeds", Some(seeds), 0, 1..=u64::MAX)?;
    let readings = whole_or("readings", readings, READINGS, 1..=u32::MAX)?;
    let methods = match methods {
        None => Method::ALL.to_vec(),
        Some(names) => names.iter().map(|name| method(name)).collect::<PyResult<_>>()?,
    };
    beside(py, progress, "Set I", |keep_going| {
        let needs_best = methods.contains(&Method::EerufBest);
        let best = |robot| best_for(robot, BEST_BUDGET, |_| keep_going(0.0)).map_err(Raise::raise);
        let best = if needs_best { Some(best(&Alcove::random(0).robot())?) } else { None };
        let table = table_of(seeds, readings, &methods, best.as_ref(), keep_going).map_err(Raise::raise)?;
        serde_json::to_string(&table).map_err(|error| ArgumentError::new_err(error.to_string()))
    })
}
