use crate::*;

/// Makes a random room with thin or thick poles and a ring among them.
fn random(number: u64) -> (Scene, Vec<Pose>) {
    let mut random = Random::new(number);
    let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 3.0], [6.0, 3.0], [6.0, 5.0], [0.0, 5.0], [0.0, 0.0]];
    let poles = (0..12).map(|_| {
        let (x, y, thick) = (random.between(0.1, 8.9), random.between(0.1, 2.9), random.between(0.004, 0.25));
        Pole::new(x, y, if number.is_multiple_of(2) { 0.004 } else { thick })
    });
    let mut poles: Vec<Pole> = poles.collect();
    let place = Vector::new(random.between(0.5, 8.5), random.between(0.5, 2.5));
    let robot = Pose::new(place, random.between(-3.0, 3.0));
    let ring: Vec<Pose> = ring_of(&robot, 8, 0.3, -0.9, 0.26).collect();
    let from = |pole: &Pole, sensor: &Pose| (pole.centre.coords - sensor.translation.vector).norm();
    poles.retain(|pole| ring.iter().all(|sensor| from(pole, sensor) >= pole.radius_m));
    (Scene::new(Wall::polyline(&corners).collect(), poles, Air::default()).unwrap(), ring)
}

#[test]
fn nothing_that_is_heard_is_kept_back() {
    // With the cut beam nothing is heard from behind, with the continuous beam some sound is.
    let [cut, continuous] = [Beam::CutAt90, Beam::Continuous].map(heard_as_weighed);
    assert!(cut.0 > 2000 && cut.1 > 500, "{cut:?}");
    assert!(continuous.2 > 100 && cut.2 == 0, "{cut:?} {continuous:?}");
}

/// Compares matrices with an evaluation of all paths one by one; returns the numbers of paths that are heard, that are
/// heard over poles, and that are heard from behind.
fn heard_as_weighed(beam: Beam) -> (usize, usize, usize) {
    let transducer = Transducer { beam, ..Transducer::POLAROID_6500 };
    let mut behind = 0;
    let (mut heard, mut over_poles) = (0, 0);
    for number in 0..40 {
        let (scene, ring) = random(number);
        let floor = 0.5 * transducer.detection_floor(scene.air());
        let piston = transducer.piston(scene.air());
        let mut matrix = CrosstalkMatrix::new();
        let (sensors, limits) = (&ring[..], Limits::order(3));
        let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
        matrix.compute(&mut Tracer::new(), &query).unwrap();
        let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
        for (emitter, source) in ring.iter().enumerate() {
            let all = scene.paths(places[emitter], &places, 3, f64::INFINITY).unwrap();
            for (receiver, listener) in ring.iter().enumerate() {
                let loud = all.of(receiver as u32).filter(|&k| {
                    all.amplitude[k]
                        * piston.pattern(all.departure_rad[k] - source.rotation.angle())
                        * piston.pattern(all.arrival_rad[k] - listener.rotation.angle())
                        >= floor
                });
                let expected: Vec<_> = loud.map(|k| (all.length_m[k], all.bounces(k))).collect();
                let heard_here = matrix.between(emitter, receiver);
                let found: Vec<_> = heard_here.iter().map(|path| (path.length_m, matrix.bounces(path))).collect();
                assert_eq!(found, expected, "{number}: {emitter} to {receiver}");
                heard += found.len();
                over_poles += found.iter().filter(|path| path.1.iter().any(|b| matches!(b, Bounce::Pole(_)))).count();
                let off = |path: &CriticalPath| libm::cos(path.departure_rad - source.rotation.angle());
                behind += heard_here.iter().filter(|path| off(path) < 0.0).count();
            }
        }
    }
    (heard, over_poles, behind)
}

// Single poles are the same whether or not longer paths are searched for.
#[test]
fn single_poles_do_not_depend_on_longer_paths() {
    let mut seen = 0;
    for number in 0..40 {
        let (scene, ring) = random(number);
        let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
        let alone = |max_order| {
            let paths = scene.paths(places[0], &places, max_order, f64::INFINITY).unwrap();
            let poles = (0..paths.len()).filter(|&k| matches!(paths.bounces(k), [Bounce::Pole(_)]));
            poles.map(|k| (paths.receiver[k], paths.length_m[k], paths.bounces(k).to_vec())).collect::<Vec<_>>()
        };
        assert_eq!(alone(1), alone(2), "{number}");
        seen += alone(1).len();
    }
    assert!(seen > 1000);
}
