//! A robot's success in a trial, by its beliefs: it sees the thing that appears, and does not stop for no reason.

use core::f64::consts::PI;

use super::heard::{Control, Heard};
use super::things::{agree, is_near, nearest_of};
use super::trial::{NEVER_S, Trial};
use super::votes::{Believed, Setting, believed};
use crate::{
    experiments::rooms::RoomPlan,
    geometry::{Point, Pose, Vector, cross},
    world::Robot,
};

/// Limits in metres for a false stop: the largest distance, and the least difference to every real surface.
const STOPS_M: f64 = 1.5;
const NEARER_M: f64 = 0.15;
/// Angle from a sensor's axis within which surfaces count.
const WITHIN_RAD: f64 = PI / 3.0;
/// Time without a false stop after which an onset is a new one; each further period of this length counts once more.
const APART_S: f64 = 1.0;
/// Share of right readings below which a sensor is blind.
const BLIND: f64 = 0.05;

/// The figures of one way and setting in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Time from the thing's appearance to the first belief in it, in ms; infinite for never, NaN without a thing.
    pub latency_ms: f64,
    /// Number of false stops before the thing appeared.
    pub false_stops: u32,
    /// The time over which false stops were counted, in seconds.
    pub watched_s: f64,
    /// Share of time in which foreign sound was believed and wrong.
    pub foreign: f64,
    /// Share of the time with an echo for the sensor alone in which the belief was right.
    pub right: f64,
    /// Right echoes that were believed, per second.
    pub right_echoes_per_s: f64,
    /// Number of sensors that were right in less than 5 % of their readings.
    pub blind: u32,
}

impl Trial {
    /// Computes the figures of readings under a setting.
    pub(super) fn sight(&self, robot: &Robot, heard: &[Heard], setting: Setting, control: Option<Control>) -> Sight {
        let life_s = Control::life_s(control, self.life_s());
        let sensors = robot.sensors.len();
        let of_sensor = |sensor| heard.iter().filter(move |one| one.sensor == sensor).copied().collect::<Vec<_>>();
        let by_sensor: Vec<Vec<Heard>> = (0..sensors).map(of_sensor).collect();
        let beliefs: Vec<Vec<Believed>> = by_sensor.iter().map(|heard| believed(heard, setting, life_s)).collect();
        let latency_ms = self.latency_ms(robot, beliefs.iter().flatten());
        let mut false_ones: Vec<[f64; 2]> = vec![];
        let (mut foreign_s, mut right_s, mut echo_s) = (0.0, 0.0, 0.0);
        let (mut blind, mut right_echoes) = (0, 0);
        for (heard, beliefs) in by_sensor.iter().zip(&beliefs) {
            let watched = beliefs.iter().filter(|belief| belief.heard.ready_s < self.appears_s);
            for belief in watched.filter(|belief| Heard::is_foreign(belief.cause)) {
                let lasts = [belief.heard.ready_s, belief.until_s.min(self.appears_s)];
                foreign_s +=
                    if is_near(belief.t_echo_us, belief.heard.reference_us) { 0.0 } else { lasts[1] - lasts[0] };
                if self.stops(belief) {
                    false_ones.push(lasts);
                }
            }
            let (mut right, mut watched) = (0, 0);
            let mut beliefs = beliefs.iter().peekable();
            let mut belief: Option<&Believed> = None;
            for (k, reading) in heard.iter().enumerate().take_while(|(_, reading)| reading.ready_s < self.appears_s) {
                let mut is_new = false;
                while let Some(next) = beliefs.next_if(|next| next.heard.ready_s <= reading.ready_s) {
                    (belief, is_new) = (Some(next), true);
                }
                let next_s = heard.get(k + 1).map_or(self.appears_s, |next| next.ready_s.min(self.appears_s));
                let is_right = belief.is_some_and(|belief| agree(belief.t_echo_us, reading.reference_us));
                right += usize::from(is_right);
                watched += 1;
                if !reading.reference_us.is_nan() {
                    right_echoes += usize::from(is_right && is_new);
                    echo_s += next_s - reading.ready_s;
                    let until_s = belief.map_or(0.0, |belief| belief.until_s.max(reading.ready_s)).min(next_s);
                    right_s += if is_right { (until_s - reading.ready_s).max(0.0) } else { 0.0 };
                }
            }
            blind += u32::from((right as f64) < BLIND * f64::from(watched));
        }
        Sight {
            latency_ms,
            false_stops: false_stops(false_ones),
            watched_s: self.appears_s,
            foreign: foreign_s / (sensors as f64 * self.appears_s),
            right: if echo_s > 0.0 { right_s / echo_s } else { f64::NAN },
            right_echoes_per_s: right_echoes as f64 / self.appears_s,
            blind,
        }
    }

