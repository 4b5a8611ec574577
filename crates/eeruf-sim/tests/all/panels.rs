//! Reflection of narrow panels: Kirchhoff's integral, reciprocity, panels cut in pieces, and completeness.

use crate::random::{Draw as _, free_point, scene};
use eeruf_sim::*;

const FAR: f64 = f64::INFINITY;

/// A path: its bounces, its length, and its amplitude.
type Row = (Vec<Bounce>, f64, f64);

fn traced(scene: &Scene, source: Point, receiver: Point, physics: Physics, max_order: u32) -> Vec<Row> {
    let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
    tracer.follow(&physics);
    tracer.trace(scene, source, &[receiver], Limits::order(max_order), &mut paths).unwrap();
    (0..paths.len()).map(|k| (paths.bounces(k).to_vec(), paths.length_m[k], paths.amplitude[k])).collect()
}

const NARROW: Physics = Physics { narrow_panels: true, ..Physics::PLAIN };
const WITH_EDGES: Physics = Physics { edges: true, ..NARROW };

fn perfect(walls: Vec<Wall>, poles: Vec<Pole>) -> Scene {
    let walls = walls.into_iter().map(|wall| wall.with_material(Material::PERFECT)).collect();
    Scene::new(walls, poles, Air::default()).unwrap()
}

fn panel(from: [f64; 2], to: [f64; 2]) -> Wall {
    Wall::new(from[0], from[1], to[0], to[1]).with_faces(Faces::Both)
}

/// Returns the amplitude after this length by spreading alone.
fn free(length_m: f64) -> f64 {
    10f64.powf(-Air::default().absorption_db_per_m(49_400.0) * length_m / 20.0) / length_m
}

fn db(ratio: f64) -> f64 {
    20.0 * ratio.log10()
}

/// Computes Kirchhoff's integral over a strip of infinite height, between two points before it: Huygens's wavelets by
/// the midpoint rule over the width, and by stationary phase over the height. Relative to 1 m, without loss in the air.
fn kirchhoff(source: Point, receiver: Point, from: Point, to: Point) -> f64 {
    let k = Transducer::POLAROID_6500.wave_number(Air::default());
    let along = (to - from).normalize();
    let normal = Vector::new(-along.y, along.x);
    let width = (to - from).norm();
    let steps = (width * 20_000.0).ceil().max(200.0) as u32;
    let step = width / f64::from(steps);
    let (mut real, mut imaginary) = (0.0, 0.0);
    for n in 0..steps {
        let at = from + along * (step * (f64::from(n) + 0.5));
        let (out, home) = (source - at, receiver - at);
        let (r1, r2) = (out.norm(), home.norm());
        let cosines = 0.5 * (out.dot(&normal).abs() / r1 + home.dot(&normal).abs() / r2);
        let size = step * cosines / (r1 * r2 * (r1 + r2)).sqrt();
        real += size * (k * (r1 + r2)).cos();
        imaginary += size * (k * (r1 + r2)).sin();
    }
    (k / std::f64::consts::TAU).sqrt() * real.hypot(imaginary)
}

/// Returns the strength of the only reflection, relative to an endless wall.
fn share(source: Point, receiver: Point, from: [f64; 2], to: [f64; 2]) -> f64 {
    let paths = traced(&perfect(vec![panel(from, to)], vec![]), source, receiver, NARROW, 1);
    let (_, length_m, amplitude) = paths.iter().find(|path| path.0.len() == 1).expect("a reflection");
    amplitude / free(*length_m)
}

#[test]
fn straight_ahead_a_panel_returns_what_the_table_says() {
    // The figures are those of docs/explanation/physics.md, in dB; the widths are in millimetres.
    let widths = [1.0, 10.0, 20.0, 50.0, 83.0, 100.0];
    for (r, expected) in [(1.0, [-35.4, -15.4, -9.4, -1.6, 2.0, 2.6]), (3.0, [-40.2, -20.2, -14.1, -6.2, -1.9, -0.4])] {
        for (width, expected) in widths.iter().zip(expected) {
            let half = 0.5e-3 * width;
            let found = db(share(Point::origin(), Point::origin(), [r, -half], [r, half]));
            assert!((found - expected).abs() < 0.06, "{width} mm at {r} m: {found}");
        }
    }
}

