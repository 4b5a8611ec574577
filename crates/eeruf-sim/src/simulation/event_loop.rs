//! The event simulation: rings fire, sound travels, sensors hear, in the order of true time.
//!
//! Only two things can happen next to a robot: its ring is due, or one of its sensors hears something. So the event
//! queue is two moments for each robot, the earlier one first and an echo before the ring on a tie. What is on its way
//! is kept with the sensor that it will reach ([`Receiver`]).

use eeruf_core::{Instant, RingEvent};

use super::arrivals::{Bursts, Propagation};
use super::channels::Channels;
use super::error::SimulationError;
use super::kinematics::Kinematics;
use super::options::Options;
use super::receiver::{NEVER, Receiver};
use super::recorder::Recorder;
use super::running_ring::{RunningRing, expected_change_us, plans, start_all};
use crate::{
    geometry::Moment,
    methods::Method,
    results::Readings,
    tracing::PathsError,
    world::{Random, World},
};

/// How many events go by between two calls of `keep_going`.
const EVENTS_PER_CALL: u32 = 8192;

/// A world under way.
struct EventLoop<'a, K> {
    world: &'a World,
    kinematics: &'a mut K,
    channels: Channels<'a>,
    /// Of every sensor of the world.
    receivers: Vec<Receiver>,
    /// What each sensor reads alone, at its last firing.
    references: Vec<u64>,
    /// Where each sensor's robot was then.
    fired: Vec<Option<Moment>>,
    propagation: Propagation,
    recorder: Recorder,
    /// Firings from here on are not reported.
    end: u64,
}

/// Runs a world under a method until the time is over or the robots' kinematics say so.
pub(crate) fn run<K: Kinematics>(
    world: &World,
    method: Method,
    options: &Options,
    kinematics: &mut K,
    mut keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    let seed = Random::new(options.seed.unwrap_or(world.seed()));
    let plans = plans(world, method, options, kinematics)?;
    let mut events = EventLoop::new(world, method, options, kinematics, seed)?;
    let mut rings = start_all(world, &plans, &events.channels, seed)?;
    let longest = rings.iter().map(|ring| ring.hearing.window).max().unwrap_or(0);
    let last = events.end + longest + 1000;
    let mut bursts = Bursts::new(&world.noise(), seed);
    let mut until_call = 0;
    loop {
        let (mut now, mut whose) = (bursts.next, None);
        for (index, ring) in rings.iter().enumerate() {
            let due = ring.wakes.min(ring.hears);
            if due < now {
                (now, whose) = (due, Some(index));
            }
        }
        if now > last || !events.kinematics.advance(now) {
            break;
        }
        if until_call == 0 {
            until_call = EVENTS_PER_CALL;
            if !keep_going((now as f64 / last as f64).min(1.0)) {
                return Err(SimulationError::Stopped);
            }
        }
        until_call -= 1;
        match whose {
            Some(index) => {
                events.step(&mut rings, index, now).map_err(|error| SimulationError::paths(now, error))?;
            }
            None => events.burst(&mut rings, &mut bursts),
        }
    }
    Ok(events.recorder.finish(events.channels.into_paths()))
}

impl<'a, K: Kinematics> EventLoop<'a, K> {
    fn new(
        world: &'a World,
        method: Method,
        options: &Options,
        kinematics: &'a mut K,
        seed: Random,
    ) -> Result<Self, SimulationError> {
        let channels = Channels::new(world, kinematics).map_err(|error| SimulationError::paths(0, error))?;
        let sensors = channels.ids().len();
        // A world has at least one robot.
        let end = u64::from(options.periods) * u64::from(world.robots()[0].period.as_micros()) * 1000;
        let recorder = Recorder::new(method, options, end, channels.ids())?;
        Ok(Self {
            world,
            kinematics,
            channels,
            receivers: vec![Receiver::NEW; sensors],
            references: vec![NEVER; sensors],
            fired: vec![None; sensors],
            propagation: Propagation::new(&world.noise(), seed),
            recorder,
            end,
        })
    }

