//! Schedules of many phases: what `verify` found, and what `design --phases` did, as text and as JSON.

use std::fmt::Write as _;

use comfy_table::{Table, presets};
use eeruf_core::{
    Micros,
    phases::{PhaseCriterion, PhaseRequirements, PhaseVerification, PhaseViolation},
};
use eeruf_design::{HoppingDesign, PhaseSchedule, RingSpec};
use serde::Serialize;

/// The report, with the names that Python uses; sensors from 0.
#[derive(Serialize)]
pub(crate) struct ReportJson {
    ok: bool,
    separation_us: Option<u32>,
    max_t_delta_us: Option<u32>,
    min_interval_us: Option<u32>,
    min_refire_us: Option<u32>,
    violations: Vec<ViolationJson>,
}

#[derive(Serialize)]
struct ViolationJson {
    kind: &'static str,
    sensors: (u8, u8),
    phases: (u8, u8),
    value_us: u32,
    required_us: u32,
    source: &'static str,
}

impl From<PhaseViolation> for ViolationJson {
    fn from(violation: PhaseViolation) -> Self {
        let (sensors, phases, value, required) = match violation {
            PhaseViolation::Crosstalk { found, required } | PhaseViolation::StaleEcho { found, required } => {
                (found.sensors, found.phases, found.value, required)
            }
            PhaseViolation::Interval { found, required } | PhaseViolation::Window { found, required } => {
                (found.sensors, found.phases, found.value, required)
            }
            // There are no more, and a new one would be caught by the tests of what is printed.
            _ => ((0, 0), Default::default(), Micros::ZERO, Micros::ZERO),
        };
        Self {
            kind: violation.as_str(),
            sensors,
            phases: (phases.0.0, phases.1.0),
            value_us: value.as_micros(),
            required_us: required.as_micros(),
            source: violation.source(),
        }
    }
}

impl From<&PhaseVerification<'_>> for ReportJson {
    fn from(report: &PhaseVerification<'_>) -> Self {
        Self {
            ok: report.ok(),
            separation_us: report.separation().map(|found| found.value.as_micros()),
            max_t_delta_us: report.max_t_delta().map(Micros::as_micros),
            min_interval_us: report.min_interval().map(|found| found.value.as_micros()),
            min_refire_us: report.min_refire().map(|found| found.value.as_micros()),
            violations: report.violations().map(ViolationJson::from).collect(),
        }
    }
}

/// The criterion in words.
fn criterion(requirements: &PhaseRequirements<'_>) -> String {
    let separation = us(requirements.separation());
    match requirements.criterion {
        PhaseCriterion::Exact => format!("needed: {separation}, 2 t_delta + 1 us"),
        PhaseCriterion::Margin(margin) => format!("needed: {separation}, t_delta and a margin of {}", us(margin)),
    }
}

fn us(time: Micros) -> String {
    format!("{} us", time.as_micros())
}

fn new_table() -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table
}

pub(crate) fn describe(
    name: &str,
    schedule: &PhaseSchedule,
    requirements: &PhaseRequirements<'_>,
    report: &PhaseVerification<'_>,
) -> String {
    let mut table = new_table();
    let (value, who) =
        report.separation().map_or(("-".to_owned(), "nothing is heard in two phases".to_owned()), |found| {
            let ((x, y), (m, n)) = (found.sensors, found.phases);
            (us(found.value), format!("from sensor {} to {}, phases {} and {}", x + 1, y + 1, m.0, n.0))
        });
    table.add_row(["separation", &value, &who]);
    table.add_row([String::new(), String::new(), criterion(requirements)]);
    let t_delta = report.max_t_delta().map_or_else(|| "-".to_owned(), us);
    table.add_row(["largest t_delta", &t_delta, ""]);
    let interval = report.min_interval().map_or(("-".to_owned(), "no neighbours".to_owned()), |found| {
        let ((x, y), (m, n)) = (found.sensors, found.phases);
        (us(found.value), format!("sensors {} in phase {} and {} in phase {}", x + 1, m.0, y + 1, n.0))
    });
    table.add_row(["smallest interval", &interval.0, &interval.1]);
    if let Some(refire) = report.min_refire() {
        table.add_row(["shortest time between two firings of a sensor", &us(refire.value), "T_wind at most"]);
    }
    let (sensors, phases) = (schedule.sensors(), schedule.phases());
    let mut text = format!("{name}: {sensors} sensors, {phases} phases, period {}\n{table}\n", us(schedule.period()));
    for violation in report.violations() {
        _ = writeln!(text, "  - {violation}");
    }
    let verified = if report.ok() { "verified" } else { "not verified" };
    _ = writeln!(text, "{verified} for t_delta = {}", us(requirements.t_delta));
    text
}

