//! The messages of ROS 2 that are written, with their definitions: a name, the text of the fields, and the definitions
//! of nested messages.

use std::fmt::Write;

use crate::cdr::Cdr;
use crate::firing_messages::{FIRING, FIRING_FIELDS};
use crate::firings::Firing;
use crate::reading::LogReading;

/// Position and orientation in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Position in metres.
    pub position: [f64; 3],
    /// A quaternion: x, y, z, w.
    pub orientation: [f64; 4],
}

impl Placement {
    /// The frame's origin.
    pub const ORIGIN: Self = Self { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] };

    /// A place in the plane, with a heading in radians.
    pub fn planar(x_m: f64, y_m: f64, heading_rad: f64) -> Self {
        let (z, w) = (0.5 * heading_rad).sin_cos();
        Self { position: [x_m, y_m, 0.0], orientation: [0.0, 0.0, z, w] }
    }

    fn write(&self, out: &mut Cdr) {
        out.f64s(self.position);
        out.f64s(self.orientation);
    }
}

/// The place of a frame in its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Transform {
    /// The parent frame.
    pub parent: String,
    /// The child frame.
    pub child: String,
    /// The place.
    pub placement: Placement,
}

/// The shape of a [`Marker`].
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Removes all markers of the topic.
    Clear,
    /// A line through all points, of this width in metres.
    Strip(Vec<[f64; 3]>, f64),
    /// A line for each pair of points, of this width in metres.
    Lines(Vec<[f64; 3]>, f64),
    /// A cylinder of this diameter and height in metres.
    Cylinder(Placement, f64, f64),
}

/// A drawn shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// The frame of the marker's points.
    pub frame: String,
    /// Namespace of the number: a marker replaces the one with the same namespace and number.
    pub namespace: String,
    /// The number.
    pub id: i32,
    /// The shape.
    pub shape: Shape,
    /// Red, green, blue and opacity, 0 to 1.
    pub colour: [f32; 4],
    /// Lifetime in nanoseconds; 0 is unlimited.
    pub lifetime_ns: u64,
}

const HEADER: (&str, &str) = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const DURATION: (&str, &str) = ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
const VECTOR: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const POINT: (&str, &str) = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: (&str, &str) = ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
const POSE: (&str, &str) =
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n");

/// A message type: its name, its fields, and their types.
pub(crate) struct Type {
    pub(crate) name: &'static str,
    fields: &'static str,
    parts: &'static [(&'static str, &'static str)],
}

impl Type {
    /// The definition in the format `ros2msg`.
    pub(crate) fn definition(&self) -> String {
        let mut text = self.fields.to_owned();
        for (name, fields) in self.parts {
            let _ = write!(text, "{}\nMSG: {name}\n{fields}", "=".repeat(80));
        }
        text
    }
}

pub(crate) const RANGE: Type = Type {
    name: "sensor_msgs/msg/Range",
    fields: "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n\
             float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n",
    parts: &[HEADER, TIME],
};

pub(crate) const FIRINGS: Type = Type { name: FIRING, fields: FIRING_FIELDS, parts: &[HEADER, TIME] };

pub(crate) const TRANSFORMS: Type = Type {
    name: "tf2_msgs/msg/TFMessage",
    fields: "geometry_msgs/TransformStamped[] transforms\n",
    parts: &[
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
        ),
        ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"),
        VECTOR,
        QUATERNION,
        HEADER,
        TIME,
    ],
};

pub(crate) const ODOMETRY: Type = Type {
    name: "nav_msgs/msg/Odometry",
    fields: "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
             geometry_msgs/TwistWithCovariance twist\n",
    parts: &[
        ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"),
        ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"),
        ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"),
        POSE,
        POINT,
        QUATERNION,
        VECTOR,
        HEADER,
        TIME,
    ],
};