    /// One robot's next event: an echo, if one of its sensors hears something now, and whatever its ring then wants.
    fn step(&mut self, rings: &mut [RunningRing<'_>], index: usize, now: u64) -> Result<(), PathsError> {
        let ring = &mut rings[index];
        let ticks = ring.clock.ticks(now);
        let instant = ring.clock.instant(ticks);
        if ring.hears <= now {
            self.hear(ring, now, ticks, instant);
        }
        loop {
            let ring = &mut rings[index];
            let (receivers, fired) = (&self.receivers, &self.fired);
            let c = self.world.scene().air().speed_of_sound();
            let change = |sensor: u8| {
                let number = ring.sensors.start + usize::from(sensor);
                match (receivers.get(number), fired.get(number)) {
                    (Some(receiver), Some(Some(fired))) => expected_change_us(ring.robot, receiver, fired, sensor, c),
                    _ => 0,
                }
            };
            match ring.ring.poll(instant, &change) {
                None => break,
                Some(RingEvent::Fire { sensor, .. }) => {
                    let emitter = ring.sensors.start + usize::from(sensor);
                    self.fire(rings, index, emitter, now)?;
                }
                Some(RingEvent::Reading(reading)) => {
                    let number = ring.sensors.start + usize::from(reading.sensor);
                    if let Some(receiver) = self.receivers.get_mut(number) {
                        let recorded = self.recorder.record(number, &reading, receiver, self.references[number]);
                        receiver.stop();
                        if let (Some(readings), Some(fired)) = (recorded, &self.fired[number]) {
                            self.kinematics.on_reading(readings, fired);
                        }
                    }
                }
                Some(RingEvent::PeriodEnded(_)) => {}
            }
        }
        let ring = &mut rings[index];
        let deadline = ring.ring.next_deadline();
        // A deadline that has passed would be polled for again at the next tick.
        let ahead = if instant.has_reached(deadline) { 1 } else { u64::from(deadline.since(instant).as_micros()) };
        ring.wakes = ring.clock.reaches(ticks + ahead);
        Ok(())
    }

    /// Hands the ring what its sensors hear now.
    fn hear(&mut self, ring: &mut RunningRing<'_>, now: u64, ticks: u64, instant: Instant) {
        ring.hears = NEVER;
        for (sensor, number) in ring.sensors.clone().enumerate() {
            let receiver = &mut self.receivers[number];
            if receiver.next_at() <= now {
                let t_echo = ticks - ring.clock.ticks(receiver.fired);
                receiver.hear(t_echo as u32, &ring.hearing);
                // At most 64 sensors.
                ring.ring.echo(sensor as u8, instant);
            }
            ring.hears = ring.hears.min(receiver.next_at());
        }
    }

    /// A sensor fires: it begins to listen, and its sound sets out to every sensor that can hear it.
    fn fire(
        &mut self,
        rings: &mut [RunningRing<'_>],
        index: usize,
        emitter: usize,
        now: u64,
    ) -> Result<(), PathsError> {
        self.fired[emitter] = Some(self.kinematics.moment(index, now));
        self.channels.prepare(emitter, now, self.kinematics)?;
        let hearing = rings[index].hearing;
        self.references[emitter] = self.channels.reference(emitter, &hearing);
        let receiver = &mut self.receivers[emitter];
        receiver.fire(now, &hearing);
        rings[index].hears = rings[index].hears.min(receiver.next_at());
        let firing = [emitter as u64, receiver.firings.into()];
        let ids = self.channels.ids();
        let channels = self.channels.from(emitter);
        self.propagation.send(firing, now, channels, &mut self.receivers, |number, receiver, arrival| {
            let ring = &mut rings[usize::from(ids[number].robot)];
            receiver.insert(arrival, &ring.hearing);
            ring.hears = ring.hears.min(receiver.next_at());
        });
        Ok(())
    }

    /// A burst from outside, heard by all at once.
    fn burst(&mut self, rings: &mut [RunningRing<'_>], bursts: &mut Bursts) {
        let now = bursts.next;
        bursts.advance();
        for ring in rings {
            for number in ring.sensors.clone() {
                if let Some(arrival) = bursts.arrival(now) {
                    let receiver = &mut self.receivers[number];
                    receiver.insert(arrival, &ring.hearing);
                    ring.hears = ring.hears.min(receiver.next_at());
                }
            }
        }
    }
}
