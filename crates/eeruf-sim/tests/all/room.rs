//! Rooms with floor and ceiling: all images of boxes in closed form, reciprocity, and the loss from pointing up or
//! down.

use std::f64::consts::{FRAC_PI_2, PI};

use eeruf_sim::*;

use crate::random::{free_point, scene as random_scene};

/// Makes a box of this size with its corner at the origin and perfect surfaces.
fn box_room(size: [f64; 3]) -> Scene {
    let [x, y, ceiling_m] = size;
    let corners = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y], [0.0, 0.0]];
    let walls = Wall::polyline(&corners).map(|wall| wall.with_material(Material::PERFECT)).collect();
    let room = Room { ceiling_m, floor: Material::PERFECT, ceiling: Material::PERFECT };
    Scene::new(walls, vec![], Air::default()).and_then(|scene| scene.with_room(Some(room))).unwrap()
}

/// Returns the lengths of all images of a box up to an order, with at most four bounces at floor and ceiling (Allen and
/// Berkley 1979): along each axis the image at `2 n l + s`, after `|2 n|` bounces, and at `2 n l - s`, after
/// `|2 n - 1|`.
fn images(size: [f64; 3], source: [f64; 3], receiver: [f64; 3], max_order: u32) -> Vec<(u32, f64)> {
    let along = |axis: usize| {
        let most = i64::from(max_order) + 1;
        let each = (-most..=most).flat_map(move |n| {
            let turn = 2.0 * n as f64 * size[axis];
            [(2 * n, turn + source[axis]), (2 * n - 1, turn - source[axis])]
        });
        each.map(move |(bounces, at)| (bounces.unsigned_abs() as u32, at - receiver[axis])).collect::<Vec<_>>()
    };
    let [xs, ys, zs] = [0, 1, 2].map(along);
    let mut found = Vec::new();
    for &(a, x) in &xs {
        for &(b, y) in &ys {
            for &(c, z) in zs.iter().filter(|(c, _)| *c <= VERTICAL_ORDER && a + b + c <= max_order) {
                found.push((a + b + c, (x * x + y * y + z * z).sqrt()));
            }
        }
    }
    found.sort_by(|p, q| p.1.total_cmp(&q.1));
    found
}

#[test]
fn paths_of_boxes_are_the_closed_form_images() {
    let mut random = Random::new(3);
    let (mut tracer, mut paths, mut count, mut worst): (_, _, usize, f64) = (Tracer::new(), Paths::default(), 0, 0.0);
    for number in 0..200 {
        // Even numbers are rooms, odd numbers corridors.
        let size =
            if number % 2 == 0 { [[2.0, 8.0], [2.0, 8.0], [2.2, 4.0]] } else { [[1.2, 2.4], [6.0, 20.0], [2.2, 3.0]] };
        let size = size.map(|[low, high]| random.between(low, high));
        let point = |random: &mut Random| size.map(|length| random.between(0.05 * length, 0.95 * length));
        let (source, receiver) = (point(&mut random), point(&mut random));
        let max_order = 2 + (number % 4) as u32;
        let heights = Heights { source_m: source[2], receivers_m: &[receiver[2]] };
        let [from, to] = [source, receiver].map(|[x, y, _]| Point::new(x, y));
        tracer.trace_at(&box_room(size), from, &[to], heights, Limits::order(max_order), &mut paths).unwrap();
        let expected = images(size, source, receiver, max_order);
        assert_eq!(paths.len(), expected.len(), "{size:?} {source:?} {receiver:?}");
        for (k, &(_, length_m)) in expected.iter().enumerate() {
            worst = worst.max((paths.length_m[k] - length_m).abs());
            // With perfect surfaces only spreading and air reduce the amplitude.
            let air = 10f64.powf(-Air::default().absorption_db_per_m(49_400.0) * length_m / 20.0);
            assert!((paths.amplitude[k] / (air / length_m) - 1.0).abs() < 1e-9);
            let vertical = paths.bounces(k).iter().filter(|bounce| bounce.is_vertical()).count() as u32;
            assert_eq!(paths.bounces(k).len(), paths.order[k] as usize);
            assert!(
                vertical <= VERTICAL_ORDER
                    && paths.bounces(k)[..paths.order[k] as usize - vertical as usize]
                        .iter()
                        .all(|bounce| !bounce.is_vertical())
            );
        }
        let mut orders: Vec<_> = paths.order.clone();
        let mut of_images: Vec<_> = expected.iter().map(|image| image.0).collect();
        orders.sort_unstable();
        of_images.sort_unstable();
        assert_eq!(orders, of_images);
        count += expected.len();
    }
    println!("{count} paths, off by {worst:.1e} m at most");
    assert!(count > 20_000 && worst < 1e-9, "{count} {worst}");
}

