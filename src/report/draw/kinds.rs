//! Recorded readings and the filter's verdicts: one lane for each sensor, time to the right.

use eeruf_core::ReadingKind;
use plotters::style::RGBColor;

use super::picture::Picture;
use super::style::{ACCEPTED, REJECTED, SILENT, TITLE, UNCOMPARED};
use crate::report::replay::Column;

/// One lane for each sensor, time to the right; the height of each colour is its share of the readings in that stretch
/// of time.
pub(crate) fn kinds_over_time(columns: &[Column], t_delta_us: u32) -> Picture {
    const LANE: f64 = 22.0;
    const LEFT: f64 = 70.0;
    const TOP: f64 = 70.0;
    const BINS: usize = 240;
    const BIN: f64 = 3.0;
    let rows = columns.iter().map(|column| column.kinds.len()).max().unwrap_or(0);
    let bins = rows.clamp(1, BINS);
    let (width, height) = (LEFT + BIN * bins as f64 + 20.0, TOP + LANE * columns.len() as f64 + 46.0);
    let mut picture = Picture::new(width.max(520.0), height);
    picture.text(format!("What the filter made of {rows} firings, t_delta = {t_delta_us} us"), (LEFT, 19.0), TITLE);
    let legend = [("accepted", ACCEPTED), ("rejected", REJECTED), ("first", UNCOMPARED), ("no echo", SILENT)];
    for (n, (name, colour)) in legend.into_iter().enumerate() {
        let x = LEFT + 110.0 * n as f64;
        picture.rect([(x, 42.0), (x + 12.0, 54.0)], colour);
        picture.text(name, (x + 18.0, 47.0), 14.0);
    }
    for (lane, column) in columns.iter().enumerate() {
        let bottom = TOP + LANE * (lane as f64 + 1.0) - 3.0;
        picture.text(column.name.clone(), (16.0, bottom - 10.0), 14.0);
        // Topics may have more or fewer readings in the same time.
        let rows = column.kinds.len();
        for bin in 0..bins {
            let stretch = &column.kinds[bin * rows / bins..(bin + 1) * rows / bins];
            let mut y = bottom;
            for (_, colour) in legend {
                let share = stretch.iter().filter(|&&kind| colour_of(kind) == colour).count() as f64;
                let top = y - share / stretch.len().max(1) as f64 * (LANE - 4.0);
                if top.round() < y.round() {
                    let x = LEFT + BIN * bin as f64;
                    picture.rect([(x, top.round()), (x + BIN, y.round())], colour);
                }
                y = top;
            }
        }
    }
    picture.text(format!("firings 1 to {rows}"), (LEFT, height - 28.0), 14.0);
    picture
}

fn colour_of(kind: ReadingKind) -> RGBColor {
    match kind {
        ReadingKind::Accepted => ACCEPTED,
        ReadingKind::Rejected | ReadingKind::Ambiguous => REJECTED,
        ReadingKind::NoEcho | ReadingKind::Clear => SILENT,
        _ => UNCOMPARED,
    }
}
