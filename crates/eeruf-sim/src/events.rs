//! The event simulation: rings fire, sound travels, sensors hear, in the order of true time.
//!
//! Only two things can happen next to a robot: its ring is due, or one of its sensors hears something. So the event queue is
//! two moments for each robot, the earlier one first and an echo before the ring on a tie. What is on its way is kept with
//! the sensor that it will reach ([`Detector`]).

use eeruf_core::{Instant, RingEvent};

use crate::{
    clock::Ticker,
    detector::{Arrival, Detector, EXTERNAL, Hearing, MAX_ECHOES, NEVER},
    drive::{Drive, drive, rungs, soonest_refire},
    error::PathsError,
    guide::Guide,
    judge::Judge,
    method::{Method, schedule_for},
    motion::Moment,
    noise::{Chance, FARTHEST, Normal},
    readings::Readings,
    robot::{Robot, offset},
    simulate::{Options, SimulationError},
    ways::Ways,
    world::World,
};

/// How many events go by between two calls of `keep_going`.
const EVENTS_PER_CALL: u32 = 8192;
// What the streams of chance are for.
pub(crate) const ARRIVALS: u64 = 1;
const BURSTS: u64 = 2;
const DITHER: u64 = 3;

/// A robot under way.
struct Crew<'a> {
    robot: &'a Robot,
    ring: Box<dyn Drive + 'a>,
    clock: Ticker,
    hearing: Hearing,
    /// Its sensors among all of the world's.
    sensors: core::ops::Range<usize>,
    /// When its ring is due.
    wakes: u64,
    /// When one of its sensors hears something.
    hears: u64,
}

/// A world under way.
struct Course<'a, G> {
    world: &'a World,
    guide: &'a mut G,
    ways: Ways<'a>,
    detectors: Vec<Detector>,
    /// What each sensor reads alone, at its last firing.
    references: Vec<u64>,
    /// Where each sensor's robot was then.
    fired: Vec<Option<Moment>>,
    chance: Chance,
    normal: &'static Normal,
    judge: Judge,
    /// Firings from here on are not reported.
    end: u64,
}

pub(crate) fn run<G: Guide>(
    world: &World,
    method: Method,
    options: &Options,
    guide: &mut G,
    mut keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    let seed = Chance::new(options.seed.unwrap_or(world.seed()));
    let schedules = schedules(world, method, options, guide)?;
    let mut course = Course::new(world, method, options, guide, seed)?;
    let mut crews = Vec::with_capacity(world.robots().len());
    for (index, robot) in world.robots().iter().enumerate() {
        let method = course.guide.method(index, method);
        crews.push(crew(method, index, robot, &schedules[index], &course.ways, world, seed)?);
    }
    let longest = crews.iter().map(|crew| crew.hearing.window).max().unwrap_or(0);
    let last = course.end + longest + 1000;
    let mut bursts = Bursts::new(world, seed);
    let mut until_call = 0;
    loop {
        let (mut now, mut whose) = (bursts.next, None);
        for (index, crew) in crews.iter().enumerate() {
            let due = crew.wakes.min(crew.hears);
            if due < now {
                (now, whose) = (due, Some(index));
            }
        }
        if now > last || !course.guide.advance(now) {
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
            Some(index) => course.step(&mut crews, index, now).map_err(|error| paths_error(now, error))?,
            None => course.burst(&mut crews, &mut bursts, world),
        }
    }
    Ok(course.judge.finish(course.ways.paths))
}

fn paths_error(now: u64, error: PathsError) -> SimulationError {
    SimulationError::Paths { at_s: now as f64 * 1e-9, error }
}

/// The schedules of each robot.
fn schedules(
    world: &World,
    method: Method,
    options: &Options,
    guide: &impl Guide,
) -> Result<Vec<Vec<crate::method::AnySchedule>>, SimulationError> {
    let robots = world.robots().iter().enumerate();
    let all =
        robots.map(|(index, robot)| {
            let method = guide.method(index, method);
            let base = schedule_for(method, robot, options.best.as_ref())
                .map_err(|error| SimulationError::Schedule { robot: index, method, error })?;
            rungs(method, index, robot, base)
        });
    all.collect()
}

