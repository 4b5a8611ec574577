//! Where robots are while they are simulated: as their motions have it, known from the start, or as a pilot steers them
//! by what their sensors read.

use crate::{geometry::Moment, methods::Method, results::Readings, world::World};

/// Says where robots are, and receives what their rings read. Time never goes back from call to call.
pub(crate) trait Kinematics {
    /// Returns true if anything ever moves.
    fn moves(&self) -> bool;

    /// Where a robot is now, in true nanoseconds.
    fn moment(&self, robot: usize, now: u64) -> Moment;

    /// Time has come to `now`, in true nanoseconds. When the answer is `false` the simulation ends.
    fn advance(&mut self, _now: u64) -> bool {
        true
    }

    /// A reading, the last of `readings`, of a firing that happened at `fired`.
    fn on_reading(&mut self, _readings: &Readings, _fired: &Moment) {}

    /// By which method a robot's ring fires.
    fn method(&self, _robot: usize, asked: Method) -> Method {
        asked
    }

    /// Returns true if it matters what a robot hears.
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

/// Robots move as the world says.
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
