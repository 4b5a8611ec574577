//! Amplitude after one path, relative to 1 m on the transducer's axis:
//!
//! ```text
//! A = D(departure) D(arrival) * product of R_i * 10^(-alpha L / 20) / L
//! ```
//!
//! The patterns `D` belong to transducers and are applied in [`CrosstalkMatrix`](crate::CrosstalkMatrix). At a pole the
//! spreading by its curvature replaces `1 / L`.

use crate::geometry::Vector;
use crate::scene::{Bounce, Material, Scene};

/// Returns the product of all surfaces' reflections, roughness included.
///
/// Walls are followed from the receiver back to a pole (or the source), then from the source to the pole, because a
/// surface's roughness depends on its own angle of incidence.
pub(crate) fn reflected(
    scene: &Scene,
    bounces: &[Bounce],
    [departure, arrival]: [f64; 2],
    pole_cos: [f64; 2],
    wave_number: f64,
) -> f64 {
    if !scene.rough {
        return bounces.iter().map(|bounce| surface(scene, *bounce).reflection).product();
    }
    let unit = |angle: f64| Vector::new(libm::cos(angle), libm::sin(angle));
    let mut product = 1.0;
    let mut follow = |mut direction: Vector, wall: u32| {
        let mirror = &scene.mirrors()[wall as usize];
        let material = scene.walls()[wall as usize].material;
        product *= material.amplitude(wave_number, mirror.cos_incidence(direction));
        direction = mirror.turned(direction);
        direction
    };
    let mut direction = unit(arrival);
    let mut back = bounces.iter().rev();
    for bounce in back.by_ref() {
        match *bounce {
            Bounce::Wall(wall) => direction = follow(direction, wall),
            Bounce::Pole(_) | Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => break,
        }
    }
    direction = unit(departure);
    for bounce in bounces.iter().take(back.len()) {
        match *bounce {
            Bounce::Wall(wall) => direction = follow(direction, wall),
            Bounce::Pole(_) | Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => break,
        }
    }
    let poles = bounces.iter().filter(|bounce| matches!(bounce, Bounce::Pole(_)));
    poles
        .zip(pole_cos)
        .fold(product, |product, (pole, cos)| product * surface(scene, *pole).amplitude(wave_number, cos))
}

fn surface(scene: &Scene, bounce: Bounce) -> &Material {
    match bounce {
        Bounce::Wall(wall) => &scene.walls()[wall as usize].material,
        Bounce::Pole(pole) => &scene.poles()[pole as usize].material,
        Bounce::Edge(_) | Bounce::Floor | Bounce::Ceiling => &Material::PERFECT,
    }
}
