//! Regions of constant depth: the angle up to which a Polaroid 6500 hears a smooth wall, by distance and gain.
//! `docs/explanation/physics.md` compares the regions with published ones.
//!
//! ```text
//! cargo lab constant-depth
//! ```

use eeruf_sim::*;

const DISTANCES_M: [f64; 6] = [0.5, 0.75, 1.0, 2.0, 4.0, 8.0];

/// Returns the widest angle at which a wall is heard, in degrees, in steps of a tenth.
fn widest_deg(distance_m: f64, gain: GainProfile) -> Option<f64> {
    let (air, transducer) = (Air::default(), Transducer { gain, ..Transducer::POLAROID_6500 });
    let piston = transducer.piston(air);
    let loss_db = air.absorption_db_per_m(transducer.frequency_hz) * 2.0 * distance_m;
    let straight = Material::SMOOTH.reflection * libm::exp10(-loss_db / 20.0) / (2.0 * distance_m);
    let level_db = |deg: f64| {
        let pattern = piston.pattern(deg.to_radians());
        transducer.level_db(straight * pattern * pattern, 2.0 * distance_m, air)
    };
    (0..900).rev().map(|tenths| 0.1 * f64::from(tenths)).find(|&deg| level_db(deg) >= 0.0)
}

pub(crate) fn main() -> crate::Answer {
    let header: Vec<_> = DISTANCES_M.iter().map(|distance_m| format!("{distance_m} m")).collect();
    println!("| gain | {} |", header.join(" | "));
    println!("|---|{}", "---:|".repeat(DISTANCES_M.len()));
    for (name, gain) in GainProfile::NAMES {
        let widest =
            DISTANCES_M.map(|distance_m| widest_deg(distance_m, gain).map_or(String::new(), |deg| format!("{deg:.0}")));
        println!("| `{name}` | {} |", widest.join(" | "));
    }
    Ok(())
}
