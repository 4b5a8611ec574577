//! A course, the way that each method drove, and the grid made of its readings (Fig. 6).

use eeruf_sim::experiments::set_two::{Cell, Course, Ending, ROOM_M, Run, SetTwo, TrackPoint};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, RGBColor};

use super::picture::{At, Picture};
use super::style::{ACCEPTED, CAPTION, INK, REJECTED, SILENT, SMALL, TITLE};

const WIDTH: f64 = 900.0;
const MARGIN: f64 = 20.0;
const GAP: f64 = 20.0;
const TOP: f64 = 50.0;
const CAPTIONS: f64 = 44.0;
const TRACK: RGBColor = RGBColor(0x1f, 0x6f, 0xb4);
/// Interval between two outlines of the platform, in seconds.
const OUTLINE_S: f64 = 1.0;
const SIDE_M: f64 = 0.75;
const CELL_M: f64 = 0.1;

/// The first course, one panel for each method: chosen by its number, not by how it ended.
pub(crate) fn courses(found: &SetTwo) -> Picture {
    let course = Course::random(found.first);
    let panel_width = 0.5 * (WIDTH - 2.0 * MARGIN - GAP);
    let scale = panel_width / ROOM_M[0];
    let panel_height = ROOM_M[1] * scale;
    let rows = found.methods.len().div_ceil(2) as f64;
    let mut picture = Picture::new(WIDTH, TOP + rows * (panel_height + CAPTIONS + GAP) + 16.0);
    let title = format!("Course {}, top speed {} m/s", found.first, found.speed_m_s);
    let beside = if found.second_robot_m.is_some() { ", a second robot firing in a corner" } else { "" };
    picture.text(title + beside, (MARGIN, 24.0), TITLE);
    for (panel_index, ((method, _), runs)) in found.methods.iter().zip(&found.runs).enumerate() {
        let left = MARGIN + (panel_index % 2) as f64 * (panel_width + GAP);
        let top = TOP + (panel_index / 2) as f64 * (panel_height + CAPTIONS + GAP);
        let Some(run) = runs.first() else { continue };
        picture.text(method.to_string(), (left, top + 10.0), CAPTION);
        picture.text_in(outcome(run), (left, top + 30.0), SMALL, HPos::Left, INK);
        let view = View { scale, height: panel_height };
        picture.insert(view.panel(&course, run, found.second_robot_m), (left, top + CAPTIONS));
    }
    picture
}

fn outcome(run: &Run) -> String {
    let ending = match run.ending {
        Ending::Finished => "finished",
        Ending::Contact => "touched something",
        Ending::TimeOut => "did not get through in time",
    };
    let mean = if run.time_s > 0.0 { run.way_m / run.time_s } else { 0.0 };
    let echoes = if run.phantom_echoes == 1 { "echo" } else { "echoes" };
    format!("{ending} after {:.1} s, mean {mean:.2} m/s, {} phantom {echoes}", run.time_s, run.phantom_echoes)
}

struct View {
    scale: f64,
    height: f64,
}

impl View {
    fn px(&self, x_m: f64, y_m: f64) -> At {
        (x_m * self.scale, self.height - y_m * self.scale)
    }

    fn panel(&self, course: &Course, run: &Run, second_robot_m: Option<[f64; 2]>) -> Picture {
        let mut picture = Picture::new(ROOM_M[0] * self.scale, self.height);
        picture.rect([(0.0, 0.0), (ROOM_M[0] * self.scale, self.height)], SILENT.mix(0.25));
        let inside = |cell: &&Cell| (0.0..ROOM_M[0]).contains(&cell.x_m) && (0.0..ROOM_M[1]).contains(&cell.y_m);
        for Cell { x_m, y_m, value } in run.grid.iter().filter(inside) {
            let half = 0.5 * CELL_M;
            let corners = [self.px(x_m - half, y_m + half), self.px(x_m + half, y_m - half)];
            picture.rect(corners, INK.mix(0.08 + 0.05 * f64::from(*value)));
        }
        // The reflective corner is drawn thicker.
        let [x, y] = ROOM_M;
        for (from, to, width) in
            [((0.0, 0.0), (x, 0.0), 1.0), ((0.0, 0.0), (0.0, y), 1.0), ((x, 0.0), (x, y), 4.0), ((0.0, y), (x, y), 4.0)]
        {
            picture.line(self.px(from.0, from.1), self.px(to.0, to.1), width, INK);
        }
        if let Some([x, y]) = second_robot_m {
            picture.dot(self.px(x, y), 0.3 * self.scale, REJECTED.mix(0.6));
        }
        let mut next = 0.0;
        for place in &run.track {
            if place.time_s >= next {
                self.outline(&mut picture, place, 1.0, TRACK.mix(0.45));
                next += OUTLINE_S;
            }
        }
        for pair in run.track.windows(2) {
            picture.line(self.px(pair[0].x_m, pair[0].y_m), self.px(pair[1].x_m, pair[1].y_m), 2.0, TRACK);
        }
        for pole in &course.poles {
            picture.dot(self.px(pole.x, pole.y), 3.0, REJECTED);
        }
        if let Some(last) = run.track.last() {
            let colour = if run.ending == Ending::Finished { ACCEPTED } else { REJECTED };
            self.outline(&mut picture, last, 2.0, colour.to_rgba());
            if run.ending != Ending::Finished {
                picture.cross(self.px(last.x_m, last.y_m), 6.0, REJECTED);
            }
        }
        picture
    }

    fn outline(&self, picture: &mut Picture, place: &TrackPoint, width: f64, colour: plotters::style::RGBAColor) {
        let (sin, cos) = place.heading_rad.sin_cos();
        let half = 0.5 * SIDE_M;
        let corner = |along: f64, aside: f64| {
            self.px(place.x_m + half * (along * cos - aside * sin), place.y_m + half * (along * sin + aside * cos))
        };
        let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
        for side in 0..4 {
            picture.line(corners[side], corners[(side + 1) % 4], width, colour);
        }
    }
}
