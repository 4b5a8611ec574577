//! The atlas: the shortest period over the number of sensors.

use eeruf_design::atlas::{Neighbourhood, Row};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::picture::{At, Picture};
use super::style::{CAPTION, INK, SMALL, TITLE, grid_step, sensor_colour, tick_label};

/// The separation and window of the rings drawn, in ticks.
const DRAWN: (u32, u32) = (2, 30);
const PANEL: At = (400.0, 300.0);
const LEFT: f64 = 56.0;
const TOP: f64 = 84.0;
const BETWEEN: f64 = 40.0;

/// Draws lines at the left and rings at the right, with a curve for each number of neighbours: dots where the period is
/// proven, else a stroke from the bound to the best period found.
pub(crate) fn atlas(rows: &[Row]) -> Picture {
    let drawn = |row: &&Row| (row.ring.separation, row.ring.window) == DRAWN;
    let rows: Vec<&Row> = rows.iter().filter(drawn).collect();
    let most = rows.iter().map(|row| row.ring.sensors).max().unwrap_or(1);
    // The period found for an open ring may be of any length, so strokes may end at the upper edge.
    let longest = 1.1 * f64::from(rows.iter().map(|row| row.bound).max().unwrap_or(1));
    let mut picture = Picture::new(LEFT + 2.0 * PANEL.0 + BETWEEN + 24.0, TOP + PANEL.1 + 60.0);
    let title = "Shortest period in ms over the number of sensors, by adjacent sensors 15 ms apart";
    picture.text(title, (16.0, 22.0), TITLE);
    picture.text("2 ms separation, 30 ms window; dots: proven, strokes: from bound to found", (16.0, 46.0), CAPTION);
    for (panel, name) in ["line", "ring"].into_iter().enumerate() {
        let left = LEFT + panel as f64 * (PANEL.0 + BETWEEN);
        let x = |sensors: u8| left + PANEL.0 * f64::from(sensors) / f64::from(most);
        let y = |period: u32| TOP + PANEL.1 * (1.0 - f64::from(period) / longest).max(0.0);
        picture.text(name, (left, TOP - 14.0), CAPTION);
        let step = grid_step(longest, 8.0);
        for line in 0..=(longest / step) as u32 {
            let at = TOP + PANEL.1 * (1.0 - f64::from(line) * step / longest);
            picture.line((left, at), (left + PANEL.0, at), 1.0, INK.mix(0.15));
            picture.text_in(tick_label(f64::from(line) * step, step), (left - 6.0, at), SMALL, HPos::Right, INK);
        }
        for sensors in (0..=most).step_by(4) {
            picture.line((x(sensors), TOP), (x(sensors), TOP + PANEL.1), 1.0, INK.mix(0.15));
            picture.text_in(sensors.to_string(), (x(sensors), TOP + PANEL.1 + 14.0), SMALL, HPos::Center, INK);
        }
        for n in 2..=6_u8 {
            let colour = sensor_colour(usize::from(n) - 2);
            // Rings whose sensors are all neighbours of each other have a neighbourhood of their own.
            let is_curve = |row: &&&Row| {
                let layout = if panel == 0 { Neighbourhood::Line(n) } else { Neighbourhood::Ring(n) };
                let sensors = row.ring.sensors;
                Neighbourhood::of(&layout.layout(sensors), sensors) == Some(row.ring.neighbourhood)
            };
            let curve: Vec<&&Row> = rows.iter().filter(is_curve).collect();
            let is_proven = |row: &Row| row.bound == row.period;
            for pair in curve.windows(2).filter(|pair| is_proven(pair[0]) && is_proven(pair[1])) {
                let at = |row: &Row| (x(row.ring.sensors), y(row.period));
                picture.line(at(pair[0]), at(pair[1]), 1.0, colour.mix(0.6));
            }
            for row in &curve {
                let (x, period) = (x(row.ring.sensors), y(row.period));
                if is_proven(row) {
                    picture.dot((x, period), 2.5, colour);
                } else {
                    picture.line((x, period), (x, y(row.bound)), 3.0, colour.mix(0.5));
                }
            }
            let label = (left + 60.0 * f64::from(n - 2), TOP + PANEL.1 + 40.0);
            picture.dot((label.0 + 4.0, label.1), 4.0, colour);
            picture.text(format!("n = {n}"), (label.0 + 12.0, label.1), SMALL);
        }
    }
    picture
}
