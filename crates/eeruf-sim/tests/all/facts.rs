//! Two facts of the paper, and the rejection of invalid scenes.

use eeruf_sim::{
    Air, CrosstalkMatrix, CrosstalkQuery, Faces, GainProfile, Limits, Material, PathsError, Point, Pole, Pose, Scene,
    SceneError, Tracer, Transducer, Vector, Wall, ring_of,
};
use std::f64::consts::FRAC_PI_2;

fn matrix(scene: &Scene, sensors: &[Pose]) -> CrosstalkMatrix {
    let transducer = Transducer::POLAROID_6500;
    let mut matrix = CrosstalkMatrix::new();
    let floor = transducer.detection_floor(scene.air());
    let query = CrosstalkQuery::new(scene, sensors, &transducer, Limits::order(2), floor);
    matrix.compute(&mut Tracer::new(), &query).unwrap();
    matrix
}

/// Returns the level of the loudest direct path in dB above the detection floor. The path leads from a sensor to the
/// one `away` places further on a ring of 24, off a flat wall that faces the middle between the two.
fn over_floor_db(distance_m: f64, away: usize) -> f64 {
    let wall = Wall::new(5.0, 0.3 + distance_m, -5.0, 0.3 + distance_m).with_material(Material::PERFECT);
    let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
    let spacing = 15f64.to_radians();
    let ring: Vec<_> = ring_of(&Pose::identity(), 24, 0.3, FRAC_PI_2 - 0.5 * away as f64 * spacing, spacing).collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let mut all = CrosstalkMatrix::new();
    let limits = Limits::order(2);
    let query = CrosstalkQuery::new(&scene, &ring, &transducer, limits, 0.0);
    all.compute(&mut Tracer::new(), &query).unwrap();
    let direct = all.between(0, away).iter().filter(|path| path.is_direct() && path.order == 1);
    20.0 * (direct.map(|path| path.amplitude).fold(0.0, f64::max) / floor).log10()
}

/// Checks Sec. 3 of the paper: a wall 0.5 to 1 m away.
#[test]
fn wall_at_a_metre_reaches_three_neighbours() {
    for distance_m in [0.5, 0.75, 1.0] {
        for away in 1..=3 {
            let level = over_floor_db(distance_m, away);
            assert!(level > 3.0, "{distance_m} m, neighbour {away}: {level:.1} dB");
        }
        let fourth = over_floor_db(distance_m, 4);
        assert!(fourth.abs() < 5.0, "{distance_m} m, neighbour 4 is marginal: {fourth:.1} dB");
    }
    assert!(over_floor_db(0.75, 4) < 0.0 && over_floor_db(1.0, 4) < 0.0);
}

/// Checks footnote 1 of Sec. 4.
#[test]
fn pole_of_8_mm_between_sensors_is_heard_at_1_6_m() {
    let ring: Vec<_> = ring_of(&Pose::identity(), 2, 0.3, -7.5f64.to_radians(), 15f64.to_radians()).collect();
    let heard_at = |range: f64| {
        let scene = Scene::new(vec![], vec![Pole::new(0.3 + range, 0.0, 0.004)], Air::default()).unwrap();
        !matrix(&scene, &ring).between(0, 0).is_empty() && !matrix(&scene, &ring).between(0, 1).is_empty()
    };
    assert!(heard_at(1.6));
    assert!(!heard_at(3.2), "but not at any distance");
}

/// Returns the largest turn of a sensor from a smooth wall with which it still hears its echo, in whole degrees: the
/// end of the region of constant depth.
fn heard_up_to_deg(distance_m: f64, gain: GainProfile) -> i32 {
    let wall = Wall::new(distance_m, -9.0, distance_m, 9.0).with_faces(Faces::Both);
    let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
    let transducer = Transducer { gain, ..Transducer::POLAROID_6500 };
    let floor = transducer.detection_floor(scene.air());
    let heard = |deg: &i32| {
        let sensors = [Pose::rotation(f64::from(*deg).to_radians())];
        let limits = Limits::order(1);
        let query = CrosstalkQuery::new(&scene, &sensors, &transducer, limits, floor);
        let mut matrix = CrosstalkMatrix::new();
        matrix.compute(&mut Tracer::new(), &query).unwrap();
        !matrix.paths().is_empty()
    };
    (0..=90).rev().find(heard).unwrap_or(-1)
}

/// Checks that walls are heard up to the published angles: near 10 to 15 degrees, and 25 to 30 for strong near walls.
/// With a constant gain this holds beyond a metre, with a growing gain also nearer.
#[test]
fn walls_are_heard_as_far_off_axis_as_reported() {
    let constant = [1.0, 2.0, 4.0].map(|distance_m| heard_up_to_deg(distance_m, GainProfile::Constant));
    assert_eq!(constant, [31, 20, 10]);
    assert!(heard_up_to_deg(0.5, GainProfile::Constant) >= 85);
    let grows = [0.5, 1.0].map(|distance_m| heard_up_to_deg(distance_m, GainProfile::SquareRoot));
    assert!(grows.iter().all(|deg| (8..=30).contains(deg)), "{grows:?}");
    let polaroid = [0.5, 1.0, 2.0, 4.0].map(|distance_m| heard_up_to_deg(distance_m, GainProfile::Polaroid6500));
    assert_eq!(polaroid, [29, 20, 10, 10]);
}

