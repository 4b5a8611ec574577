//! Places of a ring's sensors on the robot.

use eeruf_files::Pose;

/// Places of a ring's sensors on the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Place and heading of each sensor as seen from above; empty if the file does not give them.
    pub poses: Vec<Pose>,
    /// Height of each sensor above the robot's base, in metres; empty if the file does not give it.
    pub z_m: Vec<f64>,
    /// Height of the base above the floor, in metres.
    pub base_height_m: f64,
    /// The link of the URDF that is the base.
    pub base_link: Option<String>,
    /// All links of the URDF.
    pub urdf_links: Vec<String>,
    /// Assumptions about values that the URDF does not give, each a sentence without a full stop.
    pub assumed: Vec<String>,
}

impl Places {
    /// Height of each sensor above the floor, in metres; empty if the file does not give it.
    pub fn heights_m(&self) -> Vec<f64> {
        self.z_m.iter().map(|z_m| self.base_height_m + z_m).collect()
    }
}
