//! Paths between the sensors of one robot's ring, with the physics at the beginning of its world's simulation.

use super::channels::Bodies;
use crate::{
    acoustics::Transducer,
    geometry::Pose,
    tracing::{CrosstalkMatrix, CrosstalkQuery, Limits, PathsError, Tracer},
    world::World,
};

impl World {
    /// Finds the paths between a robot's sensors at the start, with the world's physics and the other robots' bodies.
    ///
    /// `max_order` replaces the world's own; paths over poles also have at most the world's
    /// [`pole_order`](Self::pole_order). Empty for a robot that does not exist.
    ///
    /// # Errors
    /// See [`Tracer::trace`].
    ///
    /// ```
    /// use eeruf_sim::*;
    /// // A pillar of 0.6 m between a robot and a wall: no sound returns from behind it.
    /// let straight_through = |physics| -> Result<usize, Box<dyn std::error::Error>> {
    ///     let wall = Wall::new(4.0, -5.0, 4.0, 5.0).with_faces(Faces::Both);
    ///     let scene = Scene::new(vec![wall], vec![Pole::new(2.0, 0.0, 0.6)], Air::default())?;
    ///     let robot = Robot::ring(Pose::identity(), 2, 0.1, 0.2, Transducer::POLAROID_6500);
    ///     let heard = World::new(scene, vec![robot], Noise::default())?.with_physics(physics)?.ring_paths(0, 1)?;
    ///     Ok(heard.paths().iter().filter(|path| heard.bounces(path) == [Bounce::Wall(0)]).count())
    /// };
    /// assert_eq!(straight_through(Physics::DEFAULT)?, 0);
    /// assert!(straight_through(Physics::PLAIN)? > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ring_paths(&self, robot: usize, max_order: u32) -> Result<CrosstalkMatrix, PathsError> {
        self.ring_paths_above(robot, max_order, 1.0)
    }

    /// Finds paths like [`ring_paths`](Self::ring_paths), down to this share of the threshold amplitude.
    ///
    /// # Errors
    /// See [`Tracer::trace`].
    pub fn ring_paths_above(&self, robot: usize, max_order: u32, share: f64) -> Result<CrosstalkMatrix, PathsError> {
        let mut matrix = CrosstalkMatrix::new();
        let Some(of) = self.robots().get(robot) else { return Ok(matrix) };
        let sensors: Vec<Pose> = self.sensors(robot, 0.0).collect();
        let poses: Vec<Pose> = self.robots().iter().map(|robot| robot.motion.at(&robot.pose, 0.0).pose).collect();
        let mut bodies = Bodies::new(self);
        let own = of.body.map(|_| robot);
        let furnished = if bodies.any() { bodies.scene(self, &poses, &sensors, [own; 2])? } else { None };
        let scene = furnished.as_ref().map_or(self.scene(), |furnished| &furnished.scene);
        let mut tracer = Tracer::new();
        tracer.follow(&self.physics());
        // Bodies shade under any physics.
        tracer.pole_shadows |= furnished.is_some();
        tracer.pole_order = self.pole_order().min(max_order);
        let kinds: Vec<Transducer> = of.transducers().collect();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for sensor in 0..kinds.len() {
            match groups.iter_mut().find(|group| kinds[group[0]] == kinds[sensor]) {
                Some(group) => group.push(sensor),
                None => groups.push(vec![sensor]),
            }
        }
        let some = |group: &[usize]| -> (Vec<Pose>, Vec<f64>) {
            group.iter().map(|&sensor| (sensors[sensor], of.height_m(sensor))).unzip()
        };
        let mut part = CrosstalkMatrix::new();
        for senders in &groups {
            for listeners in &groups {
                let (sending, hearing) = (&kinds[senders[0]], &kinds[listeners[0]]);
                if !hearing.hears(sending) {
                    continue;
                }
                let ((sources, from_m), (receivers, to_m)) = (some(senders), some(listeners));
                let (limits, floor) = (Limits::order(max_order), share * hearing.detection_floor(scene.air()));
                let query = CrosstalkQuery::new(scene, &receivers, hearing, limits, floor);
                let query = CrosstalkQuery { coupling: of.coupling(), heights_m: [&from_m, &to_m], ..query };
                part.compute_between(&sources, sending, &mut tracer, &query)?;
                matrix.absorb(&part, senders, listeners);
            }
        }
        matrix.sort(sensors.len());
        if let Some(furnished) = &furnished {
            furnished.number(matrix.bounces_mut());
        }
        Ok(matrix)
    }
}
