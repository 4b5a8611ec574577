//! `HoppingFound`: what `design` with many phases returns, and how it is asked for.

use eeruf_core::{Criterion, Micros, Requirements};
use eeruf_design::HoppingDesign;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{flag, instance, micros, shown, text, whole, wrong},
    errors::HoppingError,
    fields::{Reduced, reduce, repr, to_dict},
    hopping_schedule::HoppingSchedule,
    requirements::{self, each},
};

/// The answer of ``design`` with ``phases``: a schedule for a hopping ring, and how much shorter one could be.
///
/// Example:
///     >>> import eeruf
///     >>> found = eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5)
///     >>> found.schedule.phases, found.value_us, found.proven
///     (11, 38107, True)
///     >>> ring = eeruf.Ring.hopping(found.schedule, window_us=36_000)
#[pyclass(frozen, eq, get_all, module = "eeruf")]
#[derive(Clone, PartialEq)]
pub(crate) struct HoppingFound {
    /// The schedule: a linear congruence with lags, or Welch's sequence where stale echoes must be rejected.
    schedule: HoppingSchedule,
    /// Its period, in microseconds.
    value_us: u32,
    /// No schedule of this many phases or more that separates sound of every age has a shorter period, in microseconds.
    bound_us: u32,
    /// True if no such schedule is shorter.
    proven: bool,
    /// Reason of the bound, in words.
    reason: String,
    /// The longest wait of the code, in microseconds.
    width_us: u32,
    /// No code that separates sound of every age is narrower than this, in microseconds.
    width_bound_us: u32,
}

/// Needs given to :func:`design` that matter with many phases.
pub(crate) struct Needs<'a, 'py> {
    pub(crate) sensors: &'a Bound<'py, PyAny>,
    pub(crate) t_delta_us: &'a Bound<'py, PyAny>,
    pub(crate) min_interval_us: &'a Bound<'py, PyAny>,
    pub(crate) window_us: &'a Bound<'py, PyAny>,
    pub(crate) neighbours: Option<&'a Bound<'py, PyAny>>,
    pub(crate) layout: Option<&'a Bound<'py, PyAny>>,
    pub(crate) stale_echo: Option<&'a Bound<'py, PyAny>>,
    pub(crate) margin_us: Option<&'a Bound<'py, PyAny>>,
}

impl HoppingFound {
    /// The shortest period for at least this many phases. Of what sensors need of their own the largest counts.
    pub(crate) fn design(phases: &Bound<'_, PyAny>, needs: &Needs<'_, '_>) -> PyResult<Self> {
        let py = phases.py();
        let phases = whole("phases", phases, 2..=eeruf_core::hopping::HoppingCode::MAX_PHASES)?;
        let sensors = requirements::sensors(needs.sensors)?;
        let layout = requirements::layout(needs.layout, requirements::neighbours(needs.neighbours)?, sensors)?;
        let (t_delta, t_deltas) = each("t_delta_us", needs.t_delta_us, 0)?;
        let (window, windows) = each("window_us", needs.window_us, 1)?;
        for (name, list) in [("t_delta_us", t_deltas), ("window_us", windows)] {
            if !list.is_empty() && list.len() != sensors {
                let found = format_args!("{} times", list.len()).to_string();
                return Err(wrong(name, found, format_args!("one, or one for each of {sensors} sensors")));
            }
        }
        let margin = needs.margin_us.map(|margin| micros("margin_us", margin)).transpose()?;
        let min_interval = micros("min_interval_us", needs.min_interval_us)?;
        let stale_echo = flag("stale_echo", needs.stale_echo, false)?;
        let designed = py.detach(|| {
            let requirements = Requirements {
                criterion: margin.map_or(Criterion::Exact, Criterion::Margin),
                window,
                min_interval,
                layout: layout.layout(),
                stale_echo,
                ..Requirements::new(t_delta)
            };
            HoppingDesign::shortest(sensors, phases, &requirements, false)
        });
        designed.map(Self::from).map_err(HoppingError::new_err)
    }
}

/// Refuses what was given and does not matter, rather than to pass it over.
pub(crate) fn refuse(given: &[(&str, Option<&Bound<'_, PyAny>>)], expected: &str) -> PyResult<()> {
    match given.iter().find_map(|(name, value)| value.map(|value| (name, value))) {
        Some((name, value)) => Err(wrong(name, shown(value), expected)),
        None => Ok(()),
    }
}

impl From<HoppingDesign> for HoppingFound {
    fn from(design: HoppingDesign) -> Self {
        let proven = design.proven();
        let HoppingDesign { schedule, period_bound, width_bound, reason, .. } = design;
        Self {
            value_us: schedule.period().as_micros(),
            bound_us: period_bound.as_micros(),
            proven,
            reason: reason.to_owned(),
            width_us: schedule.code().width().as_micros(),
            width_bound_us: width_bound.as_micros(),
            schedule: HoppingSchedule(schedule),
        }
    }
}

const FIELDS: [&str; 7] = ["schedule", "value_us", "bound_us", "proven", "reason", "width_us", "width_bound_us"];

#[pymethods]
impl HoppingFound {
    #[new]
    fn new(
        schedule: &Bound<'_, PyAny>,
        value_us: &Bound<'_, PyAny>,
        bound_us: &Bound<'_, PyAny>,
        proven: &Bound<'_, PyAny>,
        reason: &Bound<'_, PyAny>,
        width_us: &Bound<'_, PyAny>,
        width_bound_us: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let time = |name, value: &Bound<'_, PyAny>| micros(name, value).map(Micros::as_micros);
        let schedule = instance::<HoppingSchedule>("schedule", schedule, "an eeruf.HoppingSchedule")?;
        Ok(Self {
            schedule: schedule.get().clone(),
            value_us: time("value_us", value_us)?,
            bound_us: time("bound_us", bound_us)?,
            proven: flag("proven", Some(proven), false)?,
            reason: text("reason", reason, "why")?,
            width_us: time("width_us", width_us)?,
            width_bound_us: time("width_bound_us", width_bound_us)?,
        })
    }

    /// Its fields by their names, as ``eeruf design --phases M --json`` prints them: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> found = eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5).to_dict()
    ///     >>> found["value_us"], found["schedule"]["step_us"]
    ///     (38107, 301)
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &FIELDS)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &FIELDS)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &FIELDS)
    }
}
