//! The active faults of a simulated world, and their effects on firings and echoes.

use std::sync::Arc;

use crate::simulation::receiver::{Arrival, EXTERNAL, Hearing, NEVER};
use crate::{
    modules::Interface,
    results::SensorId,
    world::{AnySchedule, Fault, FaultKind, Random, World, WorldError, scene_with},
};

/// Purpose of the stream of random numbers.
const FAULTS: u64 = 5;
/// Interval between two positions of a door or a leg, in nanoseconds: 5 cm at 1 m/s. A choice.
const FRAME_NS: u64 = 50_000_000;
/// Level of noise above the threshold, in dB: a choice, as loud as a burst from outside.
const NOISE_DB: f32 = 20.0;
/// Level of a glitch, which is not sound and rises at once.
const GLITCH_DB: f32 = 200.0;

/// The result of a trigger.
pub(super) enum Fired {
    /// No sound is sent, and nothing is heard.
    Nothing,
    /// This sensor sends its sound, this many nanoseconds late.
    Sends(u8, u64),
}

/// A change that is due.
pub(super) enum Due {
    /// From now on a robot fires by this table, or by its own without one.
    Table(usize, Option<Box<AnySchedule>>),
    /// From now on sound travels in this world.
    Scene(Arc<World>),
}

/// The faults of a running world.
#[derive(Clone)]
pub(super) struct Faults {
    world: Arc<World>,
    random: Random,
    /// The world without the objects of its faults.
    base: Arc<World>,
    /// Time of the next change: the beginning or end of another table, or a move of an object.
    next: u64,
    scene_next: u64,
}

fn ns(time_s: f64) -> u64 {
    if time_s.is_finite() { (time_s * 1e9).round() as u64 } else { NEVER }
}

impl Faults {
    pub(super) fn new(world: &Arc<World>, seed: Random) -> Self {
        let faults = world.faults();
        let scene_next = if faults.iter().any(|fault| fault.kind.is_of_scene()) { 0 } else { NEVER };
        let random = seed.of(FAULTS);
        let (world, base) = (Arc::clone(world), Arc::clone(world));
        let mut begun = Self { world, random, base, next: 0, scene_next };
        begun.next = begun.change_after(None).min(scene_next);
        begun
    }

    /// Returns true if there are faults.
    pub(super) fn any(&self) -> bool {
        !self.world.faults().is_empty()
    }

    /// Returns the time of the next change.
    pub(super) fn next(&self) -> u64 {
        self.next
    }

    /// Replaces the world without objects of faults; returns it with the objects at a time.
    pub(super) fn begin_anew(&mut self, base: Arc<World>, now: u64) -> Result<Arc<World>, WorldError> {
        self.base = base;
        if self.scene_next == NEVER && !self.world.faults().iter().any(|fault| fault.kind.is_of_scene()) {
            return Ok(Arc::clone(&self.base));
        }
        self.world_at(now)
    }

    fn world_at(&self, now: u64) -> Result<Arc<World>, WorldError> {
        let scene = scene_with(self.base.scene(), self.world.faults(), now as f64 * 1e-9)?;
        Ok(Arc::new(self.base.with_scene(scene)))
    }

    /// Returns the time of the first change of a table after `now`, or of the first one of all.
    fn change_after(&self, now: Option<u64>) -> u64 {
        let tables = self.world.faults().iter().filter(|fault| matches!(fault.kind, FaultKind::OtherTable { .. }));
        let times = tables.flat_map(|fault| [ns(fault.from_s), ns(fault.to_s)]);
        times.filter(|&at| now.is_none_or(|now| at > now)).min().unwrap_or(NEVER)
    }

    /// Returns the changes due at a time given by [`next`](Self::next).
    pub(super) fn due(&mut self, now: u64) -> Result<Vec<Due>, WorldError> {
        let mut due = vec![];
        let time_s = now as f64 * 1e-9;
        let world = Arc::clone(&self.world);
        let faults = world.faults();
        for fault in faults {
            if let FaultKind::OtherTable { schedule } = &fault.kind {
                if now == ns(fault.from_s) {
                    due.push(Due::Table(fault.robot, Some(schedule.clone())));
                } else if now == ns(fault.to_s) {
                    due.push(Due::Table(fault.robot, None));
                }
            }
        }
        if now >= self.scene_next {
            due.push(Due::Scene(self.world_at(now)?));
            // The next change comes soon while something moves, or else when it begins to move.
            let of_scene = || faults.iter().filter(|fault| fault.kind.is_of_scene());
            self.scene_next = if of_scene().any(|fault| fault.is_at(time_s) && fault.to_s.is_finite()) {
                let ends = of_scene().map(|fault| ns(fault.to_s)).filter(|&at| at > now).min().unwrap_or(NEVER);
                (now + FRAME_NS).min(ends)
            } else {
                of_scene().map(|fault| ns(fault.from_s)).filter(|&at| at > now).min().unwrap_or(NEVER)
            };
        }
        self.next = self.change_after(Some(now)).min(self.scene_next);
        Ok(due)
    }

