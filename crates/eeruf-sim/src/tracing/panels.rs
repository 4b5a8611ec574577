//! Reflection of finite walls: for each bounce, the share by Fresnel's integral over the wall's width.

use super::bounce_points::parts;
use crate::{
    acoustics::{LOUDEST_PANEL, panel_share},
    geometry::{Point, Vector, cross},
    scene::{Bounce, Scene},
};

/// Returns the product of the reflections of a path's walls relative to endless walls, by Fresnel's integral over each.
/// If several walls make a path louder, the gain is limited to that of one.
///
/// `corners` are the path's corners, ends included. Each edge of a wall counts by its detour. The path's other walls
/// act as mirrors, up to the path's ends or to the next pole, where the sound spreads again.
pub(super) fn share_of_walls(scene: &Scene, corners: &[Point], bounces: &[Bounce], wavelength_m: f64) -> f64 {
    let mut share = 1.0;
    for (start, end) in parts(bounces) {
        let leg = |corner: usize| corners[corner + 1] - corners[corner];
        let whole_m: f64 = (start..end).map(|corner| leg(corner).norm()).sum();
        let mut before_m = 0.0;
        for corner in start + 1..end {
            let legs = [leg(corner - 1), leg(corner)];
            before_m += legs[0].norm();
            if let Bounce::Wall(wall) = bounces[corner - 1] {
                let turn = Turn { wall, at: corners[corner], legs, whole_m: [before_m, whole_m - before_m] };
                share *= turn.share(scene, wavelength_m);
            }
        }
    }
    share.min(LOUDEST_PANEL)
}

/// A bounce at a wall.
struct Turn {
    wall: u32,
    at: Point,
    /// The vectors to the bounce and from it.
    legs: [Vector; 2],
    /// Lengths of the parts before and after the bounce, with the other walls as mirrors.
    whole_m: [f64; 2],
}

impl Turn {
    fn share(&self, scene: &Scene, wavelength_m: f64) -> f64 {
        let wall = &scene.walls()[self.wall as usize];
        let along = (wall.to - wall.from).normalize();
        // In the apex of a corner one of the legs has no length; the other leg gives the direction of the sound.
        let lengths_m = self.legs.map(|leg| leg.norm());
        let longer = usize::from(lengths_m[1] > lengths_m[0]);
        if !(lengths_m[longer] > 0.0) {
            return 1.0;
        }
        let way = self.legs[longer] / lengths_m[longer];
        let on_left = (cross(along, way) > 0.0) == (longer == 1);
        let ends = scene.extents().around(self.wall, (self.at - wall.from).dot(&along), on_left);
        if ends == [None; 2] {
            return 1.0;
        }
        let detours = ends.map(|end| end.map_or(f64::INFINITY, |end| self.detour_m(end.at, way) / wavelength_m));
        panel_share(detours, false)
    }

    /// Returns the detour of the path over an end of the wall, in metres.
    fn detour_m(&self, end: Point, way: Vector) -> f64 {
        let [before_m, after_m] = self.whole_m;
        let off = end - self.at;
        let (ahead, square) = (off.dot(&way), off.norm_squared());
        if square == 0.0 {
            return 0.0;
        }
        // Additional length of each part, computed without the difference of two lengths: both legs make the same angle
        // with the wall.
        let longer_m = |length_m: f64, more: f64| more / ((length_m * length_m + more).max(0.0).sqrt() + length_m);
        longer_m(before_m, 2.0 * before_m * ahead + square) + longer_m(after_m, square - 2.0 * after_m * ahead)
    }
}
