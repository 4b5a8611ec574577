//! Set I over many alcoves and Set III over many placings: three figures of each method, and their spread.

use eeruf_sim::experiments::{Spread, set_one::SetOne, set_three::SetThree};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBColor};

use super::picture::Picture;
use super::style::{ACCEPTED, CAPTION, INK, LISTENING, REJECTED, SMALL, TITLE, UNCOMPARED};
use crate::report::percent::percent;

const LEFT: f64 = 140.0;
const WIDTH: f64 = 900.0;
const TOP: f64 = 84.0;
const LANE: f64 = 30.0;
const ROOM: f64 = 42.0;

type Column<F> = (&'static str, RGBColor, fn(&F) -> Option<Spread>);

/// Wrong, rejected and lost readings of each method in Set I.
pub(crate) fn set_one(found: &SetOne) -> Picture {
    let title = format!("Set I over {} alcoves: median, and from 10 to 90 % of them", found.seeds);
    let lanes: Vec<_> = found.methods.iter().map(|(method, figures)| (method.to_string(), figures)).collect();
    spreads(
        title,
        &lanes,
        [
            ("wrong, % of all readings", REJECTED, |figures| figures.wrong_of_all),
            ("rejected, % of all readings", UNCOMPARED, |figures| figures.rejected),
            ("lost, % of good readings", LISTENING, |figures| figures.good_lost),
        ],
    )
}

/// Others' sound, right beliefs and lost readings of each way in Set III.
pub(crate) fn robots_of_one_make(found: &SetThree) -> Picture {
    let title = format!("Set III over {} placings: median, and from 10 to 90 % of them", found.seeds);
    let lanes: Vec<_> = found.methods.iter().map(|(way, figures)| (way.to_string(), figures)).collect();
    spreads(
        title,
        &lanes,
        [
            ("others' sound, % of accepted", REJECTED, |figures| figures.others_of_accepted),
            ("belief right, % of the time", ACCEPTED, |figures| figures.belief_right),
            ("lost, % of good readings", LISTENING, |figures| figures.good_lost),
        ],
    )
}

/// One line for each method, one column for each figure: a bar from 10 to 90 % of the runs, and the median.
fn spreads<F>(title: String, lanes: &[(String, &F)], columns: [Column<F>; 3]) -> Picture {
    let bottom = TOP + LANE * lanes.len() as f64;
    let mut picture = Picture::new(WIDTH, bottom + 40.0);
    picture.text(title, (16.0, 22.0), TITLE);
    for (lane, (method, _)) in lanes.iter().enumerate() {
        let y = TOP + LANE * (lane as f64 + 0.5);
        if lane % 2 == 0 {
            picture.rect([(8.0, y - 0.5 * LANE), (WIDTH - 8.0, y + 0.5 * LANE)], LISTENING.mix(0.2));
        }
        picture.text_in(method.clone(), (LEFT - 12.0, y), CAPTION, HPos::Right, INK);
    }
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
        for (lane, (_, figures)) in lanes.iter().enumerate() {
            let y = TOP + LANE * (lane as f64 + 0.5);
            let Some(Spread { p10, median, p90, .. }) = spread_of(figures) else { continue };
            picture.rect([(at(p10), y - 7.0), (at(p90).max(at(p10) + 1.0), y + 7.0)], colour);
            picture.line((at(median), y - 9.0), (at(median), y + 9.0), 3.0, INK);
            picture.text(percent(median), (at(p90) + 6.0, y), SMALL);
        }
    }
    picture
}
