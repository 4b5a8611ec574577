//! A study in words and tables.

use std::fmt::Write as _;
use std::path::Path;

use eeruf_sim::{Readings, Summary, World};

use super::fooled::Fooled;
use super::found::{Study, TOLERANCE_US, of_robot};
use crate::report::percent::fine_percent;
use crate::report::table::{Column, by_name, counted, or_dash};

pub(crate) fn describe(file: &Path, world: &World, study: &Study) -> String {
    let scene = world.scene();
    let mut text = format!(
        "{}: {}, {}, sound followed for up to {} bounces; seed {}\n",
        file.display(),
        counted(scene.walls().len(), "wall"),
        counted(scene.poles().len(), "pole"),
        world.max_order(),
        study.seed
    );
    for (index, robot) in world.robots().iter().enumerate() {
        let sensors = robot.sensors.len();
        let runs: Vec<Readings> = study.runs.iter().map(|readings| of_robot(readings, index, sensors)).collect();
        let seconds = runs.first().map_or(0.0, |readings| readings.duration_s);
        _ = writeln!(
            text,
            "\nRobot {}: {sensors} sensors, period {}, listening for {}, t_delta {}; {seconds:.0} s simulated",
            index + 1,
            robot.period,
            robot.window,
            robot.t_delta,
        );
        text += &tables(&runs);
        let fooled = Fooled::of(&runs, index, TOLERANCE_US);
        text += &fooled.describe();
    }
    if let Some(best) = &study.best {
        let proof = if best.proven() {
            "proven: no schedule with the same guarantees is shorter"
        } else {
            "not proven shortest"
        };
        _ = writeln!(text, "\neeruf_best fires with a period of {} ({proof}).", best.period());
    }
    for (method, why) in &study.left_out {
        _ = writeln!(text, "{method} is left out: {why}.");
    }
    text
}

const READINGS: [Column<Summary>; 4] = [
    ("wrong, % of all", |of| fine_percent(of.wrong_of_all)),
    ("% of accepted", |of| or_dash(of.wrong_of_accepted, fine_percent)),
    ("rejected %", |of| fine_percent(of.rejected)),
    ("good lost %", |of| or_dash(of.good_lost, fine_percent)),
];

const RATES: [Column<Summary>; 6] = [
    ("age ms, median", |of| format!("{:.0}", of.age_ms.median)),
    ("99 %", |of| format!("{:.0}", of.age_ms.p99)),
    ("accepted/s", |of| format!("{:.1}", of.readings_per_s)),
    ("right echoes/s", |of| format!("{:.1}", of.right_echoes_per_s)),
    ("starved", |of| count(of.starved)),
    ("blind", |of| count(of.blind)),
];

const BELIEF: [Column<Summary>; 5] = [
    ("belief right %", |of| fine_percent(of.belief.right)),
    ("unknown", |of| fine_percent(of.belief.unknown)),
    ("phantom", |of| fine_percent(of.belief.phantom)),
    ("too far", |of| fine_percent(of.belief.too_far)),
    ("faint", |of| fine_percent(of.belief.faint)),
];

fn count(count: usize) -> String {
    or_dash((count > 0).then_some(count), |count| count.to_string())
}

/// Three tables, each narrow enough for a page: readings, their rate and age, and belief.
fn tables(runs: &[Readings]) -> String {
    let named = |run: &Readings| (run.method.to_string(), run.summary());
    let summaries: Vec<(String, Summary)> = runs.iter().map(named).collect();
    let table = |columns: &[_]| format!("\n{}\n", by_name(&[("method", str::to_owned)], columns, &summaries));
    [table(&READINGS), table(&RATES), table(&BELIEF)].concat()
}
