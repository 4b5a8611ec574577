//! Contact of a robot's body with walls, poles and solids, by parry's shapes.

use super::body::{Body, meets, placed};
use super::scene::Scene;
use crate::geometry::{Point, Pose};
use parry2d_f64::{
    math::Pose as ParryPose,
    query::{Ray, RayCast},
    shape::{Ball, Segment, Shape},
};

/// An object that a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// The wall with this index. Openings do not count: a body may pass them.
    Wall(usize),
    /// The pole with this index.
    Pole(usize),
    /// Nothing is touched, but the middle of the body is inside a pillar or outside the room.
    Solid,
}

impl Scene {
    /// Returns the first object that a body at a pose touches: the wall of lowest index, else a pole, else a solid.
    ///
    /// ```
    /// use eeruf_sim::{Air, Body, Contact, Pole, Pose, Scene, Wall, Vector};
    /// let room = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]).collect();
    /// let scene = Scene::new(room, vec![Pole::new(3.0, 2.0, 0.004)], Air::default())?;
    /// let at = |x, y| scene.contact(&Body::Disc(0.25), &Pose::new(Vector::new(x, y), 0.0));
    /// assert_eq!(at(1.0, 1.0), None);
    /// assert_eq!(at(0.2, 1.0), Some(Contact::Wall(3)));
    /// assert_eq!(at(2.8, 2.0), Some(Contact::Pole(0)));
    /// assert_eq!(at(-5.0, 1.0), Some(Contact::Solid));
    /// # Ok::<(), eeruf_sim::SceneError>(())
    /// ```
    pub fn contact(&self, body: &Body, pose: &Pose) -> Option<Contact> {
        body.with_shape(|shape| self.contact_of(shape, pose))
    }

    fn contact_of(&self, shape: &dyn Shape, pose: &Pose) -> Option<Contact> {
        let at = placed(pose);
        let reach = shape.compute_aabb(&at);
        let touches = |wall: usize| {
            let segment = self.segment(wall);
            meets(&at, shape, &ParryPose::IDENTITY, &segment)
        };
        let wall = self.wall_boxes().intersect_aabb(&reach).map(|wall| wall as usize);
        if let Some(wall) = wall.filter(|&wall| !self.walls()[wall].is_open() && touches(wall)).min() {
            return Some(Contact::Wall(wall));
        }
        let pole = self.poles().iter().position(|pole| {
            let there = ParryPose::from_translation(pole.centre.coords.into());
            meets(&at, shape, &there, &Ball::new(pole.radius_m))
        });
        match pole {
            Some(pole) => Some(Contact::Pole(pole)),
            None => self.is_solid(Point::from(pose.translation.vector)).then_some(Contact::Solid),
        }
    }

    /// Returns a wall as parry's shape.
    pub fn segment(&self, wall: usize) -> Segment {
        let wall = &self.walls()[wall];
        Segment::new(wall.from.coords.into(), wall.to.coords.into())
    }

    /// Returns the nearest wall that a ray meets, with the distance in metres. Use it for drawing and cross-checks: hit
    /// points are good to about 1e-7 m at grazing angles, and a ray aimed exactly at a corner may slip through.
    pub fn cast_ray(&self, from: Point, heading_rad: f64, max_m: f64, skip: Option<usize>) -> Option<(usize, f64)> {
        let (sin, cos) = libm::sincos(heading_rad);
        let ray = Ray::new(from.coords.into(), [cos, sin].into());
        let hit = self.wall_boxes().cast_ray(&ray, max_m, |wall, best| {
            let wall = wall as usize;
            if Some(wall) == skip {
                return None;
            }
            self.segment(wall).cast_local_ray(&ray, best, true)
        });
        hit.map(|(wall, distance)| (wall as usize, distance))
    }
}

#[cfg(test)]
mod tests {
    use crate::*;

    #[test]
    fn a_box_turned_by_45_degrees_reaches_farther() {
        let wall = Wall::new(1.05, -5.0, 1.05, 5.0);
        let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
        let body = Body::Box(2.0, 2.0);
        assert_eq!(scene.contact(&body, &Pose::identity()), None);
        let turned = Pose::rotation(core::f64::consts::FRAC_PI_4);
        assert_eq!(scene.contact(&body, &turned), Some(Contact::Wall(0)));
        let open = Scene::new(vec![wall.with_faces(Faces::Open)], vec![], Air::default()).unwrap();
        assert_eq!(open.contact(&body, &turned), None);
    }

    #[test]
    fn a_point_within_a_pillar_is_solid_and_one_beside_it_is_not() {
        let mut walls: Vec<_> = Wall::polyline(&[[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0], [0.0, 0.0]]).collect();
        walls.extend(Wall::polyline(&[[3.0, 3.0], [3.0, 4.0], [4.0, 4.0], [4.0, 3.0], [3.0, 3.0]]));
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        assert!(scene.is_solid(Point::new(3.5, 3.5)));
        assert!(!scene.is_solid(Point::new(4.5, 3.5)));
        assert!(scene.is_solid(Point::new(-1.0, 3.5)));
        assert!(!scene.is_solid(Point::new(f64::NAN, 3.5)));
    }

    #[test]
    fn a_ray_meets_the_nearest_wall() {
        let scene =
            Scene::new(vec![Wall::new(2.0, -1.0, 2.0, 1.0), Wall::new(3.0, -1.0, 3.0, 1.0)], vec![], Air::default())
                .unwrap();
        let (wall, distance) = scene.cast_ray(Point::origin(), 0.0, 10.0, None).unwrap();
        assert_eq!(wall, 0);
        assert!((distance - 2.0).abs() < 1e-12);
        assert_eq!(scene.cast_ray(Point::origin(), 0.0, 10.0, Some(0)).unwrap().0, 1);
        assert_eq!(scene.cast_ray(Point::origin(), 3.0, 10.0, None), None);
    }
}