// A panel returns Kirchhoff's integral at any distance and angle.
#[test]
fn panel_returns_kirchhoffs_integral() {
    let (mut worst, mut count) = (0.0f64, 0);
    for width in [0.01, 0.03, 0.1, 0.3, 1.0, 3.0] {
        for (s, r) in [(0.3, 0.3), (1.0, 1.0), (3.0, 3.0), (0.3, 2.0), (1.0, 4.0)] {
            for incidence in [0.0f64, 0.4, 0.9, 1.3] {
                for offset in [0.0, 0.2, 0.45] {
                    // The reflection is at the origin; the panel lies along x, off to one side.
                    let (sin, cos) = incidence.sin_cos();
                    let (source, receiver) = (Point::new(-s * sin, s * cos), Point::new(r * sin, r * cos));
                    let ends = [-0.5, 0.5].map(|end| (end + offset) * width);
                    let found = share(source, receiver, [ends[0], 0.0], [ends[1], 0.0]);
                    let judge = kirchhoff(source, receiver, Point::new(ends[0], 0.0), Point::new(ends[1], 0.0));
                    let off = (found - judge * (s + r)).abs();
                    worst = worst.max(off);
                    count += 1;
                }
            }
        }
    }
    assert!(worst < 0.025 && count == 360, "{worst}");
}

// A wide panel returns everything, half of it half, and a narrow panel in proportion to its width.
#[test]
fn panel_returns_by_its_width() {
    let here = Point::new(0.0, 1.0);
    assert!((share(here, here, [-30.0, 0.0], [30.0, 0.0]) - 1.0).abs() < 0.01);
    assert!((share(here, here, [0.0, 0.0], [30.0, 0.0]) - 0.5).abs() < 0.005);
    let at = |half: f64| db(share(here, here, [-half, 0.0], [half, 0.0]));
    let zone = (Air::default().speed_of_sound() / 49_400.0).sqrt();
    for half in [0.001, 0.002, 0.004] {
        let by_width = db(2f64.sqrt() * 2.0 * half / zone);
        assert!((at(half) - by_width).abs() < 0.02, "{half}: {} {by_width}", at(half));
    }
    assert!((at(0.002) - at(0.001) - 20.0 * 2f64.log10()).abs() < 0.01);
}

#[test]
fn a_wall_that_sound_grazes_is_as_narrow_as_it_looks() {
    // At 80 degrees a wall of 40 cm is 7 cm wide. It reflects like a wall of 7 cm straight ahead at the same distances.
    let (sin, cos) = 80f64.to_radians().sin_cos();
    let grazed = share(Point::new(-2.0 * sin, 2.0 * cos), Point::new(2.0 * sin, 2.0 * cos), [-0.2, 0.0], [0.2, 0.0]);
    let ahead = share(Point::new(0.0, 2.0), Point::new(0.0, 2.0), [-0.2 * cos, 0.0], [0.2 * cos, 0.0]);
    assert!(db(grazed / ahead).abs() < 0.2 && ahead < 0.9, "{grazed} {ahead}");
}

