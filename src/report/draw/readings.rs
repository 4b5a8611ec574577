//! Readings of one sensor over time, and which of them were believed.

use eeruf_sim::Readings;
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::picture::Picture;
use super::style::{ACCEPTED, CAPTION, INK, REJECTED, SMALL, TITLE, UNCOMPARED, grid_step, tick_label};

const LEFT: f64 = 64.0;
const WIDTH: f64 = 900.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 66.0;
const HEIGHT: f64 = 190.0;
const GAP: f64 = 46.0;

/// One panel for each run: the sensor's readings from one moment to another, in metres. `sensor` is from 0, and `runs`
/// hold one robot's readings each.
pub(crate) fn readings_over_time(
    runs: &[&Readings],
    sensor: u8,
    (from_s, to_s): (f64, f64),
    metres_per_us: f64,
    tolerance_us: f64,
) -> Picture {
    let mut picture = Picture::new(WIDTH, TOP + runs.len() as f64 * (HEIGHT + GAP) + 18.0);
    picture.text(format!("What sensor {} reads", sensor + 1), (16.0, 20.0), TITLE);
    legend(&mut picture);
    let of_sensor = |readings: &Readings| -> Vec<usize> {
        let within = |reading: &usize| {
            readings.sensor[*reading] == sensor && (from_s..to_s).contains(&readings.fired_s[*reading])
        };
        (0..readings.len()).filter(within).collect()
    };
    let values = runs.iter().flat_map(|readings| {
        of_sensor(readings)
            .into_iter()
            .flat_map(|reading| [readings.t_echo_us[reading], readings.reference_us[reading]])
    });
    let most_m = metres_per_us * values.filter(|value| !value.is_nan()).fold(1000.0, f64::max) * 1.12;
    for (panel_index, readings) in runs.iter().enumerate() {
        let top = TOP + panel_index as f64 * (HEIGHT + GAP);
        let x_of = |s: f64| LEFT + (s - from_s) / (to_s - from_s) * (WIDTH - LEFT - RIGHT);
        let y_of = |us: f64| top + HEIGHT * (1.0 - us * metres_per_us / most_m);
        axes(&mut picture, top, most_m, (from_s, to_s));
        let title = format!("{}; at the upper edge: nothing heard", readings.method);
        picture.text(title, (LEFT + 6.0, top - 11.0), CAPTION);
        let own = of_sensor(readings);
        for pair in own.windows(2) {
            let [a, b] = [readings.reference_us[pair[0]], readings.reference_us[pair[1]]];
            if !a.is_nan() && !b.is_nan() {
                let [from, to] = [x_of(readings.fired_s[pair[0]]), x_of(readings.fired_s[pair[1]])];
                picture.line((from, y_of(a)), (to, y_of(b)), 2.0, INK.mix(0.45));
            }
        }
        for reading in own {
            let t_echo = readings.t_echo_us[reading];
            // A reading without an echo is drawn at the upper edge.
            let at = (x_of(readings.fired_s[reading]), if t_echo.is_nan() { top + 3.0 } else { y_of(t_echo) });
            if readings.is_accepted(reading) {
                let wrong = readings.is_wrong(reading, tolerance_us);
                picture.dot(at, if wrong { 4.0 } else { 3.0 }, if wrong { REJECTED } else { ACCEPTED });
            } else if readings.kind[reading].is_rejected() {
                picture.cross(at, 4.0, INK.mix(0.8));
            } else {
                picture.dot(at, 2.5, UNCOMPARED);
            }
        }
    }
    picture
}

fn legend(picture: &mut Picture) {
    let mut x = 200.0;
    let y = 20.0;
    picture.dot((x, y), 3.0, ACCEPTED);
    picture.text("accepted, right", (x + 9.0, y), CAPTION);
    x += 140.0;
    picture.dot((x, y), 4.0, REJECTED);
    picture.text("accepted, wrong", (x + 9.0, y), CAPTION);
    x += 150.0;
    picture.cross((x, y), 4.0, INK.mix(0.8));
    picture.text("rejected", (x + 10.0, y), CAPTION);
    x += 92.0;
    picture.dot((x, y), 2.5, UNCOMPARED);
    picture.text("first or none", (x + 9.0, y), CAPTION);
    x += 122.0;
    picture.line((x - 10.0, y), (x + 14.0, y), 2.0, INK.mix(0.45));
    picture.text("alone it reads", (x + 20.0, y), CAPTION);
}

fn axes(picture: &mut Picture, top: f64, most_m: f64, (from_s, to_s): (f64, f64)) {
    let bottom = top + HEIGHT;
    let step = grid_step(most_m, 5.0);
    for line in 0..=(most_m / step) as u32 {
        let value = f64::from(line) * step;
        let y = bottom - value / most_m * HEIGHT;
        picture.line((LEFT, y), (WIDTH - RIGHT, y), 1.0, INK.mix(0.12));
        picture.text_in(tick_label(value, step), (LEFT - 8.0, y), SMALL, HPos::Right, INK);
    }
    picture.text_in("range, m", (16.0, top - 11.0), SMALL, HPos::Left, INK);
    let step = grid_step(to_s - from_s, 8.0);
    let mut value = (from_s / step).ceil() * step;
    while value <= to_s {
        let x = LEFT + (value - from_s) / (to_s - from_s) * (WIDTH - LEFT - RIGHT);
        picture.line((x, bottom), (x, bottom + 4.0), 1.0, INK);
        picture.text_in(tick_label(value, step), (x, bottom + 14.0), SMALL, HPos::Center, INK);
        value += step;
    }
    picture.text_in("time, s", (WIDTH - RIGHT, bottom + 30.0), SMALL, HPos::Right, INK);
    picture.line((LEFT, top), (LEFT, bottom), 1.0, INK);
    picture.line((LEFT, bottom), (WIDTH - RIGHT, bottom), 1.0, INK);
}
