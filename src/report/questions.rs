//! Schedules that fit into a period, and the curve over a need, as text and as JSON.

use eeruf_core::Micros;
use eeruf_core::search::Found;
use eeruf_design::{CurvePoint, Fit, FoundJson, Need, RingSpec};
use eeruf_files::emit::Emit as _;
use serde::Serialize;

use super::table::{counted, plain};
use super::timing;

/// Output of `--curve --json`.
#[derive(Serialize)]
pub(crate) struct CurveJson {
    need: &'static str,
    points: Vec<PointJson>,
    seconds: f64,
}

#[derive(Serialize)]
struct PointJson {
    /// The need: `t_delta`, window or interval.
    value_us: u32,
    period_us: Option<u32>,
    bound_us: Option<u32>,
    proven: bool,
}

impl CurveJson {
    pub(crate) fn new(need: Need, points: &[CurvePoint], seconds: f64) -> Self {
        let us = |time: Option<Micros>| time.map(Micros::as_micros);
        let point = |point: &CurvePoint| PointJson {
            value_us: point.value.as_micros(),
            period_us: us(point.period),
            bound_us: us(point.bound),
            proven: point.proven,
        };
        Self { need: name_of(need), points: points.iter().map(point).collect(), seconds }
    }
}

/// Output of `--period --json`: `value_us` is the largest `t_delta`.
pub(crate) fn fit_json(fit: &Fit, seconds: f64) -> FoundJson {
    let Fit { schedule, t_delta: value, bound, proven, nodes, .. } = *fit;
    FoundJson { fits: fit.fits, ..FoundJson::new(&Found { schedule, value, bound, proven, nodes }, seconds) }
}

fn name_of(need: Need) -> &'static str {
    match need {
        Need::TDelta => "t_delta",
        Need::Range => "range",
        Need::Interval => "interval",
    }
}

/// The answer to `--period`.
pub(crate) fn describe_fit(name: &str, spec: &RingSpec, period: Micros, fit: &Fit, seconds: f64) -> String {
    let requirements = &fit.spec.problem().requirements;
    let mut table = plain();
    let verdict = match fit.fits {
        Some(true) => "a schedule of this period meets all needs",
        Some(false) => "proven: no schedule of this period meets all needs",
        None => "not decided: the search ended before it found a schedule or excluded all",
    };
    table.add_row(["period", &period.to_string(), verdict]);
    if let Some(t_delta) = fit.t_delta {
        let most = match (fit.proven, fit.bound) {
            (true, _) => "no schedule of this period has more".to_owned(),
            (false, Some(bound)) => format!("the best found, at most {bound}"),
            (false, None) => "the best found".to_owned(),
        };
        let whose = if spec.uneven.is_some() { "of the sensor with the largest; " } else { "" };
        table.add_row(["t_delta", &t_delta.to_string(), &format!("{whose}needed: {}; {most}", fit.spec.t_delta)]);
    }
    table.add_row(["search", &format!("{:.1} ms", 1000.0 * seconds), &format!("{} nodes", fit.nodes)]);
    let mut text = format!("{name}: {}, {}\n{table}\n", counted(spec.sensors, "sensor"), requirements.layout);
    if let Some(schedule) = &fit.schedule {
        text += &format!("\n{}\n{}\n", timing::diagram(schedule, requirements), schedule.to_toml());
    }
    text
}

/// The answer to `--curve`.
pub(crate) fn describe_curve(name: &str, spec: &RingSpec, need: Need, points: &[CurvePoint], seconds: f64) -> String {
    let mut table = plain();
    table.add_row([name_of(need), "period", "readings a second", ""]);
    for point in points {
        let value = match need {
            Need::Range => format!("{:.2} m", f64::from(spec.c.distance_mm(point.value)) / 1000.0),
            Need::TDelta | Need::Interval => point.value.to_string(),
        };
        let own = if point.tenths == 10 { ", the ring's own" } else { "" };
        let (period, rate) = match point.period {
            Some(period) => (period.to_string(), format!("{:.1}", 1e6 / f64::from(period.as_micros()))),
            None => ("none".to_owned(), String::new()),
        };
        let proof = match (point.proven, point.bound) {
            (true, _) => format!("proven{own}"),
            (false, Some(bound)) => format!("or as short as {bound}{own}"),
            (false, None) => format!("not decided{own}"),
        };
        table.add_row([value, period, rate, proof]);
    }
    format!(
        "{name}: {} sensors, the shortest period for {} values of {}, in ticks of {} ({seconds:.2} s)\n{table}\n",
        spec.sensors,
        points.len(),
        name_of(need),
        spec.tick
    )
}
