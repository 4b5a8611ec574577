//! Results of a grown tree: the bounces of a path, and the images that are loud enough.

use super::tree::BeamTree;
use super::{Beam, VisibleImage};
use crate::tracing::audibility::Audibility;
use crate::tracing::limits::Matters;
use crate::{
    geometry::Point,
    scene::{Bounce, NONE},
};

impl BeamTree {
    /// Appends the bounces of a path over walls, source to receiver.
    #[inline]
    pub(crate) fn push_bounces(&self, image: &VisibleImage, bounces: &mut Vec<Bounce>) {
        push_walls(&self.beams, image, bounces);
    }

    /// Appends the walls of a beam from the last to the first.
    pub(crate) fn push_chain(&self, beam: u32, bounces: &mut Vec<Bounce>) {
        push_chain(&self.beams, beam, bounces);
    }

    /// Drops images that are certainly too faint or do not matter.
    pub(crate) fn drop_faint(&mut self, audibility: &Audibility, matters: Option<Matters<'_>>, receivers: &[Point]) {
        self.visible_images.retain(|image| {
            if matters.is_some_and(|matters| !matters(image.receiver as usize, image.length_m)) {
                return false;
            }
            let Some(at) = receivers.get(image.receiver as usize) else { return true };
            let ahead = at - image.image;
            let departure_cos = ahead.dot(&image.axis) / image.length_m;
            audibility.may_hear_image(
                departure_cos,
                image.receiver as usize,
                -ahead,
                image.length_m,
                image.reflection_gain,
            )
        });
    }
}

/// Appends the walls of a beam from the last to the first.
pub(crate) fn push_chain(beams: &[Beam], mut beam: u32, bounces: &mut Vec<Bounce>) {
    while let Some(node) = beams.get(beam as usize).filter(|node| node.wall != NONE) {
        bounces.push(Bounce::Wall(node.wall));
        beam = node.parent;
    }
}

/// Appends the walls over which an image is seen, source to receiver.
#[inline]
fn push_walls(beams: &[Beam], image: &VisibleImage, bounces: &mut Vec<Bounce>) {
    let start = bounces.len();
    bounces.resize(start + image.order as usize, Bounce::Wall(image.wall));
    let mut beam = image.parent;
    for bounce in bounces[start..].iter_mut().rev().skip(1) {
        let node = &beams[beam as usize];
        *bounce = Bounce::Wall(node.wall);
        beam = node.parent;
    }
}
