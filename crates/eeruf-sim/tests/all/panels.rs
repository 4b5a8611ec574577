//! What panels return that are narrower than their first Fresnel zone, against Kirchhoff's integral over their surface,
//! computed here.

use eeruf_sim::*;
use std::f64::consts::{PI, TAU};

const WAVELENGTH_M: f64 = 343.2 / 49_400.0;

/// An upright panel across the x axis, from `low` to `high` in y.
fn panel(low: f64, high: f64) -> Wall {
    Wall::new(0.0, low, 0.0, high).with_faces(Faces::Both).with_material(Material::PERFECT)
}

/// Kirchhoff's integral over that panel of a point source's sound, relative to 1 m, at a receiver; both at x < 0:
///
/// ```text
/// |k / (2 pi) integral (cos a + cos b) / 2 exp(i k (r1 + r2)) / (r1 r2) dy dz|
/// ```
///
/// Its height has no end; here it fades out, slowly against the wave.
fn kirchhoff(low: f64, high: f64, source: Point, receiver: Point) -> f64 {
    let k = TAU / WAVELENGTH_M;
    let columns = ((high - low) / 4e-4).ceil().max(8.0) as usize;
    let (dy, dz, top) = ((high - low) / columns as f64, 4e-4, 1.2);
    let (mut real, mut imaginary) = (0.0, 0.0);
    for column in 0..columns {
        let y = low + (column as f64 + 0.5) * dy;
        let mut z = 0.5 * dz;
        while z < top {
            let [r1, r2] = [source, receiver].map(|at| (at.x.powi(2) + (at.y - y).powi(2) + z * z).sqrt());
            let cos = 0.5 * (-source.x / r1 - receiver.x / r2);
            let fade = if z < 0.3 { 1.0 } else { 0.5 + 0.5 * (PI * (z - 0.3) / (top - 0.3)).cos() };
            // Both halves of its height.
            let part = 2.0 * fade * cos / (r1 * r2) * dy * dz;
            let (sin, cos) = (k * (r1 + r2)).sin_cos();
            real += part * cos;
            imaginary += part * sin;
            z += dz;
        }
    }
    k / TAU * real.hypot(imaginary)
}

/// The amplitudes of all paths that meet the panel, the air's loss left out, with edges or as under `plain`.
fn amplitudes(walls: Vec<Wall>, source: Point, receiver: Point, edges: bool) -> Vec<(Vec<Bounce>, f64)> {
    let scene = Scene::new(walls, vec![], Air::default()).unwrap();
    let mut tracer = Tracer::new();
    tracer.edges = edges;
    let mut paths = Paths::default();
    tracer.trace(&scene, source, &[receiver], Limits::order(2), &mut paths).unwrap();
    let loss = scene.air().absorption_db_per_m(49_400.0) / 20.0;
    let bare = |k: usize| (paths.bounces(k).to_vec(), paths.amplitude[k] * 10f64.powf(loss * paths.length_m[k]));
    (0..paths.len()).filter(|&k| paths.order[k] > 0).map(bare).collect()
}

fn db(ratio: f64) -> f64 {
    20.0 * ratio.log10()
}

#[test]
fn a_narrow_panel_returns_what_kirchhoffs_integral_says_and_under_plain_what_a_wall_does() {
    // Straight ahead, from two places, off the middle of the panel, and aslant.
    let places = [
        ([-1.0, 0.0], [-1.0, 0.0]),
        ([-2.5, 0.0], [-2.5, 0.0]),
        ([-0.8, 0.1], [-1.6, -0.2]),
        ([-1.0, 0.004], [-1.0, 0.004]),
        ([-1.0, 0.8], [-1.0, -0.8]),
    ];
    for (source, receiver) in places.map(|(source, receiver)| (Point::from(source), Point::from(receiver))) {
        let whole = 1.0 / (receiver - Point::new(-source.x, source.y)).norm();
        for width in [0.001, 0.01, 0.02, 0.04, 0.06] {
            let [low, high] = [-0.5 * width, 0.5 * width];
            let found = amplitudes(vec![panel(low, high)], source, receiver, true);
            let loudest = found.iter().map(|(_, amplitude)| *amplitude).fold(0.0, f64::max);
            let expected = kirchhoff(low, high, source, receiver).min(whole);
            let off = db(loudest / expected);
            assert!(off.abs() < 0.7, "{width} m, {source} to {receiver}: {:.2} and {off:.2} dB", db(expected / whole));
            let plain = amplitudes(vec![panel(low, high)], source, receiver, false);
            assert!(plain.iter().all(|(_, amplitude)| (amplitude / whole - 1.0).abs() < 1e-12));
        }
    }
}

