//! The table of Set I.

use std::fmt::Write as _;

use eeruf_core::Micros;
use eeruf_sim::ShortestPeriod;
use eeruf_sim::experiments::Spread;
use eeruf_sim::experiments::set_one::{Figures, Latency, MultiEcho, NewStep, SetOne};

use crate::report::percent::{fine_percent, median, median_95, percent, percents, percents_95};
use crate::report::table::{markdown, or_dash};

/// The paper's figure for a method in Set I: the share of wrong readings.
fn paper(method: &str) -> &'static str {
    match method {
        "conventional" => "over 30, mostly 40-80",
        // This is for scheduled firing; the paper has no such figure for immediate refiring.
        "eeruf" => "under 3, mostly 1-2",
        _ => "",
    }
}

pub(crate) fn describe(found: &SetOne, best: &ShortestPeriod) -> String {
    let header = [
        "method",
        "paper: wrong %",
        "wrong, % of all",
        "confirmed",
        "by crosstalk",
        "wrong, % of accepted",
        "rejected %",
        "good lost %",
        "age ms",
        "age 99 %",
        "accepted/s",
        "starved",
        "in part",
        "blind",
        "nearer",
        "farther",
    ];
    let rows = found.methods.iter().map(|(method, figures)| row(method, figures));
    let MultiEcho { consecutive, t_delta } = MultiEcho::TUNED;
    let mut text = format!(
        "Set I: {}, {} sensors, {} periods of {} each, physics: {}{}; 10 % / median / 90 % of the alcoves, or the \
         median alone.\n\
         Starved: sensors with under 5 % of their readings accepted, on average; in part: those of them that read\n\
         right in one phase and not in another; blind: those that were right under 5 % of the times they\n\
         fired.\n\
         multi_echo compares {} readings within {}, all others two within 500 us;\n\
         eeruf_best has a period of {} ({}). Nearer, farther: after how many periods a back wall that steps by 0.25 m\n\
         is read right, median / 90 % of the steps, and how many never are within 64.\n\n",
        alcoves(found),
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
    _ = writeln!(text, "{}", markdown(&header, rows));
    let header = [
        "median, 90 % (95 % intervals)",
        "wrong, % of all",
        "confirmed",
        "good lost %",
        "age 99 %",
        "accepted/s",
        "starved",
    ];
    let rows = found.methods.iter().map(|(method, figures)| intervals(method, figures));
    _ = writeln!(text, "\n{}", markdown(&header, rows));
    let header = [
        "% of the time (mean, 95 %)",
        "right",
        "unknown",
        "phantom",
        "too far",
        "faint",
        "right echoes/s",
        "new step ms, 50 / 90 / 95 %",
    ];
    let rows = found.methods.iter().map(|(method, figures)| belief(method, figures));
    _ = writeln!(
        text,
        "\nWhat was last believed, no longer than 0.6 s ago: right, unknown, foreign sound, an own later echo, an own\n\
         nearer one (faint but real). New step: from the first step nearer to the right reading, and how many are\n\
         never seen.\n\n{}",
        markdown(&header, rows)
    );
    text
}

fn belief(method: &str, figures: &Figures) -> Vec<String> {
    let mean = |spread: Option<Spread>| or_dash(spread, |spread| fine_percent(spread.mean));
    let right = or_dash(figures.belief_right, |Spread { mean, mean_95: [low, high], .. }| {
        format!("{:.1} ({:.1}-{:.1})", 100.0 * mean, 100.0 * low, 100.0 * high)
    });
    vec![
        method.to_string(),
        right,
        mean(figures.unknown),
        mean(figures.phantom),
        mean(figures.too_far),
        mean(figures.faint),
        median(figures.right_echoes_per_s, 1),
        new_step(figures.new_step),
    ]
}

fn new_step(step: Option<NewStep>) -> String {
    let Some(NewStep { median_ms, p90_ms, p95_ms, never, .. }) = step else { return "-".to_owned() };
    let ms = |ms: Option<f64>| ms.map_or_else(|| "never".to_owned(), |ms| format!("{ms:.0}"));
    format!("{} / {} / {}, {} %", ms(median_ms), ms(p90_ms), ms(p95_ms), fine_percent(never))
}

fn alcoves(found: &SetOne) -> String {
    format!("{} alcoves from {} on", found.seeds, found.first)
}

fn intervals(method: &str, figures: &Figures) -> Vec<String> {
    let [low, high] = figures.starved_95;
    vec![
        method.to_string(),
        percents_95(figures.wrong_of_all),
        percents_95(figures.confirmed_wrong_of_all),
        percents_95(figures.good_lost),
        median_95(figures.age_p99_ms, 0),
        median_95(figures.readings_per_s, 1),
        format!("{:.2} ({low:.2}-{high:.2})", figures.starved),
    ]
}

/// Formats median and 90 % in periods, and the share of steps that are never seen.
fn latency(latency: Option<Latency>) -> String {
    let Some(Latency { median, p90, never, .. }) = latency else { return "-".to_owned() };
    let periods = |periods: Option<u32>| periods.map_or_else(|| "never".to_owned(), |periods| periods.to_string());
    format!("{} / {}, {} %", periods(median), periods(p90), fine_percent(never))
}

fn row(method: &str, figures: &Figures) -> Vec<String> {
    vec![
        method.to_string(),
        paper(method).to_owned(),
        percents(figures.wrong_of_all),
        percents(figures.confirmed_wrong_of_all),
        percents(figures.crosstalk_of_all),
        percents(figures.wrong_of_accepted),
        percents(figures.rejected),
        percents(figures.good_lost),
        median(figures.age_ms, 0),
        median(figures.age_p99_ms, 0),
        median(figures.readings_per_s, 1),
        format!("{:.2}", figures.starved),
        format!("{:.2}", figures.starved_in_part),
        format!("{:.2}", figures.blind),
        latency(figures.nearer),
        latency(figures.farther),
    ]
}

/// Describes how the figures change with the varied setting.
pub(crate) fn describe_variations(found: &[(&str, SetOne)]) -> String {
    let Some((_, one)) = found.first() else { return String::new() };
    let mut text = format!(
        "Set I, {}, {} periods of {} each, physics: {}{}, one setting changed at a time: wrong, % of all / \
         good lost %,\n\
         medians with 95 % intervals, and starved sensors on average.\n\n",
        alcoves(one),
        one.periods,
        Micros::new(one.period_us),
        one.physics,
        one.conditions,
    );
    let mut header = vec!["setting".to_owned()];
    header.extend(one.methods.iter().map(|(method, _)| method.to_string()));
    let rows = found.iter().map(|(name, table)| {
        let mut row = vec![(*name).to_owned()];
        row.extend(table.methods.iter().map(|(_, figures)| varied(figures)));
        row
    });
    _ = writeln!(text, "{}", markdown(&header, rows));
    text
}

fn varied(figures: &Figures) -> String {
    let percents = |spread: Option<Spread>| {
        or_dash(spread, |Spread { median, median_95: [low, high], .. }| {
            format!("{} ({}-{})", percent(median), percent(low), percent(high))
        })
    };
    format!("{} / {}, {:.2}", percents(figures.wrong_of_all), percents(figures.good_lost), figures.starved)
}
