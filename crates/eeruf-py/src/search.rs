//! `design`, `WaitSearch` and what they find.

use std::time::Instant;

use eeruf_core::{
    Criterion, MAX_SENSORS, Micros, Requirements,
    search::{
        self, RingNeeds, SearchError, WaitNeeds, design as period,
        design::{Flow, Progress},
        wait::{self, All, Control, Finish, Objective},
    },
};
use pyo3::{prelude::*, types::PyTuple};

use crate::{
    arguments::{
        self, OwnedLayout, choice, flag, instance, micros, number, text, times, whole, whole_or, whole_or_none,
    },
    errors::Raise,
    schedule::Schedule,
    watch::Watch,
};

/// How many nodes the choice among the shortest schedules may cost.
const PREFERENCE_BUDGET: u64 = 100_000;
/// How many nodes a search visits unless another budget is given.
const DESIGN_BUDGET: u64 = 50_000_000;
/// How many nodes of the search for waits lie between two looks at the clock.
const POLL: u32 = 1 << 12;

/// The answer of a search.
#[pyclass(frozen, eq, module = "eeruf")]
#[derive(Clone, PartialEq)]
pub(crate) struct Found {
    schedule: Option<Schedule>,
    #[pyo3(get)]
    value_us: Option<u32>,
    #[pyo3(get)]
    bound_us: Option<u32>,
    #[pyo3(get)]
    proven: bool,
    #[pyo3(get)]
    nodes: u64,
    #[pyo3(get)]
    seconds: f64,
    #[pyo3(get)]
    reason: Option<String>,
}

impl Found {
    fn of(found: &search::Found<MAX_SENSORS>, began: Instant, reason: Option<String>) -> Self {
        Self {
            schedule: found.schedule.map(Schedule),
            value_us: found.value.map(Micros::as_micros),
            bound_us: found.bound.map(Micros::as_micros),
            proven: found.proven,
            nodes: found.nodes,
            seconds: began.elapsed().as_secs_f64(),
            reason,
        }
    }
}

#[pymethods]
impl Found {
    #[new]
    #[pyo3(signature = (schedule, value_us, bound_us, proven, nodes, seconds, reason=None))]
    fn new(
        schedule: Option<&Bound<'_, PyAny>>,
        value_us: Option<&Bound<'_, PyAny>>,
        bound_us: Option<&Bound<'_, PyAny>>,
        proven: &Bound<'_, PyAny>,
        nodes: &Bound<'_, PyAny>,
        seconds: &Bound<'_, PyAny>,
        reason: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let schedule = schedule.map(|schedule| instance::<Schedule>("schedule", schedule, "an eeruf.Schedule"));
        Ok(Self {
            schedule: schedule.transpose()?.map(|schedule| schedule.get().clone()),
            value_us: whole_or_none("value_us", value_us, 0..=u32::MAX)?,
            bound_us: whole_or_none("bound_us", bound_us, 0..=u32::MAX)?,
            proven: flag("proven", Some(proven), false)?,
            nodes: whole("nodes", nodes, 0..=u64::MAX)?,
            seconds: number("seconds", seconds, 0.0..=f64::INFINITY)?,
            reason: reason.map(|reason| text("reason", reason, "why")).transpose()?,
        })
    }

    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        self.schedule.clone()
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let fields = ["schedule", "value_us", "bound_us", "proven", "nodes", "seconds", "reason"];
        let shown = fields.map(|field| Ok(format!("{field}={}", slf.getattr(field)?.repr()?)));
        Ok(format!("Found({})", shown.into_iter().collect::<PyResult<Vec<_>>>()?.join(", ")))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let this = slf.get();
        let Self { value_us, bound_us, proven, nodes, seconds, .. } = *this;
        let arguments = (this.schedule.clone(), value_us, bound_us, proven, nodes, seconds, this.reason.clone());
        Ok((slf.get_type().into_any(), arguments.into_pyobject(slf.py())?))
    }
}