fn crew<'a>(
    method: Method,
    index: usize,
    robot: &'a Robot,
    schedules: &'a [crate::method::AnySchedule],
    ways: &Ways<'_>,
    world: &World,
    seed: Chance,
) -> Result<Crew<'a>, SimulationError> {
    let clock = Ticker::new(robot.clock);
    let start = u64::from(robot.start.as_micros());
    let dither = seed.of(DITHER).of(index as u64);
    let ring = drive(method, index, robot, schedules, dither, clock.instant(start))?;
    let true_ns = |time: eeruf_core::Micros| clock.true_ns(time.as_micros());
    let c = world.scene().air().speed_of_sound();
    let hearing = Hearing {
        blanking: true_ns(robot.blanking),
        window: true_ns(robot.window),
        // Two ticks less, since the clock rounds.
        refire: true_ns(soonest_refire(method, robot)).saturating_sub(2000),
        dead_time: (robot.transducer.burst_s() * 1e9) as u64,
        echoes: if method == Method::MultiEcho { MAX_ECHOES } else { 1 },
        gain: robot.transducer.gain,
        gain_full_s: 2.0 * robot.transducer.max_range_m / c,
    };
    let first = ways.first_of(index);
    let sensors = first..first + robot.sensors.len();
    Ok(Crew { robot, ring, clock, hearing, sensors, wakes: clock.reaches(start), hears: NEVER })
}

impl<'a, G: Guide> Course<'a, G> {
    fn new(
        world: &'a World,
        method: Method,
        options: &Options,
        guide: &'a mut G,
        seed: Chance,
    ) -> Result<Self, SimulationError> {
        let ways = Ways::new(world, guide).map_err(|error| paths_error(0, error))?;
        let sensors = ways.ids().len();
        // A world has at least one robot.
        let end = u64::from(options.periods) * u64::from(world.robots()[0].period.as_micros()) * 1000;
        let judge = Judge::new(method, options, end, ways.ids())?;
        Ok(Self {
            world,
            guide,
            ways,
            detectors: vec![Detector::NEW; sensors],
            references: vec![NEVER; sensors],
            fired: vec![None; sensors],
            chance: seed.of(ARRIVALS),
            normal: Normal::shared(),
            judge,
            end,
        })
    }

