//! Exactness of parry's ray casts, as `docs/explanation/physics.md` quotes it: why they judge paths in tests and do not
//! find them.
//!
//! `cargo lab ray-casts`

use std::f64::consts::TAU;

use eeruf_sim::Random;
use parry2d_f64::{
    math::Vector,
    query::{Ray, RayCast},
    shape::Segment,
};

const TRIED: u32 = 100_000;

/// The corners of a convex room about the origin.
fn corners(random: &mut Random) -> Vec<Vector> {
    let count = 3 + (random.bits() % 6) as usize;
    let radius = random.between(1.0, 5.0);
    let turned = random.between(0.0, TAU);
    let at = |k: usize| turned + TAU * k as f64 / count as f64;
    (0..count).map(|k| Vector::new(radius * libm::cos(at(k)), radius * libm::sin(at(k)))).collect()
}

fn walls(corners: &[Vector]) -> impl Iterator<Item = Segment> + '_ {
    (0..corners.len()).map(|k| Segment::new(corners[k], corners[(k + 1) % corners.len()]))
}

/// The share of rays from inside a room that are aimed at one of its corners and meet no wall.
fn leaks(random: &mut Random) -> f64 {
    let mut leaked = 0;
    for _ in 0..TRIED {
        let corners = corners(random);
        let from = Vector::new(random.between(-0.3, 0.3), random.between(-0.3, 0.3));
        let ahead = corners[(random.bits() % corners.len() as u64) as usize] - from;
        let ray = Ray::new(from, ahead / ahead.length());
        leaked += u32::from(walls(&corners).all(|wall| wall.cast_local_ray(&ray, 100.0, true).is_none()));
    }
    f64::from(leaked) / f64::from(TRIED)
}

/// The share of rays that, reflected where they met a wall, meet the same wall again at once.
fn self_hits(random: &mut Random) -> f64 {
    let mut hit_again = 0;
    for _ in 0..TRIED {
        let angle = random.between(0.0, TAU);
        let (along, normal) =
            (Vector::new(libm::cos(angle), libm::sin(angle)), Vector::new(-libm::sin(angle), libm::cos(angle)));
        let middle = Vector::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0));
        let wall = Segment::new(middle - along * 20.0, middle + along * 20.0);
        let from = middle + normal * random.between(0.5, 3.0);
        let off = random.between(-1.2, 1.2);
        let ahead = along * libm::sin(off) - normal * libm::cos(off);
        let Some(way) = wall.cast_local_ray(&Ray::new(from, ahead), 100.0, true) else { continue };
        let back = ahead - normal * (2.0 * ahead.dot(normal));
        hit_again += u32::from(wall.cast_local_ray(&Ray::new(from + ahead * way, back), 100.0, true).is_some());
    }
    f64::from(hit_again) / f64::from(TRIED)
}

/// Largest distance from the wall's line of the hit of a ray that grazes a wall at a tenth of a milliradian, in metres.
fn grazing_m(random: &mut Random) -> f64 {
    let mut worst: f64 = 0.0;
    for _ in 0..TRIED {
        let angle = random.between(0.0, TAU);
        let (along, normal) =
            (Vector::new(libm::cos(angle), libm::sin(angle)), Vector::new(-libm::sin(angle), libm::cos(angle)));
        let wall = Segment::new(along * -10.0, along * 10.0);
        let height = random.between(1e-4, 9e-4);
        let (sin, cos) = libm::sincos(1e-4);
        let ray = Ray::new(normal * height, along * cos - normal * sin);
        if let Some(way) = wall.cast_local_ray(&ray, 100.0, true) {
            worst = worst.max((way - height / sin).abs());
        }
    }
    worst
}

pub(crate) fn main(_: &[String]) -> crate::Answer {
    let mut random = Random::new(1);
    println!("rays aimed at a corner that meet no wall: {:.1} %", 100.0 * leaks(&mut random));
    println!("reflected rays that meet their own wall again: {:.1} %", 100.0 * self_hits(&mut random));
    println!("a ray that grazes at 0.1 mrad is cut off by up to {:.1e} m", grazing_m(&mut random));
    Ok(())
}
