//! Laws for every scene: reciprocity, motion, scale, and the effects of changes to walls or order.

use crate::random::{free_point, scene};
use eeruf_sim::{Air, Bounce, Faces, Paths, Point, Pole, Pose, Random, Scene, Vector, Wall};
use proptest::prelude::*;

/// Returns the paths of one receiver as sortable rows.
fn rows(paths: &Paths) -> Vec<(Vec<Bounce>, f64)> {
    let mut rows: Vec<_> = (0..paths.len()).map(|k| (paths.bounces(k).to_vec(), paths.length_m[k])).collect();
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    rows
}

fn same(a: &[(Vec<Bounce>, f64)], b: &[(Vec<Bounce>, f64)], scale: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.0 == b.0 && (a.1 * scale - b.1).abs() < 1e-9 * scale.max(1.0))
}

/// Draws a random scene with two poles, a source and a receiver.
fn setting(seed: u64) -> (Scene, Point, Point) {
    let mut random = Random::from_state(seed);
    let bare = scene(&mut random, 8);
    let (source, receiver) = (free_point(&mut random, &bare), free_point(&mut random, &bare));
    let pole = |random: &mut Random| loop {
        let (at, radius_m) = (free_point(random, &bare), random.between(0.002, 0.1));
        if [source, receiver].iter().all(|end| (end - at).norm() > radius_m) {
            return Pole::new(at.x, at.y, radius_m);
        }
    };
    let poles = vec![pole(&mut random), pole(&mut random)];
    (Scene::new(bare.walls().to_vec(), poles, Air::default()).unwrap(), source, receiver)
}

fn changed(scene: &Scene, wall: impl Fn(&Wall) -> Wall, pole: impl Fn(&Pole) -> Pole) -> Scene {
    Scene::new(scene.walls().iter().map(wall).collect(), scene.poles().iter().map(pole).collect(), scene.air()).unwrap()
}