    /// Returns the faults that a sensor has at a time, each with its number.
    fn of(&self, id: SensorId, now: u64) -> impl Iterator<Item = (u64, &Fault)> {
        let time_s = now as f64 * 1e-9;
        let has = move |fault: &Fault| fault.is_of(id.robot.into(), id.sensor) && fault.is_at(time_s);
        self.world
            .faults()
            .iter()
            .enumerate()
            .filter(move |(_, fault)| has(fault))
            .map(|(index, fault)| (index as u64, fault))
    }

    /// Returns a random number from 0 to 1 that depends on a fault, a sensor and its firing.
    fn chance(&self, fault: u64, id: SensorId, firing: u32, what: u64) -> f64 {
        let of_sensor = self.random.of(fault).of(id.robot.into()).of(id.sensor.into());
        of_sensor.of(firing.into()).of(what).bits() as f64 / (u64::MAX as f64 + 1.0)
    }

    /// Returns the result of a sensor's trigger.
    pub(super) fn fired(&self, id: SensorId, now: u64) -> Fired {
        let wires = self.of(id, now).filter(|(_, fault)| fault.kind == FaultKind::TriggerWires);
        let sensor = wires.fold(id.sensor, |sensor, (_, fault)| fault.exchanged(sensor));
        let (mut late, mut sends) = (0, true);
        for (_, fault) in self.of(SensorId { sensor, ..id }, now) {
            match fault.kind {
                FaultKind::Missing | FaultKind::Stuck => sends = false,
                FaultKind::LateTrigger { us } => late += u64::from(us) * 1000,
                _ => {}
            }
        }
        if sends { Fired::Sends(sensor, late) } else { Fired::Nothing }
    }

    /// Returns additional sounds of a sensor after a firing, caused by faults.
    pub(super) fn heard_beside(&self, id: SensorId, now: u64, firing: u32, hearing: &Hearing) -> Vec<Arrival> {
        let mut heard = vec![];
        let robot = self.world.robots().get(usize::from(id.robot));
        let is_edge = robot.is_some_and(|robot| robot.module_of(id.sensor.into()).interface == Interface::Edge);
        for (index, fault) in self.of(id, now) {
            let chance = |what| self.chance(index, id, firing, what);
            let span = hearing.window - hearing.blanking;
            let after = match fault.kind {
                FaultKind::Noise { per_s } if per_s > 0.0 => {
                    // The wait is that for the first event of a process without memory.
                    let wait_ns = -libm::log(1.0 - chance(0)) / per_s * 1e9;
                    if wait_ns < span as f64 { hearing.blanking + wait_ns as u64 } else { continue }
                }
                FaultKind::UniformNoise { share } if chance(0) < share => {
                    hearing.blanking + (chance(1) * span as f64) as u64
                }
                FaultKind::GlitchLow { after_us, .. } if !is_edge => u64::from(after_us) * 1000,
                FaultKind::GlitchHigh { after_us, .. } if is_edge => u64::from(after_us) * 1000,
                _ => continue,
            };
            let is_sound = matches!(fault.kind, FaultKind::Noise { .. } | FaultKind::UniformNoise { .. });
            let level_over_threshold_db = if is_sound { NOISE_DB } else { GLITCH_DB };
            let at = now + after.max(1);
            heard.push(Arrival { onset: at, at, sent: now, path: EXTERNAL, level_over_threshold_db, rise: None });
        }
        heard
    }

    /// Returns the sensor on whose line this sensor's echoes appear; `None` if they appear on no line.
    pub(super) fn reported(&self, id: SensorId, now: u64, firing: u32) -> Option<u8> {
        for (index, fault) in self.of(id, now) {
            let silent = match fault.kind {
                FaultKind::Lost { share } => self.chance(index, id, firing, 2) < share,
                FaultKind::Cut => true,
                FaultKind::LostRises { every } | FaultKind::LostFalls { every } => firing.is_multiple_of(every.max(1)),
                _ => false,
            };
            if silent {
                return None;
            }
        }
        let wires = self.of(id, now).filter(|(_, fault)| fault.kind == FaultKind::EchoWires);
        Some(wires.fold(id.sensor, |sensor, (_, fault)| fault.exchanged(sensor)))
    }
}
