//! `fit` and `curve`: what fits into a period, and the shortest period as one need varies.

use std::time::Instant;

use eeruf_core::Micros;
use eeruf_core::search::{Found as FoundSchedule, Progress};
use eeruf_design::{CURVE_BUDGET, CurvePoint, Effort, Need};
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{choice, whole, whole_or},
    design::asked,
    errors::Raise,
    found::Found,
    watch::{Watch, control_flow},
};

/// Find out whether the needs fit into a period, and the largest ``T_delta`` that fits. Ctrl-C ends it.
///
/// Args:
///     period_us: the period, in whole ticks.
///     sensors: how many, 1 to 64; or a :class:`Needs`, or the path of a ring file.
///     t_delta_us: as in :func:`design`, as are the arguments below except ``budget``.
///     min_interval_us: the least time between the firings of two neighbours.
///     window_us: how long a sensor listens; one for all, or a sequence.
///     tick_us: the grid of firing times and period, 1 or more.
///     neighbours: how many sensors in a row count as neighbours, 1 to 64.
///     layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours.
///     stale_echo: whether a sensor's own echo from the previous period must be rejected too.
///     budget: how many nodes to visit at most, 1 or more; 50 million by default.
///     refire_us: how soon a sensor may be triggered again, where that is later than its window.
///     intervals_us: pairs of sensors with the least time between their firings.
///     shared_lines: groups of sensors on one echo line.
///     together: groups of sensors that fire at the same instants.
///
/// Returns:
///     True if a schedule of this period meets all needs, False if none does, None if undecided; and a :class:`Found`
///     with the largest ``T_delta`` for this period in ``value_us``. If sensors have their own, all grow by the same
///     amount, and the largest is returned. The schedule meets the needs if possible, or else has that ``T_delta``.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; invalid needs, or a period that is not a
///         whole number of ticks.
///
/// Example:
///     >>> import eeruf
///     >>> fits, found = eeruf.fit(100_000, 12, 999, 15_000, 30_000)
///     >>> fits, found.value_us, found.proven
///     (True, 2999, True)
#[pyfunction]
#[pyo3(signature = (
    period_us, sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, budget=None, **needs
))]
#[pyo3(text_signature = "(period_us, sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, \
        tick_us=1000, neighbours=4, layout=\"line\", stale_echo=False, budget=None, refire_us=None, \
        intervals_us=None, shared_lines=None, together=None)")]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
pub(crate) fn fit<'py>(
    py: Python<'py>,
    period_us: &Bound<'_, PyAny>,
    sensors: &Bound<'py, PyAny>,
    t_delta_us: Option<&Bound<'py, PyAny>>,
    min_interval_us: Option<&Bound<'py, PyAny>>,
    window_us: Option<&Bound<'py, PyAny>>,
    budget: Option<&Bound<'_, PyAny>>,
    needs: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Option<bool>, Bound<'py, PyAny>)> {
    let period = Micros::new(whole("period_us", period_us, 1..=u32::MAX)?);
    let budget = whole_or("budget", budget, 50_000_000, 1..=u64::MAX)?;
    let spec = asked(py, "fit", [t_delta_us, min_interval_us, window_us], needs)?.ring(sensors)?;
    let began = Instant::now();
    let mut watch = Watch::new(None)?;
    let fit = py.detach(|| {
        let mut control = |_: &Progress| control_flow(watch.go_on(None, String::new));
        spec.fit(period, budget, &mut control).map_err(Raise::raise)
    });
    let fit = watch.outcome(fit)?;
    let found = FoundSchedule {
        schedule: fit.schedule,
        value: fit.t_delta,
        bound: fit.bound,
        proven: fit.proven,
        nodes: fit.nodes,
    };
    Ok((fit.fits, Found::of(&found, began, None).into_python(py)?))
}

/// Find the shortest period for 20 values of one need, from a tenth of the given one to twice as much. Ctrl-C ends it.
///
/// Args:
///     need: ``"t_delta"``, ``"range"`` (the window) or ``"interval"``.
///     sensors: how many, 1 to 64; or a :class:`Needs`, or the path of a ring file.
///     t_delta_us: as in :func:`design`, as are the arguments below except ``budget``. Where sensors or pairs have
///         their own needs, all vary by the same factor.
///     min_interval_us: the least time between the firings of two neighbours.
///     window_us: how long a sensor listens; one for all, or a sequence.
///     tick_us: the grid of firing times and period, 1 or more.
///     neighbours: how many sensors in a row count as neighbours, 1 to 64.
///     layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours.
///     stale_echo: whether a sensor's own echo from the previous period must be rejected too.
///     budget: how many nodes each point may cost, 1 or more; 20,000 by default.
///     refire_us: how soon a sensor may be triggered again, where that is later than its window.
///     intervals_us: pairs of sensors with the least time between their firings.
///     shared_lines: groups of sensors on one echo line.
///     together: groups of sensors that fire at the same instants.
///
/// Returns:
///     Tuples of the need's value, the shortest period found, the bound below which there is none, all in microseconds,
///     and whether the period is proven the shortest.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; invalid needs, or too large a grid.
///
/// Example:
///     >>> import eeruf
///     >>> curve = eeruf.curve("interval", 12, 999, 15_000, 30_000)
///     >>> len(curve), curve[9]
///     (20, (15000, 65000, 65000, True))
#[pyfunction]
#[pyo3(signature = (
    need, sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, budget=None, **needs
))]
#[pyo3(text_signature = "(need, sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, tick_us=1000, \
        neighbours=4, layout=\"line\", stale_echo=False, budget=None, refire_us=None, intervals_us=None, \
        shared_lines=None, together=None)")]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
#[expect(clippy::type_complexity, reason = "a tuple for each point, as Python has it")]
pub(crate) fn curve<'py>(
    py: Python<'py>,
    need: &Bound<'_, PyAny>,
    sensors: &Bound<'py, PyAny>,
    t_delta_us: Option<&Bound<'py, PyAny>>,
    min_interval_us: Option<&Bound<'py, PyAny>>,
    window_us: Option<&Bound<'py, PyAny>>,
    budget: Option<&Bound<'_, PyAny>>,
    needs: Option<&Bound<'py, PyDict>>,
) -> PyResult<Vec<(u32, Option<u32>, Option<u32>, bool)>> {
    let named = [("t_delta", Need::TDelta), ("range", Need::Range), ("interval", Need::Interval)];
    let need = choice("need", Some(need), &named)?;
    let budget = whole_or("budget", budget, CURVE_BUDGET, 1..=u64::MAX)?;
    let spec = asked(py, "curve", [t_delta_us, min_interval_us, window_us], needs)?.ring(sensors)?;
    let mut watch = Watch::new(None)?;
    let points = py.detach(|| {
        let mut control = |_: &Progress| control_flow(watch.go_on(None, String::new));
        let search = Effort { budget, ..Effort::default() };
        spec.curve(need, &search, &mut control).map_err(Raise::raise)
    });
    let us = |time: Option<Micros>| time.map(Micros::as_micros);
    let point = |point: CurvePoint| (point.value.as_micros(), us(point.period), us(point.bound), point.proven);
    Ok(watch.outcome(points)?.into_iter().map(point).collect())
}