const FAR: f64 = f64::INFINITY;

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn paths_are_the_same_backwards(seed: u64) {
        let (scene, source, receiver) = setting(seed);
        let there = scene.paths(source, &[receiver], 4, FAR).unwrap();
        let back = scene.paths(receiver, &[source], 4, FAR).unwrap();
        let mut turned = rows(&back);
        for row in &mut turned {
            row.0.reverse();
        }
        turned.sort_by(|a, b| a.0.cmp(&b.0));
        prop_assert!(same(&rows(&there), &turned, 1.0));
        // Amplitudes are equal too, and departures and arrivals are exchanged.
        let sum = |paths: &Paths| paths.amplitude.iter().sum::<f64>();
        prop_assert!((sum(&there) - sum(&back)).abs() <= 1e-9 * sum(&back));
        let cosines = |angles: &[f64]| angles.iter().map(|a| a.cos()).sum::<f64>();
        prop_assert!((cosines(&there.departure_rad) - cosines(&back.arrival_rad)).abs() < 1e-6);
    }

    #[test]
    fn paths_move_with_the_scene(seed: u64, x in -50.0..50.0f64, y in -50.0..50.0f64, turn in -3.0..3.0f64) {
        let (scene, source, receiver) = setting(seed);
        let pose = Pose::new(Vector::new(x, y), turn);
        let moved = changed(
            &scene,
            |w| Wall { from: pose * w.from, to: pose * w.to, ..*w },
            |p| Pole { centre: pose * p.centre, ..*p },
        );
        let before = scene.paths(source, &[receiver], 4, FAR).unwrap();
        let after = moved.paths(pose * source, &[pose * receiver], 4, FAR).unwrap();
        prop_assert!(same(&rows(&before), &rows(&after), 1.0));
        for k in 0..before.len() {
            let off = before.departure_rad[k] + turn - after.departure_rad[k];
            prop_assert!(off.sin().abs() < 1e-7 || before.length_m[k..].windows(2).any(|l| l[1] - l[0] < 1e-9));
        }
    }

    #[test]
    fn paths_scale_with_the_scene(seed: u64, scale in 0.01..100.0f64) {
        let (scene, source, receiver) = setting(seed);
        let large = changed(
            &scene,
            |w| Wall { from: w.from * scale, to: w.to * scale, ..*w },
            |p| Pole { centre: p.centre * scale, radius_m: p.radius_m * scale, ..*p },
        );
        let before = scene.paths(source, &[receiver], 4, FAR).unwrap();
        let after = large.paths(source * scale, &[receiver * scale], 4, FAR).unwrap();
        prop_assert!(same(&rows(&before), &rows(&after), scale));
    }

    #[test]
    fn splitting_a_wall_changes_nothing(seed: u64, share in 0.05..0.95f64) {
        let (scene, source, receiver) = setting(seed);
        let mut walls = scene.walls().to_vec();
        let first = walls[0];
        let middle = first.from + (first.to - first.from) * share;
        walls[0].to = middle;
        walls.push(Wall { from: middle, ..first });
        let new = walls.len() as u32 - 1;
        let split = Scene::new(walls, scene.poles().to_vec(), scene.air()).unwrap();
        let before = scene.paths(source, &[receiver], 4, FAR).unwrap();
        let after = split.paths(source, &[receiver], 4, FAR).unwrap();
        let mut joined = rows(&after);
        for bounce in joined.iter_mut().flat_map(|row| &mut row.0) {
            if *bounce == Bounce::Wall(new) {
                *bounce = Bounce::Wall(0);
            }
        }
        joined.sort_by(|a, b| a.0.cmp(&b.0));
        prop_assert!(same(&rows(&before), &joined, 1.0));
    }

    #[test]
    fn opening_a_wall_only_removes_paths(seed: u64, which: prop::sample::Index) {
        let (scene, source, receiver) = setting(seed);
        let opened = which.index(scene.walls().len());
        let mut walls = scene.walls().to_vec();
        walls[opened].faces = Faces::Open;
        let open = Scene::new(walls, scene.poles().to_vec(), scene.air()).unwrap();
        // A region bounded by backs and the opened wall is solid now.
        prop_assume!(![source, receiver].iter().any(|&end| open.is_solid(end)));
        let mut expected = rows(&scene.paths(source, &[receiver], 4, FAR).unwrap());
        expected.retain(|row| !row.0.contains(&Bounce::Wall(opened as u32)));
        prop_assert!(same(&expected, &rows(&open.paths(source, &[receiver], 4, FAR).unwrap()), 1.0));
    }

    #[test]
    fn a_higher_order_and_a_longer_reach_only_add(seed: u64, order in 0..4u32, reach in 1.0..20.0f64) {
        let (scene, source, receiver) = setting(seed);
        let all = scene.paths(source, &[receiver], order + 1, FAR).unwrap();
        let mut expected = rows(&all);
        expected.retain(|row| row.0.len() <= order as usize);
        prop_assert!(same(&expected, &rows(&scene.paths(source, &[receiver], order, FAR).unwrap()), 1.0));
        let mut near = rows(&all);
        near.retain(|row| row.1 <= reach);
        prop_assert!(same(&near, &rows(&scene.paths(source, &[receiver], order + 1, reach).unwrap()), 1.0));
    }

    #[test]
    fn a_path_through_a_convex_right_angle_corner_is_one(
        turn in -3.1..3.1f64,
        x in -5.0..5.0f64,
        y in -5.0..5.0f64,
        aim in 0.05..1.52f64,
        s in 0.2..3.0f64,
        r in 0.2..3.0f64,
    ) {
        let pose = Pose::new(Vector::new(x, y), turn);
        let corner = [(10.0, 0.0), (0.0, 0.0), (0.0, 10.0)].map(|(x, y)| pose * Point::new(x, y));
        let wall = |a: Point, b: Point| Wall::new(a.x, a.y, b.x, b.y);
        let on = |far: f64| pose * Point::new(far * aim.cos(), far * aim.sin());
        let (source, receiver) = (on(s), on(r));
        // Seen from inside, the wall along x first keeps the free space on its left.
        let walls = vec![wall(corner[1], corner[0]), wall(corner[2], corner[1])];
        let inside = Scene::new(walls, vec![], Air::default()).unwrap();
        let paths = inside.paths(source, &[receiver], 3, FAR).unwrap();
        let twice = paths.order.iter().filter(|order| **order == 2).count();
        prop_assert_eq!((paths.len(), twice), (4, 1));
        // Seen from outside, the same apex is a reflex corner and returns nothing.
        let far = |p: Point| p + (corner[1] - p) * 2.0;
        let walls = vec![wall(corner[0], corner[1]), wall(corner[1], corner[2])];
        let outside = Scene::new(walls, vec![], Air::default()).unwrap();
        let paths = outside.paths(far(source), &[far(receiver)], 3, FAR).unwrap();
        prop_assert_eq!(paths.len(), 1);
    }
}