    /// One robot's next event: an echo, if one of its sensors hears something now, and whatever its ring then wants.
    fn step(&mut self, crews: &mut [Crew<'_>], index: usize, now: u64) -> Result<(), PathsError> {
        let crew = &mut crews[index];
        let ticks = crew.clock.ticks(now);
        let instant = crew.clock.instant(ticks);
        if crew.hears <= now {
            self.hear(crew, now, ticks, instant);
        }
        loop {
            let crew = &mut crews[index];
            let (detectors, fired) = (&self.detectors, &self.fired);
            let c = self.world.scene().air().speed_of_sound();
            let change = |sensor: u8| {
                let place = crew.sensors.start + usize::from(sensor);
                match (detectors.get(place), fired.get(place)) {
                    (Some(detector), Some(Some(fired))) => expected_change_us(crew.robot, detector, fired, sensor, c),
                    _ => 0,
                }
            };
            match crew.ring.poll(instant, &change) {
                None => break,
                Some(RingEvent::Fire(sensor)) => self.fire(crews, index, crew_sensor(index, crews, sensor), now)?,
                Some(RingEvent::Reading(reading)) => {
                    let place = crew.sensors.start + usize::from(reading.sensor);
                    if let Some(detector) = self.detectors.get_mut(place) {
                        let told = self.judge.tell(place, &reading, detector, self.references[place]);
                        detector.stop();
                        if let (Some(readings), Some(fired)) = (told, &self.fired[place]) {
                            self.guide.told(readings, fired);
                        }
                    }
                }
                Some(RingEvent::PeriodEnded(_)) => {}
            }
        }
        let crew = &mut crews[index];
        let deadline = crew.ring.next_deadline();
        // A deadline that has passed would be polled for again at the next tick.
        let ahead = if instant.has_reached(deadline) { 1 } else { u64::from(deadline.since(instant).as_micros()) };
        crew.wakes = crew.clock.reaches(ticks + ahead);
        Ok(())
    }

    /// Hands the ring what its sensors hear now.
    fn hear(&mut self, crew: &mut Crew<'_>, now: u64, ticks: u64, instant: Instant) {
        crew.hears = NEVER;
        for (sensor, place) in crew.sensors.clone().enumerate() {
            let detector = &mut self.detectors[place];
            if detector.next_at() <= now {
                let t_echo = ticks - crew.clock.ticks(detector.fired);
                detector.hear(t_echo as u32, &crew.hearing);
                // At most 64 sensors.
                crew.ring.echo(sensor as u8, instant);
            }
            crew.hears = crew.hears.min(detector.next_at());
        }
    }

    /// A sensor fires: it begins to listen, and its sound sets out to every sensor that can hear it.
    fn fire(&mut self, crews: &mut [Crew<'_>], index: usize, emitter: usize, now: u64) -> Result<(), PathsError> {
        self.fired[emitter] = Some(self.guide.moment(index, now));
        self.ways.prepare(emitter, now, self.guide)?;
        let hearing = crews[index].hearing;
        self.references[emitter] = self.ways.reference(emitter, &hearing);
        let detector = &mut self.detectors[emitter];
        detector.fire(now, &hearing);
        crews[index].hears = crews[index].hears.min(detector.next_at());
        let chance = self.chance.of(emitter as u64).of(detector.firings.into());
        let noise = self.world.noise();
        let (fading, jitter) = (noise.fading_db_rms as f32, (noise.jitter_us_rms * 1000.0) as f32);
        let slack = (jitter * FARTHEST).ceil() as u64;
        for way in self.ways.from(emitter) {
            let place = way.receiver as usize;
            let nominal = now + way.delay;
            if !self.detectors[place].cares(nominal, slack) {
                continue;
            }
            let [fades, shifts] = self.normal.pair(chance.of(way.path.into()).bits());
            let margin_db = way.margin_db + fading * fades;
            if margin_db < 0.0 {
                continue;
            }
            let at = nominal.saturating_add_signed((jitter * shifts) as i64).max(now + 1);
            let robot = usize::from(self.ways.ids()[place].robot);
            let crew = &mut crews[robot];
            let arrival = Arrival { at, sent: now, path: way.path, margin_db };
            self.detectors[place].insert(arrival, &crew.hearing);
            crew.hears = crew.hears.min(self.detectors[place].next_at());
        }
        Ok(())
    }

    /// A burst from outside, heard by all at once.
    fn burst(&mut self, crews: &mut [Crew<'_>], bursts: &mut Bursts, world: &World) {
        let noise = world.noise();
        let now = bursts.next;
        bursts.advance(noise.bursts_per_s);
        for crew in crews {
            for place in crew.sensors.clone() {
                let [fades, _] = self.normal.pair(bursts.chance.bits());
                let margin_db = noise.burst_db as f32 + noise.fading_db_rms as f32 * fades;
                if margin_db >= 0.0 {
                    let arrival = Arrival { at: now, sent: now, path: EXTERNAL, margin_db };
                    self.detectors[place].insert(arrival, &crew.hearing);
                    crew.hears = crew.hears.min(self.detectors[place].next_at());
                }
            }
        }
    }
}

fn crew_sensor(index: usize, crews: &[Crew<'_>], sensor: u8) -> usize {
    crews[index].sensors.start + usize::from(sensor)
}

/// By how much a good reading of a sensor should have changed since its firing before: `-2 v dt / c`, with `v` the speed at
/// which the robot carried it forward when it fired. Nothing without odometry.
fn expected_change_us(robot: &Robot, detector: &Detector, fired: &Moment, sensor: u8, speed_of_sound: f64) -> i32 {
    let Some(pose) = robot.sensors.get(usize::from(sensor)) else { return 0 };
    if !robot.odometry || detector.firings < 2 {
        return 0;
    }
    let heading = fired.pose.rotation * pose.rotation;
    let velocity = fired.velocity_at(fired.pose.rotation * offset(pose));
    let v = velocity.x * heading.re + velocity.y * heading.im;
    let dt_us = (detector.fired - detector.fired_before) as f64 * 1e-3;
    (-2.0 * v * dt_us / speed_of_sound).round() as i32
}

/// When bursts from outside come.
struct Bursts {
    chance: Chance,
    next: u64,
}

impl Bursts {
    fn new(world: &World, seed: Chance) -> Self {
        let mut bursts = Self { chance: seed.of(BURSTS), next: 0 };
        bursts.advance(world.noise().bursts_per_s);
        bursts
    }

    fn advance(&mut self, rate: f64) {
        self.next = if rate > 0.0 {
            // At least a nanosecond on, so that time passes.
            self.next.saturating_add(1 + (self.chance.until_next(rate) * 1e9) as u64)
        } else {
            NEVER
        };
    }
}
