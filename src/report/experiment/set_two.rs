//! The tables of Set II: the courses at one top speed, or at several.

use std::fmt::Write as _;

use eeruf_sim::Physics;
use eeruf_sim::experiments::Conditions;
use eeruf_sim::experiments::set_two::{Figures, MULTI_ECHO_CONSECUTIVE, SetTwo, SetTwoOptions, SpeedStep};
use serde::Serialize;

use crate::report::json::in_order;
use crate::report::percent::percent;
use crate::report::table::markdown;

/// Share of the courses that a method must finish to sustain a speed.
const SUSTAINED: f64 = 0.95;

const FILTERS: &str = "multi_echo compares 3 readings, the other filters 2";
const _: () = assert!(MULTI_ECHO_CONSECUTIVE == 3);

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
    let header = [
        "method",
        "finished",
        "contacts",
        "timed out",
        "mean m/s",
        "top m/s",
        "nearest m",
        "rejected %",
        "wrong %",
        "phantom echoes",
        "phantom cells",
        "poles missed %",
        "accepted/s",
    ];
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
    let rows = found.methods.iter().map(|(method, figures)| row(method, figures));
    _ = writeln!(text, "{}", markdown(&header, rows));
    text
}

fn row(method: &str, figures: &Figures) -> Vec<String> {
    vec![
        method.to_string(),
        finished(figures),
        figures.contacts.to_string(),
        figures.timed_out.to_string(),
        format!("{:.2}", figures.mean_speed_m_s),
        format!("{:.2}", figures.top_speed_m_s),
        format!("{:.2}", figures.nearest_m),
        percent(figures.rejected),
        percent(figures.wrong_of_all),
        format!("{:.1}", figures.phantom_echoes),
        format!("{:.1}", figures.phantom_cells),
        percent(figures.poles_missed),
        format!("{:.1}", figures.readings_per_s),
    ]
}

/// Result of a sweep of top speeds.
#[derive(Serialize)]
pub(crate) struct Sweep {
    first: u64,
    pilot: &'static str,
    physics: Physics,
    #[serde(flatten)]
    conditions: Conditions,
    bodies: bool,
    seeds: u64,
    second_robot_m: Option<[f64; 2]>,
    steps: Vec<SpeedStep>,
    /// The highest speed at which nearly all courses are finished.
    #[serde(serialize_with = "in_order")]
    borne_m_s: Vec<(String, Option<f64>)>,
}

impl Sweep {
    pub(crate) fn of(options: &SetTwoOptions, steps: Vec<SpeedStep>) -> Self {
        let sustained = |index: usize| {
            let mut enough = steps.iter().filter(|step| step.finished[index].1 >= SUSTAINED);
            enough.next_back().map(|step| step.speed_m_s)
        };
        let borne_m_s =
            options.methods.iter().enumerate().map(|(index, of)| (of.name().to_owned(), sustained(index))).collect();
        let second_robot_m = options.second_robot.map(|at| [at.x, at.y]);
        let SetTwoOptions { first, seeds, pilots, physics, bodies, .. } = *options;
        let conditions = Conditions::of(options.room.as_ref(), options.gain);
        Self { first, pilot: pilots.as_str(), physics, conditions, bodies, seeds, second_robot_m, steps, borne_m_s }
    }

    pub(crate) fn describe(&self) -> String {
        let mut header = vec!["method".to_owned()];
        header.extend(self.steps.iter().map(|step| format!("{} m/s", step.speed_m_s)));
        header.push("sustained m/s".to_owned());
        let rows = self.borne_m_s.iter().enumerate().map(|(index, (method, sustained))| {
            let mut row = vec![method.to_string()];
            row.extend(self.steps.iter().map(|step| {
                let [low, high] = step.finished_95[index].1.map(|share| 100.0 * share);
                let (share, mean_m_s) = (100.0 * step.finished[index].1, step.mean_speed_m_s[index].1);
                format!("{share:.0} ({low:.0}-{high:.0}), {mean_m_s:.2}")
            }));
            row.push(sustained.map_or_else(|| "-".to_owned(), |speed| speed.to_string()));
            row
        });
        let mut text = format!(
            "Set II: {} at several top speeds{}{}, pilot: {}, physics: {}{}: finished % with 95 % intervals \
             (Wilson's),\n\
             mean speed in m/s. Sustained is the highest speed at which {:.0} % of the courses are finished; \
             {FILTERS}.\n\n",
            courses(self.first, self.seeds),
            beside(self.second_robot_m),
            bodies(self.bodies),
            self.pilot,
            self.physics,
            self.conditions,
            100.0 * SUSTAINED
        );
        _ = writeln!(text, "{}", markdown(&header, rows));
        text
    }
}

/// Set II with several pilots.
#[derive(Serialize)]
#[serde(transparent)]
pub(crate) struct SideBySide<'a> {
    pilots: &'a [SetTwo],
}

impl<'a> SideBySide<'a> {
    pub(crate) fn of(pilots: &'a [SetTwo]) -> Self {
        Self { pilots }
    }

    pub(crate) fn describe(&self) -> String {
        let Some(one) = self.pilots.first() else { return String::new() };
        let mut header = vec!["method".to_owned()];
        header.extend(self.pilots.iter().map(|found| format!("{}: finished, m/s", found.pilot)));
        let rows = one.methods.iter().enumerate().map(|(place, (method, _))| {
            let mut row = vec![method.to_string()];
            row.extend(self.pilots.iter().map(|found| {
                let figures = &found.methods[place].1;
                format!("{}, {:.2}", finished(figures), figures.mean_speed_m_s)
            }));
            row
        });
        let mut text = format!(
            "Set II with several pilots: {} at up to {} m/s{}{}, physics: {}{}. Finished with 95 % intervals \
             (Wilson's), and the\nmean speed; {FILTERS}.\n\n",
            courses(one.first, one.seeds),
            one.speed_m_s,
            beside(one.second_robot_m),
            bodies(one.bodies),
            one.physics,
            one.conditions,
        );
        _ = writeln!(text, "{}", markdown(&header, rows));
        text
    }
}
