//! Matrix of who fools whom: a square for each pair, darker the more of the receiver's readings are the sender's sound.

use plotters::style::RGBColor;

use super::DiagnosisReport;
use crate::report::draw::Picture;

/// Draws the matrix: senders to the right, receivers downwards.
pub(crate) fn who_fools_whom(found: &DiagnosisReport<'_>) -> Picture {
    const LEFT: f64 = 70.0;
    const TOP: f64 = 96.0;
    const CELL: f64 = 46.0;
    let sensors = found.diagnosis.hearing.len();
    let size = CELL * sensors as f64;
    let mut picture = Picture::new((LEFT + size + 150.0).max(520.0), TOP + size + 40.0);
    picture.text("Whose sound each sensor reads, % of its firings", (16.0, 19.0), 18.0);
    picture.text("sound of sensor", (LEFT, 52.0), 14.0);
    picture.text("reads", (16.0, TOP - 24.0), 14.0);
    let mut counts = vec![vec![0_u32; sensors]; sensors];
    for (firing, named) in found.log.firings.iter().zip(&found.diagnosis.named) {
        if let Some(named) = named {
            counts[usize::from(firing.sensor)][usize::from(named.sender)] += 1;
        }
    }
    for (receiver, of) in found.diagnosis.hearing.iter().enumerate() {
        let y = TOP + CELL * receiver as f64;
        picture.text((receiver + 1).to_string(), (30.0, y + 22.0), 14.0);
        picture.text((receiver + 1).to_string(), (LEFT + CELL * receiver as f64 + 18.0, TOP - 24.0), 14.0);
        for sender in 0..sensors {
            let share = f64::from(counts[receiver][sender]) / f64::from(of.echoes.of.max(1));
            let x = LEFT + CELL * sender as f64;
            let corners = [(x + 1.0, y + 1.0), (x + CELL - 1.0, y + CELL - 1.0)];
            picture.rect(corners, shade(share, sender == receiver));
            if share >= 0.005 {
                picture.text(format!("{:.0}", 100.0 * share), (x + 14.0, y + 22.0), 14.0);
            }
        }
    }
    let notes = [("its own echo", true), ("another's sound", false)];
    for (n, (name, own)) in notes.into_iter().enumerate() {
        let y = TOP + 24.0 * n as f64;
        picture.rect([(LEFT + size + 16.0, y), (LEFT + size + 28.0, y + 12.0)], shade(0.5, own));
        picture.text(name, (LEFT + size + 34.0, y + 5.0), 13.0);
    }
    picture
}

/// Returns a shade from grey, for nothing, to green for own echoes and red for others' sound.
fn shade(share: f64, own: bool) -> RGBColor {
    let full = if own { [0x4c, 0x9f, 0x70] } else { [0xd1, 0x49, 0x5b] };
    let [r, g, b] = full.map(|full| {
        let (none, full) = (f64::from(0xf0_u8), f64::from(full));
        (none + (full - none) * share.sqrt().min(1.0)) as u8
    });
    RGBColor(r, g, b)
}
