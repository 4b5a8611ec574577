//! Signs that a ring file's numbers are in other units than its keys say. If two signs agree, the ring is refused
//! before anything is called proven. A single sign may be intended: a front and a rear module do not hear each other, a
//! car is large.

use core::f64::consts::TAU;

use eeruf_core::Micros;
use eeruf_files::{doubt, is_likely_rad};
use eeruf_modules::Module;

use crate::each::Each;
use crate::ring::{RingFile, RingSpec};

/// Distance from the robot's middle, in metres, beyond which a sensor is a sign of other units.
const LARGE_M: f64 = 5.0;
/// Ratio of required to possible range from which on a module's range is a sign of other units.
const FARTHER: f64 = 2.5;
/// The echo time of a wall 0.1 m away: a sensor with a shorter window sees nothing.
const SEES_NOTHING: Micros = Micros::new(600);

/// Refuses the ring if two signs agree.
pub(crate) fn check(file: &RingFile, spec: &RingSpec) -> Result<(), String> {
    for (signs, meant) in [lengths(file, spec), angles(file, spec), times(file, spec)] {
        if let [one, other, ..] = &signs[..] {
            return Err(format!("{one}, and {other}; {meant}"));
        }
    }
    Ok(())
}

type Signs = (Vec<String>, &'static str);

/// Collects the signs.
fn signs<const N: usize>(of: [(bool, String); N]) -> Vec<String> {
    of.into_iter().filter_map(|(is_there, sign)| is_there.then_some(sign)).collect()
}

fn numbers<T: Copy + Into<f64>>(each: Option<&Each<T>>) -> Vec<f64> {
    match each {
        None => vec![],
        Some(Each::All(number)) => vec![(*number).into()],
        Some(Each::Of(list)) => list.iter().map(|&number| number.into()).collect(),
    }
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(0.0, f64::max)
}

fn lengths(file: &RingFile, spec: &RingSpec) -> Signs {
    let poses = &spec.places.poses;
    let key = if file.poses.is_some() { "poses" } else { "radius_m" };
    let large_m = largest(&poses.iter().map(|pose| libm::hypot(pose.x_m, pose.y_m)).collect::<Vec<_>>());
    let are_deaf = spec.sensors > 1 && !poses.is_empty() && !spec.modules.is_empty() && {
        let layout = spec.problem().requirements.layout;
        (0..spec.sensors).all(|x| (0..x).all(|y| !layout.neighbours(spec.sensors, x, y)))
    };
    let range_m = largest(&numbers(file.max_range_m.as_ref()));
    let sees_m = largest(&spec.modules.iter().map(Module::sees_to_m).collect::<Vec<_>>());
    let is_far = sees_m > 0.0 && range_m > FARTHER * sees_m;
    let of_places = signs([
        (large_m > LARGE_M, format!("{key}: a sensor {large_m:.1} m from the robot's middle")),
        (large_m > LARGE_M && are_deaf, "no sensor that hears another".to_owned()),
    ]);
    let of_range = signs([
        (doubt("max_range_m", range_m).is_some(), format!("max_range_m: {range_m}")),
        (is_far, format!("a module that reports up to {sees_m} m")),
    ]);
    let meant = "expected metres, likely centimetres or millimetres";
    (if of_places.len() > 1 { of_places } else { of_range }, meant)
}

fn angles(file: &RingFile, spec: &RingSpec) -> Signs {
    if let Some(spacing) = file.spacing_deg.filter(|_| spec.sensors > 1) {
        let round = spacing.abs() * spec.sensors as f64;
        let one_place = spec.sensors > 1 && (spacing / 360.0).fract() == 0.0 && spacing != 0.0;
        let of = signs([
            (round < 10.0 && spacing != 0.0, format!("spacing_deg: {spacing}, {round:.1} degrees for all sensors")),
            (
                is_likely_rad(spacing) || (round - TAU).abs() < 0.1,
                format!("as radians {:.0} degrees apart", spacing.to_degrees()),
            ),
        ]);
        if of.len() > 1 {
            return (of, "expected degrees, likely radians");
        }
        let of = signs([
            (one_place, format!("spacing_deg: {spacing}, from one sensor to the next")),
            (one_place, format!("all {} sensors in one place", spec.sensors)),
        ]);
        return (of, "expected less than 360, likely the whole circle");
    }
    let headings: Vec<f64> = file.poses.iter().flatten().map(|pose| pose.heading_deg).collect();
    let turned: Vec<f64> = headings.iter().copied().filter(|&heading| heading != 0.0).collect();
    let is_small = !turned.is_empty() && turned.iter().all(|heading| heading.abs() < 6.3);
    let off = |scale: f64| {
        let bearings = file.poses.iter().flatten().map(|pose| {
            let off = libm::remainder(libm::atan2(pose.y_m, pose.x_m) - scale * pose.heading_deg, TAU);
            off.abs()
        });
        bearings.sum::<f64>() / headings.len() as f64
    };
    // Sensors all round look outwards.
    let is_round = off(1.0) < 0.2 && off(1f64.to_radians()) > 0.6;
    let of = signs([
        (is_small, "poses: each heading_deg within 6.3".to_owned()),
        (
            is_small && (is_round || turned.iter().copied().all(is_likely_rad)),
            format!("as radians {:.0} degrees and the like", turned.first().copied().unwrap_or(0.0).to_degrees()),
        ),
    ]);
    (of, "expected degrees, likely radians")
}

fn times(file: &RingFile, spec: &RingSpec) -> Signs {
    let [t_delta, jitter, window, rest] =
        [&file.t_delta_us, &file.jitter_us, &file.window_us, &file.retrigger_us].map(|each| numbers(each.as_ref()));
    let change = spec.problem().requirements.t_delta;
    let least = |numbers: &[f64]| numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let (jitter, window_us, rest_us) = (largest(&jitter).max(largest(&t_delta)), least(&window), least(&rest));
    let of_change = signs([
        (doubt("jitter_us", jitter).is_some(), format!("jitter_us or t_delta_us: {jitter}")),
        (change >= spec.listening, format!("a window of {}, which is less", spec.listening)),
    ]);
    let of_window = signs([
        (doubt("window_us", window_us).is_some() && window_us.is_finite(), format!("window_us: {window_us}")),
        (spec.listening < SEES_NOTHING, "no echo from 10 cm or more within it".to_owned()),
    ]);
    let of_rest = signs([
        (doubt("retrigger_us", rest_us).is_some() && rest_us.is_finite(), format!("retrigger_us: {rest_us}")),
        (
            rest_us < 0.01 * f64::from(spec.listening.as_micros()),
            format!("a sensor that listens for {}", spec.listening),
        ),
    ]);
    if of_change.len() > 1 {
        return (of_change, "expected microseconds, a few hundred for most modules");
    }
    let found = if of_window.len() > 1 { of_window } else { of_rest };
    (found, "expected microseconds, likely milliseconds")
}

#[cfg(test)]
mod tests {
    use crate::RingSpec;

    fn refused(lines: &str) -> Option<String> {
        let text = format!("sensors = 8\nmodule = \"hc-sr04\"\nlayout = \"ring\"\n{lines}");
        RingSpec::from_text(&text).err().map(|error| error.message().to_owned())
    }

    #[test]
    fn two_signs_that_agree_refuse_a_ring_and_say_what_was_meant() {
        for (lines, unit) in [
            ("spacing_deg = 45\nradius_m = 200", "millimetres"),
            ("max_range_m = 400", "centimetres"),
            ("spacing_deg = 0.785\nradius_m = 0.2", "radians"),
            ("spacing_deg = 360\nradius_m = 0.2", "whole circle"),
            ("retrigger_us = 60", "milliseconds"),
            ("window_us = 30", "milliseconds"),
            ("jitter_us = 100_000", "a few hundred"),
        ] {
            let message = refused(lines).unwrap_or_else(|| panic!("{lines} is taken"));
            assert!(message.contains("; expected ") && message.contains(unit), "{message}");
        }
    }

    #[test]
    fn what_may_be_meant_is_not_refused() {
        for lines in [
            "spacing_deg = 1\nradius_m = 0.2",
            "spacing_deg = 2\nradius_m = 6",
            "spacing_deg = 45\nradius_m = 0.2",
            "max_range_m = 8",
            "retrigger_us = 900",
            "window_us = 900",
            "jitter_us = 6_000",
        ] {
            assert_eq!(refused(lines), None, "{lines}");
        }
        let poses = |of: &[(f64, f64, f64)]| {
            let pose = |(x, y, deg): &(f64, f64, f64)| format!("{{ x_m = {x}, y_m = {y}, heading_deg = {deg} }}");
            let list = of.iter().map(pose).collect::<Vec<_>>().join(", ");
            let text = format!("sensors = {}\nmodule = \"hc-sr04\"\nposes = [{list}]", of.len());
            RingSpec::from_text(&text).err().map(|error| error.message().to_owned())
        };
        // A flat bumper, also toed in; a front and a rear module; a large car.
        assert_eq!(poses(&[(0.1, 0.1, 0.0), (0.1, -0.1, 0.0)]), None);
        assert_eq!(poses(&[(0.1, 0.1, 5.0), (0.1, 0.0, 0.0), (0.1, -0.1, -5.0)]), None);
        assert_eq!(poses(&[(0.1, 0.0, 0.0), (-0.1, 0.0, 180.0)]), None);
        assert_eq!(poses(&[(9.0, 0.5, 0.0), (9.0, 0.0, 0.0), (-9.0, 0.0, 180.0)]), None);
        // The same in radians, all round in radians, in millimetres.
        let all_round = [(0.2, 0.0, 0.0), (0.1, 0.17, 1.0), (-0.1, 0.17, 2.1), (-0.2, 0.0, 3.1)];
        for radians in [&[(0.1, 0.1, 1.57), (0.1, -0.1, -1.57)][..], &all_round] {
            assert!(poses(radians).is_some_and(|why| why.contains("radians")), "{radians:?}");
        }
        assert!(poses(&[(100.0, 100.0, 0.0), (100.0, -100.0, 0.0)]).is_some_and(|why| why.contains("millimetres")));
    }
}
