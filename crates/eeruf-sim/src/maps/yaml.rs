//! The YAML file beside a map's picture, as the ROS `map_server` writes and reads it.

use saphyr::{LoadableYamlNode, Scalar, Yaml};

/// The `free_thresh` of files without one, as in ROS.
const FREE_THRESH: f64 = 0.196;

/// Contents of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Head {
    pub(super) image: String,
    /// The width of a cell in metres.
    pub(super) resolution_m: f64,
    /// Pose of the lower left corner of the picture: x and y in metres, yaw in radians.
    pub(super) origin: [f64; 3],
    /// True if white is occupied instead of black.
    pub(super) negate: bool,
    /// Probability above which a cell is occupied.
    pub(super) occupied_thresh: f64,
    /// Probability below which a cell is free.
    pub(super) free_thresh: f64,
}

/// Reads the file. Keys for other programs are ignored.
pub(super) fn read(text: &str) -> Result<Head, String> {
    let documents = Yaml::load_from_str(text).map_err(|error| error.to_string())?;
    let Some(file) = documents.first().filter(|file| file.is_mapping()) else {
        return Err("no keys; expected image, resolution and origin".to_owned());
    };
    let get = |key: &str| file.as_mapping_get(key);
    let image = get("image").and_then(Yaml::as_str).ok_or("no image; expected the name of a PGM file")?;
    let resolution_m = number(get("resolution").ok_or("no resolution; expected metres per pixel")?);
    if !(resolution_m > 0.0 && resolution_m <= 1000.0) {
        return Err(format!("resolution = {resolution_m}; expected above 0 to 1000 m"));
    }
    let origin: Vec<f64> = get("origin").and_then(Yaml::as_sequence).into_iter().flatten().map(number).collect();
    let &[x, y, yaw] = &origin[..] else {
        return Err("no origin; expected [x, y, yaw] in metres and radians".to_owned());
    };
    if !(origin.iter().all(|value| value.abs() <= 1e5)) {
        return Err(format!("origin = {origin:?}; expected numbers from -100000 to 100000"));
    }
    let negate = match get("negate") {
        None | Some(Yaml::Value(Scalar::Integer(0) | Scalar::Boolean(false))) => false,
        Some(Yaml::Value(Scalar::Integer(1) | Scalar::Boolean(true))) => true,
        Some(other) => return Err(format!("negate = {}; expected 0 or 1", shown(other))),
    };
    let occupied_thresh = get("occupied_thresh").map_or(0.65, number);
    if !(0.0..1.0).contains(&occupied_thresh) {
        return Err(format!("occupied_thresh = {occupied_thresh}; expected 0 to below 1"));
    }
    let free_thresh = get("free_thresh").map_or(FREE_THRESH, number);
    if !(0.0..=1.0).contains(&free_thresh) {
        return Err(format!("free_thresh = {free_thresh}; expected 0 to 1"));
    }
    match get("mode").map(|mode| mode.as_str().unwrap_or_default()) {
        None | Some("trinary" | "scale") => {}
        Some(other) => return Err(format!("mode = {other}; expected trinary or scale")),
    }
    Ok(Head { image: image.to_owned(), resolution_m, origin: [x, y, yaw], negate, occupied_thresh, free_thresh })
}

/// Returns a number; NaN for anything else.
fn number(value: &Yaml<'_>) -> f64 {
    match value {
        Yaml::Value(Scalar::Integer(whole)) => *whole as f64,
        other => other.as_floating_point().unwrap_or(f64::NAN),
    }
}

fn shown(value: &Yaml<'_>) -> String {
    match value {
        Yaml::Value(Scalar::String(text)) => text.to_string(),
        Yaml::Value(Scalar::Integer(whole)) => whole.to_string(),
        Yaml::Value(Scalar::FloatingPoint(number)) => number.to_string(),
        _ => "neither text nor number".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "image: lab.pgm\nresolution: 0.05\norigin: [-10, 2.5, 0.0]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    #[test]
    fn a_file_as_map_saver_writes_it_is_read() {
        let head = read(FILE).unwrap();
        assert_eq!((&*head.image, head.resolution_m, head.origin), ("lab.pgm", 0.05, [-10.0, 2.5, 0.0]));
        assert!(!head.negate && head.occupied_thresh == 0.65 && head.free_thresh == 0.196);
        assert!(read(&FILE.replace("negate: 0", "negate: 1")).unwrap().negate);
    }

    #[test]
    fn what_is_missing_or_out_of_range_is_named() {
        for (from, to, says) in [
            ("image: lab.pgm\n", "", "no image"),
            ("0.05", "-1", "resolution = -1"),
            ("0.05", "wide", "resolution = NaN"),
            ("[-10, 2.5, 0.0]", "[1, 2]", "no origin; expected [x, y, yaw]"),
            ("[-10, 2.5, 0.0]", "[1, 2, 1e9]", "expected numbers from -100000"),
            ("negate: 0", "negate: 7", "negate = 7; expected 0 or 1"),
            ("occupied_thresh: 0.65", "occupied_thresh: 2", "occupied_thresh = 2"),
            ("free_thresh: 0.196", "free_thresh: -1", "free_thresh = -1; expected 0 to 1"),
            ("negate: 0", "mode: raw", "mode = raw; expected trinary or scale"),
            (FILE, "", "no keys"),
            (FILE, "a: [", ""),
        ] {
            let error = read(&FILE.replace(from, to)).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
    }
}
