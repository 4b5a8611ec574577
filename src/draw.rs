//! Pictures, as SVG.

use eeruf_core::Kind;
use plotters::prelude::*;

use crate::replay::Column;

const ACCEPTED: RGBColor = RGBColor(0x4c, 0x9f, 0x70);
const REJECTED: RGBColor = RGBColor(0xd1, 0x49, 0x5b);
const UNCOMPARED: RGBColor = RGBColor(0xed, 0xc7, 0x6a);
const SILENT: RGBColor = RGBColor(0xe4, 0xe6, 0xea);
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
