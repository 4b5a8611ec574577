//! Matrix of which sensor hears which: a square for each ordered pair, darker for shorter travel times, with the travel
//! time in it.

use plotters::style::RGBColor;

use super::SurveyReport;
use crate::report::draw::Picture;

/// Draws the matrix: senders to the right, receivers downwards.
pub(crate) fn who_hears_whom(found: &SurveyReport<'_>) -> Picture {
    const LEFT: f64 = 70.0;
    const TOP: f64 = 96.0;
    const CELL: f64 = 46.0;
    let sensors = found.surveyed.sensors;
    let size = CELL * sensors as f64;
    let mut picture = Picture::new((LEFT + size + 190.0).max(560.0), TOP + size + 40.0);
    picture.text("After which time each sensor hears the others first, ms", (16.0, 19.0), 18.0);
    picture.text("sound of sensor", (LEFT, 52.0), 14.0);
    picture.text("heard by", (8.0, TOP - 24.0), 14.0);
    for receiver in 0..sensors {
        let y = TOP + CELL * receiver as f64;
        picture.text((receiver + 1).to_string(), (30.0, y + 22.0), 14.0);
        picture.text((receiver + 1).to_string(), (LEFT + CELL * receiver as f64 + 18.0, TOP - 24.0), 14.0);
        for sender in 0..sensors {
            let first = found.surveyed.between(sender as u8, receiver as u8).next();
            let x = LEFT + CELL * sender as f64;
            let is_near = first.is_some_and(|path| path.travel_us <= f64::from(found.until_us));
            let corners = [(x + 1.0, y + 1.0), (x + CELL - 1.0, y + CELL - 1.0)];
            picture.rect(corners, colour(first.is_some(), is_near, sender == receiver));
            if let Some(path) = first {
                picture.text(format!("{:.1}", 1e-3 * path.travel_us), (x + 9.0, y + 22.0), 13.0);
            }
        }
    }
    let until = format!("another's, within {:.0} ms", 1e-3 * f64::from(found.until_us));
    let notes = [("its own echo", true, true), (&until, true, false), ("another's, later", false, false)];
    for (n, (name, near, own)) in notes.into_iter().enumerate() {
        let y = TOP + 24.0 * n as f64;
        picture.rect([(LEFT + size + 16.0, y), (LEFT + size + 28.0, y + 12.0)], colour(true, near, own));
        picture.text(name, (LEFT + size + 34.0, y + 5.0), 13.0);
    }
    picture
}

/// Returns grey for nothing, green for own echoes, red for sound that must be kept apart, yellow for later sound.
fn colour(is_heard: bool, is_near: bool, is_own: bool) -> RGBColor {
    match (is_heard, is_own, is_near) {
        (false, ..) => RGBColor(0xf0, 0xf0, 0xf0),
        (_, true, _) => RGBColor(0x9f, 0xcf, 0xb3),
        (_, _, true) => RGBColor(0xe2, 0x8a, 0x97),
        _ => RGBColor(0xf2, 0xd9, 0xa8),
    }
}
