//! A scene as a small picture, for notebooks.

use std::fmt::Write;

use eeruf_sim::{Faces, Robot, Scene};

/// Width of the picture, in pixels.
const WIDTH: f64 = 360.0;

/// Walls, poles, robots and the directions of their sensors, from above, with y upwards. Openings are dashed.
pub(crate) fn svg<'r>(scene: &Scene, robots: impl Iterator<Item = &'r Robot> + Clone) -> String {
    let mut points: Vec<(f64, f64)> = Vec::new();
    points.extend(scene.walls().iter().flat_map(|wall| [(wall.from.x, wall.from.y), (wall.to.x, wall.to.y)]));
    points.extend(scene.poles().iter().map(|pole| (pole.centre.x, pole.centre.y)));
    points.extend(robots.clone().map(|robot| (robot.pose.translation.x, robot.pose.translation.y)));
    let range = |of: fn(&(f64, f64)) -> f64| {
        let (least, most) = points
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        if least > most { (-1.0, 1.0) } else { (least - 0.5, most + 0.5) }
    };
    let ((left, right), (low, high)) = (range(|at| at.0), range(|at| at.1));
    let scale = WIDTH / (right - left).max(high - low);
    let x = |metres: f64| (metres - left) * scale;
    let y = |metres: f64| (high - metres) * scale;
    let (width, height) = (x(right), y(low));
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{width:.0}' height='{height:.0}' \
         viewBox='0 0 {width:.1} {height:.1}' fill='none' stroke='currentColor' stroke-linecap='round'>"
    );
    // Writing to a string cannot fail.
    for wall in scene.walls() {
        let dashes =
            if wall.faces == Faces::Open { " stroke-dasharray='2 5' stroke-width='1'" } else { " stroke-width='2'" };
        let (x1, y1, x2, y2) = (x(wall.from.x), y(wall.from.y), x(wall.to.x), y(wall.to.y));
        let _ = write!(svg, "<line x1='{x1:.1}' y1='{y1:.1}' x2='{x2:.1}' y2='{y2:.1}'{dashes}/>");
    }
    for pole in scene.poles() {
        let (x, y, radius) = (x(pole.centre.x), y(pole.centre.y), (pole.radius_m * scale).max(2.0));
        let _ = write!(svg, "<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}' fill='currentColor'/>");
    }
    for robot in robots {
        let at = robot.pose.translation;
        let radius = (robot.radius_m() * scale).max(3.0);
        let _ = write!(svg, "<circle cx='{:.1}' cy='{:.1}' r='{radius:.1}' stroke='#0072b2'/>", x(at.x), y(at.y));
        for sensor in &robot.sensors {
            let pose = robot.pose * sensor;
            let (from, ahead) = (pose.translation, pose.rotation);
            let (x1, y1) = (x(from.x), y(from.y));
            let (x2, y2) = (x1 + 14.0 * ahead.re, y1 - 14.0 * ahead.im);
            let _ = write!(svg, "<line x1='{x1:.1}' y1='{y1:.1}' x2='{x2:.1}' y2='{y2:.1}' stroke='#0072b2'/>");
        }
    }
    svg.push_str("</svg>");
    svg
}
