//! [`LockStep`]: the world around a ring that runs elsewhere, in the program or on a microcontroller.
//!
//! In a normal simulation, the simulator calls the ring. Here the ring calls the simulator: it reports each firing, and
//! receives the next echo of every sensor as known so far. A later firing may change it, if its sound arrives first.

use std::sync::Arc;

use super::channels::Channels;
use super::engine::Propagation;
use super::kinematics::Planned;
use super::receiver::{Hearing, NEVER, Receiver};
use crate::{
    threads::Stop,
    tracing::PathsError,
    world::{Random, World},
};

/// The first robot of a world, fired from outside. Its sensors report one echo.
pub struct LockStep<'w> {
    world: &'w World,
    channels: Channels,
    /// Hearing of each sensor.
    hearings: Vec<Hearing>,
    receivers: Vec<Receiver>,
    propagation: Propagation,
}

impl<'w> LockStep<'w> {
    /// Makes a world in which nothing has fired yet. The robot's `blanking` and `window` limit when its sensors hear.
    ///
    /// # Errors
    /// See [`simulate`](crate::simulate()).
    pub fn new(world: &'w World) -> Result<Self, PathsError> {
        // A world has at least one robot.
        let robot = &world.robots()[0];
        let ns = |time: eeruf_core::Micros| u64::from(time.as_micros()) * 1000;
        let channels = Channels::new(&Arc::new(world.clone()), &Planned(world), Stop::default())?;
        let hearing_of = |sensor| Hearing::new(world, robot, sensor, 1, ns(robot.window), ns);
        let hearings = (0..robot.sensors.len()).map(hearing_of).collect();
        let receivers = vec![Receiver::NEW; robot.sensors.len()];
        // These are the random numbers of a simulation.
        let propagation = Propagation::new(world, Random::new(world.seed()));
        Ok(Self { world, channels, hearings, receivers, propagation })
    }

    /// Fires a sensor, which then listens, at this time in nanoseconds: no earlier than the last call's time, and not
    /// within the sensor's window.
    ///
    /// # Errors
    /// Errors of [`simulate`](crate::simulate()) for robots that move.
    pub fn fire(&mut self, sensor: usize, at_ns: u64) -> Result<(), PathsError> {
        let Some(receiver) = self.receivers.get_mut(sensor) else { return Ok(()) };
        self.channels.prepare(sensor, at_ns, &Planned(self.world), None)?;
        let hearings = &self.hearings;
        receiver.fire(at_ns, &hearings[sensor]);
        let firing = [sensor as u64, receiver.firings.into()];
        // Another robot's sensors are silent here, and have no receivers.
        let channels = self.channels.from(sensor);
        self.propagation.send(firing, at_ns, channels, &mut self.receivers, |number, receiver, arrival| {
            receiver.insert(arrival, &hearings[number]);
        });
        Ok(())
    }

    /// Returns the time in nanoseconds of the sensor's next echo after its last firing, as known so far; `None` without
    /// one.
    pub fn hears_at_ns(&self, sensor: usize) -> Option<u64> {
        self.receivers.get(sensor).map(Receiver::next_at).filter(|&at| at != NEVER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::*;
    use eeruf_core::Phase;

    // A ring fired from outside hears the echoes of a simulation, to the microsecond.
    #[test]
    fn ring_fired_from_outside_hears_as_in_simulation() {
        const PERIODS: usize = 20;
        let walls = [[1.0, -0.8], [1.0, 0.8], [-0.9, 0.8], [-0.9, -0.8], [1.0, -0.8]];
        let scene = Scene::new(Wall::polyline(&walls).collect(), vec![], Air::default()).unwrap();
        let robot = Robot::ring(Pose::rotation(0.2), 8, 15f64.to_radians(), 0.3, Transducer::HC_SR04);
        let schedule = table_i_d_for(8, robot.period, 4).unwrap();
        let world = World::new(scene, vec![robot], Noise::default()).unwrap();
        let readings = simulate(&world, Method::Eeruf, &Options::periods(PERIODS as u32)).unwrap();

        let mut firings = Vec::new();
        for period in 0..PERIODS {
            for sensor in 0..8 {
                let phase = if period % 2 == 0 { Phase::A } else { Phase::B };
                let t_fire = schedule.t_fire(phase, sensor).unwrap().as_micros() as usize;
                let us = period * schedule.period().as_micros() as usize + t_fire;
                firings.push((us as u64 * 1000, sensor, period));
            }
        }
        firings.sort_unstable();
        let mut outside = LockStep::new(&world).unwrap();
        let mut fired = [None; 8];
        let mut heard = [[f64::NAN; PERIODS]; 8];
        let mut note = |fired: Option<(u64, usize)>, sensor: usize, heard_at: Option<u64>| {
            if let (Some((at, period)), Some(heard_at)) = (fired, heard_at) {
                heard[sensor][period] = (heard_at / 1000 - at / 1000) as f64;
            }
        };
        for (at, sensor, period) in firings {
            // The echo since its last firing is final now.
            note(fired[sensor], sensor, outside.hears_at_ns(sensor));
            outside.fire(sensor, at).unwrap();
            fired[sensor] = Some((at, period));
        }
        for sensor in 0..8 {
            note(fired[sensor], sensor, outside.hears_at_ns(sensor));
        }
        assert_eq!(readings.len(), 8 * PERIODS);
        for k in 0..readings.len() {
            let (simulated, heard) =
                (readings.earliest_us[k], heard[usize::from(readings.sensor[k])][readings.period[k] as usize]);
            assert!(
                simulated == heard || (simulated.is_nan() && heard.is_nan()),
                "reading {k}: {simulated} and {heard}"
            );
        }
        assert!(readings.cause.iter().filter(|&&cause| cause == Cause::Crosstalk).count() > 10);
    }
}