/// Checks sources and receivers on a lattice: paths through corners, along the mesh's own diagonals and through the
/// joints of walls that were cut at lattice points.
#[test]
fn a_rectangle_has_one_path_per_image_even_on_a_lattice() {
    let cut = |corners: &[[f64; 2]]| Scene::new(Wall::polyline(corners).collect(), vec![], Air::default()).unwrap();
    let whole = cut(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    let pieces = cut(&[
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [4.0, 0.0],
        [4.0, 1.5],
        [4.0, 3.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 1.0],
        [0.0, 0.0],
    ]);
    let lattice: Vec<_> =
        (0..35).map(|k| Point::new(0.5 + 0.5 * f64::from(k % 7), 0.5 + 0.5 * f64::from(k / 7))).collect();
    for scene in [whole, pieces] {
        for &source in &lattice {
            let paths = scene.paths(source, &lattice, 5, FAR).unwrap();
            for (receiver, &at) in lattice.iter().enumerate() {
                let expected = 1 + 2 * 5 * 6 - usize::from(at == source);
                assert_eq!(paths.of(receiver as u32).len(), expected, "{source} to {at}");
            }
        }
    }
}

/// Checks the corners of each path: equal angles at walls and poles, and the stated length.
#[test]
fn every_path_obeys_the_law_of_reflection_at_each_bounce() {
    let mut bounced = 0;
    for seed in 0..300 {
        let (scene, source, receiver) = setting(seed);
        let paths = scene.paths(source, &[receiver], 4, FAR).unwrap();
        for k in 0..paths.len() {
            let bounces = paths.bounces(k);
            let corners = scene.bounce_points(source, receiver, bounces).unwrap();
            let length: f64 = corners.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
            assert!((length - paths.length_m[k]).abs() < 1e-9);
            let angle = |from: Point, to: Point| (to.y - from.y).atan2(to.x - from.x);
            let last = corners.len() - 1;
            assert!((angle(source, corners[1]) - paths.departure_rad[k]).sin().abs() < 1e-6);
            assert!((angle(receiver, corners[last - 1]) - paths.arrival_rad[k]).sin().abs() < 1e-6);
            for (bounce, around) in bounces.iter().zip(corners.windows(3)) {
                let normal = match *bounce {
                    Bounce::Wall(wall) => {
                        let wall = scene.walls()[wall as usize];
                        let along = (wall.to - wall.from).normalize();
                        let off = around[1] - wall.from;
                        assert!((along.x * off.y - along.y * off.x).abs() < 1e-9);
                        assert!((-1e-9..=wall.length_m() + 1e-9).contains(&along.dot(&off)));
                        Vector::new(-along.y, along.x)
                    }
                    Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => unreachable!("walls and poles alone"),
                    Bounce::Pole(pole) => {
                        let pole = scene.poles()[pole as usize];
                        let normal = (around[1] - pole.centre) / pole.radius_m;
                        assert!((normal.norm() - 1.0).abs() < 1e-9);
                        normal
                    }
                };
                // The direction in, mirrored, is the direction out.
                let (way_in, way_out) = ((around[1] - around[0]).normalize(), (around[2] - around[1]).normalize());
                let mirrored = way_in - normal * (2.0 * way_in.dot(&normal));
                assert!((mirrored - way_out).norm() < 1e-6, "{bounce:?}: {way_in} to {way_out}");
                bounced += 1;
            }
        }
    }
    assert!(bounced > 10_000);
}
