//! The bounces of a path, in words and as numbers.

use std::fmt::Write as _;

use eeruf_sim::Bounce;

/// The bounces of a path, emitter to receiver; walls and poles from 0, as in files.
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
        }
        walls = matches!(bounce, Bounce::Wall(_));
    }
    text
}

/// The bounces of a path as numbers: walls from 0; pole p as -1 - p; edge e as 2^32 + e.
pub(crate) fn wall_numbers(bounces: &[Bounce]) -> Vec<i64> {
    let number = |bounce: &Bounce| match *bounce {
        Bounce::Wall(wall) => i64::from(wall),
        Bounce::Pole(pole) => -1 - i64::from(pole),
        Bounce::Edge(edge) => (1 << 32) + i64::from(edge),
    };
    bounces.iter().map(number).collect()
}
