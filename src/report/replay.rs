//! What the filter made of a log, as a table and as JSON.

use std::path::Path;

use eeruf_core::{ReadingKind, Tally};
use serde::Serialize;

use super::table::markdown;

/// What the filter made of one sensor's readings, one for each row.
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) kinds: Vec<ReadingKind>,
}

/// What `--json` prints.
#[derive(Serialize)]
pub(crate) struct Replay {
    pub(crate) total: Counts,
    pub(crate) sensors: Vec<Counts>,
}

/// How often each kind occurred.
#[derive(Clone, Default, Serialize)]
pub(crate) struct Counts {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    accepted: u64,
    rejected: u64,
    /// Agreed with the one before, but not yet with enough: only where more than two are compared.
    #[serde(skip_serializing_if = "is_zero")]
    repeated: u64,
    first: u64,
    no_echo: u64,
    clear: u64,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Counts {
    pub(crate) fn of(column: &Column) -> Self {
        let mut tally = Tally::<u32>::default();
        for &kind in &column.kinds {
            tally.count(kind);
        }
        let of = |kind| tally.of(kind).into();
        Self {
            name: Some(column.name.clone()),
            accepted: of(ReadingKind::Accepted),
            rejected: of(ReadingKind::Rejected),
            repeated: of(ReadingKind::Repeated),
            first: of(ReadingKind::First),
            no_echo: of(ReadingKind::NoEcho),
            clear: of(ReadingKind::Clear),
        }
    }

    pub(crate) fn plus(self, other: &Self) -> Self {
        Self {
            name: None,
            accepted: self.accepted + other.accepted,
            rejected: self.rejected + other.rejected,
            repeated: self.repeated + other.repeated,
            first: self.first + other.first,
            no_echo: self.no_echo + other.no_echo,
            clear: self.clear + other.clear,
        }
    }

    fn row(&self) -> Vec<String> {
        let compared = self.accepted + self.rejected + self.repeated;
        let rate = if compared == 0 {
            "-".to_owned()
        } else {
            format!("{:.1} %", 100.0 * self.rejected as f64 / compared as f64)
        };
        let mut row = vec![self.name.clone().unwrap_or_else(|| "total".to_owned())];
        row.extend([self.accepted, self.rejected, self.first, self.no_echo, self.clear].map(|n| n.to_string()));
        row.insert(3, rate);
        row
    }
}

pub(crate) fn table(file: &Path, t_delta_us: u32, counts: &[Counts], total: &Counts) -> String {
    let header = ["sensor", "accepted", "rejected", "rejection rate", "first", "no echo", "clear"];
    let table = markdown(&header, counts.iter().chain([total]).map(Counts::row));
    format!("{}: t_delta {t_delta_us} us, {} sensors\n{table}", file.display(), counts.len())
}
