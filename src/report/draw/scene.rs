//! A scene seen from above: walls, poles, the ring with its beams, and the critical paths that fooled a sensor
//! (Figs. 1, 4).

use eeruf_sim::{Faces, Point, Pose, Vector, World};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBAColor};

use super::picture::{At, Picture};
use super::style::{CAPTION, INK, SILENT, SMALL, TITLE, grid_step, sensor_colour, tick_label};

/// A path that fooled its receiver.
pub(crate) struct DrawnPath {
    /// The sensor that sent the sound, which gives the path its colour.
    pub(crate) emitter: usize,
    /// The corners, from the emitter over all bounces to the receiver.
    pub(crate) corners: Vec<Point>,
    /// Number of readings that the path spoilt.
    pub(crate) times: usize,
}

/// One method's readings of the scene.
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) paths: Vec<DrawnPath>,
}

const WIDTH: f64 = 900.0;
const MARGIN: f64 = 20.0;
const GAP: f64 = 24.0;
const TOP: f64 = 64.0;
/// Length at which a beam is drawn.
const BEAM_M: f64 = 0.22;
const HALF_BEAM_RAD: f64 = 0.15;

/// Draws the panels beside each other, to one scale, with equal widths for equal numbers of wrong readings.
pub(crate) fn scene_with_paths(world: &World, panels: &[Panel]) -> Picture {
    let count = panels.len().max(1) as f64;
    let panel_width = (WIDTH - 2.0 * MARGIN - (count - 1.0) * GAP) / count;
    let view = View::of(world, panels, panel_width);
    let mut picture = Picture::new(WIDTH, TOP + view.height + 92.0);
    let most = panels.iter().flat_map(|panel| &panel.paths).map(|path| path.times).max().unwrap_or(1);
    for (panel_index, panel) in panels.iter().enumerate() {
        let left = MARGIN + panel_index as f64 * (panel_width + GAP);
        picture.text(panel.title.as_str(), (left, 20.0), TITLE);
        picture.text(panel.caption.as_str(), (left, 43.0), CAPTION);
        picture.insert(view.panel(world, panel, most), (left, TOP));
    }
    let bottom = TOP + view.height;
    let sensors = world.robots().iter().map(|robot| robot.sensors.len()).max().unwrap_or(0);
    picture.text("sound sent by sensor", (MARGIN, bottom + 24.0), CAPTION);
    for sensor in 0..sensors.min(24) {
        let at = (MARGIN + 182.0 + 24.0 * sensor as f64, bottom + 24.0);
        picture.dot(at, 9.0, sensor_colour(sensor));
        picture.text_in((sensor + 1).to_string(), at, SMALL, HPos::Center, plotters::style::WHITE);
    }
    picture.text("wrong readings believed", (MARGIN, bottom + 56.0), CAPTION);
    let mut x = MARGIN + 182.0;
    for times in [most.div_ceil(20), most.div_ceil(4), most].into_iter().filter(|&times| times > 0) {
        picture.line((x, bottom + 56.0), (x + 34.0, bottom + 56.0), view.width_of(times, most), INK);
        picture.text(times.to_string(), (x + 40.0, bottom + 56.0), CAPTION);
        x += 100.0;
    }
    // A scale.
    let step = grid_step(view.width_m, 4.0);
    let (end, y) = (WIDTH - MARGIN, bottom + 56.0);
    picture.line((end - step * view.scale, y), (end, y), 2.0, INK);
    for x in [end - step * view.scale, end] {
        picture.line((x, y - 5.0), (x, y + 5.0), 2.0, INK);
    }
    let length = format!("{} m", tick_label(step, step));
    picture.text_in(length, (end - step * view.scale - 10.0, y), CAPTION, HPos::Right, INK);
    picture
}

/// The visible part of the scene, and its scale.
struct View {
    low: Point,
    width_m: f64,
    scale: f64,
    width: f64,
    height: f64,
}

