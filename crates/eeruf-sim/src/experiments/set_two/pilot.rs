//! The closed loop: accepted readings fill the histogram grid, the vector field histogram decides direction and speed,
//! and the platform follows within its limits.

use eeruf_core::ReadingKind;

use super::course::{FINISH_X_M, POLE_RADIUS_M, ROOM_M, TARGET};
use super::odometry::Odometry;
use super::options::SetTwoOptions;
use super::run::{Cell, Ending, Run, TrackPoint};
use crate::{
    geometry::{Moment, Point, Pose, Vector},
    methods::Method,
    navigation::{Driven, Himm, LabMate, Piloting},
    results::{DEFAULT_TOLERANCE_US, Readings},
    scene::Body,
    simulation::Kinematics,
    world::World,
};

/// Time step of the platform, in nanoseconds.
const STEP_NS: u64 = 5_000_000;
/// Number of steps between two decisions: 30 ms, the time of one decision on the paper's computer.
const STEPS_PER_LOOK: u64 = 6;
/// The width of the grid's cells, in metres, as in the papers.
const CELL_M: f64 = 0.1;
/// Distance in metres from every pole and wall beyond which an echo is a phantom, little more than a cell or the beam.
const PHANTOM_M: f64 = 0.35;
/// Least value of a cell that counts as an obstacle when phantoms are counted.
const CERTAIN: u8 = 6;
/// Distance from the platform's middle within which a pole should have been seen.
const PASSED_M: f64 = 1.0;

/// Steers the first robot of a world.
pub(super) struct Pilot<'w> {
    world: &'w World,
    labmate: LabMate,
    piloting: Piloting,
    state: Driven,
    steps: u64,
    steps_most: u64,
    /// Estimated pose, by which the grid is filled and the robot steered.
    odometry: Odometry,
    grid: Himm,
    /// The grid filled from the true poses, for finding phantoms.
    real_grid: Himm,
    wanted: (f64, f64),
    /// For each pole: true if an echo of it was entered, and its least distance from the robot's middle.
    poles: Vec<(bool, f64)>,
    run: Run,
}

impl<'w> Pilot<'w> {
    pub(super) fn new(world: &'w World, course: u64, options: &SetTwoOptions, piloting: Piloting, time_s: f64) -> Self {
        // One grid covers the whole lab; the active window moves over it.
        let side = (1.3 * ROOM_M[0] / CELL_M) as usize;
        let mut grid = Himm::new(side, CELL_M);
        grid.move_to(Point::new(0.5 * ROOM_M[0], 0.5 * ROOM_M[1]));
        grid.growth = piloting.growth;
        let state = Driven::at_rest(world.robots()[0].pose);
        Self {
            world,
            labmate: options.labmate,
            piloting,
            state,
            steps: 0,
            steps_most: (time_s * 1e9) as u64 / STEP_NS,
            odometry: Odometry::new(options.odometry_noise, &state, course),
            real_grid: grid.clone(),
            grid,
            wanted: (0.0, 0.0),
            poles: vec![(false, f64::INFINITY); world.scene().poles().len()],
            run: Run::begun(course),
        }
    }

    pub(super) fn finish(mut self) -> Run {
        self.run.time_s = (self.steps * STEP_NS) as f64 * 1e-9;
        let middle = Point::new(0.5 * ROOM_M[0], 0.5 * ROOM_M[1]);
        let cells = self.grid.occupied(middle, self.grid.side());
        self.run.grid = cells.map(|(point, value)| Cell { x_m: point.x, y_m: point.y, value }).collect();
        let certain = self.real_grid.occupied(middle, self.real_grid.side()).filter(|(_, value)| *value >= CERTAIN);
        self.run.phantom_cells = certain.filter(|(point, _)| self.is_phantom(*point)).count() as u32;
        let passed = self.poles.iter().filter(|(_, nearest)| *nearest < PASSED_M);
        self.run.poles_passed = passed.clone().count() as u32;
        self.run.poles_missed = passed.filter(|(seen, _)| !seen).count() as u32;
        self.run
    }

    fn is_phantom(&self, point: Point) -> bool {
        let wall = point.x.min(ROOM_M[0] - point.x).min(point.y).min(ROOM_M[1] - point.y);
        wall > PHANTOM_M
            && self.world.scene().poles().iter().all(|pole| (pole.centre - point).norm() > PHANTOM_M)
            && self.discs().all(|(centre, radius_m)| (centre - point).norm() - radius_m > PHANTOM_M)
    }

    /// Centres and radii of the other robots' bodies, which do not move.
    fn discs(&self) -> impl Iterator<Item = (Point, f64)> {
        self.world.robots()[1..].iter().filter_map(|robot| match robot.body {
            Some(Body::Disc(radius_m)) => Some((Point::from(robot.pose.translation.vector), radius_m)),
            _ => None,
        })
    }

    fn place(&self) -> Point {
        Point::from(self.state.pose.translation.vector)
    }

