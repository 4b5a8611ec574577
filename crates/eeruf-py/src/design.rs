//! `design`: the shortest period, with its certificate.

use std::ffi::CString;
use std::time::{Duration, Instant};

use eeruf_core::search::Progress;
use eeruf_design::{Effort, atlas::ATLAS};
use pyo3::{prelude::*, sync::PyOnceLock, types::PyDict};

use crate::{
    arguments::{flag, number, whole_or},
    errors::{CertificateError, EerufError, Raise},
    found::Found,
    program::examples,
    requirements::{ALIKE, Asked, UNEVEN},
    watch::{Watch, control_flow, in_background},
};

/// Default budget of nodes for a search.
const DESIGN_BUDGET: u64 = 50_000_000;
/// Budget of nodes for the proof of a certificate.
const CERTIFICATE_BUDGET: usize = 1_000_000;
/// Number of sensors up to which the engine checks often enough whether to stop. With more sensors there may be a good
/// part of a second between two checks, so the search runs on its own thread. A small search would wait longer for that
/// thread than for its answer.
const FEW_SENSORS: usize = 12;

/// Find the schedule with the shortest period for a ring, and prove that none is shorter.
///
/// Firing times are free, on a grid of ticks. Among all schedules of the shortest period it prefers a larger
/// ``T_delta``, then a larger smallest interval, then evener firing. It runs on one core, without the interpreter lock;
/// Ctrl-C ends it.
///
/// Args:
///     sensors: how many, 1 to 64; or a :class:`Needs`, or the path of a ring file, in place of all needs.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all
///         sensors or a sequence of one for each; two sensors need the separation of the larger.
///     min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
///     window_us: ``T_wind``, for which a sensor listens: it must not fire again earlier. 1 or more; one for all, or a
///         sequence.
///     tick_us: the grid of firing times and period, 1 or more.
///     neighbours: how many sensors in a row count as neighbours, 1 to 64.
///     layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours, as in :meth:`Schedule.verify`.
///     stale_echo: whether a sensor's own echo from the previous period must be rejected too.
///     budget: how many nodes to visit at most, 1 or more; 50 million by default.
///     progress: True for a bar (tqdm if it is installed), or a callable that takes the share done (None: unknown) and
///         a text.
///     certificate: whether to return a proof in ``Found.certificate``, for :func:`check_certificate`: no period is
///         shorter, or none is below ``bound_us``, or below a lower bound that a million nodes can prove.
///     time_limit_s: the time in seconds, above 0, after which the call returns the best schedule so far; the
///         certificate gets the time that is left. No limit by default.
///     refire_us: how soon a sensor may be triggered again, where that is later than its window. One for all, or a
///         sequence.
///     intervals_us: pairs of sensors with the least time between their firings, whatever the layout says:
///         ``[(0, 4, 9000)]``; 0 for none.
///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
///     together: groups of sensors that fire at the same instants, declared not to hear each other.
///     atlas: whether the answer may come from the atlas of rings with known shortest periods, as in the program;
///         ``Found.from_atlas`` is then true and ``nodes`` is 0.
///
/// Returns:
///     A :class:`Found`: the shortest period in ``value_us``, or the best found within budget and time; ``proven`` says
///     which.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; invalid needs, or too large a grid.
///
/// Example:
///     >>> import eeruf
///     >>> found = eeruf.design(sensors=8, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
///     >>> found.value_us, found.proven
///     (66000, True)
///     >>> windows = [36_000, 36_000, 12_000, 12_000]
///     >>> found = eeruf.design(4, [999, 999, 1500, 1500], 15_000, windows, shared_lines=[(0, 2)])
///     >>> found.value_us, found.proven
///     (59000, True)
#[pyfunction]
#[pyo3(signature = (
    sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, budget=None, progress=None, certificate=None,
    time_limit_s=None, atlas=None, **needs
))]
#[pyo3(
    text_signature = "(sensors, t_delta_us=None, min_interval_us=None, window_us=None, *, tick_us=1000, neighbours=4, \
        layout=\"line\", stale_echo=False, budget=None, progress=None, certificate=False, time_limit_s=None, \
        refire_us=None, intervals_us=None, shared_lines=None, together=None, atlas=True)"
)]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
pub(crate) fn design<'py>(
    py: Python<'py>,
    sensors: &Bound<'py, PyAny>,
    t_delta_us: Option<&Bound<'py, PyAny>>,
    min_interval_us: Option<&Bound<'py, PyAny>>,
    window_us: Option<&Bound<'py, PyAny>>,
    budget: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    certificate: Option<&Bound<'_, PyAny>>,
    time_limit_s: Option<&Bound<'_, PyAny>>,
    atlas: Option<&Bound<'_, PyAny>>,
    needs: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let spec = asked(py, "design", [t_delta_us, min_interval_us, window_us], needs)?.ring(sensors)?;
    let atlas = if flag("atlas", atlas, true)? { ATLAS } else { "" };
    let budget = whole_or("budget", budget, DESIGN_BUDGET, 1..=u64::MAX)?;
    let certificate = flag("certificate", certificate, false)?;
    let limit = time_limit_s.map(|seconds| number("time_limit_s", seconds, 1e-3..=1e9)).transpose()?;
    let limit = limit.map_or(Duration::MAX, Duration::from_secs_f64);
    let (began, sensors) = (Instant::now(), spec.sensors);
    let work = move |go_on: &mut dyn FnMut(&dyn Fn() -> String) -> bool| {
        let mut control = |at: &Progress| {
            let (bound, best) = (at.bound.unwrap_or(0), at.best.unwrap_or(0));
            let text = || format!("{} nodes, period {bound} to {best} ticks", at.nodes);
            control_flow(began.elapsed() < limit && go_on(&text))
        };
        let shortest = spec.shortest(&Effort { budget, what_if: false, atlas }, &mut control).map_err(Raise::raise)?;
        let still = |nodes| began.elapsed() < limit && go_on(&|| format!("certificate: {nodes} nodes"));
        let proof = certificate.then(|| shortest.prove(CERTIFICATE_BUDGET, still)).transpose();
        let proof = proof.map_err(|error| CertificateError::new_err(error.to_string()))?;
        Ok(Found::of_design(&shortest, began, proof))
    };
    let found: Found = if sensors <= FEW_SENSORS {
        let mut watch = Watch::new(progress)?;
        let designed = py.detach(|| work(&mut |text| watch.go_on(None, text)));
        watch.outcome(designed)?
    } else {
        in_background(py, progress, move |background| work(&mut |text| background.go_on(None, text)))?
    };
    found.into_python(py)
}

