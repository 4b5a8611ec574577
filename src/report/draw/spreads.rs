//! Set I over many alcoves: how much of what each method says is wrong, how much it rejects, and how both spread.

use eeruf_sim::experiments::{
    Spread,
    set_one::{Figures, SetOne},
};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBColor};

use super::picture::Picture;
use super::style::{CAPTION, INK, LISTENING, REJECTED, SMALL, TITLE, UNCOMPARED};
use crate::report::percent::percent;

const LEFT: f64 = 140.0;
const WIDTH: f64 = 900.0;
const TOP: f64 = 84.0;
const LANE: f64 = 30.0;
const ROOM: f64 = 42.0;

type Column = (&'static str, RGBColor, fn(&Figures) -> Option<Spread>);

/// One line for each method, one column for each figure: a bar from 10 to 90 % of the alcoves, and the median.
pub(crate) fn set_one(found: &SetOne) -> Picture {
    let bottom = TOP + LANE * found.methods.len() as f64;
    let mut picture = Picture::new(WIDTH, bottom + 40.0);
    let title = format!("Set I over {} alcoves: median, and from 10 to 90 % of them", found.seeds);
    picture.text(title, (16.0, 22.0), TITLE);
    for (lane, (method, _)) in found.methods.iter().enumerate() {
        let y = TOP + LANE * (lane as f64 + 0.5);
        if lane % 2 == 0 {
            picture.rect([(8.0, y - 0.5 * LANE), (WIDTH - 8.0, y + 0.5 * LANE)], LISTENING.mix(0.2));
        }
        picture.text_in(method.to_string(), (LEFT - 12.0, y), CAPTION, HPos::Right, INK);
    }
    let columns: [Column; 3] = [
        ("wrong, % of all readings", REJECTED, |figures| figures.wrong_of_all),
        ("rejected, % of all readings", UNCOMPARED, |figures| figures.rejected),
        ("lost, % of good readings", LISTENING, |figures| figures.good_lost),
    ];
    let column_width = (WIDTH - LEFT) / columns.len() as f64;
    for (column, (name, colour, spread_of)) in columns.into_iter().enumerate() {
        let left = LEFT + column as f64 * column_width;
        let at = |share: f64| left + share * (column_width - ROOM);
        picture.text(name, (left, 56.0), CAPTION);
        for line in 0..=4 {
            let share = 0.25 * f64::from(line);
            picture.line((at(share), TOP - 4.0), (at(share), bottom + 4.0), 1.0, INK.mix(0.15));
            let label = format!("{:.0}", 100.0 * share);
            picture.text_in(label, (at(share), bottom + 18.0), SMALL, HPos::Center, INK);
        }
        for (lane, (_, figures)) in found.methods.iter().enumerate() {
            let y = TOP + LANE * (lane as f64 + 0.5);
            let Some(Spread { p10, median, p90, .. }) = spread_of(figures) else { continue };
            picture.rect([(at(p10), y - 7.0), (at(p90).max(at(p10) + 1.0), y + 7.0)], colour);
            picture.line((at(median), y - 9.0), (at(median), y + 9.0), 3.0, INK);
            picture.text(percent(median), (at(p90) + 6.0, y), SMALL);
        }
    }
    picture
}
