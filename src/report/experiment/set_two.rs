//! The tables of Set II: the courses at one top speed, or at several.

use std::fmt::Write as _;

use eeruf_sim::experiments::set_two::{Figures, MULTI_ECHO_CONSECUTIVE, SetTwo};

use crate::report::percent::percent;
use crate::report::table::{Column, by_name, markdown};

const FILTERS: &str = "multi_echo compares 3 readings, the other filters 2";
const _: () = assert!(MULTI_ECHO_CONSECUTIVE == 3);

const COLUMNS: [Column<Figures>; 12] = [
    ("finished", finished),
    ("contacts", |of| of.contacts.to_string()),
    ("timed out", |of| of.timed_out.to_string()),
    ("mean m/s", |of| format!("{:.2}", of.mean_speed_m_s)),
    ("top m/s", |of| format!("{:.2}", of.top_speed_m_s)),
    ("nearest m", |of| format!("{:.2}", of.nearest_m)),
    ("rejected %", |of| percent(of.rejected)),
    ("wrong %", |of| percent(of.wrong_of_all)),
    ("phantom echoes", |of| format!("{:.1}", of.phantom_echoes)),
    ("phantom cells", |of| format!("{:.1}", of.phantom_cells)),
    ("poles missed %", |of| percent(of.poles_missed)),
    ("accepted/s", |of| format!("{:.1}", of.readings_per_s)),
];

fn beside(second_robot_m: Option<[f64; 2]>) -> String {
    second_robot_m
        .map_or_else(String::new, |[x, y]| format!(", a second robot at ({x} m, {y} m) firing 24 times in 80 ms"))
}

fn bodies(bodies: bool) -> &'static str {
    if bodies { ", robots with bodies" } else { "" }
}

/// The number of courses and their seeds.
fn courses(first: u64, seeds: u64) -> String {
    format!("{seeds} courses from {first} on")
}

/// Number of courses finished, and its interval in per cent.
fn finished(figures: &Figures) -> String {
    let [low, high] = figures.finished_95.map(|share| 100.0 * share);
    format!("{} of {} ({low:.0}-{high:.0} %)", figures.finished, figures.courses)
}

pub(crate) fn describe(found: &SetTwo) -> String {
    let mut text = format!(
        "Set II: {} at up to {} m/s{}{}, pilot: {}, physics: {}{}. Finished with 95 % intervals (Wilson's);\n\
         phantoms and the nearest pole are means over the courses; {FILTERS}.\n\n",
        courses(found.first, found.seeds),
        found.speed_m_s,
        beside(found.second_robot_m),
        bodies(found.bodies),
        found.pilot,
        found.physics,
        found.conditions,
    );
    _ = writeln!(text, "{}", by_name(&[("method", str::to_owned)], &COLUMNS, &found.methods));
    text
}

/// Compares several pilots.
pub(crate) fn describe_pilots(pilots: &[SetTwo]) -> String {
    let Some(one) = pilots.first() else { return String::new() };
    let mut header = vec!["method".to_owned()];
    header.extend(pilots.iter().map(|found| format!("{}: finished, m/s", found.pilot)));
    let rows = one.methods.iter().enumerate().map(|(place, (method, _))| {
        let mut row = vec![method.clone()];
        row.extend(pilots.iter().map(|found| {
            let figures = &found.methods[place].1;
            format!("{}, {:.2}", finished(figures), figures.mean_speed_m_s)
        }));
        row
    });
    format!(
        "Set II with several pilots: {} at up to {} m/s{}{}, physics: {}{}. Finished with 95 % intervals (Wilson's), \
         and the\nmean speed; {FILTERS}.\n\n{}\n",
        courses(one.first, one.seeds),
        one.speed_m_s,
        beside(one.second_robot_m),
        bodies(one.bodies),
        one.physics,
        one.conditions,
        markdown(&header, rows)
    )
}
