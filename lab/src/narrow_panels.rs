//! Effect of `narrow_panels`: the loudness of panels straight ahead.
//!
//! `cargo lab narrow-panels`

use eeruf_sim::*;

const WIDTHS_MM: [f64; 6] = [1.0, 10.0, 20.0, 50.0, 83.0, 100.0];

pub(crate) fn main() -> crate::Answer {
    let widths = WIDTHS_MM.map(|width_mm| format!(" {width_mm} mm |")).concat();
    println!("| width |{widths}\n|---|{}", "---:|".repeat(WIDTHS_MM.len()));
    for distance_m in [1.0, 3.0] {
        let mut cells = String::new();
        for width_mm in WIDTHS_MM {
            cells += &format!(" {:.1} |", straight_ahead_db(distance_m, 1e-3 * width_mm)?);
        }
        println!("| at {distance_m} m |{cells}");
    }
    Ok(())
}

/// Returns the reflection of a panel relative to a wall, in dB.
fn straight_ahead_db(distance_m: f64, width_m: f64) -> Result<f64, Box<dyn std::error::Error>> {
    let amplitude = |half_m: f64, narrow_panels| -> Result<f64, Box<dyn std::error::Error>> {
        let panel = Wall::new(distance_m, half_m, distance_m, -half_m).with_faces(Faces::Both);
        let scene = Scene::new(vec![panel], vec![], Air::default())?;
        let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
        tracer.narrow_panels = narrow_panels;
        let here = Point::origin();
        tracer.trace(&scene, here, &[here], Limits::order(1), &mut paths)?;
        Ok(paths.amplitude[0])
    };
    Ok(20.0 * libm::log10(amplitude(0.5 * width_m, true)? / amplitude(0.5 * width_m, false)?))
}
