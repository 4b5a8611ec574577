//! Shadows of poles. Sound bends around poles thinner than the first Fresnel zone, and does not reach places behind
//! thicker ones.

use crate::{
    geometry::Point,
    scene::{Bounce, Scene},
    tracing::bounce_points::parts,
};

/// Returns true if a pole blocks a path because it is too thick for sound to bend around. This is so if a leg passes it
/// within its radius and the radius exceeds
///
/// ```text
/// sqrt(lambda d1 d2 / (d1 + d2))
/// ```
///
/// `corners` are the path's corners, ends included. Walls are mirrors, so `d1` and `d2` are counted along the path,
/// across bounces at walls, up to its ends or to the next pole or edge, where the sound spreads again.
pub(in crate::tracing) fn is_shaded(scene: &Scene, corners: &[Point], bounces: &[Bounce], wavelength_m: f64) -> bool {
    for (start, end) in parts(bounces) {
        let whole_m: f64 = corners[start..=end].windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        let mut before_m = 0.0;
        for leg in start..end {
            let (from, way) = (corners[leg], corners[leg + 1] - corners[leg]);
            let length_m = way.norm();
            let of_leg = |pole: usize| {
                let pole = Some(&Bounce::Pole(pole as u32));
                bounces.get(leg) == pole || (leg > 0 && bounces.get(leg - 1) == pole)
            };
            for (index, pole) in scene.poles().iter().enumerate() {
                if of_leg(index) {
                    continue;
                }
                let along_m = ((pole.centre - from).dot(&way) / length_m).clamp(0.0, length_m);
                let aside_m = (from + way * (along_m / length_m) - pole.centre).norm();
                let (d1, d2) = (before_m + along_m, whole_m - before_m - along_m);
                if aside_m < pole.radius_m && pole.radius_m * pole.radius_m * whole_m > wavelength_m * d1 * d2 {
                    return true;
                }
            }
            before_m += length_m;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use crate::*;

    fn echoes(poles: Vec<Pole>, shadows: bool) -> Vec<f64> {
        let wall = Wall::new(3.0, -5.0, 3.0, 5.0).with_faces(Faces::Both);
        let scene = Scene::new(vec![wall], poles, Air::default()).unwrap();
        let mut tracer = Tracer::new();
        tracer.pole_shadows = shadows;
        let (here, mut paths) = (Point::origin(), Paths::default());
        tracer.trace(&scene, here, &[here], Limits::order(3), &mut paths).unwrap();
        let walls_only = (0..paths.len()).filter(|&k| paths.bounces(k) == [Bounce::Wall(0)]);
        walls_only.map(|k| paths.length_m[k]).collect()
    }

    #[test]
    fn nothing_passes_a_pillar() {
        let pillar = Pole::new(1.5, 0.0, 0.6);
        assert_eq!(echoes(vec![pillar], false), [6.0]);
        assert_eq!(echoes(vec![pillar], true), [0.0; 0]);
        // A path that grazes the pole does not pass either, while one just beside it does.
        assert_eq!(echoes(vec![Pole::new(1.5, 0.59, 0.6)], true), [0.0; 0]);
        assert_eq!(echoes(vec![Pole::new(1.5, 0.61, 0.6)], true), [6.0]);
    }

    // Sound bends around a pole thinner than its first Fresnel zone.
    #[test]
    fn sound_bends_around_a_thin_pole() {
        // Half way to the wall, 1.5 m of the 6 m there and back: sqrt(6.947 mm * 1.5 m * 4.5 m / 6 m) = 88.4 mm.
        for (radius_m, passes) in [(0.087, true), (0.090, false)] {
            assert_eq!(!echoes(vec![Pole::new(1.5, 0.0, radius_m)], true).is_empty(), passes, "{radius_m}");
        }
        // Near the sensor the zone is narrower: 26 mm at a decimetre.
        assert!(echoes(vec![Pole::new(0.1, 0.0, 0.03)], true).is_empty());
        assert!(!echoes(vec![Pole::new(0.1, 0.0, 0.02)], true).is_empty());
    }

    #[test]
    fn a_pole_is_shaded_by_a_pillar_before_it_and_not_by_itself() {
        let heard = |poles: Vec<Pole>| {
            let scene = Scene::new(vec![], poles, Air::default()).unwrap();
            let mut tracer = Tracer::new();
            tracer.pole_shadows = true;
            let (here, mut paths) = (Point::origin(), Paths::default());
            tracer.trace(&scene, here, &[here], Limits::order(1), &mut paths).unwrap();
            (0..paths.len()).map(|k| paths.bounces(k).to_vec()).collect::<Vec<_>>()
        };
        let (pillar, behind) = (Pole::new(1.0, 0.0, 0.3), Pole::new(3.0, 0.0, 0.004));
        assert_eq!(heard(vec![pillar, behind]), [[Bounce::Pole(0)]]);
        assert_eq!(heard(vec![behind]), [[Bounce::Pole(0)]]);
    }

    // The error does not depend on the physics.
    #[test]
    fn sensor_inside_a_solid_is_refused() {
        let room = Wall::polyline(&[[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0], [-4.0, -4.0]]).collect();
        let scene = Scene::new(room, vec![Pole::new(1.0, 0.0, 0.3)], Air::default()).unwrap();
        let (free, pillar, outside) = (Point::origin(), Point::new(1.1, 0.0), Point::new(-5.0, 0.0));
        let inside = |at, what| Err(format!("a sensor at {at} m is inside {what}; expected it in the open"));
        let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
        for (_, physics) in Physics::PRESETS {
            tracer.follow(&physics);
            let mut ask = |source, receiver| {
                let asked = tracer.trace(&scene, source, &[receiver], Limits::order(1), &mut paths);
                asked.map_err(|error| error.to_string())
            };
            assert_eq!(ask(free, free), Ok(()));
            assert_eq!(ask(pillar, free), inside("(1.1, 0)", "pole 0"));
            assert_eq!(ask(free, pillar), inside("(1.1, 0)", "pole 0"));
            assert_eq!(ask(free, outside), inside("(-5, 0)", "a wall or outside the room"));
        }
    }
}
