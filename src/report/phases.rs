//! Schedules of many phases: what `verify` found, and what `design --phases` did, as text and as JSON.

use std::fmt::Write as _;

use eeruf_core::{Criterion, MAX_SENSORS, Micros, Requirements, conditions::Verification};
use eeruf_design::{HoppingDesign, PhaseSchedule, RingSpec};
use serde::Serialize;

use super::table::{or_dash, plain};
use super::verify::us;

/// The criterion in words.
fn criterion(requirements: &Requirements<'_>) -> String {
    let separation = us(requirements.separation());
    let of = if requirements.uneven.is_some_and(|uneven| !uneven.t_delta.is_empty()) { "the largest " } else { "" };
    match requirements.criterion {
        Criterion::Margin(margin) => format!("needed: {separation}, {of}t_delta and a margin of {}", us(margin)),
        _ => format!("needed: {separation}, 2 {of}t_delta + 1 us"),
    }
}

pub(crate) fn describe(
    name: &str,
    schedule: &PhaseSchedule,
    requirements: &Requirements<'_>,
    report: &Verification<'_, MAX_SENSORS>,
) -> String {
    let mut table = plain();
    let (value, who) =
        report.separation().map_or(("-".to_owned(), "nothing is heard in two phases".to_owned()), |found| {
            let ((x, y), (m, n)) = (found.sensors, found.phases);
            (us(found.value), format!("from sensor {} to {}, phases {m} and {n}", x + 1, y + 1))
        });
    table.add_row(["separation", &value, &who]);
    table.add_row([String::new(), String::new(), criterion(requirements)]);
    let t_delta = or_dash(report.max_t_delta(), us);
    table.add_row(["largest t_delta", &t_delta, ""]);
    let interval = report.min_interval().map_or(("-".to_owned(), "no neighbours".to_owned()), |found| {
        let ((x, y), (m, n)) = (found.sensors, found.phases);
        (us(found.value), format!("sensors {} in phase {m} and {} in phase {n}", x + 1, y + 1))
    });
    table.add_row(["smallest interval", &interval.0, &interval.1]);
    table.add_row(["shortest time between two firings of a sensor", &us(report.min_refire()), "T_wind at most"]);
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
    #[serde(skip_serializing_if = "Vec::is_empty")]
    together: Vec<Vec<usize>>,
}

impl<'d> From<&'d HoppingDesign> for DesignJson<'d> {
    fn from(design: &'d HoppingDesign) -> Self {
        let HoppingDesign { ref schedule, ref together, period_bound, width_bound, reason } = *design;
        let members = |&set: &u64| (0..MAX_SENSORS).filter(|sensor| set >> sensor & 1 == 1).collect();
        let code = schedule.code();
        Self {
            schedule: ScheduleJson {
                period_us: schedule.period().as_micros(),
                step_us: code.step().as_micros(),
                phases: code.phases(),
                first_multiplier: code.first_multiplier(),
                t_lag_us: (0..code.sensors()).filter_map(|x| schedule.t_lag(x)).map(Micros::as_micros).collect(),
                together: together.iter().map(members).collect(),
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
    requirements: &Requirements<'_>,
    design: &HoppingDesign,
) -> String {
    let HoppingDesign { schedule, period_bound, width_bound, reason, .. } = design;
    let (code, report) = (schedule.code(), schedule.verify(requirements));
    let mut table = plain();
    let age = if code.is_welch() { "the same period" } else { "every age" };
    let of_which = format!("none that separates sound of {age}");
    let proof = if design.proven() {
        format!("proven: {of_which} is shorter")
    } else {
        format!("not proven: {of_which} is shorter than {period_bound}")
    };
    table.add_row(["period", &schedule.period().to_string(), &proof]);
    let cycle = u64::from(code.phases()) * u64::from(schedule.period().as_micros());
    table.add_row(["phases", &code.phases().to_string(), &format!("a cycle of {} ms", cycle / 1000)]);
    table.add_row(["separation", &code.step().to_string(), &criterion(requirements)]);
    let width = format!("no code that separates sound of {age} is narrower than {width_bound}");
    table.add_row(["width of the code", &code.width().to_string(), &width]);
    if let Some(interval) = report.min_interval() {
        let own = requirements.uneven.is_some_and(|uneven| !uneven.intervals.is_empty());
        let needed =
            format!("needed: {}{}", requirements.min_interval, if own { ", or what the pair asks for" } else { "" });
        table.add_row(["smallest interval", &interval.value.to_string(), &needed]);
    }
    let seen = f64::from(spec.c.distance_mm(requirements.window)) / 1000.0;
    let listening = format!("{seen:.2} m; no sensor fires again within {}", report.min_refire());
    table.add_row(["listening", &requirements.window.to_string(), &listening]);
    let rate = 1e6 / f64::from(schedule.period().as_micros());
    table.add_row(["readings", &format!("{rate:.1} a second"), "of each sensor, solo periods not counted"]);
    let odometry = match spec.speed_mm_s {
        Some(speed) if speed > 0 => {
            "T_delta is that of a robot that stands: while it drives, each poll needs the change that odometry \
             expects.\n"
        }
        _ => "",
    };
    format!(
        "{name}: {} sensors, {}\n{table}\n\nThe bound is set by {reason}.\n{odometry}\n{}",
        spec.sensors,
        requirements.layout,
        design.phases().to_toml().unwrap_or_default()
    )
}
