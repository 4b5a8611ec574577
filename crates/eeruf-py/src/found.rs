//! `Found`: what a search returns.

use std::time::Instant;

use eeruf_core::search;
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_design::ToSpare;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{flag, instance, number, of_type, text, whole, whole_or_none},
    fields::{Reduced, reduce, repr, to_dict},
    schedule::Schedule,
};

/// The answer of a search: the best schedule it came to, and whether that is proven.
///
/// Example:
///     >>> import eeruf
///     >>> found = eeruf.design(sensors=4, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
///     >>> found.value_us, found.bound_us, found.proven
///     (62000, 62000, True)
#[pyclass(frozen, eq, module = "eeruf")]
#[derive(Clone, Default, PartialEq)]
pub(crate) struct Found {
    schedule: Option<Schedule>,
    /// The optimised value, in microseconds: the period, the smallest interval or ``T_delta``; None without a schedule.
    #[pyo3(get)]
    value_us: Option<u32>,
    /// No schedule is better than this, in microseconds; None if it is proven that there is none at all.
    #[pyo3(get)]
    bound_us: Option<u32>,
    /// True if no better schedule exists (or none at all, without a schedule).
    #[pyo3(get)]
    proven: bool,
    /// Number of nodes that the search visited: the same on each machine.
    #[pyo3(get)]
    nodes: u64,
    /// Duration of the search, in seconds.
    #[pyo3(get)]
    seconds: f64,
    /// Why the period is not shorter, in words; None from ``WaitSearch.best``.
    #[pyo3(get)]
    reason: Option<String>,
    /// A proof for :func:`check_certificate`; None unless ``design`` was asked for one.
    #[pyo3(get)]
    certificate: Option<String>,
    /// True if the atlas of proven rings answered, and nothing was searched.
    #[pyo3(get)]
    from_atlas: bool,
    /// Slack of the schedule beyond every ``t_delta``, then every interval and turn on a shared line, then every
    /// refire time, in microseconds; None unless the period is proven.
    #[pyo3(get)]
    spare_us: Option<(u32, u32, u32)>,
    /// True if no schedule of this period has more, of each; None without them.
    #[pyo3(get)]
    spare_proven: Option<(bool, bool, bool)>,
}

impl Found {
    pub(crate) fn of(found: &search::Found<MAX_SENSORS>, began: Instant, reason: Option<String>) -> Self {
        Self {
            schedule: found.schedule.map(Schedule),
            value_us: found.value.map(Micros::as_micros),
            bound_us: found.bound.map(Micros::as_micros),
            proven: found.proven,
            nodes: found.nodes,
            seconds: began.elapsed().as_secs_f64(),
            reason,
            ..Self::default()
        }
    }

    pub(crate) fn out_of_atlas(self, from_atlas: bool) -> Self {
        Self { from_atlas, ..self }
    }

    pub(crate) fn with_spare(self, spare: Option<ToSpare>) -> Self {
        let (spare_us, spare_proven) =
            (spare.map(|spare| spare.in_us().into()), spare.map(|spare| spare.proven.into()));
        Self { spare_us, spare_proven, ..self }
    }

    pub(crate) fn with_certificate(self, certificate: Option<String>) -> Self {
        Self { certificate, ..self }
    }
}

const FIELDS: [&str; 11] = [
    "schedule",
    "value_us",
    "bound_us",
    "proven",
    "nodes",
    "seconds",
    "reason",
    "certificate",
    "from_atlas",
    "spare_us",
    "spare_proven",
];

/// The fields that its text has, the last two only if they are known.
const SHOWN: [&str; 9] =
    ["schedule", "value_us", "bound_us", "proven", "nodes", "seconds", "reason", "spare_us", "spare_proven"];

#[pymethods]
impl Found {
    #[new]
    #[pyo3(signature = (schedule, value_us, bound_us, proven, nodes, seconds, reason=None, certificate=None,
        from_atlas=None, spare_us=None, spare_proven=None))]
    #[pyo3(text_signature = "(schedule, value_us, bound_us, proven, nodes, seconds, reason=None, certificate=None, \
            from_atlas=False, spare_us=None, spare_proven=None)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        schedule: Option<&Bound<'_, PyAny>>,
        value_us: Option<&Bound<'_, PyAny>>,
        bound_us: Option<&Bound<'_, PyAny>>,
        proven: &Bound<'_, PyAny>,
        nodes: &Bound<'_, PyAny>,
        seconds: &Bound<'_, PyAny>,
        reason: Option<&Bound<'_, PyAny>>,
        certificate: Option<&Bound<'_, PyAny>>,
        from_atlas: Option<&Bound<'_, PyAny>>,
        spare_us: Option<&Bound<'_, PyAny>>,
        spare_proven: Option<&Bound<'_, PyAny>>,
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
            certificate: certificate.map(|proof| text("certificate", proof, "a certificate")).transpose()?,
            from_atlas: flag("from_atlas", from_atlas, false)?,
            spare_us: of_type("spare_us", spare_us, "three whole numbers of microseconds")?,
            spare_proven: of_type("spare_proven", spare_proven, "three of True and False")?,
        })
    }

    /// The schedule; None if there is none, or none was found within the budget.
    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        self.schedule.clone()
    }

    /// Its fields by their names, the schedule as its times: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> found = eeruf.design(sensors=4, t_delta_us=999, min_interval_us=15_000, window_us=36_000).to_dict()
    ///     >>> found["value_us"], found["schedule"]["period_us"]
    ///     (62000, 62000)
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &FIELDS)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let shown = if slf.get().spare_us.is_some() { &SHOWN[..] } else { &SHOWN[..7] };
        repr(slf, shown)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &FIELDS)
    }
}
