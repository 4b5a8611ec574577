//! `Found`: what a search returns.

use std::time::Instant;

use eeruf_core::search;
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_design::RingDesign;
use pyo3::prelude::*;

use crate::{fields::record, schedule::Schedule};

/// The result of a search, before conversion to Python.
#[derive(Default)]
pub(crate) struct Found {
    schedule: Option<Schedule>,
    value_us: Option<u32>,
    bound_us: Option<u32>,
    proven: bool,
    nodes: u64,
    seconds: f64,
    reason: Option<String>,
    certificate: Option<String>,
    from_atlas: bool,
    certified_us: Option<u32>,
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

    pub(crate) fn of_design(design: &RingDesign, began: Instant, certificate: Option<String>) -> Self {
        let found = search::Found { schedule: Some(design.schedule), ..design.found };
        let reason = Some(design.reason.clone());
        // The atlas has the proven bound; otherwise it is computed only if a proof was asked for, since it takes time.
        let is_asked = design.from_atlas || certificate.is_some();
        let certified_us = is_asked.then(|| design.certified()).flatten().map(Micros::as_micros);
        Self { from_atlas: design.from_atlas, certificate, certified_us, ..Self::of(&found, began, reason) }
    }

    /// The result in Python's form.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let Self { schedule, value_us, bound_us, proven, nodes, seconds, reason, certificate, .. } = self;
        let (from_atlas, certified_us) = (self.from_atlas, self.certified_us);
        let fields =
            (schedule, value_us, bound_us, proven, nodes, seconds, reason, certificate, from_atlas, certified_us);
        record(py, "Found", fields)
    }
}