impl View {
    /// Shows all of the scene, unless the important part becomes too small.
    fn of(world: &World, panels: &[Panel], width: f64) -> Self {
        let bodies = world.robots().iter().flat_map(|robot| {
            let (middle, reach) = (position(&robot.pose), Vector::repeat(robot.radius_m()));
            [middle - reach, middle + reach]
        });
        let paths = panels.iter().flat_map(|panel| &panel.paths).flat_map(|path| path.corners.iter().copied());
        let focus = around(bodies.chain(paths), 0.1);
        let walls = world.scene().walls().iter().flat_map(|wall| [wall.from, wall.to]);
        let poles = world.scene().poles().iter().map(|pole| pole.centre);
        let all = around(walls.chain(poles), 0.08);
        let [mut low, mut high] = focus;
        for axis in 0..2 {
            let spare = 0.6 * (focus[1] - focus[0]).amax();
            low[axis] = all[0][axis].clamp(low[axis] - spare, low[axis]);
            high[axis] = all[1][axis].clamp(high[axis], high[axis] + spare);
        }
        let (width_m, height_m) = (high.x - low.x, high.y - low.y);
        let scale = (width / width_m).min(560.0 / height_m);
        // Spare width is shared between both sides.
        let low = Point::new(low.x - 0.5 * (width / scale - width_m), low.y);
        Self { low, width_m: width / scale, scale, width, height: height_m * scale }
    }

    /// Returns the width of a path that spoilt this number of readings.
    fn width_of(&self, times: usize, most: usize) -> f64 {
        let widest = (0.02 * self.scale).clamp(3.0, 5.0);
        1.0 + (widest - 1.0) * (times as f64 / most.max(1) as f64).sqrt()
    }

    fn px(&self, point: Point) -> At {
        ((point.x - self.low.x) * self.scale, self.height - (point.y - self.low.y) * self.scale)
    }

    fn panel(&self, world: &World, panel: &Panel, most: usize) -> Picture {
        let mut picture = Picture::new(self.width, self.height);
        picture.rect([(0.0, 0.0), (self.width, self.height)], SILENT.mix(0.35));
        for robot in 0..world.robots().len() {
            self.course(&mut picture, world, robot);
            self.beams(&mut picture, world, robot);
        }
        for wall in world.scene().walls() {
            let colour = if wall.faces == Faces::Open { INK.mix(0.25) } else { INK.to_rgba() };
            if let Some((from, to)) = self.clipped(self.px(wall.from), self.px(wall.to)) {
                picture.line(from, to, 3.0, colour);
                // Lines end square; this fills the corners.
                picture.dot(from, 1.5, colour);
                picture.dot(to, 1.5, colour);
            }
        }
        for pole in world.scene().poles() {
            let at = self.px(pole.centre);
            if self.holds(at) {
                picture.dot(at, (pole.radius_m * self.scale).max(3.0), INK);
            }
        }
        // The most frequent path is drawn last, on top.
        for path in panel.paths.iter().rev() {
            let colour: RGBAColor = sensor_colour(path.emitter);
            let width = self.width_of(path.times, most);
            let corners: Vec<At> = path.corners.iter().map(|&corner| self.px(corner)).collect();
            for leg in corners.windows(2) {
                if let Some((from, to)) = self.clipped(leg[0], leg[1]) {
                    picture.line(from, to, width, colour.mix(0.85));
                }
            }
            if let [.., from, to] = corners[..]
                && self.holds(to)
            {
                let leg = (to.0 - from.0).hypot(to.1 - from.1);
                picture.arrow_head(from, to, (5.0 + 2.3 * width).min(0.4 * leg), colour);
            }
        }
        for robot in 0..world.robots().len() {
            self.sensors(&mut picture, world, robot);
        }
        picture
    }

