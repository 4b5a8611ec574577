//! What several tests need: a plain generator of random numbers and of rooms.
#![allow(dead_code, unreachable_pub, reason = "each test uses its own part")]

use eeruf_sim::{Air, Faces, Point, Scene, Wall};

/// The `SplitMix64` generator.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }

    pub fn point(&mut self, half: f64) -> Point {
        Point::new(self.between(-half, half), self.between(-half, half))
    }
}

/// A star-shaped room around the origin with `walls` walls.
pub fn star(random: &mut Random, walls: usize) -> Vec<Wall> {
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

/// A random scene: a star, sometimes with an opening, panels or a pillar; never one that [`Scene::new`] refuses.
pub fn scene(random: &mut Random, most_walls: usize) -> Scene {
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

/// A point that is not inside anything solid.
pub fn free_point(random: &mut Random, scene: &Scene) -> Point {
    loop {
        let at = random.point(3.0);
        if !scene.is_solid(at) {
            return at;
        }
    }
}
