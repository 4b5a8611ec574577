//! How the sensors of a ring stand, as files spell it.

use eeruf_core::{Layout, LayoutError, neighbour_rows};
use serde::Deserialize;

/// How the sensors stand, as files spell it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"line\", \"ring\", \"blocks\", or pairs of neighbours such as [[0, 1], [1, 2]]"
)]
pub(crate) enum LayoutKey {
    #[default]
    #[serde(skip)]
    Unsaid,
    Named(LayoutName),
    Pairs(Vec<(usize, usize)>),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum LayoutName {
    Line,
    Ring,
    Blocks,
}

/// A layout with the rows of a graph that it may need.
#[derive(Clone, Debug)]
pub(crate) struct OwnedLayout {
    name: Option<LayoutName>,
    neighbours: u8,
    rows: Vec<u64>,
}

impl OwnedLayout {
    pub(crate) fn layout(&self) -> Layout<'_> {
        match self.name {
            Some(LayoutName::Line) => Layout::Line(self.neighbours),
            Some(LayoutName::Ring) => Layout::Ring(self.neighbours),
            Some(LayoutName::Blocks) => Layout::Blocks(self.neighbours),
            None => Layout::Graph(&self.rows),
        }
    }
}

impl LayoutKey {
    pub(crate) fn owned(&self, neighbours: u8, sensors: usize) -> Result<OwnedLayout, String> {
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
