//! A study in words and tables.

use std::fmt::Write as _;
use std::path::Path;

use comfy_table::Table;
use eeruf_sim::{Readings, Summary, World};

use super::fooled::Fooled;
use super::found::{Study, TOLERANCE_US, of_robot};
use crate::report::percent::fine_percent;
use crate::report::table::{counted, markdown};

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

/// Three tables, each narrow enough for a page: readings, their rate and age, and belief.
fn tables(runs: &[Readings]) -> String {
    let summaries: Vec<Summary> = runs.iter().map(Readings::summary).collect();
    let share = |share: Option<f64>| share.map_or_else(|| "-".to_owned(), fine_percent);
    let count = |count: usize| if count == 0 { "-".to_owned() } else { count.to_string() };
    let readings = |of: &Summary| {
        [fine_percent(of.wrong_of_all), share(of.wrong_of_accepted), fine_percent(of.rejected), share(of.good_lost)]
    };
    let rates = |of: &Summary| {
        [
            format!("{:.0}", of.age_ms.median),
            format!("{:.0}", of.age_ms.p99),
            format!("{:.1}", of.readings_per_s),
            format!("{:.1}", of.right_echoes_per_s),
            count(of.starved),
            count(of.blind),
        ]
    };
    let belief = |of: &Summary| {
        let shares = &of.belief;
        [shares.right, shares.unknown, shares.phantom, shares.too_far, shares.faint].map(fine_percent)
    };
    [
        table(&summaries, ["method", "wrong, % of all", "% of accepted", "rejected %", "good lost %"], readings),
        table(
            &summaries,
            ["method", "age ms, median", "99 %", "accepted/s", "right echoes/s", "starved", "blind"],
            rates,
        ),
        table(&summaries, ["method", "belief right %", "unknown", "phantom", "too far", "faint"], belief),
    ]
    .map(|table| format!("\n{table}\n"))
    .concat()
}

fn table<const H: usize, const N: usize>(
    summaries: &[Summary],
    header: [&str; H],
    cells: impl Fn(&Summary) -> [String; N],
) -> Table {
    let row = |summary: &Summary| core::iter::once(summary.method.to_string()).chain(cells(summary)).collect();
    markdown(&header, summaries.iter().map(row))
}
