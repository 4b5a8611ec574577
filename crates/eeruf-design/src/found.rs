//! Results of a search, as JSON.

use eeruf_core::search::Found;
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_files::ScheduleFile;
use serde::Serialize;

/// The result of a search, with Python's names.
#[derive(Default, Serialize)]
pub struct FoundJson {
    /// The schedule, if there is one.
    pub schedule: Option<ScheduleFile>,
    /// The value that was optimised: the period, the smallest interval or `t_delta`.
    pub value_us: Option<u32>,
    /// Proven bound of the value.
    pub bound_us: Option<u32>,
    /// True if no better schedule exists.
    pub proven: bool,
    /// True if a schedule of the given period meets all needs, false if none does; only from `design --period`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fits: Option<bool>,
    /// Nodes visited.
    pub nodes: u64,
    /// Duration of the search.
    pub seconds: f64,
    /// Reason why no period is shorter; only from `design`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// True if the answer came from the atlas, without a search; only from `design`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_atlas: Option<bool>,
    /// Bound of the period that a short certificate proves, if the period is proven; only from `design`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certified_us: Option<u32>,
}

impl FoundJson {
    /// Returns the JSON of a result after this many seconds, without a reason.
    pub fn new(found: &Found<MAX_SENSORS>, seconds: f64) -> Self {
        Self {
            schedule: found.schedule.as_ref().map(ScheduleFile::from),
            value_us: found.value.map(Micros::as_micros),
            bound_us: found.bound.map(Micros::as_micros),
            proven: found.proven,
            nodes: found.nodes,
            seconds,
            ..Self::default()
        }
    }
}
