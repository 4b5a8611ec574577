//! Motions of simulated robots: planned from the start, or steered by a pilot according to readings.

use crate::{geometry::Moment, methods::Method, results::Readings, world::World};

/// Source of the robots' poses, which also receives their rings' readings. Time never decreases from call to call.
pub(crate) trait Kinematics {
    /// Returns true if anything ever moves.
    fn moves(&self) -> bool;

    /// Returns the motion of a robot at a time, in true nanoseconds.
    fn moment(&self, robot: usize, now: u64) -> Moment;

    /// Advances the time to `now`, in true nanoseconds. Returns false to end the simulation.
    fn advance(&mut self, _now: u64) -> bool {
        true
    }

    /// Reports a reading: the last of `readings`, from a firing at `fired`.
    fn on_reading(&mut self, _readings: &Readings, _fired: &Moment) {}

    /// Returns the method by which a robot's ring fires.
    fn method(&self, _robot: usize, asked: Method) -> Method {
        asked
    }

    /// Returns true if a robot's hearing matters.
    fn listens(&self, _robot: usize) -> bool {
        true
    }
}

impl<K: Kinematics> Kinematics for &mut K {
    fn moves(&self) -> bool {
        K::moves(self)
    }

    fn moment(&self, robot: usize, now: u64) -> Moment {
        K::moment(self, robot, now)
    }

    fn advance(&mut self, now: u64) -> bool {
        K::advance(self, now)
    }

    fn on_reading(&mut self, readings: &Readings, fired: &Moment) {
        K::on_reading(self, readings, fired);
    }

    fn method(&self, robot: usize, asked: Method) -> Method {
        K::method(self, robot, asked)
    }

    fn listens(&self, robot: usize) -> bool {
        K::listens(self, robot)
    }
}

/// Motions that the world describes.
pub(crate) struct Planned<'w>(pub(crate) &'w World);

impl Kinematics for Planned<'_> {
    fn moves(&self) -> bool {
        self.0.moves()
    }

    fn moment(&self, robot: usize, now: u64) -> Moment {
        let robot = &self.0.robots()[robot];
        robot.motion.at(&robot.pose, now as f64 * 1e-9)
    }
}
