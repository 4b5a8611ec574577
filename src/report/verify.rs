//! Result of `verify`, as text and as JSON.

use std::fmt::Write as _;

use eeruf_core::{
    Criterion, Layout, MAX_SENSORS, Micros, Phase, Requirements,
    conditions::{Least, Verification},
};
use eeruf_sim::AnySchedule;
use serde::Serialize;

use super::table::plain;

/// The report with the names that Python uses; sensors from 0, phases in the form `P`.
#[derive(Serialize)]
pub(crate) struct ReportJson<P> {
    ok: bool,
    separation_us: Option<u32>,
    max_t_delta_us: Option<u32>,
    min_interval_us: Option<u32>,
    min_refire_us: u32,
    violations: Vec<ViolationJson<P>>,
}

#[derive(Serialize)]
struct ViolationJson<P> {
    kind: &'static str,
    sensors: (u8, u8),
    phases: (P, P),
    value_us: u32,
    required_us: u32,
    source: &'static str,
}

impl<P> ReportJson<P> {
    pub(crate) fn new(report: &Verification<'_, MAX_SENSORS>, phase: impl Fn(Phase) -> P) -> Self {
        let violations = report.violations().map(|violation| ViolationJson {
            kind: violation.kind.as_str(),
            sensors: violation.sensors,
            phases: (phase(violation.phases.0), phase(violation.phases.1)),
            value_us: violation.value.as_micros(),
            required_us: violation.required.as_micros(),
            source: violation.kind.source(),
        });
        Self {
            ok: report.ok(),
            separation_us: report.separation().map(|separation| separation.value.as_micros()),
            max_t_delta_us: report.max_t_delta().map(Micros::as_micros),
            min_interval_us: report.min_interval().map(|interval| interval.value.as_micros()),
            min_refire_us: report.min_refire().as_micros(),
            violations: violations.collect(),
        }
    }
}

/// Formats a time for a table.
pub(super) fn us(time: Micros) -> String {
    format!("{} us", time.as_micros())
}

/// Number of violations to print before counting the rest.
const PRINTED_VIOLATIONS: usize = 10;

pub(crate) fn describe(
    name: &str,
    schedule: &AnySchedule,
    requirements: &Requirements<'_>,
    report: &Verification<'_, MAX_SENSORS>,
) -> String {
    let mut table = plain();
    for criterion in [Criterion::Paper, Criterion::Exact] {
        let chosen = if criterion == requirements.criterion { "" } else { " (not asked for)" };
        let separation =
            if criterion == requirements.criterion { report.separation() } else { schedule.separation(criterion) };
        let (value, who) = match separation {
            Some(separation) => {
                (us(separation.value), format!("sensors {} and {}", separation.sensors.0 + 1, separation.sensors.1 + 1))
            }
            None => ("-".to_owned(), "a single sensor".to_owned()),
        };
        table.add_row([format!("separation, criterion {criterion}{chosen}"), value, who]);
    }
    let t_delta = report.max_t_delta().map_or_else(|| "none".to_owned(), us);
    table.add_row(["largest t_delta", &t_delta, "2 t_delta + 1 us <= separation"]);
    let intervals = match requirements.uneven {
        None => layouts(requirements.layout),
        Some(_) => vec![("two that need one".to_owned(), requirements.layout)],
    };
    for (label, layout) in intervals {
        let interval =
            if requirements.uneven.is_some() { report.min_interval() } else { schedule.min_interval(layout) };
        let (value, who) = match interval {
            Some(interval) => (us(interval.value), describe_interval(interval)),
            None => ("-".to_owned(), "no neighbours".to_owned()),
        };
        table.add_row([format!("smallest interval, {label}"), value, who]);
    }
    table.add_row(["shortest time between two firings of a sensor", &us(report.min_refire()), "T_wind at most"]);

    let mut text = format!("{name}: {} sensors, period {}\n{table}\n", schedule.sensors(), us(schedule.period()));
    let violations: Vec<_> = report.violations().collect();
    for violation in violations.iter().take(PRINTED_VIOLATIONS) {
        _ = writeln!(text, "  - {violation}");
    }
    if violations.len() > PRINTED_VIOLATIONS {
        _ = writeln!(text, "  - and {} more", violations.len() - PRINTED_VIOLATIONS);
    }
    _ = match violations.len() {
        0 if requirements.uneven.is_some() => writeln!(text, "verified for what each sensor needs"),
        n if requirements.uneven.is_some() => writeln!(text, "not verified for what each sensor needs: {n} violations"),
        0 => writeln!(text, "verified for t_delta = {}", us(requirements.t_delta)),
        n => writeln!(text, "not verified for t_delta = {}: {n} violations", us(requirements.t_delta)),
    };
    text
}

/// Returns the layout asked for, then the other two common ones for comparison.
fn layouts(asked: Layout<'_>) -> Vec<(String, Layout<'_>)> {
    let label = |layout| match layout {
        Layout::Line(n) => format!("line of {n}"),
        Layout::Ring(n) => format!("ring of {n}"),
        Layout::Blocks(n) => format!("blocks of {n}"),
        Layout::Graph(_) => "the pairs given".to_owned(),
    };
    let others = match asked {
        Layout::Line(n) | Layout::Ring(n) | Layout::Blocks(n) => {
            vec![Layout::Line(n), Layout::Ring(n), Layout::Blocks(n)]
        }
        Layout::Graph(_) => vec![],
    };
    let mut all = vec![(label(asked), asked)];
    for other in others.into_iter().filter(|&other| other != asked) {
        all.push((label(other) + " (not asked for)", other));
    }
    all
}

fn describe_interval(interval: Least) -> String {
    let (x, y) = (interval.sensors.0 + 1, interval.sensors.1 + 1);
    if interval.phases.0 == interval.phases.1 {
        format!("sensors {x} and {y} in phase {}", interval.phases.0)
    } else {
        format!("sensors {x} and {y} from phase {} to {}", interval.phases.0, interval.phases.1)
    }
}