/// Needs from the arguments that all searches share.
pub(crate) fn asked<'py>(
    py: Python<'py>,
    call: &str,
    [t_delta_us, min_interval_us, window_us]: [Option<&Bound<'py, PyAny>>; 3],
    needs: Option<&Bound<'py, PyDict>>,
) -> PyResult<Asked<'py>> {
    let placed = [("t_delta_us", t_delta_us), ("min_interval_us", min_interval_us), ("window_us", window_us)];
    Asked::of(py, call, placed, needs, &[&["tick_us"], &ALIKE, &UNEVEN])
}

/// Check a certificate: that its schedule keeps the requirements in it, and that no period is below its bound.
///
/// The checker is ``checker/check_period.py``, which shares nothing with the search; :func:`example` returns its text;
/// ``docs/reference/certificate.md`` has the format and the proof of each rule. A certificate is only about the numbers
/// in it.
///
/// Args:
///     text: the certificate, as in ``design(..., certificate=True).certificate``.
///
/// Returns:
///     The proven lower bound on the period, in microseconds. If the schedule has this period, it is the shortest.
///
/// Raises:
///     EerufError: not a string.
///     CertificateError: the first line that is wrong.
///
/// Example:
///     >>> import eeruf
///     >>> found = eeruf.design(4, 999, 15_000, 36_000, certificate=True)
///     >>> eeruf.check_certificate(found.certificate)
///     62000
///     >>> eeruf.check_certificate(found.certificate.replace("below 62", "below 63"))
///     Traceback (most recent call last):
///     eeruf.CertificateError: line 16: found '63', expected 1 to 62
#[pyfunction]
#[pyo3(name = "check_certificate", signature = (text))]
pub(crate) fn check_certificate(py: Python<'_>, text: &Bound<'_, PyAny>) -> PyResult<u64> {
    let text = crate::arguments::text("text", text, "a certificate")?;
    let checker = checker(py)?;
    let problem = checker.getattr("check")?.call1((text,)).map_err(|error| {
        let refused = checker.getattr("Refused").is_ok_and(|refused| error.matches(py, refused).unwrap_or(false));
        if refused { CertificateError::new_err(error.value(py).to_string()) } else { error }
    })?;
    let bound = problem.getattr("bound")?.mul(problem.getattr("tick")?)?;
    bound.getattr("numerator")?.floor_div(bound.getattr("denominator")?)?.extract()
}

/// The module of the checker, loaded on first use so that importing eeruf is fast.
fn checker(py: Python<'_>) -> PyResult<&Bound<'_, PyModule>> {
    static CHECKER: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = CHECKER.get_or_try_init(py, || {
        let none = || EerufError::new_err("no checker: this package was built without the program");
        let text = CString::new(examples::text("checker/check_period.py").ok_or_else(none)?)?;
        PyModule::from_code(py, &text, c"checker/check_period.py", c"eeruf._check_period").map(Bound::unbind)
    })?;
    Ok(module.bind(py))
}
