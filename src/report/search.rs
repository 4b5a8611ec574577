//! What `search` found, as text and as JSON.

use eeruf_core::MAX_SENSORS;
use eeruf_core::search::Found;
use serde::Serialize;

/// What `--count` prints.
#[derive(Serialize)]
pub(crate) struct CountJson {
    pub(crate) count: u128,
    /// Absent where the count is exact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(crate) at_least: bool,
}

/// One table, or that there is none. `what` names the table or the value that was to be largest.
pub(crate) fn describe(what: &str, found: &Found<MAX_SENSORS>, seconds: f64) -> String {
    let cost = format!("{} nodes in {seconds:.3} s", found.nodes);
    let Some(schedule) = &found.schedule else {
        let verdict = if found.proven { "there is no such table: all were searched" } else { "no table found yet" };
        return format!("{verdict} ({cost})");
    };
    let value = found.value.map_or_else(String::new, |value| value.to_string());
    let proof = match (found.value, found.bound) {
        (Some(_), _) if found.proven => ", and no table has a larger one".to_owned(),
        (Some(_), Some(bound)) => format!(", at most {bound}"),
        _ => String::new(),
    };
    format!("{what}{value}{proof} ({cost})\n\n{}", schedule.to_toml())
}
