//! [`Simulation`]: a world that is simulated step by step, under the caller's own controller or filter.

use std::sync::Arc;

use super::channels::SharedPaths;
use super::engine::{EventLoop, Own, end_of, plans};
use super::error::SimulationError;
use super::kinematics::{Kinematics, Planned};
use super::options::Options;
use super::steered::Steered;
use crate::{
    geometry::{Moment, Pose},
    methods::Method,
    results::Readings,
    scene::Scene,
    threads::Stop,
    world::{AnySchedule, MAX_SPEED, World},
};

/// The longest single step, in seconds: a longer one is probably a mistake.
const MAX_STEP_S: f64 = 1e9;

/// A simulation that runs step by step. All steps together give the readings of [`simulate`](crate::simulate()), bit
/// for bit, but need memory only for the readings of one step.
///
/// ```
/// use std::sync::Arc;
/// use eeruf_sim::*;
/// let wall = Wall::new(5.0, 2.0, -5.0, 2.0);
/// let ahead = Pose::rotation(std::f64::consts::FRAC_PI_2);
/// let robot = Robot::ring(ahead, 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
/// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
/// let mut simulation = Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default())?;
/// simulation.set_velocity(0, 0.5, 0.0)?;
/// simulation.step(1.0, |_| true)?;
/// let readings = simulation.step(0.12, |_| true)?;
/// assert_eq!(readings.len(), 16);
/// assert!((simulation.moment(0)?.pose.translation.y - 0.56).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulation {
    /// The world at the beginning.
    world: Arc<World>,
    events: EventLoop<Steered>,
    method: Method,
    robots: usize,
    /// Present time in true nanoseconds.
    now: u64,
    /// Time before which all events have happened.
    happened: u64,
    /// The world with its current scene, and the time of the last change.
    place: (Arc<World>, u64),
    /// End of the time for which firings are reported.
    end: u64,
    /// The first robot's period.
    period: u64,
    over: bool,
}

impl Simulation {
    /// Opens a simulation in which nothing has fired yet; the option `periods` is ignored. `stop` ends a running step
    /// from another thread.
    ///
    /// # Errors
    /// See [`simulate`](crate::simulate()).
    pub fn new(world: Arc<World>, method: Method, options: &Options, stop: Stop) -> Result<Self, SimulationError> {
        Self::until(world, method, options, Own::new(), None, stop)
    }

    /// Opens a simulation with the caller's [`Own`] firing methods or filters; robots without any follow the method.
    /// For a robot with its own firing but no filter, the method's judge is used.
    ///
    /// # Errors
    /// Errors of [`simulate`](crate::simulate()), a part for a robot that does not exist, or an invalid first period.
    pub fn with_own(
        world: Arc<World>,
        method: Method,
        options: &Options,
        own: Own,
        stop: Stop,
    ) -> Result<Self, SimulationError> {
        Self::until(world, method, options, own, None, stop)
    }

    /// Opens a simulation with [`Own`], in which firings after `options.periods` periods of the first robot are not
    /// reported.
    ///
    /// # Errors
    /// See [`simulate`](crate::simulate()).
    pub fn ending(
        world: Arc<World>,
        method: Method,
        options: &Options,
        own: Own,
        stop: Stop,
    ) -> Result<Self, SimulationError> {
        let end = end_of(&world, options.periods);
        Self::until(world, method, options, own, Some(end), stop)
    }

    fn until(
        world: Arc<World>,
        method: Method,
        options: &Options,
        mut own: Own,
        end: Option<u64>,
        stop: Stop,
    ) -> Result<Self, SimulationError> {
        let (robots, period) = (world.robots().len(), end_of(&world, 1));
        own.check(robots)?;
        let plans = plans(&world, method, options, &Planned(&world), &own)?;
        let place = (Arc::clone(&world), 0);
        let kinematics = Steered::new(Arc::clone(&world));
        let events = EventLoop::new(&world, &plans, method, options, kinematics, &mut own, end, 0, stop)?;
        let end = end.unwrap_or(u64::MAX);
        Ok(Self { world, events, method, robots, now: 0, happened: 0, place, end, period, over: false })
    }

