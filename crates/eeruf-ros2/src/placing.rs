//! Poses of the sensors on the robot, from a ring file and the URDF that it may name.

use std::fs;

use eeruf_core::MAX_SENSORS;
use eeruf_design::RingSpec;
use eeruf_sim::{Pose, pose_of};

use crate::parameters::Parameters;

/// The pose of each sensor; empty if unknown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placing {
    pub(crate) places: Vec<Place>,
    /// Links of the robot's URDF, whose frames another node publishes.
    pub(crate) urdf_links: Vec<String>,
}

/// Position of a sensor in the robot's frame, and its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) z_m: f64,
    pub(crate) yaw_rad: f64,
}

impl Placing {
    /// Reads the ring file of the parameters, if they name one; it gives the number of sensors and their directions.
    pub(crate) fn read(parameters: &mut Parameters) -> Result<Self, String> {
        let file = parameters.ring.clone();
        if file.as_os_str().is_empty() {
            return Ok(Self::default());
        }
        let wrong = |why: String| format!("ring: {}: {why}", file.display());
        let text = fs::read_to_string(&file).map_err(|error| wrong(error.to_string()))?;
        let ring = RingSpec::in_file(&file, &text).map_err(|error| format!("ring: {error}"))?.places;
        if ring.poses.is_empty() {
            let expected = "expected poses, or spacing_deg and radius_m, or urdf and links";
            return Err(wrong(format!("no places of sensors; {expected}")));
        }
        let poses: Vec<_> = ring.poses.iter().map(pose_of).collect();
        let mut placing = Self::of(&poses, parameters.height_m);
        for (place, z_m) in placing.places.iter_mut().zip(ring.z_m) {
            place.z_m = z_m;
        }
        if let Some(base) = ring.base_link.filter(|base| *base != parameters.base_frame) {
            let frame = &mut parameters.base_frame;
            if ring.urdf_links.contains(frame) {
                return Err(format!("base_frame: {frame}; expected {base}, from which the URDF's poses are taken"));
            }
            // A frame with another name may be the same frame with a prefix.
            if *frame == Parameters::default().base_frame {
                *frame = base;
            }
        }
        placing.urdf_links = ring.urdf_links;
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
        Self { places: poses.iter().map(place).collect(), urdf_links: vec![] }
    }

    /// The places of sensors with their frames, except links of the URDF, which the robot's own publisher publishes.
    pub(crate) fn frames<'a>(&'a self, frame_ids: &'a [String]) -> impl Iterator<Item = (&'a Place, &'a String)> {
        self.places.iter().zip(frame_ids).filter(|(_, frame_id)| !self.urdf_links.contains(frame_id))
    }

    /// Sets the parameters that follow from the places: the number of sensors and their directions.
    pub(crate) fn direct(&self, parameters: &mut Parameters) {
        parameters.sensors = u8::try_from(self.places.len()).unwrap_or(MAX_SENSORS as u8);
        parameters.yaws_deg = self.places.iter().map(|place| place.yaw_rad.to_degrees() as f32).collect();
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
        let first = placing.places[0];
        assert_eq!((first.x_m, first.y_m, first.z_m), (0.8, 0.35, 0.2));
        assert!((parameters.yaws_deg[0] - 30.0).abs() < 1e-4 && (parameters.yaws_deg[1] + 90.0).abs() < 1e-4);
    }

    const URDF: &str = r#"<robot name="r"><link name="chassis"/><link name="left"/><link name="right"/>
        <joint name="l" type="fixed"><parent link="chassis"/><child link="left"/>
            <origin xyz="0.2 0.1 0.15" rpy="0 0 0.5"/></joint>
        <joint name="r" type="fixed"><parent link="chassis"/><child link="right"/>
            <origin xyz="0.2 -0.1 0.15" rpy="0 0 -0.5"/></joint></robot>"#;

    fn read_with_urdf(base_frame: &str) -> Result<(Placing, Parameters), String> {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("robot.urdf"), URDF).unwrap();
        let ring = folder.path().join("ring.toml");
        let text = "sensors = 2\nmodule = \"ping\"\nurdf = \"robot.urdf\"\nlinks = [\"left\", \"right\"]";
        fs::write(&ring, text).unwrap();
        let mut parameters = Parameters { ring, base_frame: base_frame.to_owned(), ..Parameters::default() };
        Placing::read(&mut parameters).map(|placing| (placing, parameters))
    }

    #[test]
    fn places_of_a_urdf_stand_in_its_base() {
        let (placing, parameters) = read_with_urdf("base_link").unwrap();
        assert_eq!((&*parameters.base_frame, parameters.sensors), ("chassis", 2));
        let Place { x_m, y_m, z_m, yaw_rad } = placing.places[1];
        assert_eq!((x_m, y_m, z_m), (0.2, -0.1, 0.15));
        assert!((yaw_rad + 0.5).abs() < 1e-12);
        // Another robot's prefix stays; a link that is not the base of the poses is refused.
        assert_eq!(read_with_urdf("robot_1/chassis").unwrap().1.base_frame, "robot_1/chassis");
        let error = read_with_urdf("left").unwrap_err();
        assert_eq!(error, "base_frame: left; expected chassis, from which the URDF's poses are taken");
    }

    #[test]
    fn links_of_the_urdf_are_left_to_its_publisher() {
        let (placing, _) = read_with_urdf("base_link").unwrap();
        let frames = |ids: [&str; 2]| {
            let ids = ids.map(str::to_owned);
            placing.frames(&ids).map(|(_, frame_id)| frame_id.clone()).collect::<Vec<_>>()
        };
        assert_eq!(frames(["sonar_1", "right"]), ["sonar_1"]);
        assert_eq!(frames(["sonar_1", "sonar_2"]).len(), 2);
    }

    #[test]
    fn ring_file_without_places_is_refused() {
        let error = read("sensors = 2\nmodule = \"ping\"\njitter_us = 100\nmin_interval_us = 0").unwrap_err();
        assert!(error.ends_with("expected poses, or spacing_deg and radius_m, or urdf and links"), "{error}");
        assert!(read("sensors = 2\nsenors = 3").unwrap_err().contains("line 2"));
    }
}
