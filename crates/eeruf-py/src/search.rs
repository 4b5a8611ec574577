//! `WaitSearch`: the waits for given lags, and an iterator over all tables.

use std::time::Instant;

use eeruf_core::search::{
    self as search, Budget, COUNT_WORDS, Outcome, Progress, SearchError, WaitProblem, WaitSearch as Waits, memory_words,
};
use eeruf_core::{Criterion, MAX_SENSORS, Micros};
use pyo3::prelude::*;

use crate::{
    arguments::{choice, micros, micros_or, times, whole, whole_or},
    errors::Raise,
    exclusive::Exclusive,
    found::Found,
    requirements,
    schedule::Schedule,
    watch::{Watch, control_flow},
};

/// Number of nodes of the search for waits between two checks of the clock.
const POLL: u32 = 1 << 12;

/// A search for waits on a grid, for given lags, so that crosstalk never repeats: the paper's problem (Sec. 3.1).
///
/// Args:
///     sensors: how many, 1 to 64.
///     period_us: ``T_p``, a whole number of ticks.
///     wait_max_us: waits are 0, one tick, two ticks, up to this.
///     tick_us: the grid, 1 or more.
///     t_lag_us: ``T_lag`` of each sensor, in whole ticks; None spreads each group of ``neighbours`` over the period,
///         as in Table I-a.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11).
///     min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
///     neighbours: how many adjacent sensors make a group, 1 to 64.
///     layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours, as in :meth:`Schedule.verify`.
///     criterion: how to read Eqs. (13a), (13b): as the ``"paper"`` prints them, or ``"exact"``.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; invalid needs, or too large a grid.
///
/// Example:
///     >>> import eeruf
///     >>> search = eeruf.WaitSearch(12, 100_000, 24_000, 1000, t_delta_us=999, min_interval_us=15_000)
///     >>> search.best("interval").value_us
///     19000
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct WaitSearch {
    search: search::WaitSearch,
    sensors: usize,
    period: Micros,
    wait_max: Micros,
}

impl WaitSearch {
    /// Runs a search that Ctrl-C may end.
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        budget: u64,
        work: impl FnOnce(&mut [u32], &mut Budget<'_>) -> Result<T, SearchError> + Send,
        words: usize,
    ) -> PyResult<T> {
        let mut watch = Watch::new(None)?;
        let result = py.detach(|| {
            let mut watcher = |_: &Progress| control_flow(watch.go_on(None, String::new));
            let mut budget = Budget::nodes_at_most(budget).watched(POLL, &mut watcher);
            work(&mut vec![0; words], &mut budget)
        });
        watch.outcome(result.map_err(Raise::raise))
    }
}

