//! The table of Set I.

use std::fmt::Write as _;

use eeruf_core::Micros;
use eeruf_sim::ShortestPeriod;
use eeruf_sim::experiments::Spread;
use eeruf_sim::experiments::set_one::{Figures, Latency, MultiEcho, NewStep, SetOne};

use crate::report::percent::{fine_percent, mean_95, median, median_95, percents, percents_95};
use crate::report::table::{Column, by_name, or_dash};

/// The paper's figure for a method in Set I: the share of wrong readings.
fn paper(method: &str) -> String {
    let figure = match method {
        "conventional" => "over 30, mostly 40-80",
        // This is for scheduled firing; the paper has no such figure for immediate refiring.
        "eeruf" => "under 3, mostly 1-2",
        _ => "",
    };
    figure.to_owned()
}

const COLUMNS: [Column<Figures>; 14] = [
    ("wrong, % of all", |of| percents(of.wrong_of_all)),
    ("confirmed", |of| percents(of.confirmed_wrong_of_all)),
    ("by crosstalk", |of| percents(of.crosstalk_of_all)),
    ("wrong, % of accepted", |of| percents(of.wrong_of_accepted)),
    ("rejected %", |of| percents(of.rejected)),
    ("good lost %", |of| percents(of.good_lost)),
    ("age ms", |of| median(of.age_ms, 0)),
    ("age 99 %", |of| median(of.age_p99_ms, 0)),
    ("accepted/s", |of| median(of.readings_per_s, 1)),
    ("starved", |of| format!("{:.2}", of.starved)),
    ("in part", |of| format!("{:.2}", of.starved_in_part)),
    ("blind", |of| format!("{:.2}", of.blind)),
    ("nearer", |of| latency(of.nearer)),
    ("farther", |of| latency(of.farther)),
];

const INTERVALS: [Column<Figures>; 6] = [
    ("wrong, % of all", |of| percents_95(of.wrong_of_all)),
    ("confirmed", |of| percents_95(of.confirmed_wrong_of_all)),
    ("good lost %", |of| percents_95(of.good_lost)),
    ("age 99 %", |of| median_95(of.age_p99_ms, 0)),
    ("accepted/s", |of| median_95(of.readings_per_s, 1)),
    ("starved", |Figures { starved, starved_95: [low, high], .. }| format!("{starved:.2} ({low:.2}-{high:.2})")),
];

const BELIEF: [Column<Figures>; 7] = [
    ("right", |of| mean_95(of.belief_right, 100.0, 1)),
    ("unknown", |of| mean(of.unknown)),
    ("phantom", |of| mean(of.phantom)),
    ("too far", |of| mean(of.too_far)),
    ("faint", |of| mean(of.faint)),
    ("right echoes/s", |of| median(of.right_echoes_per_s, 1)),
    ("new step ms, 50 / 90 / 95 %", |of| new_step(of.new_step)),
];

pub(crate) fn describe(found: &SetOne, best: &ShortestPeriod) -> String {
    let MultiEcho { consecutive, t_delta } = MultiEcho::TUNED;
    let mut text = format!(
        "Set I: {} alcoves from {} on, {} sensors, {} periods of {} each, physics: {}{}; 10 % / median / 90 % \
         of the alcoves, or the median alone.\n\
         Starved: sensors with under 5 % of their readings accepted, on average; in part: those of them that read\n\
         right in one phase and not in another; blind: those that were right under 5 % of the times they\n\
         fired.\n\
         multi_echo compares {} readings within {}, all others two within 500 us;\n\
         eeruf_best has a period of {} ({}). Nearer, farther: after how many periods a back wall that steps by 0.25 m\n\
         is read right, median / 90 % of the steps, and how many never are within 64.\n\n",
        found.seeds,
        found.first,
        found.sensors,
        found.periods,
        Micros::new(found.period_us),
        found.physics,
        found.conditions,
        consecutive,
        t_delta,
        best.schedule.period(),
        if best.proven() { "proven shortest" } else { "not proven shortest" },
    );
    let methods = &found.methods;
    _ = writeln!(text, "{}", by_name(&[("method", str::to_owned), ("paper: wrong %", paper)], &COLUMNS, methods));
    _ = writeln!(text, "\n{}", by_name(&[("median, 90 % (95 % intervals)", str::to_owned)], &INTERVALS, methods));
    _ = writeln!(
        text,
        "\nWhat was last believed, no longer than 0.6 s ago: right, unknown, foreign sound, an own later echo, an own\n\
         nearer one (faint but real). New step: from the first step nearer to the right reading, and how many are\n\
         never seen.\n\n{}",
        by_name(&[("% of the time (mean, 95 %)", str::to_owned)], &BELIEF, methods)
    );
    text
}

fn mean(spread: Option<Spread>) -> String {
    or_dash(spread, |spread| fine_percent(spread.mean))
}

fn new_step(step: Option<NewStep>) -> String {
    let Some(NewStep { median_ms, p90_ms, p95_ms, never, .. }) = step else { return "-".to_owned() };
    let ms = |ms: Option<f64>| ms.map_or_else(|| "never".to_owned(), |ms| format!("{ms:.0}"));
    format!("{} / {} / {}, {} %", ms(median_ms), ms(p90_ms), ms(p95_ms), fine_percent(never))
}

/// Formats median and 90 % in periods, and the share of steps that are never seen.
fn latency(latency: Option<Latency>) -> String {
    let Some(Latency { median, p90, never, .. }) = latency else { return "-".to_owned() };
    let periods = |periods: Option<u32>| periods.map_or_else(|| "never".to_owned(), |periods| periods.to_string());
    format!("{} / {}, {} %", periods(median), periods(p90), fine_percent(never))
}
