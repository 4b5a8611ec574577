//! The view of the ring along one direction, where the cones of several sensors may overlap.

use crate::placing::Place;
use crate::range::{Distance, Scale};
use crate::view::View;

/// The view along a heading, with the distance from the robot's centre. The nearest obstacle counts, or else an unknown
/// view; a direction is free if every sensor whose cone contains the ray at the maximum range is clear.
pub(crate) fn along(
    heading_rad: f64,
    places: &[Place],
    views: &[(View, f32)],
    half_view_rad: f64,
    scale: &Scale,
) -> View {
    let (sin, cos) = heading_rad.sin_cos();
    let [min_m, max_m] = [scale.min_m, scale.max_m].map(f64::from);
    let (mut nearest, mut doubtful, mut clear) = (f64::INFINITY, false, false);
    for (place, &(view, _)) in places.iter().zip(views) {
        let holds = |along_m: f64| {
            let (x, y) = (along_m * cos - place.x_m, along_m * sin - place.y_m);
            let (axis_sin, axis_cos) = place.yaw_rad.sin_cos();
            (axis_cos * y - axis_sin * x).atan2(axis_cos * x + axis_sin * y).abs() <= half_view_rad
        };
        // The ray meets the arc at this distance from the sensor where it enters or leaves a circle.
        let arc_m = match view {
            View::Sees(Distance::At(metres)) => Some(f64::from(metres)),
            View::Sees(Distance::TooClose) => Some(min_m),
            _ => None,
        };
        let met = arc_m.and_then(|arc_m| {
            let middle = place.x_m * cos + place.y_m * sin;
            let half = (middle * middle + arc_m * arc_m - place.x_m * place.x_m - place.y_m * place.y_m).sqrt();
            [middle - half, middle + half].into_iter().find(|&along_m| along_m > 0.0 && holds(along_m))
        });
        match met {
            Some(met) => nearest = nearest.min(met),
            None if !holds(max_m) => {}
            None if view == View::Sees(Distance::Clear) => clear = true,
            None => doubtful = true,
        }
    }
    if nearest.is_finite() {
        View::Sees(Distance::At(nearest as f32))
    } else if clear && !doubtful {
        View::Sees(Distance::Clear)
    } else {
        View::Unknown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    #[test]
    fn overlapping_cones_give_one_answer() {
        use Distance::{At, Clear, TooClose};
        // Two sensors 20 cm ahead of the centre, 15 degrees apart, with cones of 30 degrees.
        let place = |deg: f64| Place { x_m: 0.2, y_m: 0.0, z_m: 0.0, yaw_rad: deg.to_radians() };
        let places = [place(7.5), place(-7.5)];
        let scale = Scale::new(&Parameters::default());
        let said = |left, right| {
            let views = [left, right].map(|view| (view, 0.0));
            [15.0_f64, 0.0, -15.0].map(|deg| along(deg.to_radians(), &places, &views, 15_f64.to_radians(), &scale))
        };
        let (clear, unknown) = (View::Sees(Clear), View::Unknown);
        assert_eq!(said(clear, clear), [clear; 3]);
        for doubtful in [View::Unknown, View::Unanswered] {
            assert_eq!(said(clear, doubtful), [clear, unknown, unknown]);
        }
        let metres = |view| if let View::Sees(At(metres)) = view { metres } else { f32::NAN };
        let [left, middle, right] = said(View::Sees(At(1.0)), clear);
        assert!((metres(left) - 1.193).abs() < 0.01 && (metres(middle) - 1.2).abs() < 1e-6 && right == clear);
        assert!((metres(said(View::Sees(At(1.0)), View::Sees(At(0.5)))[1]) - 0.7).abs() < 1e-6);
        assert!((metres(said(View::Sees(TooClose), clear)[1]) - 0.22).abs() < 1e-6);
    }

    #[test]
    fn ray_beyond_an_arc_that_it_misses_is_not_free() {
        // The ray enters the cone of the sensor on the left beyond what that sensor sees.
        let place = |y_m, deg: f64| Place { x_m: 0.0, y_m, z_m: 0.0, yaw_rad: deg.to_radians() };
        let views = [View::Sees(Distance::At(0.5)), View::Sees(Distance::Clear)].map(|view| (view, 0.0));
        let places = [place(0.3, 0.0), place(0.0, 0.0)];
        let scale = Scale::new(&Parameters::default());
        let said = |half_deg: f64| along(0.0, &places, &views, half_deg.to_radians(), &scale);
        assert_eq!(said(15.0), View::Unknown);
        assert_eq!(said(4.0), View::Sees(Distance::Clear));
    }
}