    /// Returns the latency from the thing's appearance to the first of these beliefs in it; NaN without a thing.
    fn latency_ms<'b>(&self, robot: &Robot, beliefs: impl Iterator<Item = &'b Believed>) -> f64 {
        if self.thing.is_none() {
            return f64::NAN;
        }
        let mut after: Vec<_> = beliefs.filter(|belief| belief.heard.fired_s >= self.appears_s).collect();
        after.sort_by(|one, other| one.heard.ready_s.total_cmp(&other.heard.ready_s));
        let first = after.iter().find(|belief| self.sees(robot, belief));
        let late_s = first.map_or(f64::INFINITY, |belief| belief.heard.ready_s - self.appears_s);
        if late_s > NEVER_S { f64::INFINITY } else { 1e3 * late_s }
    }

    /// Returns true if every setting has seen the thing by these readings, which are complete up to a time except for
    /// sensors that still listen then.
    pub(super) fn is_seen(&self, robot: &Robot, heard: &[Heard], until_s: f64) -> bool {
        let of_sensor = |sensor| heard.iter().filter(move |one| one.sensor == sensor).copied().collect::<Vec<_>>();
        let by_sensor: Vec<Vec<Heard>> = (0..robot.sensors.len()).map(of_sensor).collect();
        let life_s = Control::life_s(None, self.life_s());
        let known_ms = 1e3 * (until_s - self.appears_s) - 1e-3 * f64::from(robot.window.as_micros());
        Setting::ALL.iter().all(|&setting| {
            let beliefs: Vec<_> = by_sensor.iter().flat_map(|heard| believed(heard, setting, life_s)).collect();
            self.latency_ms(robot, beliefs.iter()) < known_ms
        })
    }

    /// Returns true if the belief is in the thing, and the sensor alone would read the thing too.
    fn sees(&self, robot: &Robot, belief: &Believed) -> bool {
        let Believed { heard, t_echo_us, .. } = belief;
        let Some(thing) = self.thing.as_ref().filter(|_| heard.fired_s >= self.appears_s) else { return false };
        let us = thing.nearest_us(self.c, Point::from(heard.seen.translation.vector));
        is_near(*t_echo_us, us)
            && is_near(heard.reference_us, us)
            && thing.changes(&self.plan, robot, heard.sensor, &heard.seen, us)
    }

    /// Returns true if a robot would stop for this belief in foreign sound.
    fn stops(&self, belief: &Believed) -> bool {
        let says_m = 0.5e-6 * self.c * belief.t_echo_us;
        says_m < STOPS_M && says_m + NEARER_M < nearest_m(&self.plan, &belief.heard.seen)
    }
}

/// Returns the distance in metres of the nearest surface within 60 degrees of a sensor's axis.
fn nearest_m(plan: &RoomPlan, seen: &Pose) -> f64 {
    let from = Point::from(seen.translation.vector);
    let side = |turn: f64| {
        let rad = seen.rotation.angle() + turn;
        Vector::new(libm::cos(rad), libm::sin(rad))
    };
    let (right, left) = (side(-WITHIN_RAD), side(WITHIN_RAD));
    // Clip the wall to the left of the right border, and to the right of the left border.
    let of_wall = |[mut one, mut end]: [Point; 2]| {
        for inside in [|to: Vector, border: Vector| cross(border, to), |to: Vector, border: Vector| cross(to, border)]
            .into_iter()
            .zip([right, left])
            .map(|(inside, border)| move |at: Point| inside(at - from, border))
        {
            let (a, b) = (inside(one), inside(end));
            if a < 0.0 && b < 0.0 {
                return f64::INFINITY;
            }
            let border = one + (end - one) * (a / (a - b));
            if a < 0.0 {
                one = border;
            } else if b < 0.0 {
                end = border;
            }
        }
        (nearest_of(one, end, from) - from).norm()
    };
    let walls = plan.walls.iter().map(|wall| of_wall([wall.from, wall.to]));
    let poles = plan.poles.iter().map(|pole| {
        let to = pole.centre - from;
        let wide_rad = libm::asin((pole.radius_m / to.norm()).min(1.0));
        let off_rad = crate::geometry::wrap_angle(libm::atan2(to.y, to.x) - seen.rotation.angle()).abs();
        if off_rad <= WITHIN_RAD + wide_rad { to.norm() - pole.radius_m } else { f64::INFINITY }
    });
    walls.chain(poles).fold(f64::INFINITY, f64::min)
}

/// Returns the number of false stops in these intervals of all sensors.
fn false_stops(mut intervals: Vec<[f64; 2]>) -> u32 {
    intervals.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let (mut count, mut last_s, mut of_it_s) = (0, f64::NEG_INFINITY, 0.0);
    for [from_s, to_s] in intervals {
        if from_s >= last_s + APART_S {
            (count, of_it_s) = (count + 1, 0.0);
        }
        let before = (of_it_s / APART_S) as u32;
        of_it_s += (to_s - from_s.max(last_s)).max(0.0);
        count += (of_it_s / APART_S) as u32 - before;
        last_s = last_s.max(to_s);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn false_stops_count_onsets_and_seconds() {
        assert_eq!(false_stops(vec![]), 0);
        // Two sensors at once make one false stop of the robot; half a second later it is still the same one.
        assert_eq!(false_stops(vec![[1.0, 1.3], [1.1, 1.4], [1.9, 2.0]]), 1);
        assert_eq!(false_stops(vec![[1.0, 1.3], [2.4, 2.5]]), 2);
        assert_eq!(false_stops(vec![[1.0, 3.5]]), 3);
    }

    #[test]
    fn nearest_surface_is_sought_within_sixty_degrees() {
        let mut room = RoomPlan::own(
            0,
            crate::Wall::polyline(&[[3.0, -9.0], [3.0, 9.0]]).collect(),
            vec![],
            Pose::identity(),
            0.0,
        );
        let at = |rad: f64| nearest_m(&room, &Pose::rotation(rad));
        assert!((at(0.0) - 3.0).abs() < 1e-9 && (at(1.0) - 3.0).abs() < 1e-9);
        // Beyond 60 degrees of the perpendicular the border of the sector meets the wall.
        assert!((at(80f64.to_radians()) - 3.0 / libm::cos(20f64.to_radians())).abs() < 1e-9);
        assert_eq!(at(PI), f64::INFINITY);
        room.poles = vec![crate::Pole::new(1.0, 0.0, 0.1)];
        assert!((nearest_m(&room, &Pose::identity()) - 0.9).abs() < 1e-9);
    }
}
