//! The arrangement of the sensors of a ring, as files spell it.

use eeruf_core::{
    Layout,
    conditions::{RequirementsError, neighbour_rows},
};
use serde::Deserialize;

/// The arrangement of the sensors, as files spell it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"line\", \"ring\", \"blocks\", or pairs of neighbours such as [[0, 1], [1, 2]]"
)]
pub enum LayoutKey {
    /// No layout given: a line.
    #[default]
    #[serde(skip)]
    Unsaid,
    /// A layout by its name.
    Named(LayoutName),
    /// A layout by its pairs of neighbours, sensors from 0.
    Pairs(Vec<(usize, usize)>),
}

/// The layouts that have a name.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LayoutName {
    /// A line: the first and the last sensor are not neighbours.
    Line,
    /// The sensors form a ring.
    Ring,
    /// The sensors of a block are neighbours of each other only.
    Blocks,
}

/// A layout that owns the rows of its graph, if it needs them.
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

impl OwnedLayout {
    /// Returns the layout without the neighbours that do not hear each other according to these rows, and the pairs
    /// that were removed.
    pub(crate) fn of_those_that_hear(self, hearing: &[u64]) -> (Self, Vec<(usize, usize)>) {
        let sensors = hearing.len();
        let rows = self.layout().rows(sensors);
        let heard = |x: usize, y: usize| hearing[x] >> y & 1 == 1;
        let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
        let deaf: Vec<_> = pairs.filter(|&(x, y)| rows[x] >> y & 1 == 1 && !heard(x, y)).collect();
        if deaf.is_empty() {
            return (self, deaf);
        }
        let mut kept = rows.to_vec();
        kept.iter_mut().zip(hearing).for_each(|(row, hearing)| *row &= hearing);
        // A named layout says more, and is searched faster.
        let named = (1..=self.neighbours).flat_map(|neighbours| {
            [LayoutName::Line, LayoutName::Ring].map(|name| Self { name: Some(name), neighbours, rows: vec![] })
        });
        let same = named.into_iter().find(|named| named.layout().rows(sensors)[..] == kept[..]);
        (same.unwrap_or(Self { name: None, neighbours: self.neighbours, rows: kept }), deaf)
    }
}

impl LayoutKey {
    /// Returns true if the layout's pairs depend on the number of neighbours.
    pub(crate) fn counts_neighbours(&self) -> bool {
        !matches!(self, Self::Pairs(_))
    }

    /// The layout of this many sensors, of which this many adjacent ones are neighbours.
    ///
    /// # Errors
    /// A pair that names a sensor out of range, or the same sensor twice.
    pub fn owned(&self, neighbours: u8, sensors: usize) -> Result<OwnedLayout, String> {
        let pairs = match self {
            Self::Unsaid => return Ok(OwnedLayout { name: Some(LayoutName::Line), neighbours, rows: vec![] }),
            &Self::Named(name) => return Ok(OwnedLayout { name: Some(name), neighbours, rows: vec![] }),
            Self::Pairs(pairs) => pairs,
        };
        let rows = neighbour_rows(pairs.iter().copied(), sensors).map_err(|error| match error {
            // Sensors are counted as in the file.
            RequirementsError::Neighbours { pair: (x, y), sensors } => {
                format!(
                    "layout: neighbours [{x}, {y}]; expected two different sensors, counted from 0 to {}",
                    sensors - 1
                )
            }
            error => format!("layout: {error:#}"),
        })?;
        Ok(OwnedLayout { name: None, neighbours, rows: rows.to_vec() })
    }
}
