//! The event simulation: rings fire, sound travels, sensors hear, in the order of true time.
//!
//! Each robot has two possible next events: its ring is due, or one of its sensors hears something. So the event queue
//! is two moments for each robot. The earlier one comes first, and on a tie the echo comes before the ring. Sound in
//! flight is stored with the sensor that it will reach ([`Receiver`]).

use std::sync::Arc;

use eeruf_core::{Instant, RingEvent};

use super::arrivals::{Bursts, Propagation};
use super::faults::{Due, Faults, Fired};
use super::filter::FiredReading;
use super::own::Own;
use super::recorder::Recorder;
use super::running_ring::{Plan, RunningRing, expected_change_us, plans, start_all};
use crate::simulation::channels::{Arrives, Channels, SharedPaths};
use crate::simulation::error::SimulationError;
use crate::simulation::kinematics::Kinematics;
use crate::simulation::options::Options;
use crate::simulation::receiver::{NEVER, Receiver};
use crate::{
    geometry::Moment,
    methods::{ChangeError, Method, OwnError},
    results::Readings,
    threads::Stop,
    tracing::PathsError,
    world::{AnySchedule, Random, Robot, World},
};

/// Number of events between two calls of `keep_going`.
const EVENTS_PER_CALL: u32 = 8192;
/// Interval at which a control loop reports the robot's motion to its ring.
const CONTROL_CYCLE_NS: u64 = 20_000_000;

/// A running world.
pub(crate) struct EventLoop<K> {
    /// The speed of sound, in m/s.
    c: f64,
    kinematics: K,
    channels: Channels,
    rings: Vec<RunningRing>,
    bursts: Bursts,
    /// Receivers of every sensor of the world.
    receivers: Vec<Receiver>,
    /// Echo time of each sensor's reading if it were alone, at its last firing.
    references: Vec<u64>,
    /// Motion of each sensor's robot at its last firing, and at the firing before that.
    fired: Vec<Option<Moment>>,
    fired_before: Vec<Option<Moment>>,
    propagation: Propagation,
    faults: Faults,
    /// Time when each sensor was triggered.
    triggered: Vec<u64>,
    /// The method by which each robot fires, and its own table.
    own_tables: Vec<(Method, Option<AnySchedule>)>,
    recorder: Recorder,
    /// The last moment for which events are reported.
    last: u64,
    stop: Stop,
    until_call: u32,
}

/// Runs a world under a method until the time is over or the robots' kinematics end the run.
pub(crate) fn run(
    world: &World,
    method: Method,
    options: &Options,
    mut own: Own,
    kinematics: &mut impl Kinematics,
    stop: &Stop,
    keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    own.check(world.robots().len())?;
    let plans = plans(world, method, options, kinematics, &own)?;
    let end = end_of(world, options.periods);
    let (world, room, stop) = (&Arc::new(world.clone()), expected(world, end), stop.clone());
    let mut events = EventLoop::new(world, &plans, method, options, kinematics, &mut own, Some(end), room, stop)?;
    events.run_until(u64::MAX, keep_going)?;
    Ok(events.take(end as f64 * 1e-9))
}

/// Returns the time when this many periods of a world's first robot are over, in true nanoseconds.
pub(crate) fn end_of(world: &World, periods: u32) -> u64 {
    // A world has at least one robot.
    u64::from(periods) * u64::from(world.robots()[0].period.as_micros()) * 1000
}

