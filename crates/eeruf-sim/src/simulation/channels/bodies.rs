//! Robots' bodies as walls and poles: for each emitter and receiver, the scene with all bodies except their own
//! robots'.

use crate::{
    geometry::{Point, Pose},
    scene::{Body, Bounce, Material, Pole, Scene, SceneError, Wall},
    tracing::PathsError,
    world::World,
};

/// Numbers of bodies among a scene's walls and poles. Each side and each disc keeps its number no matter which bodies
/// are left out: the scene's own objects come first, then the sides and discs of all robots in order.
#[derive(Clone)]
pub(in crate::simulation) struct Bodies {
    /// For each robot, the numbers of its first side and of its disc.
    first: Vec<[u32; 2]>,
    any: bool,
    /// Recent scenes of the world with these sides; they stay the same while robots stand still.
    sided: Vec<(Vec<Wall>, Scene)>,
}

/// A scene with bodies in it.
pub(in crate::simulation) struct Furnished {
    pub(in crate::simulation) scene: Scene,
    /// Numbers of walls and poles of the world's own scene.
    own: [usize; 2],
    /// The numbers of the walls and poles that are bodies.
    walls: Vec<u32>,
    poles: Vec<u32>,
}

impl Bodies {
    pub(in crate::simulation) fn new(world: &World) -> Self {
        let scene = world.scene();
        let mut next = [scene.walls().len() as u32, scene.poles().len() as u32];
        let mut first = Vec::new();
        for robot in world.robots() {
            first.push(next);
            match robot.body {
                Some(Body::Disc(_)) => next[1] += 1,
                Some(body) => next[0] += body.sides() as u32,
                None => {}
            }
        }
        let any = world.robots().iter().any(|robot| robot.body.is_some());
        Self { first, any, sided: Vec::new() }
    }

    /// Returns true if there are bodies.
    pub(in crate::simulation) fn any(&self) -> bool {
        self.any
    }

    /// Returns the world's scene with the bodies of all robots except these; `None` if there is nothing to add.
    pub(in crate::simulation) fn scene(
        &mut self,
        world: &World,
        poses: &[Pose],
        sensors: &[Pose],
        without: [Option<usize>; 2],
    ) -> Result<Option<Furnished>, PathsError> {
        let scene = world.scene();
        let (mut sides, mut discs) = (Vec::new(), Vec::new());
        let (mut wall_numbers, mut pole_numbers) = (Vec::new(), Vec::new());
        let bodies = world.robots().iter().enumerate().filter(|(robot, _)| !without.contains(&Some(*robot)));
        let bodies: Vec<_> = bodies.filter_map(|(robot, of)| of.body.map(|body| (robot, body))).collect();
        for (index, &(robot, body)) in bodies.iter().enumerate() {
            let pose = &poses[robot];
            let overlaps = bodies[..index].iter().any(|(other, shape)| body.overlaps(pose, shape, &poses[*other]))
                || sensors.iter().any(|sensor| body.holds(pose, Point::from(sensor.translation.vector)))
                || scene.contact(&body, pose).is_some();
            if overlaps {
                return Err(PathsError::Body { robot });
            }
            let [first_wall, disc] = self.first[robot];
            if let Body::Disc(radius_m) = body {
                discs.push(Pole { centre: Point::from(pose.translation.vector), radius_m, material: Material::SMOOTH });
                pole_numbers.push(disc);
            } else {
                sides.extend(Wall::polyline(&body.walls_around(pose)));
                wall_numbers.extend((first_wall..).take(body.sides()));
            }
        }
        let Some(&(robot, _)) = bodies.first() else { return Ok(None) };
        let own = [scene.walls().len(), scene.poles().len()];
        // Bodies that touch nothing make a valid scene.
        let furnished = self.with_sides(scene, sides).and_then(|sided| sided.with_more_poles(discs));
        let scene = furnished.map_err(|_| PathsError::Body { robot })?;
        Ok(Some(Furnished { scene, own, walls: wall_numbers, poles: pole_numbers }))
    }

    fn with_sides<'s>(&'s mut self, scene: &'s Scene, sides: Vec<Wall>) -> Result<&'s Scene, SceneError> {
        if sides.is_empty() {
            return Ok(scene);
        }
        let known = self.sided.iter().position(|(of, _)| *of == sides);
        let index = match known {
            Some(index) => index,
            None => {
                let walls = [scene.walls(), &sides].concat();
                let built = Scene::new(walls, scene.poles().to_vec(), scene.air())?.with_room(scene.room().copied())?;
                // Keep one scene for each robot that may be left out.
                self.sided.truncate(self.first.len());
                self.sided.insert(0, (sides, built));
                0
            }
        };
        Ok(self.sided.get(index).map_or(scene, |(_, sided)| sided))
    }
}

impl Furnished {
    /// Replaces the numbers in bounces by the numbers that hold in every scene of the world.
    pub(in crate::simulation) fn number(&self, bounces: &mut [Bounce]) {
        for bounce in bounces {
            let (own, numbers, index) = match bounce {
                Bounce::Wall(wall) => (self.own[0], &self.walls, wall),
                Bounce::Pole(pole) => (self.own[1], &self.poles, pole),
                // Edges of bodies follow the scene's own, and keep their numbers in this scene.
                Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => continue,
            };
            if let Some(number) = (*index as usize).checked_sub(own).and_then(|body| numbers.get(body)) {
                *index = *number;
            }
        }
    }
}
