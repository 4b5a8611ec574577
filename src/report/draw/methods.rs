//! Methods side by side: wrong shares of believed readings, shares rejected, and good readings lost.

use eeruf_sim::{Method, Summary};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBColor};

use super::picture::Picture;
use super::style::{ACCEPTED, CAPTION, INK, LISTENING, REJECTED, SMALL, TITLE, UNCOMPARED, grid_step, tick_label};

const LEFT: f64 = 140.0;
const WIDTH: f64 = 900.0;
const TOP: f64 = 104.0;
const LANE: f64 = 28.0;
/// Room at the right of each column for the number at its longest bar.
const ROOM: f64 = 50.0;

/// A figure: its name, unit and colour, and the function that takes it from a summary.
type Column = (&'static str, &'static str, RGBColor, fn(&Summary) -> Option<f64>);

fn in_percent(share: Option<f64>) -> Option<f64> {
    share.map(|share| 100.0 * share)
}

/// One line for each method, one column of bars for each figure.
pub(crate) fn methods_chart(summaries: &[Summary]) -> Picture {
    let bottom = TOP + LANE * summaries.len() as f64;
    let mut picture = Picture::new(WIDTH, bottom + 44.0);
    picture.text("Readings by each method in one scene, on one seed; flow is shaded", (16.0, 22.0), TITLE);
    for (lane, summary) in summaries.iter().enumerate() {
        let y = TOP + LANE * (lane as f64 + 0.5);
        if summary.method == Method::Flow {
            picture.rect([(8.0, y - 0.5 * LANE), (WIDTH - 8.0, y + 0.5 * LANE)], LISTENING.mix(0.5));
        }
        picture.text_in(summary.method.to_string(), (LEFT - 10.0, y), CAPTION, HPos::Right, INK);
    }
    let columns: [Column; 4] = [
        ("wrong", "of accepted, %", REJECTED, |summary| in_percent(summary.wrong_of_accepted)),
        ("rejected", "of all, %", UNCOMPARED, |summary| in_percent(Some(summary.rejected))),
        ("good lost", "of good, %", LISTENING, |summary| in_percent(summary.good_lost)),
        ("accepted", "readings a second", ACCEPTED, |summary| Some(summary.readings_per_s)),
    ];
    let column_width = (WIDTH - LEFT) / columns.len() as f64;
    for (column, (name, unit, colour, value_of)) in columns.into_iter().enumerate() {
        let left = LEFT + column as f64 * column_width;
        let most = summaries.iter().filter_map(value_of).fold(0.0, f64::max).max(1.0);
        let scale = (column_width - ROOM) / most;
        picture.text(name, (left, 58.0), CAPTION);
        picture.text_in(unit, (left, 80.0), SMALL, HPos::Left, INK.mix(0.75));
        let step = grid_step(most, 3.0);
        for line in 0..=(most / step) as u32 {
            let value = f64::from(line) * step;
            let x = left + value * scale;
            picture.line((x, TOP - 4.0), (x, bottom + 4.0), 1.0, INK.mix(0.15));
            picture.text_in(tick_label(value, step), (x, bottom + 16.0), SMALL, HPos::Center, INK);
        }
        for (lane, summary) in summaries.iter().enumerate() {
            let y = TOP + LANE * (lane as f64 + 0.5);
            let Some(value) = value_of(summary) else {
                picture.text("none", (left + 4.0, y), SMALL);
                continue;
            };
            let end = left + value * scale;
            picture.rect([(left, y - 8.0), (end.max(left + 1.0), y + 8.0)], colour);
            picture.text(rounded(value), (end + 5.0, y), SMALL);
        }
    }
    picture
}

/// Share of right firings below which a sensor is blind.
const BLIND: f64 = 0.05;

/// One line for each method, one cell for each sensor: the share of right firings, with blind sensors marked.
pub(crate) fn blind_sensors(lanes: &[(Method, Vec<f64>)]) -> Picture {
    let sensors = lanes.iter().map(|(_, shares)| shares.len()).max().unwrap_or(0);
    let cell = ((WIDTH - LEFT) / sensors.max(1) as f64).min(90.0);
    let mut picture = Picture::new(WIDTH, TOP + LANE * lanes.len() as f64 + 20.0);
    picture.text("Blind sensors (red): right in under 5 % of their firings", (16.0, 22.0), TITLE);
    picture.text("sensor; firings that are right, %", (LEFT, 58.0), CAPTION);
    for sensor in 0..sensors {
        let x = LEFT + cell * (sensor as f64 + 0.5);
        picture.text_in((sensor + 1).to_string(), (x, 84.0), SMALL, HPos::Center, INK);
    }
    for (lane, (method, shares)) in lanes.iter().enumerate() {
        let y = TOP + LANE * (lane as f64 + 0.5);
        if *method == Method::Flow {
            picture.rect([(8.0, y - 0.5 * LANE), (LEFT - 4.0, y + 0.5 * LANE)], LISTENING.mix(0.5));
        }
        picture.text_in(method.to_string(), (LEFT - 10.0, y), CAPTION, HPos::Right, INK);
        for (sensor, &share) in shares.iter().enumerate() {
            let x = LEFT + cell * sensor as f64;
            let colour = if share < BLIND { REJECTED.mix(1.0) } else { ACCEPTED.mix(0.15 + 0.5 * share) };
            picture.rect([(x + 1.0, y - 0.5 * LANE + 1.0), (x + cell - 1.0, y + 0.5 * LANE - 1.0)], colour);
            picture.text_in(format!("{:.0}", 100.0 * share), (x + 0.5 * cell, y), SMALL, HPos::Center, INK);
        }
    }
    picture
}

fn rounded(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value < 0.1 => format!("{value:.2}"),
        value if value < 99.95 => format!("{value:.1}"),
        value => format!("{value:.0}"),
    }
}
