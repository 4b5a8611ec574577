//! The few messages that the node sends and receives, with the fields that ROS 2 defines.

use serde::{Deserialize, Serialize};

/// `builtin_interfaces/Time`.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub(crate) struct Time {
    sec: i32,
    nanosec: u32,
}

impl Time {
    /// Nanoseconds since 1970.
    pub(crate) fn from_nanoseconds(ns: i64) -> Self {
        let second = 1_000_000_000;
        // The field holds seconds until 2038.
        Self { sec: ns.div_euclid(second) as i32, nanosec: ns.rem_euclid(second) as u32 }
    }
}

/// `std_msgs/Header`.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Header {
    pub(crate) stamp: Time,
    pub(crate) frame_id: String,
}

/// `sensor_msgs/Range::ULTRASOUND`.
pub(crate) const ULTRASOUND: u8 = 0;

/// `sensor_msgs/Range` of ROS 2 Iron and later; Humble's ends before the variance.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Range {
    pub(crate) header: Header,
    pub(crate) radiation_type: u8,
    pub(crate) field_of_view: f32,
    pub(crate) min_range: f32,
    pub(crate) max_range: f32,
    pub(crate) range: f32,
    /// 0 for unknown.
    pub(crate) variance: f32,
}

/// `diagnostic_msgs/DiagnosticArray`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DiagnosticArray {
    pub(crate) header: Header,
    pub(crate) status: Vec<DiagnosticStatus>,
}

/// `diagnostic_msgs/DiagnosticStatus`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DiagnosticStatus {
    pub(crate) level: u8,
    pub(crate) name: String,
    pub(crate) message: String,
    pub(crate) hardware_id: String,
    pub(crate) values: Vec<KeyValue>,
}

/// `diagnostic_msgs/KeyValue`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct KeyValue {
    pub(crate) key: String,
    pub(crate) value: String,
}

/// `sensor_msgs/PointField`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PointField {
    pub(crate) name: String,
    pub(crate) offset: u32,
    pub(crate) datatype: u8,
    pub(crate) count: u32,
}

/// `sensor_msgs/PointField::UINT8`.
pub(crate) const UINT8: u8 = 2;
/// `sensor_msgs/PointField::FLOAT32`.
pub(crate) const FLOAT32: u8 = 7;

/// `sensor_msgs/PointCloud2`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PointCloud2 {
    pub(crate) header: Header,
    pub(crate) height: u32,
    pub(crate) width: u32,
    pub(crate) fields: Vec<PointField>,
    pub(crate) is_bigendian: bool,
    pub(crate) point_step: u32,
    pub(crate) row_step: u32,
    pub(crate) data: Vec<u8>,
    pub(crate) is_dense: bool,
}

/// `sensor_msgs/LaserScan`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LaserScan {
    pub(crate) header: Header,
    pub(crate) angle_min: f32,
    pub(crate) angle_max: f32,
    pub(crate) angle_increment: f32,
    pub(crate) time_increment: f32,
    pub(crate) scan_time: f32,
    pub(crate) range_min: f32,
    pub(crate) range_max: f32,
    pub(crate) ranges: Vec<f32>,
    pub(crate) intensities: Vec<f32>,
}

/// `geometry_msgs/Vector3`, and `Point`.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Vector3 {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
}

/// `geometry_msgs/Quaternion`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

impl Quaternion {
    /// A rotation about the vertical axis.
    pub(crate) fn from_yaw(yaw_rad: f64) -> Self {
        let (sin, cos) = (yaw_rad / 2.0).sin_cos();
        Self { x: 0.0, y: 0.0, z: sin, w: cos }
    }
}

/// `geometry_msgs/Transform`.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Transform {
    pub(crate) translation: Vector3,
    pub(crate) rotation: Quaternion,
}

/// `geometry_msgs/TransformStamped`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TransformStamped {
    pub(crate) header: Header,
    pub(crate) child_frame_id: String,
    pub(crate) transform: Transform,
}

/// `tf2_msgs/TFMessage`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TfMessage {
    pub(crate) transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/Pose`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Pose {
    pub(crate) position: Vector3,
    pub(crate) orientation: Quaternion,
}

/// `geometry_msgs/Twist`.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Twist {
    pub(crate) linear: Vector3,
    pub(crate) angular: Vector3,
}

/// Covariance of six numbers; zero means exact.
type Covariance = [[f64; 6]; 6];

/// `nav_msgs/Odometry`, whose pose and twist have a covariance each.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Odometry {
    pub(crate) header: Header,
    pub(crate) child_frame_id: String,
    pub(crate) pose: (Pose, Covariance),
    pub(crate) twist: (Twist, Covariance),
}
