//! The messages of ROS 2 that are written, with their definitions.

use std::fmt::Write;

use super::cdr::Cdr;
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

/// Definitions of the messages, each after its name.
const DEFINITIONS: &str = include_str!("definitions.msg");

/// Names of the messages that are written.
pub(crate) const RANGE: &str = "sensor_msgs/msg/Range";
pub(crate) const FIRING: &str = "eeruf_msgs/msg/Firing";
pub(crate) const TRANSFORMS: &str = "tf2_msgs/msg/TFMessage";
pub(crate) const ODOMETRY: &str = "nav_msgs/msg/Odometry";
pub(crate) const MARKERS: &str = "visualization_msgs/msg/MarkerArray";

/// The definition of a message with those of its nested messages, in the format `ros2msg`.
pub(crate) fn definition(name: &str) -> String {
    let (mut names, mut text, mut next) = (vec![name.replace("/msg/", "/")], String::new(), 0);
    while let Some(name) = names.get(next) {
        if next > 0 {
            _ = write!(text, "{}\nMSG: {name}\n", "=".repeat(80));
        }
        let of_name = |part: &'static str| part.strip_prefix(name)?.strip_prefix('\n');
        let fields = DEFINITIONS.split("MSG: ").find_map(of_name).unwrap_or_default();
        text += fields;
        for line in fields.lines() {
            let of = line.split([' ', '[']).next().unwrap_or_default();
            if of.contains('/') && !names.iter().any(|name| name == of) {
                names.push(of.to_owned());
            }
        }
        next += 1;
    }
    text
}

pub(crate) fn range(out: &mut Cdr, frame: &str, reading: &LogReading) {
    let LogReading { radiation, field_of_view_rad, min_range_m, max_range_m, range_m, variance, .. } = *reading;
    out.header(reading.at_ns.unwrap_or(0), frame);
    out.u8(radiation);
    let [min, max, range] = [min_range_m, max_range_m, range_m].map(|metres| metres as f32);
    out.f32s([field_of_view_rad, min, max, range, variance.unwrap_or(0.0)]);
}

/// Writes the fields of [`FIRING`]; missing values are 0, and a flag before each says so.
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