#[test]
fn a_millimetre_is_35_decibel_below_a_wall_and_its_edges_are_not_louder() {
    let here = Point::new(-1.0, 0.0);
    let found = amplitudes(vec![panel(-0.0005, 0.0005)], here, here, true);
    assert_eq!(found.len(), 3, "the panel and its two edges");
    for (bounces, amplitude) in &found {
        assert!((db(amplitude / 0.5) + 35.4).abs() < 0.5, "{bounces:?}: {:.1}", db(amplitude / 0.5));
    }
}

#[test]
fn sound_whose_specular_point_is_beside_a_narrow_panel_returns_as_kirchhoffs_integral_says() {
    for (aside, width) in [(0.01, 0.01), (0.02, 0.01), (0.02, 0.03)] {
        let here = Point::new(-1.0, 0.5 * width + aside);
        let found = amplitudes(vec![panel(-0.5 * width, 0.5 * width)], here, here, true);
        let loudest = found.iter().map(|(_, amplitude)| *amplitude).fold(0.0, f64::max);
        let expected = kirchhoff(-0.5 * width, 0.5 * width, here, here);
        let off = db(loudest / expected);
        assert!(off.abs() < 1.5, "{aside} {width}: {off:.2} dB");
    }
}

#[test]
fn a_panel_seen_over_a_mirror_is_as_narrow_as_from_where_its_image_is() {
    // A long wall under source and receiver, without an end near the path.
    let floor = Wall::new(-9.0, -1.0, 9.0, -1.0).with_material(Material::PERFECT);
    let (source, receiver) = (Point::new(-1.0, 0.3), Point::new(-1.4, -0.2));
    let image = Point::new(receiver.x, -2.0 - receiver.y);
    let middle = source.y + (image.y - source.y) / 2.4;
    let strip = panel(middle - 0.01, middle + 0.01);
    let over_both: Vec<_> = amplitudes(vec![strip, floor], source, receiver, true)
        .into_iter()
        .filter(|(bounces, _)| bounces[..] == [Bounce::Wall(0), Bounce::Wall(1)])
        .collect();
    let direct = amplitudes(vec![strip], source, image, true);
    let direct: Vec<_> = direct.into_iter().filter(|(bounces, _)| bounces[..] == [Bounce::Wall(0)]).collect();
    assert_eq!((over_both.len(), direct.len()), (1, 1));
    assert!((over_both[0].1 / direct[0].1 - 1.0).abs() < 1e-9, "{over_both:?} {direct:?}");
    assert!(db(direct[0].1 * (image - Point::new(-source.x, source.y)).norm()) < -8.0);
}

#[test]
fn a_wide_panel_a_wall_in_a_room_and_one_in_pieces_return_what_they_did() {
    let (source, receiver) = (Point::new(-1.0, 0.1), Point::new(-1.3, -0.1));
    let wide = [vec![panel(-0.3, 0.3)], vec![panel(-0.3, -0.01), panel(-0.01, 0.01), panel(0.01, 0.3)]];
    for walls in wide {
        let of = |edges| -> Vec<_> {
            let found = amplitudes(walls.clone(), source, receiver, edges).into_iter();
            found.filter(|(bounces, _)| matches!(bounces[..], [Bounce::Wall(_)])).collect()
        };
        assert_eq!(of(true), of(false));
        assert_eq!(of(true).len(), 1);
    }
    // A niche of two centimetres: its end goes on in the images at its sides.
    let niche = [[1.0, 0.5], [0.01, 0.5], [0.01, 0.3], [-0.01, 0.3], [-0.01, 0.5], [-1.0, 0.5]];
    let walls: Vec<_> = Wall::polyline(&niche).map(|wall| Wall { from: wall.to, to: wall.from, ..wall }).collect();
    let here = Point::new(0.0, 1.5);
    let of = |edges| -> Vec<_> {
        let found = amplitudes(walls.clone(), here, here, edges).into_iter();
        found.filter(|(bounces, _)| bounces[..] == [Bounce::Wall(2)]).collect()
    };
    assert_eq!(of(true), of(false));
    assert_eq!(of(true).len(), 1);
}
