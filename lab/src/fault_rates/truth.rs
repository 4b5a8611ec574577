//! The simulator's knowledge of a healthy ring, which decides where a fault counts.

use std::error::Error;

use eeruf_sim::{Cause, Readings, Robot, Scene, World};

pub(crate) const SENSORS: usize = 8;

/// Fewer firings that heard another sensor say nothing about it.
const HEARD: u32 = 20;
/// The own echo of a sensor that loses echoes is as much above what is just heard, in dB.
const LOUD_DB: f64 = 6.0;
/// A deaf sensor would hear in this share of the firings if it were not.
const HEARS: f64 = 0.2;
/// A reading that comes less early than this, in microseconds, is not changed.
const CHANGED_US: f64 = 150.0;
/// More noise than this is none that a ring could be diagnosed with, in 1/s.
const MOST_NOISE_PER_S: f64 = 2000.0;
/// Places of its way at which the own echo of a robot that drives is weighed.
const PLACES: u32 = 5;

/// Sounds of each sensor of a healthy ring.
#[derive(Clone, Debug, Default)]
pub(crate) struct Truth {
    firings: [u32; SENSORS],
    echoes: [u32; SENSORS],
    /// Readings of others' sound.
    foreign: [u32; SENSORS],
    /// Others' readings of its sound.
    sent: [u32; SENSORS],
    /// Level of its loudest own echo while it listens above what is just heard, the least along its way.
    own_db: [f64; SENSORS],
    /// Times in which each sensor listens before its reading, in seconds.
    listens_s: [Vec<f64>; SENSORS],
}

impl Truth {
    pub(crate) fn of(world: &World, readings: &Readings) -> Result<Self, Box<dyn Error>> {
        let mut truth = Self { own_db: own_db(world, readings.duration_s)?, ..Self::default() };
        let robot = &world.robots()[0];
        let window = f64::from(robot.window.as_micros());
        for k in (0..readings.len()).filter(|&k| readings.robot[k] == 0) {
            let sensor = usize::from(readings.sensor[k]);
            let blanking = f64::from(robot.blanking_of(sensor).as_micros());
            let echo = readings.earliest_us[k];
            truth.firings[sensor] += 1;
            truth.echoes[sensor] += u32::from(!echo.is_nan());
            let until = if echo.is_nan() { window } else { echo };
            truth.listens_s[sensor].push(1e-6 * (until - CHANGED_US - blanking).max(0.0));
            if readings.cause[k] == Cause::Crosstalk {
                truth.foreign[sensor] += 1;
                if let Some(path) = readings.path_of(k) {
                    truth.sent[usize::from(path.emitter.sensor)] += 1;
                }
            }
        }
        Ok(truth)
    }

    /// A sensor that would hear if it were not deaf.
    pub(crate) fn would_hear(&self, sensor: usize) -> bool {
        f64::from(self.echoes[sensor]) >= HEARS * f64::from(self.firings[sensor])
    }

    /// A sensor whose own echo is loud.
    pub(crate) fn is_loud(&self, sensor: usize) -> bool {
        self.own_db[sensor] >= LOUD_DB
    }

    /// A sensor that heard others.
    pub(crate) fn heard_others(&self, sensor: usize) -> bool {
        self.foreign[sensor] >= HEARD
    }

    /// A sensor that heard others and was heard.
    pub(crate) fn heard_both_ways(&self, sensor: usize) -> bool {
        self.heard_others(sensor) && self.sent[sensor] >= HEARD
    }

    /// The rate of noise, in 1/s, that changes a share of the readings, if there is one.
    pub(crate) fn noise_that_changes(&self, sensor: usize, share: f64) -> Option<f64> {
        let listens = &self.listens_s[sensor];
        let changed = |per_s: f64| {
            listens.iter().map(|listens_s| 1.0 - (-per_s * listens_s).exp()).sum::<f64>() / listens.len().max(1) as f64
        };
        let (mut low, mut high) = (0.0, MOST_NOISE_PER_S);
        if changed(high) < share {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if changed(middle) < share { low = middle } else { high = middle }
        }
        Some(high)
    }
}

/// The level of each sensor's own echo above what is just heard, the least along its way.
fn own_db(world: &World, seconds: f64) -> Result<[f64; SENSORS], Box<dyn Error>> {
    let (robot, air) = (&world.robots()[0], world.scene().air());
    let window = f64::from(robot.window.as_micros());
    let mut least = [f64::INFINITY; SENSORS];
    let places = if world.moves() { PLACES } else { 1 };
    for place in 0..places {
        let at_s = seconds * f64::from(place) / f64::from(PLACES - 1);
        let pose = robot.motion.at(&robot.pose, at_s).pose;
        let scene = Scene::new(world.scene().walls().to_vec(), world.scene().poles().to_vec(), air)?;
        let there = World::new(scene, vec![Robot { pose, ..robot.clone() }], world.noise())?;
        let matrix = there.with_physics(world.physics())?.ring_paths_above(0, world.max_order(), 1.0)?;
        let mut here = [f64::NEG_INFINITY; SENSORS];
        for path in matrix.paths().iter().filter(|path| path.emitter == path.receiver) {
            let sensor = path.receiver as usize;
            let echo_us = 1e6 * path.length_m / air.speed_of_sound();
            if !(f64::from(robot.blanking_of(sensor).as_micros())..window).contains(&echo_us) {
                continue;
            }
            let level_db = robot.transducer_of(sensor).level_db(path.amplitude, path.length_m, air);
            here[sensor] = level_db.max(here[sensor]);
        }
        least.iter_mut().zip(here).for_each(|(least, here)| *least = here.min(*least));
    }
    Ok(least)
}