    /// Decides the direction to steer in, and the speed.
    fn look(&mut self) {
        let Piloting { vfh, turn_gain, .. } = self.piloting;
        let (estimate, turn_most_rad_s) = (self.odometry.pose(), self.labmate.turn_max_rad_s);
        self.wanted = vfh.drive(&self.grid, estimate, TARGET, self.state.turn_rad_s, turn_gain, turn_most_rad_s);
        let Driven { pose, speed_m_s, .. } = self.state;
        let time_s = (self.steps * STEP_NS) as f64 * 1e-9;
        let (x_m, y_m) = (pose.translation.x, pose.translation.y);
        self.run.track.push(TrackPoint { time_s, x_m, y_m, heading_rad: pose.rotation.angle(), speed_m_s });
    }

    /// Ends the course with a contact.
    pub(super) fn touched(&mut self) {
        self.run.ending = Ending::Contact;
        self.run.nearest_m = self.run.nearest_m.max(0.0);
    }

    /// Drives one step; returns false when the course is over.
    fn step(&mut self) -> bool {
        if self.steps.is_multiple_of(STEPS_PER_LOOK) {
            self.look();
        }
        self.labmate.drive(&mut self.state, self.wanted.0, self.wanted.1, STEP_NS as f64 * 1e-9);
        self.odometry.drove(&self.state, STEP_NS as f64 * 1e-9);
        self.steps += 1;
        self.run.way_m += self.state.speed_m_s * STEP_NS as f64 * 1e-9;
        self.run.top_speed_m_s = self.run.top_speed_m_s.max(self.state.speed_m_s);
        let place = self.place();
        for (pole, (_, nearest)) in self.world.scene().poles().iter().zip(&mut self.poles) {
            let off = (pole.centre - place).norm();
            *nearest = nearest.min(off);
            if off < 2.0 * self.labmate.side_m {
                let clearance = self.labmate.clearance_m(&self.state.pose, pole.centre) - POLE_RADIUS_M;
                self.run.nearest_m = self.run.nearest_m.min(clearance);
            }
        }
        let touches = |(centre, radius_m)| self.labmate.clearance_m(&self.state.pose, centre) - radius_m <= 0.0;
        let contact = self.run.nearest_m <= 0.0
            || self.discs().any(touches)
            || self.world.scene().contact(&self.labmate.body(), &self.state.pose).is_some();
        if contact {
            self.touched();
        } else if place.x >= FINISH_X_M {
            self.run.ending = Ending::Finished;
        } else {
            return self.steps < self.steps_most;
        }
        false
    }
}

impl Kinematics for Pilot<'_> {
    fn moves(&self) -> bool {
        true
    }

    fn moment(&self, robot: usize, now: u64) -> Moment {
        if robot == 0 {
            self.state.moment((now - self.steps * STEP_NS) as f64 * 1e-9)
        } else {
            let robot = &self.world.robots()[robot];
            robot.motion.at(&robot.pose, now as f64 * 1e-9)
        }
    }

    fn advance(&mut self, now: u64) -> bool {
        while (self.steps + 1) * STEP_NS <= now {
            if !self.step() {
                return false;
            }
        }
        true
    }

    fn on_reading(&mut self, readings: &Readings, fired: &Moment) {
        let Some(last) = readings.len().checked_sub(1).filter(|&last| readings.robot[last] == 0) else { return };
        let robot = &self.world.robots()[0];
        let sensor = fired.pose * robot.sensors[usize::from(readings.sensor[last])];
        let estimate = self.odometry.estimate_of(&self.state.pose, &sensor);
        let place = |sensor: &Pose| (Point::from(sensor.translation.vector), sensor.rotation.angle());
        let ((at, heading), (estimated_at, estimated_heading)) = (place(&sensor), place(&estimate));
        let metres_per_us = 0.5e-6 * self.world.scene().air().speed_of_sound();
        let near_m = f64::from(robot.blanking.as_micros()) * metres_per_us;
        self.run.readings += 1;
        if !readings.is_accepted(last) {
            self.run.rejected += 1;
            return;
        }
        self.run.wrong += u32::from(readings.is_wrong(last, DEFAULT_TOLERANCE_US));
        let range_m = readings.t_echo_us[last] * metres_per_us;
        // A tentative echo is an echo too: treating it as free space would drive the robot into a new obstacle.
        if readings.kind[last] == ReadingKind::Clear || range_m > self.piloting.range_m {
            self.grid.clear(estimated_at, estimated_heading, near_m, self.piloting.range_m);
            self.real_grid.clear(at, heading, near_m, self.piloting.range_m);
            return;
        }
        self.grid.echo(estimated_at, estimated_heading, near_m, range_m);
        self.real_grid.echo(at, heading, near_m, range_m);
        let hit = Point::from(at.coords + (sensor.rotation * Vector::x()) * range_m);
        self.run.phantom_echoes += u32::from(self.is_phantom(hit));
        for (pole, (seen, _)) in self.world.scene().poles().iter().zip(&mut self.poles) {
            *seen |= (pole.centre - hit).norm() <= PHANTOM_M;
        }
    }

    fn method(&self, robot: usize, asked: Method) -> Method {
        if robot == 0 { asked } else { Method::Eeruf }
    }

    fn listens(&self, robot: usize) -> bool {
        robot == 0
    }
}
