//! The state of all sensors as a `PointCloud2`, with a point for each in order, and of the ring as a `LaserScan`.

use std::f32::consts::{PI, TAU};

use crate::fan;
use crate::placing::Place;
use crate::range::{Distance, Scale};
use crate::view::View;

use super::messages::{FLOAT32, Header, LaserScan, PointCloud2, PointField, UINT8};

/// Number of rays of a scan: at 4 m they are 3.5 cm apart, too close to miss a cell of 5 cm.
const RAYS: u16 = 720;

/// Name, offset and type of each field.
const FIELDS: [(&str, u32, u8); 6] = [
    ("x", 0, FLOAT32),
    ("y", 4, FLOAT32),
    ("z", 8, FLOAT32),
    ("sensor", 12, UINT8),
    ("state", 13, UINT8),
    ("age", 16, FLOAT32),
];
const POINT: u32 = 20;

/// The cloud of the sensors' views, with their ages in seconds. Without an obstacle, the point is NaN: a reader that
/// ignores states finds neither an obstacle nor free space there.
pub(super) fn cloud(header: Header, places: &[Place], views: &[(View, f32)], min_m: f32) -> PointCloud2 {
    let mut data = Vec::new();
    for ((place, &(view, age_s)), sensor) in places.iter().zip(views).zip(0_u8..) {
        let (state, metres) = match view {
            View::Unknown => (0, None),
            View::Sees(Distance::At(metres)) => (1, Some(metres)),
            View::Sees(Distance::Clear) => (2, None),
            View::Sees(Distance::TooClose) => (3, Some(min_m)),
            View::Unanswered => (4, None),
        };
        let (sin, cos) = place.yaw_rad.sin_cos();
        let point = metres
            .map(f64::from)
            .map_or([f64::NAN; 3], |metres| [place.x_m + metres * cos, place.y_m + metres * sin, place.z_m]);
        data.extend(point.iter().flat_map(|&metres| (metres as f32).to_le_bytes()));
        data.extend([sensor, state, 0, 0]);
        data.extend(age_s.to_le_bytes());
    }
    let width = places.len().min(views.len()) as u32;
    let field =
        |&(name, offset, datatype): &(&str, u32, u8)| PointField { name: name.to_owned(), offset, datatype, count: 1 };
    PointCloud2 {
        header,
        height: 1,
        width,
        fields: FIELDS.iter().map(field).collect(),
        is_bigendian: false,
        point_step: POINT,
        row_step: POINT * width,
        data,
        is_dense: false,
    }
}

/// The scan of the ring from the robot's centre, counter-clockwise from behind: an obstacle's distance, `+Inf` where
/// the ring is clear, NaN where it is unknown.
pub(crate) fn scan(header: Header, places: &[Place], views: &[(View, f32)], view_rad: f32, scale: &Scale) -> LaserScan {
    let angle_increment = TAU / f32::from(RAYS);
    let ray = |n: u16| {
        let heading = f64::from(angle_increment * f32::from(n) - PI);
        match fan::along(heading, places, views, f64::from(view_rad / 2.0), scale) {
            View::Sees(Distance::At(metres)) if metres < scale.max_m => metres,
            View::Sees(_) => f32::INFINITY,
            View::Unanswered | View::Unknown => f32::NAN,
        }
    };
    LaserScan {
        header,
        angle_min: -PI,
        angle_max: PI - angle_increment,
        angle_increment,
        time_increment: 0.0,
        scan_time: 0.0,
        range_min: 0.0,
        range_max: scale.max_m,
        ranges: (0..RAYS).map(ray).collect(),
        intensities: Vec::new(),
    }
}
