//! What the two searches found, side by side: images seen over walls first, paths over poles after them.

use crate::geometry::{Point, TOUCH_M};
use crate::scene::Bounce;
use crate::tracing::beam::{BeamTree, VisibleImage};
use crate::tracing::poles::{PolePath, PoleSearch};

/// Everything that was found, numbered in one sequence.
#[derive(Clone, Copy)]
pub(in crate::tracing) struct Found<'a> {
    pub(in crate::tracing) tree: &'a BeamTree,
    pub(in crate::tracing) poles: &'a PoleSearch,
}

/// One found path.
pub(in crate::tracing) enum FoundPath<'a> {
    Walls(&'a VisibleImage),
    Pole(&'a PolePath),
}

impl<'a> Found<'a> {
    /// The path with a number.
    pub(in crate::tracing) fn get(self, index: u32) -> FoundPath<'a> {
        match self.tree.visible_images.get(index as usize) {
            Some(image) => FoundPath::Walls(image),
            None => FoundPath::Pole(&self.poles.found[index as usize - self.tree.visible_images.len()]),
        }
    }

    /// Whether two paths have the same number of bounces and the same image.
    pub(in crate::tracing) fn are_one(self, a: u32, b: u32) -> bool {
        let ((order_a, image_a), (order_b, image_b)) = (self.key(a), self.key(b));
        order_a == order_b && (image_a - image_b).norm() <= TOUCH_M
    }

    fn key(self, index: u32) -> (u32, Point) {
        match self.get(index) {
            FoundPath::Walls(image) => (image.order, image.image),
            FoundPath::Pole(path) => (path.order, path.image),
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
        }
    }
}
