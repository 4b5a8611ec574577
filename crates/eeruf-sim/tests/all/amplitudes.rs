//! Amplitudes along whole paths: each surface has its own angle, poles are waves, and many sources run at once.

use eeruf_sim::{Air, Limits, Material, Paths, Point, Pole, Scene, Tracer, Transducer, Wall, pole_wave_correction};

const FAR: f64 = f64::INFINITY;

fn room(material: Material, poles: Vec<Pole>) -> Scene {
    let walls = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    Scene::new(walls.map(|wall| wall.with_material(material)).collect(), poles, Air::default()).unwrap()
}

#[test]
fn roughness_counts_at_each_wall_by_its_own_angle() {
    let (source, receiver) = (Point::new(1.0, 1.0), Point::new(2.5, 1.7));
    let rough = Material { reflection: 0.9, roughness_m: 0.2e-3 };
    let smooth = room(Material::flat(0.9), vec![]).paths(source, &[receiver], 3, FAR).unwrap();
    let scattered = room(rough, vec![]).paths(source, &[receiver], 3, FAR).unwrap();
    let k = Transducer::POLAROID_6500.wave_number(Air::default());
    for path in 0..smooth.len() {
        // In a rectangle the angle to each pair of walls is the same at every bounce.
        let direction = smooth.departure_rad[path];
        let expected: f64 = smooth.bounces(path).iter().fold(1.0, |product, bounce| {
            let lying = matches!(bounce, eeruf_sim::Bounce::Wall(0 | 2));
            let cos = if lying { direction.sin() } else { direction.cos() };
            product * (-2.0 * (k * rough.roughness_m * cos).powi(2)).exp()
        });
        assert!((scattered.amplitude[path] / smooth.amplitude[path] / expected - 1.0).abs() < 1e-9);
    }
}

// A pole as a rigid cylinder returns 95 % of geometric optics.
#[test]
fn pole_returns_95_per_cent_of_geometric_optics() {
    let scene = Scene::new(vec![], vec![Pole::new(1.0, 0.0, 0.004)], Air::default()).unwrap();
    let here = Point::origin();
    let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
    tracer.trace(&scene, here, &[here], Limits::order(1), &mut paths).unwrap();
    let by_rays = paths.amplitude[0];
    tracer.pole_waves = true;
    tracer.trace(&scene, here, &[here], Limits::order(1), &mut paths).unwrap();
    let ka = Transducer::POLAROID_6500.wave_number(Air::default()) * 0.004;
    assert!((paths.amplitude[0] / by_rays - pole_wave_correction(ka, 0.0)).abs() < 1e-12);
    assert!((paths.amplitude[0] / by_rays - 0.950).abs() < 1e-3);
}

#[test]
fn a_tracer_used_again_finds_what_a_new_one_does() {
    let scene = room(Material::SMOOTH, vec![Pole::new(2.0, 2.0, 0.01)]);
    let points: Vec<_> = (0..20).map(|k| Point::new(0.3 + 0.17 * f64::from(k), 0.4 + 0.11 * f64::from(k))).collect();
    let (mut tracer, mut again) = (Tracer::new(), Paths::default());
    for source in &points {
        // Data of an earlier query would show.
        tracer.trace(&scene, *source, &points, Limits::order(3), &mut again).unwrap();
        assert_eq!(scene.paths(*source, &points, 3, f64::INFINITY).unwrap(), again);
    }
    assert!(tracer.trace(&scene, Point::new(f64::NAN, 0.0), &points, Limits::order(3), &mut again).is_err());
}
