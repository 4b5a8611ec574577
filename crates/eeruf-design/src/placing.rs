//! The keys of a ring file that say where its sensors are: one by one, on an arc, or as links of the robot's URDF.

use std::path::Path;

use eeruf_files::{Pose, arc};

use crate::limits::number;
use crate::places::Places;
use crate::ring::{PlaceFile, RingFile};

impl RingFile {
    /// The places of the ring's sensors. A URDF is looked up beside `file`, the ring file.
    pub(crate) fn places(&self, file: Option<&Path>) -> Result<Places, String> {
        let base_height_m = self.base_height_m.map(|m| number("base_height_m", m, 0.0, 100.0)).transpose()?;
        let (key, mut places) = match (&self.poses, self.spacing_deg, self.radius_m, &self.urdf, &self.links) {
            (None, None, None, None, None) => return Ok(Places::default()),
            (Some(poses), None, None, None, None) => ("poses", self.listed(poses)?),
            (None, Some(spacing), Some(radius), None, None) => {
                let spacing = number("spacing_deg", spacing, -360.0, 360.0)?.to_radians();
                let radius = number("radius_m", radius, 0.0, 1000.0)?;
                let first = -0.5 * spacing * (self.sensors - 1) as f64;
                let poses = arc(self.sensors, radius, first, spacing).collect();
                ("base_height_m", Places { poses, ..Places::default() })
            }
            (None, None, None, Some(urdf), Some(links)) => ("links", self.linked(file, urdf, links)?),
            (None, None, None, Some(urdf), None) => {
                let expected = "expected `links = [\"sonar_1\", ..]`, the link of each sensor in their order";
                return Err(format!("urdf = {urdf:?} without links; {expected}"));
            }
            _ => {
                let expected = "either poses, or spacing_deg and radius_m, or urdf and links, or none of them";
                return Err(format!("expected {expected}"));
            }
        };
        if let Some(base_height_m) = base_height_m {
            places.base_height_m = base_height_m;
            places.z_m.resize(self.sensors, 0.0);
            places.assumed.clear();
        }
        if let Some((sensor, m)) = places.heights_m().iter().enumerate().find(|(_, m)| !(**m > 0.0 && **m <= 100.0)) {
            return Err(format!(
                "{key}: sensor {sensor} is {m} m above the floor; expected above 0 to 100: base_height_m says how \
                 high the base is, where z is 0"
            ));
        }
        Ok(places)
    }

    fn listed(&self, poses: &[PlaceFile]) -> Result<Places, String> {
        if poses.len() != self.sensors {
            let plural = if poses.len() == 1 { "" } else { "s" };
            return Err(format!("poses: {} place{plural}; expected {}, one a sensor", poses.len(), self.sensors));
        }
        let pose = |place: &PlaceFile| {
            let &PlaceFile { x_m, y_m, heading_deg, .. } = place;
            Pose { x_m, y_m, heading_rad: heading_deg.to_radians() }
        };
        let is_high = poses.iter().any(|place| place.z_m.is_some());
        let z_m = if is_high { poses.iter().map(|place| place.z_m.unwrap_or(0.0)).collect() } else { vec![] };
        Ok(Places { poses: poses.iter().map(pose).collect(), z_m, ..Places::default() })
    }

    fn linked(&self, file: Option<&Path>, urdf: &str, links: &[String]) -> Result<Places, String> {
        if links.len() != self.sensors {
            return Err(format!("links has {} names; expected {}, as many as sensors", links.len(), self.sensors));
        }
        if let Some(link) = links.iter().enumerate().find(|(at, link)| links[..*at].contains(link)) {
            return Err(format!("links: `{}` twice; expected a link for each sensor", link.1));
        }
        let Some(file) = file else {
            return Err(format!(
                "urdf = {urdf:?} is looked for beside the ring file; expected poses in a ring without one"
            ));
        };
        #[cfg(feature = "urdf")]
        return crate::urdf::places(&file.parent().unwrap_or(Path::new("")).join(urdf), links);
        #[cfg(not(feature = "urdf"))]
        Err(format!("urdf = {urdf:?} in {}; expected poses: this program reads no URDF", file.display()))
    }
}
