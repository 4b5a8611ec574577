//! Where the sensors are on the robot, out of a ring file.

use std::fs;

use eeruf_core::MAX_SENSORS;
use eeruf_sim::Pose;

use crate::parameters::Parameters;

/// The place of each sensor; empty if nothing says it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placing(pub(crate) Vec<Place>);

/// Where a sensor is, in the robot's frame, and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) z_m: f64,
    pub(crate) yaw_rad: f64,
}

impl Placing {
    /// Reads the ring file of the parameters, if they name one; it says how many sensors there are and where they look.
    pub(crate) fn read(parameters: &mut Parameters) -> Result<Self, String> {
        let file = parameters.ring.clone();
        if file.as_os_str().is_empty() {
            return Ok(Self::default());
        }
        let wrong = |why: String| format!("ring: {}: {why}", file.display());
        let text = fs::read_to_string(&file).map_err(|error| wrong(error.to_string()))?;
        let ring = eeruf_design::robot_ring(&text).map_err(|error| format!("ring: {}", error.in_file(&file)))?;
        if ring.poses.is_empty() {
            return Err(wrong("no places of sensors; expected poses, or spacing_deg and radius_m".to_owned()));
        }
        let placing = Self::of(&ring.poses, parameters.height_m);
        placing.direct(parameters);
        Ok(placing)
    }

    /// Sensors at these poses, all at one height.
    pub(crate) fn of(poses: &[Pose], height_m: f64) -> Self {
        let place = |pose: &Pose| Place {
            x_m: pose.translation.x,
            y_m: pose.translation.y,
            z_m: height_m,
            yaw_rad: pose.rotation.angle(),
        };
        Self(poses.iter().map(place).collect())
    }

    /// Sets what follows from the places: how many sensors there are, and where they look.
    pub(crate) fn direct(&self, parameters: &mut Parameters) {
        parameters.sensors = u8::try_from(self.0.len()).unwrap_or(MAX_SENSORS as u8);
        parameters.yaws_deg = self.0.iter().map(|place| place.yaw_rad.to_degrees() as f32).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(Placing, Parameters), String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), text).unwrap();
        let mut parameters = Parameters { ring: file.path().into(), height_m: 0.2, ..Parameters::default() };
        Placing::read(&mut parameters).map(|placing| (placing, parameters))
    }

    #[test]
    fn ring_file_says_number_and_places() {
        let poses =
            "poses = [{ x_m = 0.8, y_m = 0.35, heading_deg = 30 }, { x_m = 0.5, y_m = -0.4, heading_deg = -90 }]";
        let text = format!("sensors = 2\nmodule = \"ping\"\njitter_us = 100\nmin_interval_us = 0\n{poses}");
        let (placing, parameters) = read(&text).unwrap();
        assert_eq!((parameters.sensors, parameters.yaws_deg.len()), (2, 2));
        let first = placing.0[0];
        assert_eq!((first.x_m, first.y_m, first.z_m), (0.8, 0.35, 0.2));
        assert!((parameters.yaws_deg[0] - 30.0).abs() < 1e-4 && (parameters.yaws_deg[1] + 90.0).abs() < 1e-4);
    }

    #[test]
    fn ring_file_without_places_is_refused() {
        let error = read("sensors = 2\nmodule = \"ping\"\njitter_us = 100\nmin_interval_us = 0").unwrap_err();
        assert!(error.ends_with("no places of sensors; expected poses, or spacing_deg and radius_m"), "{error}");
        assert!(read("sensors = 2\nsenors = 3").unwrap_err().contains("line 2"));
    }
}
