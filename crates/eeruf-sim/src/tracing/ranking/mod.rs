//! Sorts the found paths by receiver, then by length, and removes duplicates.

mod found;

use super::limits::MAX_BEAMS;
use crate::geometry::TOUCH_M;
use crate::scene::Bounce;
pub(super) use found::{Found, FoundPath};

/// Mask of the low bits of a sorting key, which hold the index of the path. The high bits are those of its length,
/// since the bits of positive numbers sort like the numbers.
const INDEX: u64 = (1 << 24) - 1;
const _: () = assert!(MAX_BEAMS as u64 <= INDEX);

/// A path in the order of lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rank {
    pub(super) length_m: f64,
    /// The number in [`Found`].
    pub(super) index: u32,
}

/// The order of the paths of one query, with buffers.
#[derive(Debug, Default)]
pub(super) struct Ranking {
    keys: Vec<u64>,
    ranks: Vec<Rank>,
    starts: Vec<u32>,
    // Buffers for two sequences of walls that are compared.
    known: Vec<Bounce>,
    other: Vec<Bounce>,
}

impl Ranking {
    /// Sorts the found paths for this number of receivers.
    pub(super) fn rank(&mut self, found: Found<'_>, receivers: usize) {
        self.sort(found, receivers);
        self.remove_doubles(found, receivers);
    }

    /// Returns the paths in order.
    pub(super) fn ranks(&self) -> &[Rank] {
        &self.ranks
    }

    /// Sorts by receiver, then length: a counting sort over receivers, and a short sort of plain numbers within each.
    fn sort(&mut self, found: Found<'_>, receivers: usize) {
        let walls = found.tree.visible_images.iter().map(|image| (image.receiver, image.length_m));
        let poles = found.poles.found.iter().map(|path| (path.receiver, path.length_m));
        let edges = found.edges.found.iter().map(|path| (path.receiver, path.length_m));
        let all = walls.chain(poles).chain(edges);
        self.starts.clear();
        self.starts.resize(receivers + 2, 0);
        for (receiver, _) in all.clone() {
            self.starts[receiver as usize + 2] += 1;
        }
        for receiver in 2..self.starts.len() {
            self.starts[receiver] += self.starts[receiver - 1];
        }
        self.keys.clear();
        self.keys.resize(all.clone().count(), 0);
        for (index, (receiver, length_m)) in all.enumerate() {
            let next = &mut self.starts[receiver as usize + 1];
            self.keys[*next as usize] = (length_m.to_bits() & !INDEX) | index as u64;
            *next += 1;
        }
        for receiver in 0..receivers {
            let range = self.starts[receiver] as usize..self.starts[receiver + 1] as usize;
            self.keys[range].sort_unstable();
        }
    }

    /// Sorts the paths exactly and removes duplicates with the same order and image, which come from both wall orders
    /// of a right-angle corner, or from two pieces of one straight wall at their common point.
    fn remove_doubles(&mut self, found: Found<'_>, receivers: usize) {
        self.ranks.clear();
        for receiver in 0..receivers {
            let group = self.ranks.len();
            for at in self.starts[receiver] as usize..self.starts[receiver + 1] as usize {
                let index = (self.keys[at] & INDEX) as u32;
                let length_m = match found.get(index) {
                    FoundPath::Walls(image) => image.length_m,
                    FoundPath::Pole(path) => path.length_m,
                    FoundPath::Edge(path) => path.length_m,
                };
                // The keys ignore the last digits of the lengths, so a neighbour or two may have to move up.
                let mut at_rank = self.ranks.len();
                while at_rank > group && self.ranks[at_rank - 1].length_m > length_m {
                    at_rank -= 1;
                }
                let near = |rank: &Rank| (rank.length_m - length_m).abs() <= TOUCH_M;
                let below = (group..at_rank).rev().take_while(|&k| near(&self.ranks[k]));
                let above = (at_rank..self.ranks.len()).take_while(|&k| near(&self.ranks[k]));
                match below.chain(above).find(|&k| found.are_one(self.ranks[k].index, index)) {
                    None => self.ranks.insert(at_rank, Rank { length_m, index }),
                    Some(k) => {
                        // The smaller sequence of walls stays, so that the result does not depend on the mesh.
                        self.known.clear();
                        self.other.clear();
                        found.push_bounces(self.ranks[k].index, &mut self.known);
                        found.push_bounces(index, &mut self.other);
                        if self.other < self.known {
                            self.ranks[k].index = index;
                        }
                    }
                }
            }
        }
    }
}