impl<K: Kinematics> EventLoop<K> {
    /// Makes the state before the first event. Firings from `end` on, if given, are not reported. The recorder has room
    /// for `room` readings.
    #[expect(clippy::too_many_arguments, reason = "each of them once, in two places")]
    pub(crate) fn new(
        world: &Arc<World>,
        plans: &[Plan],
        method: Method,
        options: &Options,
        kinematics: K,
        own: &mut Own,
        end: Option<u64>,
        room: u64,
        stop: Stop,
    ) -> Result<Self, SimulationError> {
        let seed = Random::new(options.seed.unwrap_or(world.seed()));
        let channels =
            Channels::new(world, &kinematics, stop.clone()).map_err(|error| SimulationError::paths(0, error))?;
        let rings = start_all(world, plans, options, &channels, seed, own, end.is_some())?;
        let sensors = channels.ids().len();
        let longest = rings.iter().map(RunningRing::longest_window).max().unwrap_or(0);
        let recorder = Recorder::new(method, end.unwrap_or(u64::MAX), room, channels.ids(), own)?;
        Ok(Self {
            c: world.scene().air().speed_of_sound(),
            kinematics,
            channels,
            rings,
            bursts: Bursts::new(&world.noise(), seed),
            receivers: vec![Receiver::NEW; sensors],
            references: vec![NEVER; sensors],
            fired: vec![None; sensors],
            fired_before: vec![None; sensors],
            propagation: Propagation::new(world, seed),
            faults: Faults::new(world, seed),
            triggered: vec![0; sensors],
            own_tables: plans.iter().map(|of| (of.method, of.firing.as_ref().map(|plan| plan.schedule))).collect(),
            recorder,
            last: end.map_or(u64::MAX - 1, |end| end + longest + 1000),
            stop,
            until_call: 0,
        })
    }

    /// Copies the state, with a separate switch to stop it; `None` if the caller's own firing method or filter cannot
    /// be copied.
    pub(crate) fn copy(&self, stop: Stop) -> Option<Self>
    where
        K: Clone,
    {
        Some(Self {
            c: self.c,
            kinematics: self.kinematics.clone(),
            channels: self.channels.copy(stop.clone()),
            rings: self.rings.iter().map(RunningRing::copy).collect::<Option<_>>()?,
            bursts: self.bursts.clone(),
            receivers: self.receivers.clone(),
            references: self.references.clone(),
            fired: self.fired.clone(),
            fired_before: self.fired_before.clone(),
            propagation: self.propagation.clone(),
            faults: self.faults.clone(),
            triggered: self.triggered.clone(),
            own_tables: self.own_tables.clone(),
            recorder: self.recorder.copy()?,
            last: self.last,
            stop,
            until_call: self.until_call,
        })
    }

    /// Runs until a time, in true nanoseconds; events at that time wait for the next call. `keep_going` is sometimes
    /// called with the elapsed share of the whole time. Returns true if more events follow.
    pub(crate) fn run_until(
        &mut self,
        until: u64,
        mut keep_going: impl FnMut(f64) -> bool,
    ) -> Result<bool, SimulationError> {
        let mut rings = core::mem::take(&mut self.rings);
        let more = self.run_rings(&mut rings, until, false, &mut keep_going);
        self.rings = rings;
        Ok(more?.0)
    }

    /// Runs at most to the first event that yields readings. Returns true if more events follow, and the time of that
    /// event, if there was one.
    pub(crate) fn run_to_reading(
        &mut self,
        until: u64,
        mut keep_going: impl FnMut(f64) -> bool,
    ) -> Result<(bool, Option<u64>), SimulationError> {
        let mut rings = core::mem::take(&mut self.rings);
        let more = self.run_rings(&mut rings, until, true, &mut keep_going);
        self.rings = rings;
        more
    }

    fn run_rings(
        &mut self,
        rings: &mut [RunningRing],
        until: u64,
        to_reading: bool,
        keep_going: &mut impl FnMut(f64) -> bool,
    ) -> Result<(bool, Option<u64>), SimulationError> {
        loop {
            let (mut now, mut whose) = (self.bursts.next, None);
            for (index, ring) in rings.iter().enumerate() {
                let due = ring.wakes.min(ring.hears);
                if due < now {
                    (now, whose) = (due, Some(index));
                }
            }
            let changes = self.faults.next() <= now && self.faults.next() < until;
            if changes && now <= self.last {
                self.change(rings)?;
                continue;
            }
            if now >= until && now <= self.last {
                return Ok((true, None));
            }
            if now > self.last || !self.kinematics.advance(now) {
                return Ok((false, None));
            }
            if self.until_call == 0 {
                self.until_call = EVENTS_PER_CALL;
                if !keep_going((now as f64 / self.last as f64).min(1.0)) || self.stop.is_stopped() {
                    return Err(SimulationError::Stopped);
                }
            }
            self.until_call -= 1;
            self.recorder.make_room()?;
            match whose {
                Some(index) => self.step(rings, index, now)?,
                None => self.burst(rings),
            }
            if to_reading && !self.recorder.is_empty() {
                return Ok((true, Some(now)));
            }
        }
    }