    /// Returns a copy in the same state: with the same steps it gives the same readings, bit for bit. The copy has its
    /// own switch, `stop`. `None` if the caller's own [`FiringMethod`](crate::FiringMethod) or
    /// [`Filter`](crate::Filter) cannot be copied.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use eeruf_sim::*;
    /// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    /// let wall = Wall::new(2.0, -5.0, 2.0, 5.0).with_faces(Faces::Both);
    /// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
    /// let mut one = Simulation::new(Arc::new(world), Method::Flow, &Options::default(), Stop::default())?;
    /// one.step(1.0, |_| true)?;
    /// let mut other = one.copy(Stop::default()).unwrap();
    /// assert_eq!(one.step(1.0, |_| true)?.earliest_us.len(), other.step(1.0, |_| true)?.earliest_us.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn copy(&self, stop: Stop) -> Option<Self> {
        let (world, place) = (Arc::clone(&self.world), self.place.clone());
        Some(Self { world, events: self.events.copy(stop)?, place, ..*self })
    }

    /// Advances the time, and returns the readings of all firings whose windows have closed since. `keep_going` is
    /// called from time to time with the elapsed share; if it returns `false`, the step ends with
    /// [`SimulationError::Stopped`] and may be repeated.
    ///
    /// # Errors
    /// A time that is negative or above 10^9 s, a robot that has moved out of the scene's reach, or too little memory.
    pub fn step(&mut self, seconds: f64, keep_going: impl FnMut(f64) -> bool) -> Result<Readings, SimulationError> {
        self.go_on(Self::ns(seconds)?, keep_going)
    }

    fn ns(seconds: f64) -> Result<u64, SimulationError> {
        if !(0.0..=MAX_STEP_S).contains(&seconds) {
            return Err(SimulationError::Number { what: "seconds", value: seconds, expected: "0 to 1e9" });
        }
        Ok((seconds * 1e9).round() as u64)
    }

    /// Advances like [`step`](Self::step), but at most to the next reading. Returns all readings of that moment, or
    /// none after this many seconds.
    ///
    /// # Errors
    /// See [`step`](Self::step).
    ///
    /// ```
    /// use std::sync::Arc;
    /// use eeruf_sim::*;
    /// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    /// let wall = Wall::new(2.0, -5.0, 2.0, 5.0).with_faces(Faces::Both);
    /// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
    /// let mut simulation = Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default())?;
    /// let first = simulation.step_to_reading(1.0, |_| true)?;
    /// assert_eq!(first.len(), 1);
    /// // It fires, listens for 36 ms at most, and has been read.
    /// let listened_s = simulation.time_s() - first.fired_s[0];
    /// assert!(listened_s > 0.0 && listened_s < 0.0361);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_to_reading(
        &mut self,
        seconds: f64,
        keep_going: impl FnMut(f64) -> bool,
    ) -> Result<Readings, SimulationError> {
        let ns = Self::ns(seconds)?;
        let (before, farthest) = (self.now, self.now.saturating_add(ns));
        let until = if farthest >= self.end { u64::MAX } else { farthest };
        let end = self.end;
        let (more, at) = self.events.run_to_reading(until, keep_going)?;
        let now = at.map_or(farthest, |at| at.clamp(before, farthest));
        let readings = self.events.take((now.min(end) - before.min(end)) as f64 * 1e-9);
        (self.now, self.happened, self.over) = (now, at.map_or(now, |_| now + 1), !more);
        Ok(readings)
    }

    /// Advances like [`step`](Self::step) by this many periods of the first robot.
    ///
    /// # Errors
    /// See [`step`](Self::step).
    pub fn step_periods(
        &mut self,
        periods: u32,
        keep_going: impl FnMut(f64) -> bool,
    ) -> Result<Readings, SimulationError> {
        self.go_on(u64::from(periods) * self.period, keep_going)
    }

    fn go_on(&mut self, ns: u64, keep_going: impl FnMut(f64) -> bool) -> Result<Readings, SimulationError> {
        let (before, now) = (self.now.min(self.end), self.now.saturating_add(ns));
        // Sound of firings before the end is still heard after it.
        let until = if now >= self.end { u64::MAX } else { now };
        let duration_s = (now.min(self.end) - before) as f64 * 1e-9;
        let more = self.events.run_until(until, keep_going)?;
        let readings = self.events.take(duration_s);
        (self.now, self.happened, self.over) = (now, now, !more);
        Ok(readings)
    }

    /// Returns true if no more readings will come.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// Returns the simulated time that has passed, in seconds.
    pub fn time_s(&self) -> f64 {
        self.now as f64 * 1e-9
    }

    /// Sets a robot's forward speed, `v_m_s`, and rate of turn, `w_rad_s`, counter-clockwise, from now on. This
    /// overrides the motion given in the world.
    ///
    /// # Errors
    /// The robot does not exist, or the value is above 50 m/s or rad/s.
    pub fn set_velocity(&mut self, robot: usize, v_m_s: f64, w_rad_s: f64) -> Result<(), SimulationError> {
        self.known(robot)?;
        for (what, value) in [("v_m_s", v_m_s), ("w_rad_s", w_rad_s)] {
            if !(-MAX_SPEED..=MAX_SPEED).contains(&value) {
                return Err(SimulationError::Number { what, value, expected: "-50 to 50" });
            }
        }
        let now = self.now;
        self.events.steer().set(robot, now, v_m_s, w_rad_s);
        Ok(())
    }

    /// Moves a robot to another place at once. The robot keeps the speeds set last, or stands still. Readings before
    /// and after are compared as if odometry had followed the jump. Free space is not checked.
    ///
    /// # Errors
    /// The robot does not exist, or the pose is beyond 10^6 m.
    pub fn set_pose(&mut self, robot: usize, pose: Pose) -> Result<(), SimulationError> {
        self.known(robot)?;
        let place = pose.translation.vector;
        for (what, value) in [("x_m", place.x), ("y_m", place.y), ("heading_rad", pose.rotation.angle())] {
            if !(-1e6..=1e6).contains(&value) {
                return Err(SimulationError::Number { what, value, expected: "-1e6 to 1e6" });
            }
        }
        let now = self.now;
        self.events.steer().place(robot, now, pose);
        Ok(())
    }

    /// Changes a robot's schedule at the end of its current period, late enough to keep the intervals of both. Readings
    /// before and after the change are not compared.
    ///
    /// The robot does not exist; the method has no such schedule (immediate refiring, dither, flow, adaptive, the
    /// caller's own firing); or the schedule is for another number of sensors, or would fire a sensor again while it
    /// listens. The ring then continues as before.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use eeruf_core::Micros;
    /// use eeruf_sim::*;
    /// let wall = Wall::new(5.0, 2.0, -5.0, 2.0);
    /// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    /// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
    /// let mut simulation = Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default())?;
    /// assert_eq!(simulation.step(0.6, |_| true)?.len() / 8, 9);
    /// simulation.change_schedule(0, &table_i_d_for(8, Micros::from_millis(120), 4)?)?;
    /// simulation.step(0.6, |_| true)?;
    /// assert_eq!(simulation.step(0.6, |_| true)?.len() / 8, 5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn change_schedule(&mut self, robot: usize, schedule: &AnySchedule) -> Result<(), SimulationError> {
        self.known(robot)?;
        let method = self.method;
        let sensors = self.world.robots().get(robot).map_or(0, |robot| robot.sensors.len());
        if schedule.sensors() != sensors {
            return Err(SimulationError::Sensors { robot, schedule: schedule.sensors(), sensors });
        }
        let changed = self.events.change_schedule(robot, schedule);
        changed.map_err(|error| SimulationError::change(robot, method, error))
    }

    /// Changes walls, poles and air from now on, for obstacles that move. Sound in flight arrives as in the old scene.
    /// Free space around robots is not checked.
    ///
    /// # Errors
    /// [`SimulationError::Paths`] if a sensor is inside a solid or out of the scene's reach. The scene then does not
    /// change; for a robot that moves, the error comes at its next firing.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use eeruf_sim::*;
    /// let at = |x: f64| Scene::new(vec![Wall::new(x, -5.0, x, 5.0).with_faces(Faces::Both)], vec![], Air::default());
    /// let robot = Robot::with_sensors(Pose::identity(), vec![Pose::identity()], Transducer::POLAROID_6500);
    /// let world = World::new(at(2.0)?, vec![robot], Noise::NONE)?.with_physics(Physics::PLAIN)?;
    /// let options = Options::default();
    /// let mut simulation = Simulation::new(Arc::new(world), Method::Sequential, &options, Stop::default())?;
    /// let distance_m = |readings: Readings| (readings.t_echo_us[0] * 343.2e-6 * 5.0).round() / 10.0;
    /// assert_eq!(distance_m(simulation.step_to_reading(1.0, |_| true)?), 2.0);
    /// simulation.change_scene(at(3.0)?)?;
    /// assert_eq!(distance_m(simulation.step_to_reading(1.0, |_| true)?), 3.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn change_scene(&mut self, scene: Scene) -> Result<(), SimulationError> {
        let world = Arc::new(self.world().with_scene(scene));
        self.events.change_scene(Arc::clone(&world), self.now)?;
        self.place = (world, self.happened);
        Ok(())
    }

    /// Shares the paths of the current scene, until it changes, with simulations in which robots move alike and differ
    /// only in their firing and listening.
    pub(crate) fn share(&mut self, shared: Arc<SharedPaths>) {
        self.events.share(shared);
    }

    /// Returns the pose and speed of a robot now.
    ///
    /// # Errors
    /// The robot does not exist.
    pub fn moment(&self, robot: usize) -> Result<Moment, SimulationError> {
        self.known(robot)?;
        Ok(self.events.kinematics().moment(robot, self.now))
    }

    /// Returns the pose and speed of a robot at a time up to now: at most ten seconds before its last steering, or any
    /// time if it was never steered.
    ///
    /// # Errors
    /// The robot does not exist, or the time is outside that range.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use eeruf_sim::*;
    /// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    /// let wall = Wall::new(9.0, -5.0, 9.0, 5.0);
    /// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
    /// let mut simulation = Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default())?;
    /// simulation.step(1.0, |_| true)?;
    /// simulation.set_velocity(0, 0.5, 0.0)?;
    /// simulation.step(2.0, |_| true)?;
    /// assert_eq!(simulation.moment_at(0, 0.9)?.pose.translation.x, 0.0);
    /// assert_eq!(simulation.moment_at(0, 2.0)?.pose.translation.x, 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moment_at(&self, robot: usize, time_s: f64) -> Result<Moment, SimulationError> {
        self.known(robot)?;
        let then = (time_s * 1e9).round();
        let is_known = |then| self.events.kinematics().knows(robot, then);
        if !(0.0..=self.now as f64).contains(&then) || !is_known(then as u64) {
            let expected = "0 to now, and at most 10 s before the robot was last steered";
            return Err(SimulationError::Number { what: "time_s", value: time_s, expected });
        }
        Ok(self.events.kinematics().moment(robot, then as u64))
    }

    /// Returns the simulated world, in its state at the beginning.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// Returns the world with its current scene, and the time in seconds since which firings have used it; see
    /// [`change_scene`](Self::change_scene).
    pub fn world_now(&self) -> (&Arc<World>, f64) {
        (&self.place.0, self.place.1 as f64 * 1e-9)
    }

    fn known(&self, robot: usize) -> Result<(), SimulationError> {
        let robots = self.robots;
        if robot < robots { Ok(()) } else { Err(SimulationError::Robot { robot, robots }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{acoustics::Transducer, scene::Air, scene::Scene, world::Noise, world::Robot};

    #[test]
    fn steered_positions_are_known_for_ten_seconds() {
        let robot = Robot::ring(Pose::identity(), 2, 0.3, 0.1, Transducer::POLAROID_6500);
        let scene = Scene::new(vec![], vec![], Air::default()).unwrap();
        let world = World::new(scene, vec![robot], Noise::default()).unwrap();
        let (options, stop) = (Options::default(), Stop::default());
        let mut simulation = Simulation::new(Arc::new(world), Method::Sequential, &options, stop).unwrap();
        let mut seen = vec![];
        for step in 0..150 {
            simulation.set_velocity(0, 0.1 * f64::from(step % 5), 0.3 * f64::from(step % 7 - 3)).unwrap();
            simulation.step(0.1, |_| true).unwrap();
            seen.push((simulation.time_s(), simulation.moment(0).unwrap().pose));
            for &(then, pose) in seen.iter().rev().take(99) {
                let was = simulation.moment_at(0, then).unwrap().pose;
                assert!((was.translation.vector - pose.translation.vector).norm() < 1e-12, "{then} s");
            }
        }
        let far = simulation.moment_at(0, 3.0).unwrap_err().to_string();
        assert!(far.starts_with("time_s is 3; expected 0 to now"), "{far}");
        assert!(simulation.moment_at(0, 15.01).is_err() && simulation.moment_at(1, 1.0).is_err());
        assert!(simulation.moment_at(0, f64::NAN).is_err());
    }
}