fn refused(walls: Vec<Wall>, poles: Vec<Pole>) -> String {
    Scene::new(walls, poles, Air::default()).unwrap_err().to_string()
}

#[test]
fn bad_scenes_are_refused_in_words() {
    let wall = Wall::new(0.0, 0.0, 4.0, 0.0);
    assert_eq!(
        refused(vec![wall, Wall::new(1.0, f64::NAN, 2.0, 2.0)], vec![]),
        "wall 1 has a coordinate NaN m; expected a number within 100000 m"
    );
    assert_eq!(
        refused(vec![Wall::new(1.0, 1.0, 1.0, 1.0)], vec![]),
        "wall 0 is 0 m long; expected at least 0.000001 m"
    );
    assert_eq!(
        refused(vec![wall, wall], vec![]),
        "walls 0 and 1 lie on top of each other; they may share one point only"
    );
    assert_eq!(
        refused(vec![wall, Wall::new(4.0, 0.0, 0.0, 0.0)], vec![]),
        "walls 0 and 1 lie on top of each other; they may share one point only"
    );
    assert_eq!(
        refused(vec![wall, Wall::new(1.0, 0.0, 3.0, 0.0)], vec![]),
        "walls 0 and 1 lie on top of each other; they may share one point only"
    );
    assert_eq!(
        refused(vec![wall, Wall::new(0.0, 0.0, 3.0, 0.0)], vec![]),
        "walls 0 and 1 lie on top of each other; they may share one point only"
    );
    assert_eq!(
        refused(vec![wall, Wall::new(1.0, -1.0, 1.0, 1.0)], vec![]),
        "walls 0 and 1 cross at (1.0000, 0.0000); end one of them there"
    );
    assert_eq!(
        refused(vec![wall.with_material(Material::flat(1.5))], vec![]),
        "the material of wall 0 is out of range; expected a reflection of 0 to 1 and a roughness of 0 m or more"
    );
    assert_eq!(
        refused(vec![], vec![Pole::new(0.0, 0.0, -1.0)]),
        "pole 0 has -1 m; expected finite coordinates and a radius above 0 and up to 100 m"
    );
    assert_eq!(
        refused(vec![], vec![Pole::new(0.0, 0.0, 0.1), Pole::new(0.0, 0.0, 0.2)]),
        "poles 0 and 1 have the same axis"
    );
    let hot = Scene::new(vec![], vec![], Air::at(600.0)).unwrap_err();
    assert_eq!(hot.to_string(), "air temperature is 600; expected -50 to 60 C");
    assert!(matches!(hot, SceneError::Air { value: 600.0, .. }));
}

#[test]
fn bad_questions_are_refused_in_words() {
    let scene = Scene::new(vec![Wall::new(0.0, 0.0, 4.0, 0.0)], vec![], Air::default()).unwrap();
    let here = Point::new(1.0, 1.0);
    let nan = Point::new(f64::NAN, 1.0);
    let ask = |source, receiver, order, length| scene.paths(source, &[receiver], order, length).unwrap_err();
    assert_eq!(
        ask(nan, here, 1, 9.0).to_string(),
        "the source is at (NaN, 1) m; expected a point within 1020 m of the walls"
    );
    assert_eq!(
        ask(here, Point::new(1e7, 0.0), 1, 9.0).to_string(),
        "receiver 0 is at (10000000, 0) m; expected a point within 1020 m of the walls"
    );
    assert_eq!(ask(here, here, 5000, 9.0).to_string(), "paths up to order 5000; expected at most 1000");
    assert_eq!(ask(here, here, 1, f64::NAN).to_string(), "paths up to NaN m; expected a positive length");
    assert!(scene.paths(here, &[], 3, 9.0).unwrap().is_empty());
}

#[test]
fn a_wall_that_ends_on_another_splits_it() {
    let room = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
    let mut walls: Vec<_> = Wall::polyline(&room).collect();
    walls.push(Wall::new(2.0, 0.0, 2.0, 2.0).with_faces(Faces::Both));
    let scene = Scene::new(walls, vec![], Air::default()).unwrap();
    let paths =
        scene.paths(Point::new(1.0, 1.0), &[Point::new(3.0, 1.0), Point::new(1.0, 0.4)], 1, f64::INFINITY).unwrap();
    // Behind the partition only the ceiling reflects; before it all walls and the partition do, except the right wall.
    assert_eq!(paths.of(0).map(|k| paths.bounces(k).to_vec()).collect::<Vec<_>>(), [[eeruf_sim::Bounce::Wall(2)]]);
    assert_eq!(paths.of(1).len(), 1 + 4);
}