    /// Applies the faults' changes that are due: tables, and objects in the scene.
    fn change(&mut self, rings: &mut [RunningRing]) -> Result<(), SimulationError> {
        let now = self.faults.next();
        let at_s = now as f64 * 1e-9;
        let due = self.faults.due(now).map_err(|error| SimulationError::Fault { at_s, error })?;
        for change in due {
            match change {
                Due::Table(robot, table) => {
                    let Some(&(method, own)) = self.own_tables.get(robot) else { continue };
                    let changed = match (table.map(|table| *table).or(own), rings.get_mut(robot)) {
                        (Some(table), Some(ring)) => ring.ring.change_schedule(&table),
                        _ => Err(ChangeError::Fixed),
                    };
                    changed.map_err(|error| SimulationError::change(robot, method, error))?;
                }
                Due::Scene(world) => {
                    let moved = self.channels.change_scene(world, &self.kinematics);
                    moved.map_err(|error| SimulationError::paths(now, error))?;
                }
            }
        }
        Ok(())
    }

    /// Takes the readings since the last call, with a duration of this many seconds.
    pub(crate) fn take(&mut self, duration_s: f64) -> Readings {
        self.recorder.take(self.channels.paths(), duration_s)
    }

    /// Changes to the scene of another world with the same robots.
    pub(crate) fn change_scene(&mut self, world: Arc<World>, now: u64) -> Result<(), SimulationError> {
        let c = world.scene().air().speed_of_sound();
        let at_s = now as f64 * 1e-9;
        let world = self.faults.begin_anew(world, now).map_err(|error| SimulationError::Fault { at_s, error })?;
        let changed = self.channels.change_scene(world, &self.kinematics);
        changed.map_err(|error| SimulationError::paths(now, error))?;
        self.c = c;
        Ok(())
    }

    /// Shares the paths of the current scene with other simulations.
    pub(crate) fn share(&mut self, shared: Arc<SharedPaths>) {
        self.channels.share(shared);
    }

    /// Changes a robot's ring to another schedule for the same number of sensors, at the end of its period.
    pub(crate) fn change_schedule(&mut self, robot: usize, schedule: &AnySchedule) -> Result<(), ChangeError> {
        self.rings.get_mut(robot).map_or(Err(ChangeError::Fixed), |ring| ring.ring.change_schedule(schedule))
    }

    /// Returns the robots' motions.
    pub(crate) fn kinematics(&self) -> &K {
        &self.kinematics
    }

    /// Returns the robots for steering; from now on something may move.
    pub(crate) fn steer(&mut self) -> &mut K {
        self.channels.set_moving();
        &mut self.kinematics
    }

