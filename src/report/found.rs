//! What a search found, as JSON.

use eeruf_core::search::Found;
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_sim::ScheduleFile;
use serde::Serialize;

/// Found, as Python names it.
#[derive(Serialize)]
pub(crate) struct FoundJson {
    pub(crate) schedule: Option<ScheduleFile>,
    pub(crate) value_us: Option<u32>,
    pub(crate) bound_us: Option<u32>,
    pub(crate) proven: bool,
    pub(crate) nodes: u64,
    pub(crate) seconds: f64,
    /// Why nothing is better; only `design` says it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) reason: Option<String>,
}

impl FoundJson {
    pub(crate) fn new(found: &Found<MAX_SENSORS>, seconds: f64) -> Self {
        Self {
            schedule: found.schedule.as_ref().map(ScheduleFile::from),
            value_us: found.value.map(Micros::as_micros),
            bound_us: found.bound.map(Micros::as_micros),
            proven: found.proven,
            nodes: found.nodes,
            seconds,
            reason: None,
        }
    }
}