#[test]
fn sound_goes_the_same_way_back_in_any_room() {
    let mut random = Random::new(8);
    let mut count = 0;
    for _ in 0..60 {
        let scene = random_scene(&mut random, 8).with_room(Some(Room::DEFAULT)).unwrap();
        let [a, b] = [(); 2].map(|()| free_point(&mut random, &scene));
        let [low_m, high_m] = [random.between(0.1, 0.9), random.between(1.0, 2.4)];
        let trace = |from, from_m, to, to_m| {
            let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
            tracer.follow(&Physics { shadows: false, ..Physics::DEFAULT });
            let heights = Heights { source_m: from_m, receivers_m: &[to_m] };
            tracer.trace_at(&scene, from, &[to], heights, Limits::order(3), &mut paths).unwrap();
            paths
        };
        let (there, back) = (trace(a, low_m, b, high_m), trace(b, high_m, a, low_m));
        assert_eq!(there.len(), back.len());
        for k in 0..there.len() {
            assert!((there.length_m[k] - back.length_m[k]).abs() < 1e-9);
            assert!((there.amplitude[k] / back.amplitude[k] - 1.0).abs() < 1e-6, "{:?}", there.bounces(k));
            let [[out, home], [out_back, home_back]] = [there.elevations_rad(k), back.elevations_rad(k)];
            assert!((out - home_back).abs() < 1e-9 && (home - out_back).abs() < 1e-9);
        }
        count += there.len();
    }
    assert!(count > 1000, "{count}");
}

#[test]
fn floor_and_ceiling_take_what_their_materials_say() {
    let soft = Room { ceiling_m: 3.0, floor: Material::flat(0.5), ceiling: Material::flat(0.8) };
    let scene = Scene::new(vec![], vec![], Air::default()).and_then(|scene| scene.with_room(Some(soft))).unwrap();
    let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
    let heights = Heights { source_m: 1.0, receivers_m: &[1.0] };
    let (here, there) = (Point::origin(), Point::new(2.0, 0.0));
    tracer.trace_at(&scene, here, &[there], heights, Limits::order(2), &mut paths).unwrap();
    let air = |length_m: f64| 10f64.powf(-Air::default().absorption_db_per_m(49_400.0) * length_m / 20.0) / length_m;
    let found: Vec<_> =
        (0..paths.len()).map(|k| (paths.bounces(k).to_vec(), paths.amplitude[k] / air(paths.length_m[k]))).collect();
    let expected = [
        (vec![], 1.0),
        (vec![Bounce::Floor], 0.5),
        (vec![Bounce::Ceiling], 0.8),
        (vec![Bounce::Floor, Bounce::Ceiling], 0.4),
        (vec![Bounce::Ceiling, Bounce::Floor], 0.4),
    ];
    assert_eq!(found.len(), expected.len());
    for ((bounces, left), (of, leaves)) in found.iter().zip(&expected) {
        assert!(bounces == of && (left - leaves).abs() < 1e-12, "{found:?}");
    }
    assert!((paths.length_m[1] - 8f64.sqrt()).abs() < 1e-12);
    assert!((paths.elevations_rad(1)[0] + PI / 4.0).abs() < 1e-12, "down to the floor");
    // A sensor hears its own echo from the floor right below it.
    tracer.trace_at(&scene, here, &[here], heights, Limits::order(1), &mut paths).unwrap();
    assert_eq!(paths.length_m, [2.0, 4.0]);
    assert_eq!((paths.bounces(0), paths.bounces(1)), (&[Bounce::Floor][..], &[Bounce::Ceiling][..]));
}