    /// Processes one robot's next event: an echo, if one of its sensors hears something now, and the ring's response.
    fn step(&mut self, rings: &mut [RunningRing], index: usize, now: u64) -> Result<(), SimulationError> {
        let own = |what: &'static str| {
            move |error: OwnError| SimulationError::Own { robot: index, what, at_s: now as f64 * 1e-9, error }
        };
        let ring = &mut rings[index];
        let ticks = ring.clock.ticks(now);
        let instant = ring.clock.instant(ticks);
        if ring.hears <= now {
            self.hear(ring, now, ticks, instant);
        }
        if ring.tells <= now && self.kinematics.moves() {
            let Moment { velocity, turn_rad_s, .. } = self.kinematics.moment(index, now);
            let [speed, turn] = [velocity.norm(), turn_rad_s.abs()].map(|per_s| (1e3 * per_s).round() as u32);
            ring.ring.moving(speed, turn, instant);
            ring.tells = now + CONTROL_CYCLE_NS;
        }
        loop {
            let ring = &mut rings[index];
            let (before, fired) = (&self.fired_before, &self.fired);
            let (c, robot) = (self.c, &ring.world.robots()[ring.robot]);
            let change = |sensor: u8| {
                let number = ring.sensors.start + usize::from(sensor);
                match (before.get(number), fired.get(number)) {
                    (Some(Some(before)), Some(Some(fired))) => {
                        expected_change_us(robot, sensor, &before.pose, &fired.pose, c)
                    }
                    _ => 0,
                }
            };
            match ring.ring.poll(instant, &change) {
                None => break,
                Some(RingEvent::Fire { sensor, .. }) => {
                    let emitter = ring.sensors.start + usize::from(sensor);
                    self.fire(rings, index, emitter, now).map_err(|error| SimulationError::paths(now, error))?;
                }
                Some(RingEvent::Reading(reading)) => {
                    let expected_change_us = change(reading.sensor);
                    let number = ring.sensors.start + usize::from(reading.sensor);
                    let stands_for = ring.ring.stands_for(reading.sensor).into();
                    if let (Some(receiver), Some(fired)) = (self.receivers.get_mut(number), &self.fired[number]) {
                        let fired_from = fired.pose * robot.sensors[usize::from(reading.sensor)];
                        let (echoes, triggered) = (receiver.heard(), self.triggered[number]);
                        let fired_s = triggered as f64 * 1e-9;
                        let firing = FiredReading { reading: &reading, echoes, fired_s, expected_change_us };
                        let reference = self.references[number];
                        let recorded =
                            self.recorder.record(number, &firing, stands_for, triggered, reference, &fired_from);
                        receiver.stop();
                        if let Some(readings) = recorded.map_err(own("filter"))? {
                            self.kinematics.on_reading(readings, fired);
                        }
                    }
                }
                Some(RingEvent::PeriodEnded(_)) => {}
            }
        }
        let ring = &mut rings[index];
        if let Some(error) = ring.ring.error() {
            return Err(own("firing")(error.clone()));
        }
        let deadline = ring.ring.next_deadline();
        // After a missed deadline the ring is polled again at the next tick.
        let ahead = if instant.has_reached(deadline) { 1 } else { u64::from(deadline.since(instant).as_micros()) };
        ring.wakes = ring.clock.reaches(ticks + ahead);
        Ok(())
    }

    /// Passes the sounds that the ring's sensors hear now to the ring.
    fn hear(&mut self, ring: &mut RunningRing, now: u64, ticks: u64, instant: Instant) {
        ring.hears = NEVER;
        for (sensor, number) in ring.sensors.clone().enumerate() {
            let receiver = &mut self.receivers[number];
            if receiver.next_at() <= now {
                // At most 64 sensors.
                let sensor = sensor as u8;
                let says = if self.faults.any() {
                    self.faults.reported(self.channels.ids()[number], now, receiver.firings)
                } else {
                    Some(sensor)
                };
                let t_echo = |triggered: u64| (ticks - ring.clock.ticks(triggered)) as u32;
                match says {
                    Some(says) if says == sensor => {
                        receiver.hear(t_echo(self.triggered[number]), ring.hearing_of(number));
                        ring.ring.echo(sensor, instant);
                    }
                    Some(says) => {
                        let (heard, number) = (receiver.lose(), ring.sensors.start + usize::from(says));
                        let triggered = self.triggered[number];
                        let listens = ring.hearing_of(number);
                        let in_time = (triggered + listens.blanking..=triggered + listens.window).contains(&now);
                        if let Some(heard) = heard.filter(|_| in_time) {
                            self.receivers[number].report(t_echo(triggered), heard, listens);
                            ring.ring.echo(says, instant);
                        }
                    }
                    None => {
                        receiver.lose();
                    }
                }
            }
            ring.hears = ring.hears.min(self.receivers[number].next_at());
        }
    }

    /// Triggers a sensor. It (or the sensor on its trigger wire) begins to listen, and sends its sound to every sensor
    /// that can hear it.
    fn fire(&mut self, rings: &mut [RunningRing], index: usize, triggered: usize, now: u64) -> Result<(), PathsError> {
        self.triggered[triggered] = now;
        self.receivers[triggered].forget();
        let id = self.channels.ids()[triggered];
        let fired = if self.faults.any() { self.faults.fired(id, now) } else { Fired::Sends(id.sensor, 0) };
        let Fired::Sends(sensor, late) = fired else {
            self.receivers[triggered].firings += 1;
            self.receivers[triggered].stop();
            return self.prepare(triggered, triggered, &rings[index], now);
        };
        let emitter = rings[index].sensors.start + usize::from(sensor);
        self.prepare(triggered, emitter, &rings[index], now)?;
        self.send(rings, index, emitter, now + late);
        Ok(())
    }

    /// Finds the reading that a triggered sensor would have alone, and the paths from the sensor that sends.
    fn prepare(&mut self, triggered: usize, emitter: usize, ring: &RunningRing, now: u64) -> Result<(), PathsError> {
        if self.channels.moves() {
            // Paths are searched for again, which takes as long as many events.
            self.until_call = self.until_call.saturating_sub(EVENTS_PER_CALL / 64);
        }
        self.fired_before[triggered] = self.fired[triggered];
        self.fired[triggered] = Some(self.kinematics.moment(usize::from(self.channels.ids()[triggered].robot), now));
        // Inaudible paths need not be evaluated, unless random numbers depend on the paths found.
        let (receivers, propagation) = (&self.receivers, &self.propagation);
        let arrives = |number: usize, at: u64, slack: u64| {
            let receiver = receivers.get(number);
            number == triggered
                || number == emitter
                || receiver.is_some_and(|receiver| receiver.cares(at, propagation.slack(slack)))
        };
        let arrives: Option<Arrives<'_>> = if propagation.is_keyed() { Some(&arrives) } else { None };
        self.channels.prepare(triggered, now, &self.kinematics, arrives)?;
        self.references[triggered] = self.channels.reference(triggered, ring.hearing_of(triggered));
        if emitter != triggered {
            self.channels.prepare(emitter, now, &self.kinematics, arrives)?;
        }
        Ok(())
    }

    /// Starts listening with a prepared sensor, and sends its sound.
    fn send(&mut self, rings: &mut [RunningRing], index: usize, emitter: usize, now: u64) {
        let hearing = *rings[index].hearing_of(emitter);
        let receiver = &mut self.receivers[emitter];
        receiver.listen(now, &hearing);
        let ids = self.channels.ids();
        if self.faults.any() {
            for arrival in self.faults.heard_beside(ids[emitter], now, receiver.firings, &hearing) {
                receiver.insert(arrival, &hearing);
            }
        }
        rings[index].hears = rings[index].hears.min(receiver.next_at());
        let firing = [emitter as u64, receiver.firings.into()];
        let channels = self.channels.from(emitter);
        self.propagation.send(firing, now, channels, &mut self.receivers, |number, receiver, arrival| {
            let ring = &mut rings[usize::from(ids[number].robot)];
            receiver.insert(arrival, ring.hearing_of(number));
            ring.hears = ring.hears.min(receiver.next_at());
        });
    }

    /// Lets a burst from outside reach all sensors at once.
    fn burst(&mut self, rings: &mut [RunningRing]) {
        let bursts = &mut self.bursts;
        let now = bursts.next;
        bursts.advance();
        for ring in rings {
            for number in ring.sensors.clone() {
                if let Some(arrival) = bursts.arrival(now) {
                    let receiver = &mut self.receivers[number];
                    receiver.insert(arrival, ring.hearing_of(number));
                    ring.hears = ring.hears.min(receiver.next_at());
                }
            }
        }
    }
}

/// Estimates the readings in this many periods of a world's first robot, for the memory to reserve.
pub fn expected_readings(world: &World, periods: u32) -> u64 {
    expected(world, end_of(world, periods))
}

/// Estimates the readings of all rings until a time in true nanoseconds: one per sensor and period.
fn expected(world: &World, end: u64) -> u64 {
    let of = |robot: &Robot| {
        let period = u64::from(robot.period.as_micros()) * 1000;
        (end / period.max(1) + 1).saturating_mul(robot.sensors.len() as u64)
    };
    world.robots().iter().map(of).fold(0, u64::saturating_add)
}
