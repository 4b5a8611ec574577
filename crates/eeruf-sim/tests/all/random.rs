//! Random draws for several tests: points, rooms and scenes, from a raw state of the simulator's own generator.

use eeruf_sim::{Air, Faces, Point, Random, Scene, Wall};

/// Random draws for tests, other than numbers in a range.
pub(crate) trait Draw {
    /// Draws a whole number below `count`.
    fn below(&mut self, count: u64) -> u64;
    /// Draws a point in a square around the origin.
    fn point(&mut self, half: f64) -> Point;
}

impl Draw for Random {
    fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    fn point(&mut self, half: f64) -> Point {
        Point::new(self.between(-half, half), self.between(-half, half))
    }
}

/// Makes a star-shaped room around the origin with `walls` walls.
pub(crate) fn star(random: &mut Random, walls: usize) -> Vec<Wall> {
    let tau = std::f64::consts::TAU;
    let corners: Vec<_> = (0..walls)
        .map(|k| {
            let angle = (k as f64 + random.between(-0.35, 0.35)) / walls as f64 * tau;
            let radius = random.between(1.6, 4.0);
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    (0..walls).map(|k| (corners[k], corners[(k + 1) % walls])).map(|(a, b)| Wall::new(a[0], a[1], b[0], b[1])).collect()
}

/// Draws a random scene that [`Scene::new`] accepts: a star, sometimes with an opening, panels or a pillar.
pub(crate) fn scene(random: &mut Random, most_walls: usize) -> Scene {
    loop {
        let count = 3 + random.below(most_walls as u64 - 2) as usize;
        let mut walls = star(random, count);
        if random.below(4) == 0 {
            walls[0].faces = Faces::Open;
        }
        for _ in 0..random.below(3) {
            let (a, b) = (random.point(1.5), random.point(1.5));
            walls.push(Wall::new(a.x, a.y, b.x, b.y).with_faces(Faces::Both));
        }
        if random.below(3) == 0 {
            let (at, a) = (random.point(1.0), random.between(0.1, 0.4));
            walls.extend(Wall::polyline(&[
                [at.x - a, at.y],
                [at.x, at.y + a],
                [at.x + a, at.y],
                [at.x, at.y - a],
                [at.x - a, at.y],
            ]));
        }
        if let Ok(scene) = Scene::new(walls, vec![], Air::default()) {
            return scene;
        }
    }
}

/// Draws a point that is not inside a solid.
pub(crate) fn free_point(random: &mut Random, scene: &Scene) -> Point {
    loop {
        let at = random.point(3.0);
        if !scene.is_solid(at) {
            return at;
        }
    }
}