// Points on walls, corners and panels are accepted or refused without a panic.
#[test]
fn points_on_walls_are_answered_without_panic() {
    let mut walls: Vec<_> = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]).collect();
    walls.push(Wall::new(1.0, 1.0, 2.0, 2.0).with_faces(Faces::Both));
    let scene = Scene::new(walls, vec![Pole::new(3.0, 1.0, 0.3)], Air::default()).unwrap();
    let odd = [
        [0.0, 0.0],
        [4.0, 3.0],
        [2.0, 0.0],
        [1.0, 1.0],
        [1.5, 1.5],
        [2.0, 2.0],
        [3.0, 1.0],
        [3.3, 1.0],
        [0.5, 0.5],
        [-3.0, 1.0],
    ]
    .map(Point::from);
    for source in odd {
        for receiver in odd {
            match scene.paths(source, &[receiver], 5, f64::INFINITY) {
                Ok(paths) => assert!(paths.length_m.iter().all(|length| length.is_finite())),
                // These are the pole's axis, a point on its rim up to rounding, and a point outside the room.
                Err(PathsError::Inside { at: [x, _], .. }) => assert!([3.0, 3.3, -3.0].contains(&x), "{x}"),
                Err(error) => panic!("{error}"),
            }
        }
    }
}

// A hundred thousand walls work, and a million crossing walls are refused.
#[test]
fn hundred_thousand_walls_work_a_million_are_refused() {
    let side = 158;
    let mut walls = Vec::new();
    for k in 0..side * side {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        walls.extend(Wall::polyline(&[[x, y], [x, y + 0.3], [x + 0.3, y + 0.3], [x + 0.3, y], [x, y]]));
    }
    let scene = Scene::new(walls, vec![], Air::default()).unwrap();
    let paths = scene.paths(Point::new(50.6, 50.6), &[Point::new(51.7, 50.7)], 3, 10.0).unwrap();
    assert!(paths.len() > 1);

    let crossing =
        (0..1_000_000).map(|k| Wall::new(f64::from(k) * 0.01, 0.0, f64::from(k) * 0.01 + 1.0, 1.0 + f64::from(k % 7)));
    assert!(matches!(Scene::new(crossing.collect(), vec![], Air::default()), Err(SceneError::WallsCross { .. })));
}

#[test]
fn budgets_end_questions_that_would_never_end() {
    let room = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.3, 3.0], [2.0, 1.9], [0.1, 3.0], [0.0, 0.0]]).collect();
    let scene = Scene::new(room, vec![], Air::default()).unwrap();
    let wide = [Point::new(0.5, 0.7), Point::new(3.1, 0.8)];
    let error = scene.paths(Point::new(1.0, 1.0), &wide, 1000, f64::INFINITY);
    assert!(matches!(error, Err(PathsError::Budget { .. })) || error.unwrap().len() > 1000);
}

#[test]
fn the_matrix_is_sorted_and_blind_to_pairs_that_do_not_exist() {
    let room = Wall::polyline(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]]).collect();
    let scene = Scene::new(room, vec![], Air::default()).unwrap();
    let ring: Vec<_> = ring_of(&Pose::new(Vector::new(1.3, 0.9), 0.2), 8, 0.2, 0.0, 45f64.to_radians()).collect();
    let heard = matrix(&scene, &ring);
    let mut total = 0;
    for emitter in 0..8 {
        for receiver in 0..8 {
            let paths = heard.between(emitter, receiver);
            assert!(paths.is_sorted_by(|a, b| a.length_m <= b.length_m));
            assert!(paths.iter().all(|path| (path.emitter, path.receiver) == (emitter as u32, receiver as u32)));
            assert!(paths.iter().all(|path| heard.bounces(path).len() == path.order as usize));
            total += paths.len();
        }
    }
    assert_eq!(total, heard.paths().len());
    assert!(total > 8);
    assert!(heard.between(8, 0).is_empty() && heard.between(0, 8).is_empty());
}

#[test]
fn a_forest_and_a_hall_of_poles_are_answered_soon() {
    let forest = |count: u32| {
        (0..count).map(|k| Pole::new(0.37 * f64::from(k % 17), 0.41 * f64::from(k / 17), 0.01)).collect::<Vec<_>>()
    };
    let open = Scene::new(vec![], forest(200), Air::default()).unwrap();
    let (source, receiver) = (Point::new(-1.0, 0.2), Point::new(-1.0, 0.9));
    let paths = open.paths(source, &[receiver], 2, f64::INFINITY).unwrap();
    // No pole is hidden: there is one path over each, and there are many over two.
    assert_eq!(paths.order.iter().filter(|order| **order == 1).count(), 200);
    assert!(paths.len() > 10_000);
    let room = Wall::polyline(&[[-2.0, -2.0], [8.0, -2.0], [8.0, 8.0], [-2.0, 8.0], [-2.0, -2.0]]).collect();
    let hall = Scene::new(room, forest(100), Air::default()).unwrap();
    let near = hall.paths(source, &[receiver], 60, 9.0).unwrap();
    assert!(near.length_m.iter().all(|length| *length <= 9.0));
    assert!(near.len() > 1000);
}