#[test]
fn patterns_take_the_angle_in_space() {
    let scene =
        Scene::new(vec![], vec![], Air::default()).and_then(|scene| scene.with_room(Some(Room::DEFAULT))).unwrap();
    let module = Transducer::HC_SR04;
    let ends = [Pose::identity(), Pose::new(Vector::new(1.0, 0.2), PI - 0.1)];
    let query = CrosstalkQuery::new(&scene, &ends, &module, Limits::order(1), 0.0);
    let heights_m = [0.3, 0.5];
    let mut matrix = CrosstalkMatrix::new();
    let query = CrosstalkQuery { heights_m: [&heights_m; 2], ..query };
    matrix.compute(&mut Tracer::at(module.frequency_hz), &query).unwrap();
    let floor = matrix.between(0, 1).iter().find(|path| matrix.bounces(path) == [Bounce::Floor]).unwrap();
    let length_m = (1.0f64 + 0.04 + 0.64).sqrt();
    let piston = module.piston(scene.air());
    // The directions are vectors: to the receiver's image below the floor, and from it to the source's image.
    let sent = piston.pattern((1.0 / length_m).acos());
    let (sin, cos) = (PI - 0.1).sin_cos();
    let heard = piston.pattern(((-cos - 0.2 * sin) / length_m).acos());
    let air = 10f64.powf(-scene.air().absorption_db_per_m(40e3) * length_m / 20.0) / length_m;
    assert!((floor.length_m - length_m).abs() < 1e-12);
    assert!((floor.amplitude / (sent * heard * 0.95 * air) - 1.0).abs() < 1e-9);
    assert!(floor.elevations_rad.iter().all(|&up| up < 0.0 && up > -FRAC_PI_2));
}

/// Checks that the search that omits faint paths finds every audible path, with a pole and panels too.
#[test]
fn nothing_that_is_heard_in_a_room_is_kept_back() {
    let mut random = Random::new(12);
    let mut heard = 0;
    for number in 0..24 {
        let beam = if number % 2 == 0 { Beam::CutAt90 } else { Beam::Continuous };
        let module = Transducer { beam, ..Transducer::POLAROID_6500 };
        let plan = random_scene(&mut random, 7);
        let at = free_point(&mut random, &plan);
        let scene = Scene::new(plan.walls().to_vec(), vec![Pole::new(at.x, at.y, 0.02)], Air::default())
            .and_then(|scene| scene.with_room(Some(Room::DEFAULT)))
            .unwrap();
        let ring: Vec<_> =
            (0..3).map(|_| Pose::new(free_point(&mut random, &plan).coords, random.between(-3.0, 3.0))).collect();
        let heights_m: Vec<_> = (0..3).map(|_| random.between(0.05, 1.5)).collect();
        let floor = 0.3 * module.detection_floor(scene.air());
        let mut tracer = Tracer::new();
        tracer.follow(&Physics { shadows: false, ..Physics::DEFAULT });
        let limits = Limits::order(3);
        let query = CrosstalkQuery::new(&scene, &ring, &module, limits, floor);
        let query = CrosstalkQuery { heights_m: [&heights_m; 2], ..query };
        let mut matrix = CrosstalkMatrix::new();
        matrix.compute(&mut tracer, &query).unwrap();
        let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
        let piston = module.piston(scene.air());
        let pattern =
            |azimuth: f64, elevation: f64| piston.pattern((azimuth.cos() * elevation.cos()).clamp(-1.0, 1.0).acos());
        for (emitter, source) in ring.iter().enumerate() {
            let mut all = Paths::default();
            let heights = Heights { source_m: heights_m[emitter], receivers_m: &heights_m };
            tracer.trace_at(&scene, places[emitter], &places, heights, limits, &mut all).unwrap();
            for (receiver, listener) in ring.iter().enumerate() {
                let loud = all.of(receiver as u32).filter(|&k| {
                    let [up, from_up] = all.elevations_rad(k);
                    all.amplitude[k]
                        * pattern(all.departure_rad[k] - source.rotation.angle(), up)
                        * pattern(all.arrival_rad[k] - listener.rotation.angle(), from_up)
                        >= floor
                });
                let expected: Vec<_> = loud.map(|k| (all.length_m[k], all.bounces(k))).collect();
                let found = matrix.between(emitter, receiver);
                let found: Vec<_> = found.iter().map(|path| (path.length_m, matrix.bounces(path))).collect();
                assert_eq!(found, expected, "{number}: {emitter} to {receiver}");
                heard += found.len();
            }
        }
    }
    assert!(heard > 400, "{heard}");
}

