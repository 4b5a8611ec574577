//! Pictures, as SVG.

use eeruf_core::{Kind, Phase, Requirements};
use plotters::prelude::*;

use crate::input::AnySchedule;
use crate::replay::Column;

const ACCEPTED: RGBColor = RGBColor(0x4c, 0x9f, 0x70);
const REJECTED: RGBColor = RGBColor(0xd1, 0x49, 0x5b);
const UNCOMPARED: RGBColor = RGBColor(0xed, 0xc7, 0x6a);
const SILENT: RGBColor = RGBColor(0xe4, 0xe6, 0xea);
const LISTENING: RGBColor = RGBColor(0xb9, 0xd0, 0xe8);
const INK: RGBColor = RGBColor(0x2b, 0x2d, 0x33);
const FONT: &str = "sans-serif";

/// One lane for each sensor, time to the right; the height of each colour is its share of the readings in that stretch
/// of time.
pub(crate) fn kinds_over_time(columns: &[Column], t_delta_us: u32) -> String {
    const LANE: i32 = 22;
    const LEFT: i32 = 70;
    const TOP: i32 = 70;
    const BINS: usize = 240;
    const BIN: i32 = 3;
    let rows = columns.iter().map(|column| column.kinds.len()).max().unwrap_or(0);
    let bins = rows.clamp(1, BINS);
    let (width, height) = (LEFT + BIN * bins as i32 + 20, TOP + LANE * columns.len() as i32 + 46);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (width.max(520) as u32, height as u32)).into_drawing_area();
        // Writing to a string does not fail; a picture is never worth a panic all the same.
        _ = area.fill(&WHITE);
        let text = |text: String, at: (i32, i32), size: i32| {
            _ = area.draw(&Text::new(text, at, (FONT, size).into_font().color(&INK)));
        };
        text(format!("What the filter made of {rows} firings, t_delta = {t_delta_us} us"), (LEFT, 12), 18);
        let legend = [("accepted", ACCEPTED), ("rejected", REJECTED), ("first", UNCOMPARED), ("no echo", SILENT)];
        for (n, (name, colour)) in legend.into_iter().enumerate() {
            let x = LEFT + 110 * n as i32;
            _ = area.draw(&Rectangle::new([(x, 42), (x + 12, 54)], colour.filled()));
            text(name.to_owned(), (x + 18, 41), 14);
        }
        for (lane, column) in columns.iter().enumerate() {
            let bottom = TOP + LANE * (lane as i32 + 1) - 3;
            text(column.name.clone(), (16, bottom - 16), 14);
            for bin in 0..bins {
                let stretch = &column.kinds[bin * rows / bins..(bin + 1) * rows / bins];
                let mut y = f64::from(bottom);
                for (_, colour) in legend {
                    let share = stretch.iter().filter(|&&kind| colour_of(kind) == colour).count() as f64;
                    let top = y - share / stretch.len().max(1) as f64 * f64::from(LANE - 4);
                    if top.round() < y.round() {
                        let x = LEFT + BIN * bin as i32;
                        let corners = [(x, top.round() as i32), (x + BIN, y.round() as i32)];
                        _ = area.draw(&Rectangle::new(corners, colour.filled()));
                    }
                    y = top;
                }
            }
        }
        text(format!("firings 1 to {rows}"), (LEFT, height - 34), 14);
        _ = area.present();
    }
    svg
}

fn colour_of(kind: Kind) -> RGBColor {
    match kind {
        Kind::Accepted => ACCEPTED,
        Kind::Rejected => REJECTED,
        Kind::NoEcho | Kind::Clear => SILENT,
        _ => UNCOMPARED,
    }
}

/// When each sensor fires in two periods, and how long it listens: one lane for each sensor, as Fig. 3 of the paper.
pub(crate) fn timing_diagram(schedule: &AnySchedule, requirements: &Requirements<'_>) -> String {
    const LANE: i32 = 26;
    const LEFT: i32 = 48;
    const TOP: i32 = 76;
    const WIDTH: f64 = 900.0;
    let period = f64::from(schedule.period().as_micros());
    let x_of = |us: f64| LEFT + (us / (2.0 * period) * WIDTH).round() as i32;
    let sensors = schedule.sensors() as i32;
    let (width, height) = (LEFT + WIDTH as i32 + 24, TOP + LANE * sensors + 50);
    let bottom = TOP + LANE * sensors;
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (width as u32, height as u32)).into_drawing_area();
        // As above: writing to a string does not fail.
        _ = area.fill(&WHITE);
        let text = |text: String, at: (i32, i32), size: i32| {
            _ = area.draw(&Text::new(text, at, (FONT, size).into_font().color(&INK)));
        };
        let title = format!("{} sensors, T_p = {}: firing and listening", schedule.sensors(), schedule.period());
        text(title, (LEFT, 12), 18);
        for (phase, start) in [(Phase::A, 0.0), (Phase::B, period)] {
            text(format!("phase {phase}"), (x_of(start) + 6, 46), 14);
        }
        for start in [0.0, period, 2.0 * period] {
            let line = [(x_of(start), 44), (x_of(start), bottom)];
            _ = area.draw(&PathElement::new(line, INK.mix(0.5).stroke_width(1)));
        }
        let step = grid_step_us(2.0 * period);
        let mut tick = 0.0;
        while tick <= 2.0 * period {
            let line = [(x_of(tick), TOP), (x_of(tick), bottom + 4)];
            _ = area.draw(&PathElement::new(line, INK.mix(0.12).stroke_width(1)));
            text(format!("{}", tick / 1000.0), (x_of(tick) - 8, bottom + 8), 13);
            tick += step;
        }
        text("ms".to_owned(), (x_of(2.0 * period) - 18, bottom + 26), 13);
        for x in 0..schedule.sensors() {
            let top = TOP + LANE * x as i32 + 3;
            text(format!("{}", x + 1), (16, top + 2), 14);
            for (phase, start) in [(Phase::A, 0.0), (Phase::B, period)] {
                let Some(t_fire) = schedule.t_fire(phase, x) else { continue };
                let fire = start + f64::from(t_fire.as_micros());
                let end = fire + f64::from(requirements.window.as_micros());
                // What the second period leaves over is heard in the first.
                for (from, to) in [(fire, end.min(2.0 * period)), (0.0, end - 2.0 * period)] {
                    if to > from {
                        let corners = [(x_of(from), top + 4), (x_of(to), top + LANE - 10)];
                        _ = area.draw(&Rectangle::new(corners, LISTENING.filled()));
                    }
                }
                let corners = [(x_of(fire) - 1, top), (x_of(fire) + 2, top + LANE - 6)];
                _ = area.draw(&Rectangle::new(corners, REJECTED.filled()));
            }
        }
        _ = area.present();
    }
    svg
}

/// A round distance between grid lines: some ten of them over this time.
fn grid_step_us(whole: f64) -> f64 {
    let rough = whole / 10.0;
    let magnitude = 10_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * magnitude).find(|&step| step >= rough).unwrap_or(rough)
}
