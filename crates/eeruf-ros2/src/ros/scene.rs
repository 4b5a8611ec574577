//! The ROS side of a simulation: it publishes the robot's pose and what its sensors would see alone, and takes velocity
//! commands.

use ros2_client::{Publisher, Subscription};

use crate::placing::Place;
use crate::simulated::Course;
use crate::view::View;

use super::messages::{
    Header, Odometry, PointCloud2, Pose, Quaternion, TfMessage, Time, Transform, TransformStamped, Twist, Vector3,
};
use super::{PUBLISHING, Topics, cloud};

pub(super) struct Scene {
    transforms: Publisher<TfMessage>,
    truth: Publisher<Odometry>,
    cloud: Publisher<PointCloud2>,
    velocity: Subscription<Twist>,
    map_frame: String,
    base_frame: String,
}

impl Scene {
    pub(super) fn open(node: &mut Topics<'_>, parameters: &crate::parameters::Parameters) -> Result<Self, String> {
        Ok(Self {
            transforms: node.publisher("/tf", ["tf2_msgs", "TFMessage"], &PUBLISHING)?,
            truth: node.publisher("~/truth", ["nav_msgs", "Odometry"], &PUBLISHING)?,
            cloud: node.publisher("~/true_points", ["sensor_msgs", "PointCloud2"], &PUBLISHING)?,
            velocity: node.subscription("cmd_vel", ["geometry_msgs", "Twist"])?,
            map_frame: parameters.map_frame.clone(),
            base_frame: parameters.base_frame.clone(),
        })
    }

    /// Returns the latest commanded speed ahead and rate of turn.
    pub(super) fn velocity(&self) -> Option<Result<(f64, f64), String>> {
        let mut last = None;
        while let Some(heard) = self.velocity.take().transpose() {
            let speeds = heard.map(|(twist, _)| (twist.linear.x, twist.angular.z));
            last = Some(speeds.map_err(|error| format!("cmd_vel: {error}")));
        }
        last
    }

    /// Publishes the robot's pose, and what each sensor would see alone; false if sending failed.
    pub(super) fn publish(
        &self,
        stamp: Time,
        course: Course,
        places: &[Place],
        views: &[(View, f32)],
        min_m: f32,
    ) -> bool {
        let in_frame = |frame: &str| Header { stamp, frame_id: frame.to_owned() };
        let place = Vector3 { x: course.x_m, y: course.y_m, z: 0.0 };
        let turn = Quaternion::from_yaw(course.yaw_rad);
        let transform = TransformStamped {
            header: in_frame(&self.map_frame),
            child_frame_id: self.base_frame.clone(),
            transform: Transform { translation: place, rotation: turn },
        };
        let twist = Twist {
            linear: Vector3 { x: course.v_m_s, ..Vector3::default() },
            angular: Vector3 { z: course.w_rad_s, ..Vector3::default() },
        };
        let exact = [[0.0; 6]; 6];
        let truth = Odometry {
            header: in_frame(&self.map_frame),
            child_frame_id: self.base_frame.clone(),
            pose: (Pose { position: place, orientation: turn }, exact),
            twist: (twist, exact),
        };
        let cloud = cloud::cloud(in_frame(&self.base_frame), places, views, min_m);
        self.transforms.publish(TfMessage { transforms: vec![transform] }).is_ok()
            && self.truth.publish(truth).is_ok()
            && self.cloud.publish(cloud).is_ok()
    }
}
