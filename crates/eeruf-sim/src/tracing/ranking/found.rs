//! Results of the three searches in one sequence: images over walls first, then paths over poles, then paths around
//! edges.

use crate::geometry::{Point, TOUCH_M};
use crate::scene::Bounce;
use crate::tracing::beam::{BeamTree, VisibleImage};
use crate::tracing::edges::{EdgePath, EdgeSearch};
use crate::tracing::poles::{PolePath, PoleSearch};

/// All found paths, numbered in one sequence.
#[derive(Clone, Copy)]
pub(in crate::tracing) struct Found<'a> {
    pub(in crate::tracing) tree: &'a BeamTree,
    pub(in crate::tracing) poles: &'a PoleSearch,
    pub(in crate::tracing) edges: &'a EdgeSearch,
}

/// One found path.
pub(in crate::tracing) enum FoundPath<'a> {
    Walls(&'a VisibleImage),
    Pole(&'a PolePath),
    Edge(&'a EdgePath),
}

impl FoundPath<'_> {
    /// Returns the number of the path's receiver.
    pub(in crate::tracing) fn receiver(&self) -> u32 {
        match self {
            Self::Walls(image) => image.receiver,
            Self::Pole(path) => path.receiver,
            Self::Edge(path) => path.receiver,
        }
    }
}

impl<'a> Found<'a> {
    /// Returns the path with this number.
    pub(in crate::tracing) fn get(self, index: u32) -> FoundPath<'a> {
        let index = index as usize;
        let (walls, poles) = (self.tree.visible_images.len(), self.poles.found.len());
        match (index.checked_sub(walls), index.checked_sub(walls + poles)) {
            (None, _) => FoundPath::Walls(&self.tree.visible_images[index]),
            (Some(pole), None) => FoundPath::Pole(&self.poles.found[pole]),
            (_, Some(edge)) => FoundPath::Edge(&self.edges.found[edge]),
        }
    }

    /// Returns true if two paths have the same number of bounces and the same image.
    pub(in crate::tracing) fn are_one(self, a: u32, b: u32) -> bool {
        let ((order_a, image_a), (order_b, image_b)) = (self.key(a), self.key(b));
        order_a == order_b && (image_a - image_b).norm() <= TOUCH_M
    }

    fn key(self, index: u32) -> (u32, Point) {
        match self.get(index) {
            FoundPath::Walls(image) => (image.order, image.image),
            FoundPath::Pole(path) => (path.order, path.image),
            FoundPath::Edge(path) => (1, path.at),
        }
    }

    /// Appends the bounces of a path, source to receiver, and returns its receiver.
    pub(in crate::tracing) fn push_bounces(self, index: u32, bounces: &mut Vec<Bounce>) -> u32 {
        match self.get(index) {
            FoundPath::Walls(image) => {
                self.tree.push_bounces(image, bounces);
                image.receiver
            }
            FoundPath::Pole(path) => {
                bounces.extend_from_slice(self.poles.bounces(path));
                path.receiver
            }
            FoundPath::Edge(path) => {
                bounces.push(Bounce::Edge(path.edge));
                path.receiver
            }
        }
    }
}
