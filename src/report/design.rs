//! Result of `design`, as text.

use std::fmt::Write as _;

use eeruf_core::tables::TABLE_I_D;
use eeruf_core::{Micros, Phase, Requirements};
use eeruf_design::{RingDesign, RingSpec, ToSpare, WhatIf};
use eeruf_files::emit::Emit as _;
use eeruf_sim::AnySchedule;

use super::table::{counted, plain};
use super::timing;

pub(crate) fn describe(name: &str, spec: &RingSpec, design: &RingDesign, seconds: f64) -> String {
    let RingDesign { schedule, found, to_spare, what_if, .. } = design;
    let requirements = &design.spec.problem().requirements;
    let report = schedule.verify(requirements);
    let period = schedule.period();
    let mut table = plain();
    let none = format!("no schedule in ticks of {} is shorter", spec.tick);
    let proof = match design.certified() {
        _ if !found.proven => format!("not proven: it may be as short as {}", found.bound.unwrap_or(period)),
        Some(certified) if certified < period => {
            format!("proven, not certified: {none}; a short certificate says that none is below {certified}")
        }
        Some(_) => format!("proven: {none}"),
        None => format!("proven, not certified: {none}"),
    };
    table.add_row(["period", &period.to_string(), &proof]);
    let best = |proven: Option<bool>| match proven {
        Some(true) => ", and no schedule of this period has more",
        Some(false) => ", the best found",
        None => "",
    };
    table.add_row([
        "t_delta".to_owned(),
        report.max_t_delta().map_or_else(|| "none".to_owned(), |t_delta| t_delta.to_string()),
        match &spec.uneven {
            None => format!(
                "needed: {}, {} of range{}",
                requirements.t_delta,
                as_range(spec, requirements.t_delta),
                best(to_spare.map(|spare| spare.proven[0]))
            ),
            Some(_) => format!(
                "if all sensors had the same; needed: {}, and kept; the largest is {} of range",
                span(spec.sensors, |sensor| design.spec.problem().requirements.t_delta_of(sensor)),
                as_range(spec, design.spec.t_delta)
            ),
        },
    ]);
    if let Some(interval) = report.min_interval() {
        table.add_row([
            "smallest interval".to_owned(),
            interval.value.to_string(),
            match &spec.uneven {
                None => {
                    format!("needed: {}{}", requirements.min_interval, best(to_spare.map(|spare| spare.proven[1])))
                }
                Some(_) => "between two that need one; all are kept".to_owned(),
            },
        ]);
    }
    if let (Some(ToSpare { t_delta, interval, refire, proven, .. }), Some(_)) = (to_spare, &spec.uneven) {
        let whose = if *proven == [true; 3] { "no schedule of this period has more" } else { "the best found" };
        table.add_row([
            "to spare".to_owned(),
            format!("{t_delta}, {interval}, {refire}"),
            format!("beyond every t_delta, then every interval, then every refire time; {whose}"),
        ]);
    }
    let listens = design.spec.table_requirements();
    table.add_row([
        "listening".to_owned(),
        span(spec.sensors, |sensor| listens.window_of(sensor)),
        format!(
            "{:.2} m; no sensor fires again within {}",
            f64::from(spec.c.distance_mm(listens.window)) / 1000.0,
            report.min_refire()
        ),
    ]);
    let speed = schedule.max_speed_mm_s(report.max_t_delta().unwrap_or(Micros::ZERO), spec.c.mm_per_s());
    table.add_row([
        "motion".to_owned(),
        format!("{:.2} m/s", f64::from(speed) / 1000.0),
        format!("before good readings differ by more than t_delta ({} at most between firings)", schedule.max_refire()),
    ]);
    let rate = |period: f64| 1e6 / period;
    let us = f64::from(period.as_micros());
    table.add_row(["firings".to_owned(), format!("{:.1} a second", rate(us)), "of each sensor".to_owned()]);
    if let Some(paper) = papers_period_us(spec, requirements) {
        table.add_row([
            String::new(),
            String::new(),
            format!("{:.2} times Table I-d scaled to the same needs ({:.1} a second)", paper / us, rate(paper)),
        ]);
    }
    let choice = to_spare.map_or(0, |spare| spare.nodes);
    let from = match design.from_atlas {
        true => "from the atlas, verified; --no-atlas searches".to_owned(),
        false => format!("{} nodes, and {choice} for the choice", found.nodes),
    };
    table.add_row(["search".to_owned(), format!("{:.1} ms", 1000.0 * seconds), from]);

    let mut text = format!("{name}: {}, {}\n{table}\n", counted(spec.sensors, "sensor"), requirements.layout);
    text += &not_neighbours(spec);
    _ = writeln!(text, "\nNot shorter because of {}.", design.reason);
    if !what_if.is_empty() {
        _ = writeln!(text, "\n{}", ways_to_get_faster(what_if, period));
    }
    text.push('\n');
    text += &timing::diagram(schedule, requirements);
    _ = writeln!(text, "\n{}", schedule.to_toml());
    text
}

