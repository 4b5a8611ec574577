//! The filter's verdicts on a log, as a table and as JSON.

use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_logs::Counted;
use serde::Serialize;

use super::table::markdown;

/// The filter's verdicts on one sensor's readings, one after the other.
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) kinds: Vec<ReadingKind>,
}

/// Output of `--json`.
#[derive(Serialize)]
pub(crate) struct Replay {
    pub(crate) total: Counts,
    pub(crate) sensors: Vec<Counts>,
    /// Damage of the log.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) damage: Vec<String>,
    /// Topics that were left out, and why.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) skipped: Vec<String>,
    /// Warnings of values that seem wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) warnings: Vec<String>,
    /// Firing pattern of the sensors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) firing: Option<Firing>,
}

/// Firing pattern of a log's sensors, and what readings that agree prove under it.
#[derive(Serialize)]
pub(crate) struct Firing {
    pub(crate) pattern: &'static str,
    pub(crate) proves: String,
}

/// Number of readings of each kind.
#[derive(Serialize)]
pub(crate) struct Counts {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    accepted: u64,
    rejected: u64,
    /// Readings that agreed with the previous one, but not yet with enough others; only if more than two are compared.
    #[serde(skip_serializing_if = "is_zero")]
    repeated: u64,
    first: u64,
    no_echo: u64,
    clear: u64,
    /// Readings nearer than the sensor can measure.
    #[serde(skip_serializing_if = "is_zero")]
    too_early: u64,
    /// Readings that are not numbers.
    #[serde(skip_serializing_if = "is_zero")]
    invalid: u64,
    /// Readings with an earlier time than the previous reading.
    #[serde(skip_serializing_if = "is_zero")]
    backwards: u64,
    /// Pauses; nothing is compared across them.
    #[serde(skip_serializing_if = "is_zero")]
    gaps: u64,
    /// Time from the first reading to the latest, if the log has times.
    #[serde(skip_serializing_if = "Option::is_none")]
    duration_s: Option<f64>,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Counts {
    /// Sums up sensors' readings: of one sensor under its name, or of all.
    pub(crate) fn of(name: Option<&str>, sensors: &[Counted]) -> Self {
        let of = |kind| sensors.iter().map(|counted| u64::from(counted.tally.of(kind))).sum::<u64>();
        let sum = |count: fn(&Counted) -> u64| sensors.iter().map(count).sum();
        let between_ns = name.and(sensors.first()).and_then(|counted| counted.between_ns);
        Self {
            name: name.map(str::to_owned),
            accepted: of(ReadingKind::Accepted),
            rejected: of(ReadingKind::Rejected) + of(ReadingKind::Ambiguous),
            repeated: of(ReadingKind::Repeated),
            first: of(ReadingKind::First),
            no_echo: of(ReadingKind::NoEcho),
            clear: of(ReadingKind::Clear),
            too_early: of(ReadingKind::TooEarly),
            invalid: sum(|counted| counted.invalid),
            backwards: sum(|counted| counted.backwards),
            gaps: sum(|counted| counted.gaps),
            duration_s: between_ns.map(|(from, to)| (to - from) as f64 * 1e-9),
        }
    }

    /// Number of readings.
    fn readings(&self) -> u64 {
        let compared = self.compared();
        compared + self.first + self.no_echo + self.clear + self.too_early + self.invalid
    }

    fn compared(&self) -> u64 {
        self.accepted + self.rejected + self.repeated
    }

    fn row(&self, columns: Columns) -> Vec<String> {
        let compared = self.compared();
        let rate = if compared == 0 {
            "-".to_owned()
        } else {
            format!("{:.1} %", 100.0 * self.rejected as f64 / compared as f64)
        };
        let mut row = vec![self.name.clone().unwrap_or_else(|| "total".to_owned())];
        row.extend([self.accepted, self.rejected, self.first, self.no_echo, self.clear].map(|n| n.to_string()));
        row.insert(3, rate);
        if columns.close {
            row.push(self.too_early.to_string());
        }
        if columns.invalid {
            row.push(self.invalid.to_string());
        }
        if columns.time {
            row.push(match self.duration_s {
                Some(seconds) if seconds > 0.0 => format!("{:.1}", self.readings().saturating_sub(1) as f64 / seconds),
                _ => "-".to_owned(),
            });
        }
        row
    }
}

/// Columns that not every log needs.
#[derive(Clone, Copy)]
struct Columns {
    close: bool,
    invalid: bool,
    time: bool,
}

pub(crate) fn table(file: &Path, t_delta_us: u32, counts: &[Counts], total: &Counts) -> String {
    let columns = Columns {
        close: total.too_early > 0,
        invalid: total.invalid > 0,
        time: counts.iter().any(|sensor| sensor.duration_s.is_some()),
    };
    let mut header = vec!["sensor", "accepted", "rejected", "rejection rate", "first", "no echo", "clear"];
    let more = [(columns.close, "too close"), (columns.invalid, "no number"), (columns.time, "readings/s")];
    header.extend(more.into_iter().filter(|(shown, _)| *shown).map(|(_, name)| name));
    let table = markdown(&header, counts.iter().chain([total]).map(|counts| counts.row(columns)));
    let mut text = format!("{}: t_delta {t_delta_us} us, {} sensors\n{table}", file.display(), counts.len());
    if total.backwards > 0 {
        text += &format!("\n{} readings have an earlier time than the one before.", total.backwards);
    }
    if total.gaps > 0 {
        text += &format!("\n{} gaps in the times: readings after them are not compared with those before.", total.gaps);
    }
    text
}
