//! The table of Set I.

use std::fmt::Write as _;

use eeruf_sim::BestSchedule;
use eeruf_sim::Method;
use eeruf_sim::experiments::set_one::{
    Figures, MULTI_ECHO_CONSECUTIVE, MULTI_ECHO_PATIENCE, MULTI_ECHO_T_DELTA, SetOne,
};

use crate::report::percent::{median, percents};
use crate::report::table::markdown;

/// What the paper reports of a method in Set I: how many of the readings were wrong.
fn paper(method: Method) -> &'static str {
    match method {
        Method::Conventional => "over 30, mostly 40-80",
        Method::EerufImmediate | Method::Eeruf => "under 3, mostly 1-2",
        _ => "",
    }
}

pub(crate) fn describe(found: &SetOne, best: &BestSchedule) -> String {
    let header = [
        "method",
        "paper: wrong %",
        "wrong, % of all",
        "by crosstalk",
        "wrong, % of accepted",
        "rejected %",
        "good lost %",
        "age ms",
        "age 99 %",
        "accepted/s",
        "starved",
    ];
    let rows = found.methods.iter().map(|(method, figures)| row(*method, figures));
    let mut text = format!(
        "Set I: {} alcoves, {} periods of 60 ms each; 10 % / median / 90 % of the alcoves, or the median alone.\n\
         multi_echo compares {} readings within {} and has a patience of {}, all others two within 500 us and none;\n\
         eeruf_best has a period of {} ({}).\n\n",
        found.seeds,
        found.periods,
        MULTI_ECHO_CONSECUTIVE,
        MULTI_ECHO_T_DELTA,
        MULTI_ECHO_PATIENCE,
        best.schedule.period(),
        if best.proven { "proven shortest" } else { "not proven shortest" },
    );
    _ = writeln!(text, "{}", markdown(&header, rows));
    text
}

fn row(method: Method, figures: &Figures) -> Vec<String> {
    vec![
        method.to_string(),
        paper(method).to_owned(),
        percents(figures.wrong_of_all),
        percents(figures.crosstalk_of_all),
        percents(figures.wrong_of_accepted),
        percents(figures.rejected),
        percents(figures.good_lost),
        median(figures.age_ms, 0),
        median(figures.age_p99_ms, 0),
        median(figures.readings_per_s, 1),
        format!("{:.2}", figures.starved),
    ]
}
