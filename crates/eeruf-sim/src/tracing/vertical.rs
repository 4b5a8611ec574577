//! Vertical paths between two heights in a room: direct, or over floor and ceiling in turn. Each turns a path of the
//! plan into a path of the room.

use crate::scene::{Bounce, Room};

/// Largest number of bounces at floor and ceiling, a choice: with a ceiling at 2.6 m a fifth bounce is too faint.
pub const VERTICAL_ORDER: u32 = 4;

/// One vertical path between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Way {
    /// The receiver's height above the source's image in floor and ceiling, in metres.
    pub(super) rise_m: f64,
    /// The number of bounces.
    pub(super) order: u32,
    /// The first bounce, if there is any; floor and ceiling alternate.
    pub(super) first: Bounce,
}

impl Way {
    /// Finds all vertical paths with at most this many bounces, fewest first.
    pub(super) fn between(room: &Room, source_m: f64, receiver_m: f64, most: u32, ways: &mut Vec<Self>) {
        ways.clear();
        ways.push(Self { rise_m: receiver_m - source_m, order: 0, first: Bounce::Floor });
        for order in 1..=most.min(VERTICAL_ORDER) {
            for first in [Bounce::Floor, Bounce::Ceiling] {
                let way = Self { rise_m: 0.0, order, first };
                let image_m = way.bounces().fold(source_m, |at_m, bounce| match bounce {
                    Bounce::Ceiling => 2.0 * room.ceiling_m - at_m,
                    _ => -at_m,
                });
                ways.push(Self { rise_m: receiver_m - image_m, ..way });
            }
        }
    }

    /// Returns the bounces, from source to receiver.
    pub(super) fn bounces(self) -> impl Iterator<Item = Bounce> {
        let other = if self.first == Bounce::Floor { Bounce::Ceiling } else { Bounce::Floor };
        (0..self.order).map(move |k| if k.is_multiple_of(2) { self.first } else { other })
    }

    /// Returns the share of the amplitude after floor and ceiling, at a wave number and a sine of the elevation.
    pub(super) fn reflected(self, room: &Room, wave_number: f64, sin_elevation: f64) -> f64 {
        let each = self.bounces().map(|bounce| {
            let material = if bounce == Bounce::Ceiling { &room.ceiling } else { &room.floor };
            material.amplitude(wave_number, sin_elevation)
        });
        each.product()
    }

    /// Returns the elevations of departure and arrival in radians, upwards positive, by the path's length in the plan.
    pub(super) fn elevations(self, plan_m: f64) -> [f64; 2] {
        let up = libm::atan2(self.rise_m, plan_m);
        [if self.order.is_multiple_of(2) { up } else { -up }, -up]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_the_images_of_two_mirrors() {
        let room = Room { ceiling_m: 2.5, ..Room::DEFAULT };
        let (source_m, receiver_m) = (0.4, 1.1);
        let mut ways = Vec::new();
        Way::between(&room, source_m, receiver_m, 9, &mut ways);
        // A slab has images at 2 n H + z after an even number of bounces, at 2 n H - z after an odd number.
        let mut expected: Vec<f64> = (-2..=2).map(|n| receiver_m - (5.0 * f64::from(n) + source_m)).collect();
        expected.extend((-1..=2).map(|n| receiver_m - (5.0 * f64::from(n) - source_m)));
        let mut found: Vec<f64> = ways.iter().map(|way| way.rise_m).collect();
        for list in [&mut found, &mut expected] {
            list.sort_by(f64::total_cmp);
        }
        assert_eq!(found.len(), 9);
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }

    #[test]
    fn sound_over_the_floor_leaves_downwards_and_comes_from_below() {
        let mut ways = Vec::new();
        Way::between(&Room::DEFAULT, 0.3, 0.5, 2, &mut ways);
        let signs: Vec<_> = ways.iter().map(|way| way.elevations(1.0).map(f64::signum)).collect();
        // The order is straight; floor; ceiling; floor then ceiling; ceiling then floor.
        assert_eq!(signs, [[1.0, -1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]]);
    }
}
