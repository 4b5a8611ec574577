//! Writes the found paths in order, with directions and amplitudes. In a room each path of the plan is written once
//! for each vertical path between the heights.

use super::audibility::Audibility;
use super::limits::{Limits, Matters};
use super::panels::share_of_walls;
use super::paths::Paths;
use super::poles::{PolePath, is_shaded};
use super::ranking::{Found, FoundPath, Rank};
use super::tracer::{Heights, Tracer};
use super::vertical::Way;
use crate::{
    acoustics::{pole_wave_correction, reflected},
    geometry::{Point, TOUCH_M, opposite, wrap_angle},
    scene::{Bounce, Room, Scene},
};
use core::f64::consts::TAU;

/// A path in the plan, without its amplitude.
#[derive(Clone, Copy)]
struct Course {
    receiver: u32,
    order: u32,
    /// Directions of departure, and of arrival as the receiver sees it.
    angles: [f64; 2],
}

/// A path of a room that waits for its position in the order.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    receiver: u32,
    length_m: f64,
    order: u32,
    angles: [f64; 2],
    elevations: [f64; 2],
    amplitude: f64,
    /// The bounces in the plan, as a range, and the vertical path.
    bounces: [u32; 2],
    way: Way,
}

/// Buffers for paths in rooms.
#[derive(Debug, Default)]
pub(super) struct InRoom {
    waiting: Vec<Waiting>,
    bounces: Vec<Bounce>,
    ways: Vec<Way>,
}

impl Tracer {
    /// Writes the paths of a flat scene.
    pub(super) fn write(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        matters: Option<Matters<'_>>,
        paths: &mut Paths,
    ) {
        let loss_per_m = self.loss_per_m(scene.air());
        let wave_number = TAU * self.frequency_hz / scene.air().speed_of_sound();
        paths.reserve(self.ranking.ranks().len());
        let found = Found { tree: &self.tree, poles: &self.poles, edges: &self.around };
        let wavelength_m = TAU / wave_number;
        let shades = self.pole_shadows && !scene.poles().is_empty();
        let mut corners = core::mem::take(&mut self.corners);
        for &Rank { length_m, index } in self.ranking.ranks() {
            if matters.is_some_and(|matters| !matters(found.get(index).receiver() as usize, length_m)) {
                continue;
            }
            let start = paths.bounces.len();
            let receiver = found.push_bounces(index, &mut paths.bounces);
            let mut share = 1.0;
            let narrow = self.narrow_panels && ends(scene, &paths.bounces[start..]);
            if shades || narrow {
                let bounces = &paths.bounces[start..];
                let corners = corners.of(scene, source, receivers[receiver as usize], bounces);
                if shades && corners.is_some_and(|corners| is_shaded(scene, corners, bounces, wavelength_m)) {
                    paths.bounces.truncate(start);
                    continue;
                }
                if narrow {
                    share = corners.map_or(1.0, |corners| share_of_walls(scene, corners, bounces, wavelength_m));
                }
            }
            let path = found.get(index);
            let course = course(&path, receivers);
            let amplitude = self.spread(&path, &course, &paths.bounces[start..], scene, wave_number, length_m);
            paths.push(course.receiver, course.order, course.angles);
            paths.length_m.push(length_m);
            paths.amplitude.push(share * amplitude * libm::exp(loss_per_m * length_m));
            paths.ends.push(paths.bounces.len() as u32);
        }
        self.corners = corners;
    }

