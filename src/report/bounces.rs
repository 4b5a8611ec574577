//! The bounces of a path, in words and as numbers.

use std::fmt::Write as _;

use eeruf_sim::Bounce;

/// Describes the bounces of a path, emitter to receiver; walls and poles from 0, as in files.
pub(crate) fn by_way_of(bounces: &[Bounce]) -> String {
    if bounces.is_empty() {
        return "straight".to_owned();
    }
    let mut text = String::new();
    let mut walls = false;
    for (index, bounce) in bounces.iter().enumerate() {
        text += if index == 0 { "" } else { ", " };
        match bounce {
            Bounce::Wall(wall) if walls => _ = write!(text, "{wall}"),
            Bounce::Wall(wall) => _ = write!(text, "wall {wall}"),
            Bounce::Pole(pole) => _ = write!(text, "pole {pole}"),
            Bounce::Edge(edge) => _ = write!(text, "edge {edge}"),
            Bounce::Floor => text += "floor",
            Bounce::Ceiling => text += "ceiling",
        }
        walls = matches!(bounce, Bounce::Wall(_));
    }
    text
}

/// Returns the bounces of a path as numbers, see [`Bounce::number`].
pub(crate) fn wall_numbers(bounces: &[Bounce]) -> Vec<i64> {
    bounces.iter().map(|bounce| bounce.number()).collect()
}