// Every bounce counts by its distances along the path, and a pole is an end.
#[test]
fn every_bounce_counts_along_the_path() {
    // The path leads to a wall, back to a panel behind, and to the wall again: the panel is 2 m from either end.
    let wall = || panel([-9.0, 1.0], [9.0, 1.0]);
    let behind = || panel([-0.02, -0.5], [0.02, -0.5]);
    let (here, there) = (Point::new(-0.2, 0.0), Point::new(0.2, 0.0));
    let both = perfect(vec![wall(), behind()], vec![]);
    let over = traced(&both, here, there, NARROW, 3);
    let over = over.iter().find(|path| path.0 == [0, 1, 0].map(Bounce::Wall)).unwrap();
    let half_m = 0.5 * over.1;
    let cos = 2.5 / half_m;
    let straight = share(Point::new(0.0, half_m), Point::new(0.0, half_m), [-0.02 * cos, 0.0], [0.02 * cos, 0.0]);
    // The wall is practically endless.
    assert!((over.2 / free(over.1) / straight - 1.0).abs() < 0.01, "{} {straight}", over.2 / free(over.1));
    // If the path continues to a pole, the panel's distance to that end is its distance to the pole.
    let pole = Pole { material: Material::PERFECT, ..Pole::new(0.0, 0.5, 0.004) };
    let by_way = |behind: Wall, physics| {
        let paths = traced(&perfect(vec![behind], vec![pole]), Point::origin(), Point::origin(), physics, 2);
        paths.into_iter().find(|path| path.0 == [Bounce::Wall(0), Bounce::Pole(0)]).map_or(0.0, |path| path.2)
    };
    let found = by_way(behind(), NARROW) / by_way(panel([-9.0, -0.5], [9.0, -0.5]), Physics::PLAIN);
    let expected = share(Point::origin(), Point::new(0.0, 0.496), [-0.02, -0.5], [0.02, -0.5]);
    assert!(found < 0.9 && (found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
}

#[test]
fn two_panels_make_a_path_no_louder_than_one_does() {
    // Both panels have the loudest width for a bounce 1 m and 3 m from the path's ends.
    let zone = (2.0 * Air::default().speed_of_sound() / 49_400.0 * 0.75).sqrt();
    let half = 0.5 * 1.209 * zone;
    let facing = perfect(vec![panel([-half, 1.0], [half, 1.0]), panel([-half, -1.0], [half, -1.0])], vec![]);
    let paths = traced(&facing, Point::origin(), Point::origin(), NARROW, 2);
    let over_both = paths.iter().find(|path| path.0 == [0, 1].map(Bounce::Wall)).unwrap();
    let found = over_both.2 / free(over_both.1);
    assert!((found - 1.342).abs() < 1e-3, "{found}");
}

#[test]
fn a_wall_cut_in_pieces_sounds_as_before() {
    let (source, receiver) = (Point::new(-0.3, 1.0), Point::new(0.1, 0.7));
    let whole = |physics| traced(&perfect(vec![panel([-0.2, 0.0], [0.15, 0.0])], vec![]), source, receiver, physics, 2);
    // One piece is reversed, and one has a panel on its back.
    let cut = vec![
        panel([-0.2, 0.0], [-0.1, 0.0]),
        panel([0.0, 0.0], [-0.1, 0.0]),
        panel([0.0, 0.0], [0.15, 0.0]),
        panel([-0.05, -0.4], [-0.05, 0.0]),
    ];
    let cut = |physics| traced(&perfect(cut.clone(), vec![]), source, receiver, physics, 2);
    for physics in [NARROW, WITH_EDGES] {
        let amplitudes = |paths: Vec<Row>| paths.iter().map(|path| (path.1, path.2)).collect::<Vec<_>>();
        let (whole, cut) = (amplitudes(whole(physics)), amplitudes(cut(physics)));
        // The panel behind has its own end, which is hidden.
        assert_eq!(whole.len(), cut.len(), "{physics}");
        for (whole, cut) in whole.iter().zip(cut) {
            assert!((whole.0 - cut.0).abs() < 1e-12 && (whole.1 / cut.1 - 1.0).abs() < 1e-9, "{whole:?} {cut:?}");
        }
    }
    assert!(whole(NARROW)[1].2 < 0.98 * whole(Physics::PLAIN)[1].2 || whole(NARROW)[1].2 > whole(Physics::PLAIN)[1].2);
}

#[test]
fn rectangular_room_does_not_change_with_panels() {
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
    let room = Scene::new(Wall::polyline(&corners).collect(), vec![], Air::default()).unwrap();
    // The same holds straight into a corner, where the images are the exact answer.
    for at in [Point::new(0.3, 0.2), Point::new(0.5, 0.5), Point::new(2.0, 1.0)] {
        assert_eq!(traced(&room, at, at, WITH_EDGES, 4), traced(&room, at, at, Physics::PLAIN, 4));
    }
    let pillar = [[0.0, 0.0], [-1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let pillar = perfect(Wall::polyline(&pillar).collect(), vec![]);
    let before = Point::new(1e-12, 1.0);
    let reflected = traced(&pillar, before, before, NARROW, 1);
    let found: Vec<_> = reflected.iter().filter(|path| path.0.len() == 1).collect();
    assert!(found.iter().all(|path| path.2 / free(path.1) <= 0.51), "{found:?}");
}

#[test]
fn paths_over_panels_are_the_same_backwards() {
    let mut compared = 0;
    for number in 0..60 {
        let mut random = Random::from_state(number);
        let (scene, source, receiver) = furnished(&mut random);
        for physics in [NARROW, WITH_EDGES, Physics { shadows: true, ..WITH_EDGES }] {
            let sorted = |mut rows: Vec<Row>| {
                rows.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
                rows
            };
            if scene.poles().iter().any(|pole| [source, receiver].iter().any(|at| (at - pole.centre).norm() < 0.2)) {
                continue;
            }
            let there = sorted(traced(&scene, source, receiver, physics, 3));
            let mut back = traced(&scene, receiver, source, physics, 3);
            back.iter_mut().for_each(|row| row.0.reverse());
            let back = sorted(back);
            assert_eq!(there.len(), back.len(), "{number}");
            for (there, back) in there.iter().zip(&back) {
                assert!(there.0 == back.0 && (there.2 - back.2).abs() < 1e-6 * back.2, "{number} {there:?} {back:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 5000, "{compared}");
}

/// Draws a random room with poles, and with panels 5 mm to 25 cm wide.
fn furnished(random: &mut Random) -> (Scene, Point, Point) {
    loop {
        let bare = scene(random, 8);
        let mut walls = bare.walls().to_vec();
        for _ in 0..6 {
            let (at, turn, width) = (random.point(1.5), random.between(0.0, 3.2), random.between(0.005, 0.25));
            let half = Vector::new(turn.cos(), turn.sin()) * (0.5 * width);
            walls.push(panel([at.x - half.x, at.y - half.y], [at.x + half.x, at.y + half.y]));
        }
        let poles = (0..2).map(|_| free_point(random, &bare)).map(|at| Pole::new(at.x, at.y, 0.01)).collect();
        if let Ok(scene) = Scene::new(walls, poles, Air::default()) {
            let ends = (free_point(random, &scene), free_point(random, &scene));
            return (scene, ends.0, ends.1);
        }
    }
}

/// Checks that no audible path over panels is lost: panels may be louder than walls, so a bound for walls does not hold
/// for panels.
#[test]
fn nothing_that_is_heard_over_panels_is_lost() {
    let (mut heard, mut louder, mut around) = (0, 0, 0);
    for number in 0..40 {
        let mut random = Random::from_state(1000 + number);
        let (scene, place, _) = furnished(&mut random);
        let ring: Vec<_> = ring_of(&Pose::new(place.coords, random.between(-3.0, 3.0)), 6, 0.5, 0.05, 0.3).collect();
        if ring.iter().any(|sensor| scene.is_solid(sensor.translation.vector.into())) {
            continue;
        }
        let transducer = Transducer { cycles: 12, ..Transducer::POLAROID_6500 };
        let piston = transducer.piston(scene.air());
        let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
        let floors = [0.5, 12.0].map(|times| (times, NARROW));
        let with_edges = [0.2, 1.0, 4.0, 15.0].map(|times| (times, WITH_EDGES));
        for (times, physics) in floors.into_iter().chain(with_edges) {
            let floor = times * transducer.detection_floor(scene.air());
            let (mut matrix, mut tracer, limits) = (CrosstalkMatrix::new(), Tracer::new(), Limits::order(3));
            tracer.follow(&physics);
            let query = CrosstalkQuery::new(&scene, &ring, &transducer, limits, floor);
            matrix.compute(&mut tracer, &query).unwrap();
            for (emitter, source) in ring.iter().enumerate() {
                let mut all = Paths::default();
                tracer.trace(&scene, places[emitter], &places, limits, &mut all).unwrap();
                for (receiver, listener) in ring.iter().enumerate() {
                    let patterns = |k: usize| {
                        piston.pattern(all.departure_rad[k] - source.rotation.angle())
                            * piston.pattern(all.arrival_rad[k] - listener.rotation.angle())
                    };
                    let loud = all.of(receiver as u32).filter(|&k| all.amplitude[k] * patterns(k) >= floor);
                    let expected: Vec<_> = loud.map(|k| (all.length_m[k], all.bounces(k))).collect();
                    let here = matrix.between(emitter, receiver);
                    let found: Vec<_> = here.iter().map(|path| (path.length_m, matrix.bounces(path))).collect();
                    assert_eq!(found, expected, "{number}, {times}: {emitter} to {receiver}");
                    heard += found.len();
                    let is_louder = |path: &&CriticalPath| {
                        let walls = 0.95f64.powi(path.order as i32) * free(path.length_m);
                        let patterns = piston.pattern(path.departure_rad - source.rotation.angle())
                            * piston.pattern(path.arrival_rad - listener.rotation.angle());
                        path.amplitude > 1.01 * walls * patterns && walls * patterns < floor
                    };
                    louder += here.iter().filter(is_louder).count();
                    around += found.iter().filter(|path| matches!(path.1, [Bounce::Edge(_)])).count();
                }
            }
        }
    }
    assert!(heard > 2000 && louder > 5 && around > 20, "{heard} {louder} {around}");
}

#[test]
fn the_ends_of_a_panel_are_heard_once() {
    let physics = Physics { edges: true, ..Physics::PLAIN };
    let (here, half) = (Point::origin(), 0.005);
    let ahead = perfect(vec![panel([1.0, -half], [1.0, half])], vec![]);
    assert_eq!(traced(&ahead, here, here, physics, 1).len(), 3, "the reflection and two ends");
    let found = traced(&ahead, here, here, WITH_EDGES, 1);
    assert!(found.len() == 1 && found[0].0 == [Bounce::Wall(0)], "{found:?}");
    // An end that is more than a burst away is an echo of its own.
    let wide = perfect(vec![panel([1.0, -0.02], [1.0, 3.0])], vec![]);
    let found = traced(&wide, here, here, WITH_EDGES, 1);
    assert!(found.len() == 2 && found[1].1 > 6.0 && matches!(found[1].0[..], [Bounce::Edge(_)]), "{found:?}");
}

// Beside its reflection a panel returns Kirchhoff's integral as one echo.
#[test]
fn panel_beside_its_reflection_returns_kirchhoffs_integral() {
    let here = Point::origin();
    let mut worst = 0.0f64;
    for width in [0.005, 0.01, 0.03, 0.06] {
        for turned in [0.01f64, 0.04, 0.1, 0.2, 0.4] {
            let half = Vector::new(-turned.sin(), turned.cos()) * (0.5 * width);
            let (from, to) = (Point::new(1.0, 0.0) - half, Point::new(1.0, 0.0) + half);
            let scene = perfect(vec![panel([from.x, from.y], [to.x, to.y])], vec![]);
            let found = traced(&scene, here, here, WITH_EDGES, 1);
            assert_eq!(found.len(), 1, "{width} {turned}: {found:?}");
            let judge = kirchhoff(here, here, from, to);
            let alone = found[0].2 / (free(found[0].1) * found[0].1);
            worst = worst.max(db(alone / judge).abs());
        }
    }
    assert!(worst < 0.7, "{worst}");
    // A square post of 7 mm seen along its diagonal returns echoes of both sides, which are equal here. At 45 degrees
    // Kirchhoff's cosines take 2.3 dB more than the geometric theory of diffraction does.
    let side = 0.00523;
    let post = [[1.0 - side, 0.0], [1.0, side], [1.0 + side, 0.0], [1.0, -side], [1.0 - side, 0.0]];
    let found = traced(&perfect(Wall::polyline(&post).collect(), vec![]), here, here, WITH_EDGES, 1);
    let judge = 2.0 * kirchhoff(here, here, Point::new(1.0 - side, 0.0), Point::new(1.0, side));
    let alone = found[0].2 / (free(found[0].1) * found[0].1);
    assert!(found.len() == 1 && (0.0..2.5).contains(&db(alone / judge)), "{found:?} {} {}", db(alone), db(judge));
}

#[test]
fn default_has_it_and_under_plain_nothing_of_it_is_there() {
    let mut random = Random::from_state(5);
    let (scene, source, receiver) = furnished(&mut random);
    let rows = |physics| traced(&scene, source, receiver, physics, 3);
    assert_ne!(rows(NARROW), rows(Physics::PLAIN));
    let plain = scene.paths(source, &[receiver], 3, FAR).unwrap();
    assert_eq!(rows(Physics::PLAIN).iter().map(|row| row.2).collect::<Vec<_>>(), plain.amplitude);
    assert_ne!(rows(Physics::DEFAULT), rows(Physics { narrow_panels: false, ..Physics::DEFAULT }));
    assert_eq!(rows(Physics::DEFAULT), rows(Physics { shadows: true, ..WITH_EDGES }));
}

#[test]
fn a_panel_is_heard_from_farther_than_a_wall() {
    let reads = |physics: Physics| {
        // A wall is audible up to 3 m; the panel has the loudest width.
        let transducer = Transducer { max_range_m: 3.0, ..Transducer::POLAROID_6500 };
        let scene = perfect(vec![panel([3.05, -0.088], [3.05, 0.088])], vec![]);
        let robot = Robot::with_sensors(Pose::identity(), vec![Pose::identity()], transducer);
        let world = World::new(scene, vec![robot], Noise::NONE).and_then(|world| world.with_physics(physics)).unwrap();
        simulate(&world, Method::Conventional, &Options::periods(1)).unwrap().reference_us[0]
    };
    assert!(reads(Physics::PLAIN).is_nan());
    assert!((reads(NARROW) - 2.0 * 3.05 / 343.2 * 1e6).abs() < 2.0, "{}", reads(NARROW));
}