pub(crate) const MARKERS: Type = Type {
    name: "visualization_msgs/msg/MarkerArray",
    fields: "visualization_msgs/Marker[] markers\n",
    parts: &[
        (
            "visualization_msgs/Marker",
            "int32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 ADD=0\nint32 DELETEALL=3\n\
             std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n\
             geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n\
             bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n\
             string texture_resource\nsensor_msgs/CompressedImage texture\n\
             visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n\
             visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
        ),
        ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"),
        ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"),
        ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"),
        ("visualization_msgs/MeshFile", "string filename\nuint8[] data\n"),
        POSE,
        POINT,
        QUATERNION,
        VECTOR,
        DURATION,
        HEADER,
        TIME,
    ],
};

pub(crate) fn range(out: &mut Cdr, frame: &str, reading: &LogReading) {
    let LogReading { radiation, field_of_view_rad, min_range_m, max_range_m, range_m, variance, .. } = *reading;
    out.header(reading.at_ns.unwrap_or(0), frame);
    out.u8(radiation);
    let [min, max, range] = [min_range_m, max_range_m, range_m].map(|metres| metres as f32);
    out.f32s([field_of_view_rad, min, max, range, variance.unwrap_or(0.0)]);
}

/// The fields of [`FIRINGS`]; missing values are 0, and a flag before each says so.
pub(crate) fn firing(out: &mut Cdr, at_ns: u64, clock: &str, firing: &Firing) {
    let Firing { sensor, fired_us, period, phase, t_echo_us, g_us_ms, .. } = *firing;
    out.header(at_ns, "");
    out.text(clock);
    out.u8(sensor);
    out.i64(fired_us);
    out.u32(period);
    out.u8(phase);
    out.bool(t_echo_us.is_some());
    out.u32(t_echo_us.unwrap_or(0));
    out.text(firing.spelled());
    out.f32s([g_us_ms.unwrap_or(-1.0)]);
}

pub(crate) fn transforms(out: &mut Cdr, at_ns: u64, transforms: &[Transform]) {
    out.length(transforms.len());
    for Transform { parent, child, placement } in transforms {
        out.header(at_ns, parent);
        out.text(child);
        placement.write(out);
    }
}

/// Writes odometry with zero covariances: place and velocities are exact.
pub(crate) fn odometry(out: &mut Cdr, at_ns: u64, of: &Transform, linear_m_s: [f64; 3], angular_rad_s: [f64; 3]) {
    out.header(at_ns, &of.parent);
    out.text(&of.child);
    of.placement.write(out);
    out.f64s([0.0; 36]);
    out.f64s(linear_m_s);
    out.f64s(angular_rad_s);
    out.f64s([0.0; 36]);
}

pub(crate) fn markers(out: &mut Cdr, at_ns: u64, markers: &[Marker]) {
    out.length(markers.len());
    for Marker { frame, namespace, id, shape, colour, lifetime_ns } in markers {
        out.header(at_ns, frame);
        out.text(namespace);
        out.i32(*id);
        let (kind, action, placement, scale, points): (_, _, _, _, &[[f64; 3]]) = match shape {
            Shape::Clear => (0, 3, Placement::ORIGIN, [1.0; 3], &[]),
            Shape::Strip(points, width) => (4, 0, Placement::ORIGIN, [*width, 0.0, 0.0], points),
            Shape::Lines(points, width) => (5, 0, Placement::ORIGIN, [*width, 0.0, 0.0], points),
            Shape::Cylinder(placement, across, height) => (3, 0, *placement, [*across, *across, *height], &[]),
        };
        out.i32(kind);
        out.i32(action);
        placement.write(out);
        out.f64s::<3>(scale);
        out.f32s(*colour);
        out.time(*lifetime_ns);
        out.bool(false);
        out.length(points.len());
        points.iter().for_each(|point| out.f64s(*point));
        out.length(0);
        // No texture, text or mesh.
        out.text("");
        out.header(0, "");
        out.text("");
        out.length(0);
        out.length(0);
        out.text("");
        out.text("");
        out.text("");
        out.length(0);
        out.bool(false);
    }
}