    /// Draws the course of a moving robot.
    fn course(&self, picture: &mut Picture, world: &World, robot: usize) {
        const STEP_S: f64 = 0.25;
        const STEPS: u32 = 400;
        let Some(body) = world.robots().get(robot).filter(|body| !body.motion.is_still()) else { return };
        let at = |step: u32| self.px(position(&body.motion.at(&body.pose, STEP_S * f64::from(step)).pose));
        // Every other step: dashes, longer for a faster robot.
        for step in (0..STEPS).step_by(2) {
            if let Some((from, to)) = self.clipped(at(step), at(step + 1)) {
                picture.line(from, to, 2.0, INK.mix(0.3));
            }
        }
    }

    fn beams(&self, picture: &mut Picture, world: &World, robot: usize) {
        let Some(body) = world.robots().get(robot) else { return };
        let middle = Point::from(body.pose.translation.vector);
        let at = self.px(middle);
        if self.holds(at) {
            picture.dot(at, body.radius_m() * self.scale, SILENT);
        }
        for (k, sensor) in world.sensors(robot, 0.0).enumerate() {
            let ahead = |angle: f64| sensor * Point::new(BEAM_M * angle.cos(), BEAM_M * angle.sin());
            let arc = (-4..=4).map(|step| ahead(HALF_BEAM_RAD * f64::from(step) / 4.0));
            let corners: Vec<At> = std::iter::once(position(&sensor)).chain(arc).map(|point| self.px(point)).collect();
            if corners.iter().all(|&corner| self.holds(corner)) {
                picture.area(corners, sensor_colour(k).mix(0.22));
            }
        }
    }

    fn sensors(&self, picture: &mut Picture, world: &World, robot: usize) {
        let mut numbers: Vec<At> = Vec::new();
        for (k, sensor) in world.sensors(robot, 0.0).enumerate() {
            let at = self.px(position(&sensor));
            if !self.holds(at) {
                continue;
            }
            picture.dot(at, (0.02 * self.scale).clamp(2.0, 4.0), sensor_colour(k));
            // Numbers stand inside the ring, where no sound goes, if there is room for them.
            let inside = self.px(sensor * Point::new(-14.0 / self.scale, 0.0));
            let apart = |&(x, y): &At| (inside.0 - x).hypot(inside.1 - y) > 12.0;
            if 0.25 * self.scale > 30.0 && numbers.iter().all(apart) {
                picture.text_in((k + 1).to_string(), inside, SMALL, HPos::Center, INK);
                numbers.push(inside);
            }
        }
    }

    fn holds(&self, (x, y): At) -> bool {
        (0.0..=self.width).contains(&x) && (0.0..=self.height).contains(&y)
    }

    /// Returns the part of a line within the panel.
    fn clipped(&self, from: At, to: At) -> Option<(At, At)> {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (start, change, most) in [(from.0, to.0 - from.0, self.width), (from.1, to.1 - from.1, self.height)] {
            if change == 0.0 {
                if start < 0.0 || start > most {
                    return None;
                }
                continue;
            }
            let (one, other) = (-start / change, (most - start) / change);
            enter = enter.max(one.min(other));
            leave = leave.min(one.max(other));
        }
        let at = |share: f64| (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share);
        (enter < leave).then(|| (at(enter), at(leave)))
    }
}

fn position(sensor: &Pose) -> Point {
    Point::from(sensor.translation.vector)
}

/// Returns the corners of the smallest box around points, with a margin.
fn around(points: impl Iterator<Item = Point>, margin: f64) -> [Point; 2] {
    let empty = [Point::new(f64::INFINITY, f64::INFINITY), Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY)];
    let [low, high] = points.fold(empty, |[low, high], point| [low.inf(&point), high.sup(&point)]);
    if low.x > high.x {
        return [Point::new(-margin, -margin), Point::new(margin, margin)];
    }
    [Point::new(low.x - margin, low.y - margin), Point::new(high.x + margin, high.y + margin)]
}