#[pymethods]
impl WaitSearch {
    #[new]
    #[pyo3(signature = (
        sensors, period_us, wait_max_us, tick_us, t_lag_us=None, *, t_delta_us, min_interval_us=None, neighbours=None,
        layout=None, criterion=None
    ))]
    #[pyo3(text_signature = "(sensors, period_us, wait_max_us, tick_us, t_lag_us=None, *, t_delta_us, \
            min_interval_us=0, neighbours=4, layout=\"line\", criterion=\"paper\")")]
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
        let sensors = requirements::sensors(sensors)?;
        let t_lag = t_lag_us.map(|lags| times("t_lag_us", lags)).transpose()?;
        let neighbours = requirements::neighbours(neighbours)?;
        let layout = requirements::layout(layout, neighbours, sensors)?;
        let (period, wait_max) = (micros("period_us", period_us)?, micros("wait_max_us", wait_max_us)?);
        let needs = WaitProblem {
            sensors,
            period,
            wait_max,
            tick: micros("tick_us", tick_us)?,
            t_lag: t_lag.as_deref(),
            t_delta: micros("t_delta_us", t_delta_us)?,
            min_interval: micros_or("min_interval_us", min_interval_us, Micros::ZERO)?,
            neighbours,
            layout: layout.layout(),
            criterion: choice("criterion", criterion, &[("paper", Criterion::Paper), ("exact", Criterion::Exact)])?,
        };
        Ok(Self { search: search::WaitSearch::new(&needs).map_err(Raise::raise)?, sensors, period, wait_max })
    }

    fn __repr__(&self) -> String {
        format!("<WaitSearch: {} sensors, period {}, waits up to {}>", self.sensors, self.period, self.wait_max)
    }

    /// One table of waits, the same each time, or None if there is none. Ctrl-C ends the search.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> table = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).first()
    ///     >>> table.t_wait_a_us, table.t_wait_b_us
    ///     ((2000, 0), (0, 0))
    fn first(&self, py: Python<'_>) -> PyResult<Option<Schedule>> {
        let words = memory_words(self.sensors);
        let first = self.run(py, u64::MAX, |memory, budget| self.search.first(memory, budget), words)?;
        Ok(if let Outcome::Found(table) = first { Some(Schedule(table)) } else { None })
    }

    /// Number of tables, counted without listing them if possible. Ctrl-C ends the search.
    ///
    /// Args:
    ///     limit: where to stop counting, 1 or more; None counts all.
    ///
    /// Returns:
    ///     The number of tables, or the limit if there are that many or more.
    ///
    /// Raises:
    ///     EerufError: an invalid limit; too many tables to count.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).count(limit=10)
    ///     10
    #[pyo3(signature = (limit=None))]
    fn count(&self, py: Python<'_>, limit: Option<&Bound<'_, PyAny>>) -> PyResult<u128> {
        let limit = limit.map(|limit| whole("limit", limit, 1..=u64::MAX)).transpose()?.map(u128::from);
        let count = |memory: &mut [u32], budget: &mut Budget<'_>| Ok(self.search.count(limit, memory, budget).1);
        let count = self.run(py, u64::MAX, count, COUNT_WORDS)?;
        // Core counts all tables of the last sensor at once, so the count may exceed the limit.
        Ok(limit.map_or(count, |limit| count.min(limit)))
    }

    /// All tables in lexical order, as an iterator of ``Schedule``.
    ///
    /// Raises:
    ///     EerufError: too large to search.
    ///
    /// Example:
    ///     >>> import itertools, eeruf
    ///     >>> search = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999)
    ///     >>> [table.t_wait_b_us for table in itertools.islice(search.all(), 2)]
    ///     [(0, 2000), (0, 3000)]
    fn all(&self) -> WaitTables {
        WaitTables(Exclusive::new("iterator of tables", Walk { search: self.search.clone(), last: None }))
    }

    /// The best table, by its smallest interval between neighbours, ``T_delta`` (both as large as possible), longest
    /// wait, or period for these lags, at most the given one (both as short as possible). Ctrl-C ends the search.
    ///
    /// Args:
    ///     objective: ``"interval"``, ``"t_delta"``, ``"waits"`` or ``"period"``.
    ///     budget: how many nodes to visit at most, 1 or more; unlimited by default.
    ///
    /// Returns:
    ///     The table, with the interval, ``T_delta``, longest wait or period as ``value_us``.
    ///
    /// Raises:
    ///     EerufError: an invalid objective or budget; too large to search.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> found = eeruf.WaitSearch(4, 40_000, 8_000, 1000, t_delta_us=999).best("t_delta")
    ///     >>> found.proven, found.schedule.verify(found.value_us).ok
    ///     (True, True)
    ///     >>> eeruf.WaitSearch(4, 40_000, 8_000, 1000, t_delta_us=999).best("waits").value_us
    ///     6000
    #[pyo3(signature = (objective=None, budget=None), text_signature = "($self, objective=\"interval\", budget=None)")]
    fn best<'py>(
        &self,
        py: Python<'py>,
        objective: Option<&Bound<'_, PyAny>>,
        budget: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        type Best = fn(&Waits, &mut [u32], &mut Budget<'_>) -> Result<search::Found<MAX_SENSORS>, SearchError>;
        let objectives: [(&str, Best); 4] = [
            ("interval", Waits::best_interval),
            ("t_delta", Waits::best_t_delta),
            ("waits", Waits::shortest_waits),
            ("period", Waits::shortest_period),
        ];
        let best = choice("objective", objective, &objectives)?;
        let budget = whole_or("budget", budget, u64::MAX, 1..=u64::MAX)?;
        let words = memory_words(self.sensors);
        let began = Instant::now();
        let found = self.run(py, budget, |memory, budget| best(&self.search, memory, budget), words)?;
        Found::of(&found, began, None).into_python(py)
    }

    /// The Pareto front: tables that no other beats in smallest interval or ``T_delta`` without losing in the other,
    /// both at least the given needs, from the largest interval to the largest ``T_delta``. Ctrl-C ends the search.
    ///
    /// Returns:
    ///     Triples of table, smallest interval and ``T_delta``, in microseconds; ``T_delta`` is None if two readings of
    ///     the table are alike.
    ///
    /// Raises:
    ///     EerufError: too large to search.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> search = eeruf.WaitSearch(4, 40_000, 9_000, 1000, t_delta_us=99)
    ///     >>> [(interval_us, t_delta_us) for _, interval_us, t_delta_us in search.pareto()]
    ///     [(9000, 499), (8000, 999), (7000, 1499)]
    fn pareto(&self, py: Python<'_>) -> PyResult<Vec<(Schedule, u32, Option<u32>)>> {
        let words = memory_words(self.sensors);
        let front = |memory: &mut [u32], budget: &mut Budget<'_>| {
            let mut tables = Vec::new();
            while let Outcome::Found(table) = self.search.next_on_front(tables.last(), memory, budget)? {
                tables.push(table);
            }
            let row = |table: &search::FrontTable<MAX_SENSORS>| {
                (Schedule(table.schedule), table.min_interval.as_micros(), table.t_delta.map(Micros::as_micros))
            };
            Ok(tables.iter().map(row).collect())
        };
        self.run(py, u64::MAX, front, words)
    }
}

/// The problem, and the last returned table.
struct Walk {
    search: search::WaitSearch,
    last: Option<eeruf_core::Schedule<MAX_SENSORS>>,
}

/// All tables of a ``WaitSearch``, one after the other: an iterator that Ctrl-C interrupts.
///
/// Example:
///     >>> import eeruf
///     >>> tables = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).all()
///     >>> next(tables).sensors
///     2
#[pyclass(frozen, module = "eeruf.typing")]
pub(crate) struct WaitTables(Exclusive<Walk>);

#[pymethods]
impl WaitTables {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Schedule>> {
        let (mut watch, mut walk) = (Watch::new(None)?, self.0.get()?);
        let walk = &mut *walk;
        let next = py.detach(|| {
            let mut watcher = |_: &Progress| control_flow(watch.go_on(None, String::new));
            let mut budget = Budget::nodes_at_most(u64::MAX).watched(POLL, &mut watcher);
            Ok(match walk.search.next_table(walk.last.as_ref(), &mut budget)? {
                Outcome::Found(table) => {
                    walk.last = Some(table);
                    Some(table)
                }
                _ => None,
            })
        });
        watch.outcome(next.map(|schedule| schedule.map(Schedule)).map_err(|error: SearchError| error.raise()))
    }
}