/// Lists the pairs that are no neighbours in their places, with sensors counted from 1.
fn not_neighbours(spec: &RingSpec) -> String {
    const NAMED: usize = 6;
    let pairs = &spec.not_neighbours;
    if pairs.is_empty() {
        return String::new();
    }
    let named =
        pairs.iter().take(NAMED).map(|(x, y)| format!("{} and {}", x + 1, y + 1)).collect::<Vec<_>>().join(", ");
    let more = if pairs.len() > NAMED { ", .." } else { "" };
    let range_m = f64::from(spec.c.distance_mm(spec.min_interval)) / 1000.0;
    let pairs = counted(pairs.len(), "pair");
    format!(
        "\nFrom their places {pairs} of {} adjacent sensors hear nothing of each other off walls up to \
         {range_m:.2} m, and may fire close together: {named}{more}.\n",
        spec.neighbours
    )
}

/// Formats a time that all sensors share, or the shortest and the longest.
fn span(sensors: usize, of: impl Fn(usize) -> Micros) -> String {
    let least = (0..sensors).map(&of).min().unwrap_or_default();
    let most = (0..sensors).map(&of).max().unwrap_or_default();
    if least == most { most.to_string() } else { format!("{least} to {most}") }
}

/// Formats a time as the change of range that it corresponds to.
fn as_range(spec: &RingSpec, time: Micros) -> String {
    // c/2 in mm/s times us is 1e-7 cm.
    format!("{:.1} cm", 0.5e-7 * f64::from(spec.c.mm_per_s()) * f64::from(time.as_micros()))
}

/// Lists changes by which the designer may get a shorter period.
fn ways_to_get_faster(cases: &[WhatIf], period: Micros) -> String {
    let mut table = plain();
    for WhatIf { need, period: with, proven } in cases {
        let verdict = match with {
            Some(with) if *with < period && *proven => format!("{with}"),
            Some(with) if *with < period => format!("{with} or less"),
            _ if *proven => "no shorter".to_owned(),
            _ => "not found out".to_owned(),
        };
        table.add_row([need, &verdict]);
    }
    format!("To get faster than {period}, one change at a time:\n{table}")
}

/// Returns the period to which Table I-d, cut to this many sensors, must be scaled to meet the same requirements.
fn papers_period_us(spec: &RingSpec, requirements: &Requirements<'_>) -> Option<f64> {
    if spec.sensors > TABLE_I_D.sensors() || spec.uneven.is_some() {
        return None;
    }
    let cut = |phase| TABLE_I_D.t_wait(phase).get(..spec.sensors);
    let table = AnySchedule::from_slices(
        TABLE_I_D.period(),
        TABLE_I_D.t_lag().get(..spec.sensors)?,
        [cut(Phase::A)?, cut(Phase::B)?],
    )
    .ok()?;
    let report = table.verify(requirements);
    let ratio = |needed: Micros, has: Micros| f64::from(needed.as_micros()) / f64::from(has.as_micros());
    let mut scale = ratio(requirements.window, report.min_refire());
    if let Some(max_t_delta) = report.max_t_delta() {
        scale = scale.max(ratio(requirements.separation(), Micros::new(2 * max_t_delta.as_micros() + 1)));
    }
    if let Some(interval) = report.min_interval() {
        scale = scale.max(ratio(requirements.min_interval, interval.value));
    }
    // Where all are neighbours, no scale keeps the table's interval of 0.
    Some(scale * f64::from(TABLE_I_D.period().as_micros())).filter(|us| us.is_finite())
}
