//! Robots' bodies as walls and poles: for each emitter and receiver the scene in which all bodies stand but their own
//! robots'.

use crate::{
    geometry::{Point, Pose},
    scene::{Body, Bounce, Material, Pole, Scene, Wall},
    tracing::PathsError,
    world::World,
};

/// Where bodies come among a scene's walls and poles. Whoever is left out, each side and each disc keeps its number:
/// those of the scene first, then the sides and the discs of all robots in order.
pub(in crate::simulation) struct Bodies {
    /// For each robot, its first side and its disc.
    first: Vec<[u32; 2]>,
    any: bool,
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
        Self { first, any: world.robots().iter().any(|robot| robot.body.is_some()) }
    }

    /// True if there are any.
    pub(in crate::simulation) fn any(&self) -> bool {
        self.any
    }

    /// The world's scene with the bodies of all robots but these; none if nothing is to be added.
    pub(in crate::simulation) fn scene(
        &self,
        world: &World,
        poses: &[Pose],
        sensors: &[Pose],
        without: [Option<usize>; 2],
    ) -> Result<Option<Furnished>, PathsError> {
        let scene = world.scene();
        let (mut walls, mut poles) = (scene.walls().to_vec(), scene.poles().to_vec());
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
                poles.push(Pole { centre: Point::from(pose.translation.vector), radius_m, material: Material::SMOOTH });
                pole_numbers.push(disc);
            } else {
                walls.extend(Wall::polyline(&body.walls_around(pose)));
                wall_numbers.extend((first_wall..).take(body.sides()));
            }
        }
        if bodies.is_empty() {
            return Ok(None);
        }
        let own = [scene.walls().len(), scene.poles().len()];
        // What touches nothing makes a scene.
        let robot = bodies.first().map_or(0, |body| body.0);
        let built = Scene::new(walls, poles, scene.air()).and_then(|built| built.with_room(scene.room().copied()));
        let scene = built.map_err(|_| PathsError::Body { robot })?;
        Ok(Some(Furnished { scene, own, walls: wall_numbers, poles: pole_numbers }))
    }
}

impl Furnished {
    /// Gives bounces the numbers that they have in every scene of the world.
    pub(in crate::simulation) fn number(&self, bounces: &mut [Bounce]) {
        for bounce in bounces {
            let (own, numbers, index) = match bounce {
                Bounce::Wall(wall) => (self.own[0], &self.walls, wall),
                Bounce::Pole(pole) => (self.own[1], &self.poles, pole),
                // Those of bodies follow the scene's own, and are numbered as in this very scene.
                Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => continue,
            };
            if let Some(number) = (*index as usize).checked_sub(own).and_then(|body| numbers.get(body)) {
                *index = *number;
            }
        }
    }
}