/// Result of `design --phases`, with the names that `design` uses.
#[derive(Serialize)]
pub(crate) struct DesignJson<'d> {
    schedule: ScheduleJson,
    value_us: u32,
    bound_us: u32,
    proven: bool,
    reason: &'d str,
    width_us: u32,
    width_bound_us: u32,
}

#[derive(Serialize)]
struct ScheduleJson {
    period_us: u32,
    step_us: u32,
    phases: u8,
    first_multiplier: u8,
    t_lag_us: Vec<u32>,
}

impl<'d> From<&'d HoppingDesign> for DesignJson<'d> {
    fn from(design: &'d HoppingDesign) -> Self {
        let HoppingDesign { ref schedule, period_bound, width_bound, reason } = *design;
        let code = schedule.code();
        Self {
            schedule: ScheduleJson {
                period_us: schedule.period().as_micros(),
                step_us: code.step().as_micros(),
                phases: code.phases(),
                first_multiplier: code.first_multiplier(),
                t_lag_us: (0..code.sensors()).filter_map(|x| schedule.t_lag(x)).map(Micros::as_micros).collect(),
            },
            value_us: schedule.period().as_micros(),
            bound_us: period_bound.as_micros(),
            proven: design.proven(),
            reason,
            width_us: code.width().as_micros(),
            width_bound_us: width_bound.as_micros(),
        }
    }
}

pub(crate) fn describe_design(
    name: &str,
    spec: &RingSpec,
    requirements: &PhaseRequirements<'_>,
    design: &HoppingDesign,
) -> String {
    let HoppingDesign { schedule, period_bound, width_bound, reason } = design;
    let (code, report) = (schedule.code(), schedule.verify(requirements));
    let mut table = new_table();
    let proof = if design.proven() {
        "proven: none that separates sound of every age is shorter".to_owned()
    } else {
        format!("not proven: none that separates sound of every age is shorter than {period_bound}")
    };
    table.add_row(["period", &schedule.period().to_string(), &proof]);
    let cycle = u64::from(code.phases()) * u64::from(schedule.period().as_micros());
    table.add_row(["phases", &code.phases().to_string(), &format!("a cycle of {} ms", cycle / 1000)]);
    table.add_row(["separation", &code.step().to_string(), &criterion(requirements)]);
    table.add_row([
        "width of the code".to_owned(),
        code.width().to_string(),
        format!("no code that separates sound of every age is narrower than {width_bound}"),
    ]);
    if let Some(interval) = report.min_interval() {
        let needed = format!("needed: {}", requirements.min_interval);
        table.add_row(["smallest interval", &interval.value.to_string(), &needed]);
    }
    if let Some(refire) = report.min_refire() {
        let seen = f64::from(spec.c.distance_mm(requirements.audible.window)) / 1000.0;
        let listening = format!("{seen:.2} m; no sensor fires again within {}", refire.value);
        table.add_row(["listening", &requirements.audible.window.to_string(), &listening]);
    }
    let rate = 1e6 / f64::from(schedule.period().as_micros());
    table.add_row(["readings", &format!("{rate:.1} a second"), "of each sensor, solo periods not counted"]);
    format!(
        "{name}: {} sensors, {}\n{table}\n\nThe bound is set by {reason}.\n\n{}",
        spec.sensors,
        requirements.layout,
        schedule.to_toml()
    )
}