    /// Writes the paths of a scene in a room.
    ///
    /// Between floor and ceiling, sound of wave number `k` at an elevation `e` behaves in the plan like sound of wave
    /// number `k cos e` and spreads by `cos e` more; the air attenuates it over its whole length.
    #[expect(clippy::too_many_arguments, reason = "one question")]
    pub(super) fn write_in_room(
        &mut self,
        audibility: Option<&Audibility>,
        matters: Option<Matters<'_>>,
        scene: &Scene,
        room: &Room,
        source: Point,
        receivers: &[Point],
        heights: Heights<'_>,
        [limits, at_poles]: [Limits; 2],
        paths: &mut Paths,
    ) {
        let loss_per_m = self.loss_per_m(scene.air());
        let wave_number = TAU * self.frequency_hz / scene.air().speed_of_sound();
        let mut in_room = core::mem::take(&mut self.in_room);
        let InRoom { waiting, bounces, ways } = &mut in_room;
        waiting.clear();
        bounces.clear();
        let found = Found { tree: &self.tree, poles: &self.poles, edges: &self.around };
        let shades = self.pole_shadows && !scene.poles().is_empty();
        let mut rises_to = f64::NAN;
        let mut turns = core::mem::take(&mut self.corners);
        for &Rank { length_m: plan_m, index } in self.ranking.ranks() {
            let path = found.get(index);
            let course = course(&path, receivers);
            let receiver = course.receiver as usize;
            let height_m = heights.receiver_m(receiver);
            if rises_to != height_m {
                Way::between(room, heights.source_m, height_m, limits.max_order, ways);
                rises_to = height_m;
            }
            let most = if matches!(path, FoundPath::Pole(_)) { at_poles } else { limits };
            let start = bounces.len();
            let (mut narrow, mut plan_cosines) = (false, None);
            let mut corners: Option<Option<&[Point]>> = None;
            for &way in ways.iter().take_while(|way| course.order + way.order <= most.max_order) {
                let length_m = libm::hypot(plan_m, way.rise_m);
                let (cos, sin) = (plan_m / length_m, way.rise_m.abs() / length_m);
                let horizontal = wave_number * cos;
                if length_m > most.max_length_m || matters.is_some_and(|matters| !matters(receiver, length_m)) {
                    continue;
                }
                let vertical = way.reflected(room, wave_number, sin);
                let heard = |audibility: &Audibility| {
                    let plan = *plan_cosines.get_or_insert_with(|| audibility.cosines(receiver, course.angles));
                    audibility.may_hear_in_room(plan, cos, vertical, length_m)
                };
                if !audibility.is_none_or(heard) {
                    continue;
                }
                if corners.is_none() {
                    found.push_bounces(index, bounces);
                    let here = &bounces[start..];
                    narrow = self.narrow_panels && ends(scene, here);
                    let needed = shades || narrow;
                    corners = Some(if needed { turns.of(scene, source, receivers[receiver], here) } else { None });
                }
                let here = &bounces[start..];
                let mut share = 1.0;
                if let Some(corners) = corners.flatten() {
                    if shades && is_shaded(scene, corners, here, TAU / horizontal) {
                        continue;
                    }
                    if narrow {
                        share = share_of_walls(scene, corners, here, TAU / horizontal);
                    }
                }
                let spread = self.spread(&path, &course, here, scene, horizontal, plan_m) * cos;
                waiting.push(Waiting {
                    receiver: course.receiver,
                    length_m,
                    order: course.order + way.order,
                    angles: course.angles,
                    elevations: way.elevations(plan_m),
                    amplitude: share * spread * vertical * libm::exp(loss_per_m * length_m),
                    bounces: [start as u32, bounces.len() as u32],
                    way,
                });
            }
        }
        // A sensor hears itself straight over floor and ceiling, on paths that are not in the plan.
        for (receiver, _) in receivers.iter().enumerate().filter(|(_, at)| (*at - source).norm() <= TOUCH_M) {
            Way::between(room, heights.source_m, heights.receiver_m(receiver), limits.max_order, ways);
            for &way in ways.iter().filter(|way| (TOUCH_M..=limits.max_length_m).contains(&way.rise_m.abs())) {
                let length_m = way.rise_m.abs();
                let spread = way.reflected(room, wave_number, 1.0) / length_m;
                waiting.push(Waiting {
                    receiver: receiver as u32,
                    length_m,
                    order: way.order,
                    angles: [0.0; 2],
                    elevations: way.elevations(0.0),
                    amplitude: spread * libm::exp(loss_per_m * length_m),
                    bounces: [0; 2],
                    way,
                });
            }
        }
        // Paths of equal length stay in the order in which they were found.
        waiting.sort_by(|a, b| a.receiver.cmp(&b.receiver).then(a.length_m.total_cmp(&b.length_m)));
        paths.reserve(waiting.len());
        for path in waiting.iter() {
            paths.bounces.extend_from_slice(&bounces[path.bounces[0] as usize..path.bounces[1] as usize]);
            paths.bounces.extend(path.way.bounces());
            paths.push(path.receiver, path.order, path.angles);
            paths.elevations_rad.push(path.elevations);
            paths.length_m.push(path.length_m);
            paths.amplitude.push(path.amplitude);
            paths.ends.push(paths.bounces.len() as u32);
        }
        self.in_room = in_room;
        self.corners = turns;
    }

    /// Returns the share of the amplitude in the plan after spreading, walls, poles and edges.
    #[inline]
    fn spread(
        &self,
        path: &FoundPath<'_>,
        course: &Course,
        bounces: &[Bounce],
        scene: &Scene,
        wave_number: f64,
        length_m: f64,
    ) -> f64 {
        match path {
            FoundPath::Walls(image) => {
                let reflection_gain = if scene.rough {
                    reflected(scene, bounces, course.angles, [1.0; 2], wave_number)
                } else {
                    image.reflection_gain
                };
                reflection_gain / length_m
            }
            FoundPath::Pole(path) => {
                let reflection_gain = reflected(scene, bounces, course.angles, path.cos_incidence, wave_number);
                reflection_gain * path.spread * self.pole_waves(path, bounces, scene, wave_number)
            }
            FoundPath::Edge(path) => path.spread_at(wave_number),
        }
    }

    /// Returns the wave correction of a path's poles, if it is enabled; otherwise 1.
    fn pole_waves(&self, path: &PolePath, bounces: &[Bounce], scene: &Scene, wave_number: f64) -> f64 {
        if !self.pole_waves {
            return 1.0;
        }
        let poles = bounces.iter().filter_map(|bounce| match *bounce {
            Bounce::Pole(pole) => scene.poles().get(pole as usize),
            _ => None,
        });
        let corrections = poles
            .zip(path.cos_incidence)
            .map(|(pole, cos)| pole_wave_correction(wave_number * pole.radius_m, libm::acos(cos.min(1.0))));
        corrections.product()
    }
}

/// Returns true if a path meets a wall whose surface ends.
#[inline]
fn ends(scene: &Scene, bounces: &[Bounce]) -> bool {
    bounces.iter().any(|bounce| matches!(*bounce, Bounce::Wall(wall) if scene.extents().ends(wall)))
}

#[inline]
fn course(path: &FoundPath<'_>, receivers: &[Point]) -> Course {
    match path {
        FoundPath::Walls(image) => {
            let ahead = receivers[image.receiver as usize] - image.image;
            let there = libm::atan2(ahead.y, ahead.x);
            let departure = if image.order.is_multiple_of(2) { there - image.turn } else { image.turn - there };
            let angles = [wrap_angle(departure), opposite(there)];
            Course { receiver: image.receiver, order: image.order, angles }
        }
        FoundPath::Pole(path) => {
            Course { receiver: path.receiver, order: path.order, angles: [path.departure_rad, path.arrival_rad] }
        }
        FoundPath::Edge(path) => {
            Course { receiver: path.receiver, order: 1, angles: [path.departure_rad, path.arrival_rad] }
        }
    }
}