/// The shortest period for a ring.
#[pyfunction]
#[pyo3(signature = (sensors, t_delta_us, min_interval_us, window_us, tick_us=None, neighbours=None, layout=None, stale_echo=None, budget=None, progress=None))]
#[pyo3(
    text_signature = "(sensors, t_delta_us, min_interval_us, window_us, tick_us=1000, neighbours=4, layout=\"line\", stale_echo=False, budget=None, progress=None)"
)]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
pub(crate) fn design(
    py: Python<'_>,
    sensors: &Bound<'_, PyAny>,
    t_delta_us: &Bound<'_, PyAny>,
    min_interval_us: &Bound<'_, PyAny>,
    window_us: &Bound<'_, PyAny>,
    tick_us: Option<&Bound<'_, PyAny>>,
    neighbours: Option<&Bound<'_, PyAny>>,
    layout: Option<&Bound<'_, PyAny>>,
    stale_echo: Option<&Bound<'_, PyAny>>,
    budget: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Found> {
    let sensors = arguments::sensors(sensors)?;
    let layout = OwnedLayout::new(layout, arguments::neighbours(neighbours)?)?;
    let (t_delta, min_interval) = (micros("t_delta_us", t_delta_us)?, micros("min_interval_us", min_interval_us)?);
    let window = whole("window_us", window_us, 1..=u32::MAX).map(Micros::new)?;
    let tick = Micros::new(whole_or("tick_us", tick_us, 1000, 1..=u32::MAX)?);
    let stale_echo = flag("stale_echo", stale_echo, false)?;
    let budget = whole_or("budget", budget, DESIGN_BUDGET, 1..=u64::MAX)?;
    let mut watch = Watch::new(progress)?;
    let began = Instant::now();
    let designed = py.detach(|| {
        let criterion = Criterion::Exact;
        let layout = layout.layout();
        let requirements = Requirements { t_delta, criterion, min_interval, layout, window, stale_echo };
        let needs = RingNeeds { sensors, requirements, tick };
        let mut control = |at: &Progress| {
            let text = || format!("{} nodes, period {} to {} ticks", at.nodes, at.bound, at.best);
            if watch.go_on(None, text) { Flow::Continue } else { Flow::Stop }
        };
        shortest(&needs, budget, &mut control)
    });
    let found = designed.map(|(found, reason)| Found::of(&found, began, Some(reason))).map_err(Raise::raise);
    watch.outcome(found)
}

fn shortest(
    needs: &RingNeeds<'_>,
    budget: u64,
    control: &mut impl period::Control,
) -> Result<(search::Found<MAX_SENSORS>, String), SearchError> {
    let mut memory = vec![0; period::memory_words(needs.sensors)];
    let designed = needs.shortest::<MAX_SENSORS>(budget, &mut memory, control)?;
    let mut found = designed.found;
    if found.proven {
        found.schedule = Some(needs.prefer(&designed, PREFERENCE_BUDGET, &mut memory, control)?.schedule);
    }
    Ok((found, designed.reason().to_string()))
}

/// The paper's question.
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct WaitSearch {
    search: search::WaitSearch,
    sensors: usize,
}

impl WaitSearch {
    /// Runs a search that Ctrl-C may end.
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        budget: u64,
        work: impl FnOnce(&mut [u32], &mut Control<'_>) -> Result<T, SearchError> + Send,
        words: usize,
    ) -> PyResult<T> {
        let mut watch = Watch::new(None)?;
        let result = py.detach(|| {
            let mut watcher = |_| watch.go_on(None, String::new);
            let mut control = Control::nodes_at_most(budget).watched(POLL, &mut watcher);
            work(&mut vec![0; words], &mut control)
        });
        watch.outcome(result.map_err(Raise::raise))
    }
}

#[pymethods]
impl WaitSearch {
    #[new]
    #[pyo3(signature = (sensors, period_us, wait_max_us, tick_us, t_lag_us=None, *, t_delta_us, min_interval_us=None, neighbours=None, layout=None, criterion=None))]
    #[pyo3(
        text_signature = "(sensors, period_us, wait_max_us, tick_us, t_lag_us=None, *, t_delta_us, min_interval_us=0, neighbours=4, layout=\"line\", criterion=\"paper\")"
    )]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        sensors: &Bound<'_, PyAny>,
        period_us: &Bound<'_, PyAny>,
        wait_max_us: &Bound<'_, PyAny>,
        tick_us: &Bound<'_, PyAny>,
        t_lag_us: Option<&Bound<'_, PyAny>>,
        t_delta_us: &Bound<'_, PyAny>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        layout: Option<&Bound<'_, PyAny>>,
        criterion: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let sensors = arguments::sensors(sensors)?;
        let t_lag = t_lag_us.map(|lags| times("t_lag_us", lags)).transpose()?;
        let neighbours = arguments::neighbours(neighbours)?;
        let layout = OwnedLayout::new(layout, neighbours)?;
        let needs = WaitNeeds {
            sensors,
            period: micros("period_us", period_us)?,
            wait_max: micros("wait_max_us", wait_max_us)?,
            tick: micros("tick_us", tick_us)?,
            t_lag: t_lag.as_deref(),
            t_delta: micros("t_delta_us", t_delta_us)?,
            min_interval: min_interval_us.map_or(Ok(Micros::ZERO), |value| micros("min_interval_us", value))?,
            neighbours,
            layout: layout.layout(),
            criterion: choice("criterion", criterion, &[("paper", Criterion::Paper), ("exact", Criterion::Exact)])?,
        };
        Ok(Self { search: search::WaitSearch::new(&needs).map_err(Raise::raise)?, sensors })
    }

    fn first(&self, py: Python<'_>) -> PyResult<Option<Schedule>> {
        let words = wait::memory_words(self.sensors);
        let first = self.run(py, u64::MAX, |memory, control| self.search.first(memory, control), words)?;
        Ok(first.1.map(Schedule))
    }

    #[pyo3(signature = (limit=None))]
    fn count(&self, py: Python<'_>, limit: Option<&Bound<'_, PyAny>>) -> PyResult<u128> {
        let limit = limit.map(|limit| whole("limit", limit, 1..=u64::MAX)).transpose()?.map(u128::from);
        let count = |memory: &mut [u32], control: &mut Control<'_>| self.search.count(limit, memory, control);
        Ok(self.run(py, u64::MAX, count, wait::COUNT_WORDS)?.count)
    }

    fn all(&self) -> PyResult<WaitTables> {
        Ok(WaitTables(Walk::try_new(self.search.clone(), search::WaitSearch::all).map_err(Raise::raise)?))
    }

    #[pyo3(signature = (objective=None, budget=None), text_signature = "($self, objective=\"interval\", budget=None)")]
    fn best(
        &self,
        py: Python<'_>,
        objective: Option<&Bound<'_, PyAny>>,
        budget: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Found> {
        let objectives = [("interval", Objective::Interval), ("t_delta", Objective::Separation)];
        let objective = choice("objective", objective, &objectives)?;
        let budget = whole_or("budget", budget, u64::MAX, 1..=u64::MAX)?;
        let words = wait::memory_words(self.sensors);
        let began = Instant::now();
        let best = |memory: &mut [u32], control: &mut Control<'_>| self.search.best(objective, memory, control);
        let found: search::Found<MAX_SENSORS> = self.run(py, budget, best, words)?;
        Ok(Found::of(&found, began, None))
    }
}

self_cell::self_cell!(
    /// A walk over all tables, with the question that it borrows.
    struct Walk {
        owner: search::WaitSearch,
        #[covariant]
        dependent: All,
    }
);

/// All tables, one after the other.
#[pyclass(module = "eeruf")]
pub(crate) struct WaitTables(Walk);

#[pymethods]
impl WaitTables {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Schedule>> {
        let mut watch = Watch::new(None)?;
        let next = py.detach(|| {
            self.0.with_dependent_mut(|search, all| {
                let (mut a, mut b) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
                let mut watcher = |_| watch.go_on(None, String::new);
                let mut control = Control::nodes_at_most(u64::MAX).watched(POLL, &mut watcher);
                match all.next_into(&mut control, &mut a, &mut b)? {
                    Finish::Found => search.schedule(&a, &b).map(Some),
                    _ => Ok(None),
                }
            })
        });
        watch.outcome(next.map(|schedule| schedule.map(Schedule)).map_err(|error: SearchError| error.raise()))
    }
}
