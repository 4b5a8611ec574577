//! Result of `search`, as text and as JSON.

use std::fmt::Write as _;

use eeruf_core::search::{Found, FrontTable};
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_files::emit::Emit as _;
use eeruf_sim::ScheduleFile;
use serde::Serialize;

use super::table::plain;

/// The line for a search that ended before its answer, in text.
pub(crate) const NOT_DECIDED: &str = "not decided: the search ended before it found a table or excluded all; expected \
                                      a larger --budget or --time-limit\n";

/// Output of `--count`.
#[derive(Serialize)]
pub(crate) struct CountJson {
    pub(crate) count: u128,
    /// Absent where the count is exact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(crate) at_least: bool,
}

/// Output of `--best pareto`.
#[derive(Serialize)]
pub(crate) struct FrontJson {
    tables: Vec<FrontTableJson>,
    /// True if no table of the front is missing.
    proven: bool,
    nodes: u64,
    seconds: f64,
}

#[derive(Serialize)]
struct FrontTableJson {
    schedule: ScheduleFile,
    min_interval_us: u32,
    t_delta_us: Option<u32>,
}

impl FrontJson {
    pub(crate) fn new(tables: &[FrontTable<MAX_SENSORS>], proven: bool, nodes: u64, seconds: f64) -> Self {
        let row = |table: &FrontTable<MAX_SENSORS>| FrontTableJson {
            schedule: ScheduleFile::from(&table.schedule),
            min_interval_us: table.min_interval.as_micros(),
            t_delta_us: table.t_delta.map(Micros::as_micros),
        };
        Self { tables: tables.iter().map(row).collect(), proven, nodes, seconds }
    }
}

/// Describes a table, or says that there is none. `what` names the table, or the value that was maximised.
pub(crate) fn describe(what: &str, found: &Found<MAX_SENSORS>, seconds: f64) -> String {
    let cost = cost(found.nodes, seconds);
    let Some(schedule) = &found.schedule else {
        return if found.proven { format!("{NONE} ({cost})") } else { format!("{NOT_DECIDED}({cost})") };
    };
    let value = found.value.map_or_else(String::new, |value| value.to_string());
    let proof = match (found.value, found.bound) {
        (Some(_), _) if found.proven => ", and no table has a larger one".to_owned(),
        (Some(_), Some(bound)) => format!(", at most {bound}"),
        _ => String::new(),
    };
    format!("{what}{value}{proof} ({cost})\n\n{}", schedule.to_toml())
}

/// The Pareto front: its values as a table, then the tables of waits.
pub(crate) fn describe_front(tables: &[FrontTable<MAX_SENSORS>], complete: bool, nodes: u64, seconds: f64) -> String {
    let cost = cost(nodes, seconds);
    if tables.is_empty() {
        return if complete { format!("{NONE} ({cost})\n") } else { format!("{NOT_DECIDED}({cost})\n") };
    }
    let rest = if complete { "and no others" } else { "the search ended before the others" };
    let mut values = plain();
    values.add_row(["smallest interval", "t_delta"]);
    let t_delta = |table: &FrontTable<MAX_SENSORS>| table.t_delta.map_or("none".to_owned(), |time| time.to_string());
    for table in tables {
        values.add_row([table.min_interval.to_string(), t_delta(table)]);
    }
    let count = if tables.len() == 1 { "1 table".to_owned() } else { format!("{} tables", tables.len()) };
    let front = "of which no other has more of one without less of the other";
    let mut text = format!("{count} {front}, {rest} ({cost})\n\n{values}\n");
    for table in tables {
        let (interval, t_delta) = (table.min_interval, t_delta(table));
        _ = write!(text, "\n# smallest interval {interval}, t_delta {t_delta}\n{}", table.schedule.to_toml());
    }
    text
}

const NONE: &str = "there is no such table: all were searched";

fn cost(nodes: u64, seconds: f64) -> String {
    format!("{nodes} nodes in {seconds:.3} s")
}
