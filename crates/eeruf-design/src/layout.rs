//! The arrangement of the sensors of a ring, as files spell it.

use eeruf_core::{
    Layout,
    conditions::{LayoutError, neighbour_rows},
};
use serde::Deserialize;

/// The arrangement of the sensors, as files spell it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"line\", \"ring\", \"blocks\", or pairs of neighbours such as [[0, 1], [1, 2]]"
)]
pub enum LayoutKey {
    /// No such key: a line.
    #[default]
    #[serde(skip)]
    Unsaid,
    /// By its name.
    Named(LayoutName),
    /// By its pairs of neighbours, sensors from 0.
    Pairs(Vec<(usize, usize)>),
}

/// The layouts that have a name.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LayoutName {
    /// The first and the last sensor are no neighbours.
    Line,
    /// They are.
    Ring,
    /// The sensors of a block are neighbours of each other only.
    Blocks,
}

/// A layout with the rows of a graph that it may need.
#[derive(Clone, Debug)]
pub struct OwnedLayout {
    name: Option<LayoutName>,
    neighbours: u8,
    rows: Vec<u64>,
}

impl OwnedLayout {
    /// The layout as core takes it.
    pub fn layout(&self) -> Layout<'_> {
        match self.name {
            Some(LayoutName::Line) => Layout::Line(self.neighbours),
            Some(LayoutName::Ring) => Layout::Ring(self.neighbours),
            Some(LayoutName::Blocks) => Layout::Blocks(self.neighbours),
            None => Layout::Graph(&self.rows),
        }
    }
}

impl LayoutKey {
    /// The layout of this many sensors, of which this many adjacent ones are neighbours.
    ///
    /// # Errors
    /// A pair that names a sensor out of range, or one twice.
    pub fn owned(&self, neighbours: u8, sensors: usize) -> Result<OwnedLayout, String> {
        let pairs = match self {
            Self::Unsaid => return Ok(OwnedLayout { name: Some(LayoutName::Line), neighbours, rows: vec![] }),
            &Self::Named(name) => return Ok(OwnedLayout { name: Some(name), neighbours, rows: vec![] }),
            Self::Pairs(pairs) => pairs,
        };
        let rows =
            neighbour_rows(pairs.iter().copied(), sensors).map_err(|LayoutError { pair: (x, y), sensors }| {
                // As the file counts them.
                format!("layout: neighbours [{x}, {y}]; expected two different sensors from 0 to {}", sensors - 1)
            })?;
        Ok(OwnedLayout { name: None, neighbours, rows: rows.to_vec() })
    }
}