#[test]
fn rooms_and_heights_that_make_no_sense_are_refused() {
    let flat = || Scene::new(vec![], vec![], Air::default()).unwrap();
    let refused = |room| flat().with_room(Some(room)).unwrap_err().to_string();
    let low = Room { ceiling_m: 0.0, ..Room::DEFAULT };
    assert_eq!(refused(low), "the ceiling is at 0 m; expected a height above 0 and up to 1000 m");
    let loud = Room { floor: Material::flat(1.5), ..Room::DEFAULT };
    let expected =
        "the material of the floor is out of range; expected a reflection of 0 to 1 and a roughness of 0 m or more";
    assert_eq!(refused(loud), expected);
    let scene = flat().with_room(Some(Room::DEFAULT)).unwrap();
    let heights = Heights { source_m: 2.7, receivers_m: &[] };
    let (here, mut paths) = (Point::origin(), Paths::default());
    let traced = Tracer::new().trace_at(&scene, here, &[here], heights, Limits::order(1), &mut paths);
    assert_eq!(
        traced.unwrap_err().to_string(),
        "a sensor is 2.7 m high; expected more than 0 and less than the ceiling's 2.6 m"
    );
    let robot = Robot {
        heights_m: vec![3.0],
        ..Robot::with_sensors(Pose::identity(), vec![Pose::identity()], Transducer::HC_SR04)
    };
    let error = World::new(scene, vec![robot], Noise::NONE).unwrap_err().to_string();
    assert_eq!(error, "robot 1: height_m is 3; expected more than 0, and less than the ceiling");
}

/// Checks that a low robot hears the floor: its readings differ from those in a flat room, and equal them if floor and
/// ceiling are silent.
#[test]
fn a_room_changes_what_rings_read_and_a_silent_one_does_not() {
    let run = |room: Option<Room>| {
        let walls = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]).collect();
        let scene = Scene::new(walls, vec![], Air::default()).and_then(|scene| scene.with_room(room)).unwrap();
        let pose = Pose::new(Vector::new(1.7, 1.4), 0.3);
        let motion = Motion::Constant { velocity: Vector::new(0.1, 0.05), turn_rad_s: 0.1 };
        let robot = Robot { motion, ..Robot::ring(pose, 8, PI / 4.0, 0.15, Transducer::POLAROID_6500) };
        let world = World::new(scene, vec![robot], Noise::default()).and_then(|world| world.with_max_order(3)).unwrap();
        simulate(&world, Method::Conventional, &Options::periods(20)).unwrap()
    };
    let (flat, room) = (run(None), run(Some(Room::DEFAULT)));
    let silent = Room { floor: Material::flat(0.0), ceiling: Material::flat(0.0), ..Room::DEFAULT };
    let silent = run(Some(silent));
    let same = |a: &Readings, b: &Readings| {
        (0..a.len()).filter(|&k| a.earliest_us[k].to_bits() == b.earliest_us[k].to_bits()).count()
    };
    assert_eq!(same(&flat, &silent), flat.len());
    assert!(same(&flat, &room) < flat.len());
    let over_floor = room.paths.iter().filter(|path| path.bounces.contains(&Bounce::Floor)).count();
    assert!(over_floor > 0);
}
