//! Crosstalk matrix: the critical paths of a ring at one pose, from each emitter to each receiver, that are loud
//! enough.

use super::audibility::Audibility;
use super::error::PathsError;
use super::limits::{Limits, Matters};
use super::paths::Paths;
use super::poles::Asked;
use super::tracer::{Heights, Tracer};
use crate::{
    acoustics::{Piston, Transducer},
    geometry::{Point, Pose, Vector},
    scene::{Bounce, Scene},
};

/// An audible path from an emitter to a receiver. With `emitter == receiver` it is the sensor's own echo; otherwise it
/// is a critical path, one that can cause crosstalk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalPath {
    /// Index of the sensor that fires; 0 if there is only one emitter.
    pub emitter: u32,
    /// Index of the sensor that hears the sound.
    pub receiver: u32,
    /// Length in metres.
    pub length_m: f64,
    /// Amplitude relative to 1 m on axis, both patterns included.
    pub amplitude: f64,
    /// Number of bounces.
    pub order: u32,
    /// Direction of departure, in the scene's frame.
    pub departure_rad: f64,
    /// Direction in which the receiver sees the path, in the scene's frame.
    pub arrival_rad: f64,
    /// The elevations of departure and arrival in radians, upwards positive; 0 in a flat scene.
    pub elevations_rad: [f64; 2],
    /// Amplitude without the patterns.
    bare: f64,
    bounces: [u32; 2],
}

impl CriticalPath {
    /// Returns true if the path causes *direct* crosstalk: without a bounce or by a single reflection. All others are
    /// *indirect*.
    pub fn is_direct(&self) -> bool {
        self.order <= 1
    }
}

/// The input of a [`CrosstalkMatrix`]: the sensors, their hearing and the scene.
#[derive(Clone, Copy, Debug)]
pub struct CrosstalkQuery<'a> {
    /// The scene in which the sound travels.
    pub scene: &'a Scene,
    /// The transducers' poses in the scene; each heads along its pose's x axis.
    pub sensors: &'a [Pose],
    /// The transducer of the receivers, and of the emitters unless others are given.
    pub transducer: &'a Transducer,
    /// Limits up to which the sound is followed.
    pub limits: Limits,
    /// Threshold of hearing, compared with the [received level](Transducer::received).
    pub floor: f64,
    /// The least amplitude of straight paths between two different sensors, carried by their mounting, relative to two
    /// sensors that face each other at the same distance; 0 if only the patterns count.
    pub coupling: f64,
    /// The emitters' and the sensors' heights above the floor, in metres, if the scene has a [room](Scene::room).
    /// Missing heights are [`DEFAULT_HEIGHT_M`](crate::DEFAULT_HEIGHT_M).
    pub heights_m: [&'a [f64]; 2],
}

impl<'a> CrosstalkQuery<'a> {
    /// Makes a query without direct coupling, with all sensors at the same height.
    pub const fn new(
        scene: &'a Scene,
        sensors: &'a [Pose],
        transducer: &'a Transducer,
        limits: Limits,
        floor: f64,
    ) -> Self {
        Self { scene, sensors, transducer, limits, floor, coupling: 0.0, heights_m: [&[]; 2] }
    }
}

/// All paths between the sensors of a ring, by emitter, receiver and length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrosstalkMatrix {
    emitters: usize,
    sensors: usize,
    paths: Vec<CriticalPath>,
    /// Start of each pair's paths, with one more entry at the end.
    starts: Vec<u32>,
    bounces: Vec<Bounce>,
    // These are kept between computations only for their memory.
    positions: Vec<Point>,
    found: Paths,
    straight: Paths,
    audibility: Option<Audibility>,
}

impl CrosstalkMatrix {
    /// Makes an empty matrix, to be [computed](Self::compute).
    pub fn new() -> Self {
        Self::default()
    }

    /// Traces each sensor once as the emitter and keeps the audible paths. The matrix is valid until something moves.
    ///
    /// # Errors
    /// Errors of [`Tracer::trace`]; the matrix is then empty.
    pub fn compute(&mut self, tracer: &mut Tracer, query: &CrosstalkQuery<'_>) -> Result<(), PathsError> {
        self.fill(tracer, query.sensors, query.transducer, query, None)
    }

    /// Computes the matrix like [`compute`](Self::compute) for a single emitter, which has number 0 and need not be one
    /// of the sensors. Use it for a world in which things move from firing to firing.
    ///
    /// # Errors
    /// See [`compute`](Self::compute).
    pub fn compute_from(
        &mut self,
        emitter: &Pose,
        tracer: &mut Tracer,
        query: &CrosstalkQuery<'_>,
    ) -> Result<(), PathsError> {
        self.fill(tracer, core::slice::from_ref(emitter), query.transducer, query, None)
    }

    /// Computes the matrix like [`compute`](Self::compute) for separate emitters of another kind. It uses the emitters'
    /// frequency and pattern of departure, and the sensors' pattern of arrival, gain and floor.
    ///
    /// # Errors
    /// See [`compute`](Self::compute).
    pub fn compute_between(
        &mut self,
        emitters: &[Pose],
        sending: &Transducer,
        tracer: &mut Tracer,
        query: &CrosstalkQuery<'_>,
    ) -> Result<(), PathsError> {
        self.fill(tracer, emitters, sending, query, None)
    }

    /// Computes the matrix without paths that do not matter.
    pub(crate) fn compute_what_matters(
        &mut self,
        emitters: &[Pose],
        sending: &Transducer,
        tracer: &mut Tracer,
        query: &CrosstalkQuery<'_>,
        matters: Option<Matters<'_>>,
    ) -> Result<(), PathsError> {
        self.fill(tracer, emitters, sending, query, matters)
    }

    fn fill(
        &mut self,
        tracer: &mut Tracer,
        emitters: &[Pose],
        sending: &Transducer,
        query: &CrosstalkQuery<'_>,
        matters: Option<Matters<'_>>,
    ) -> Result<(), PathsError> {
        let CrosstalkQuery { scene, sensors, transducer, limits, floor, coupling, heights_m } = *query;
        let air = scene.air();
        let departing = sending.piston(air);
        // Sound arrives with the emitter's frequency.
        let arriving = Transducer { frequency_hz: sending.frequency_hz, ..*transducer }.piston(air);
        (self.emitters, self.sensors) = (0, 0);
        self.paths.clear();
        self.starts.clear();
        self.bounces.clear();
        self.positions.clear();
        self.positions.extend(sensors.iter().map(|sensor| Point::from(sensor.translation.vector)));
        tracer.frequency_hz = sending.frequency_hz;
        tracer.burst_cycles = sending.cycles;
        let in_room = scene.room().is_some();
        // Paths that stay too faint even with the gain of a panel are left out.
        let (patterns, faintest, loss_per_m) =
            ([departing, arriving], floor / tracer.loudest(), tracer.loss_per_m(air));
        let audibility = match &mut self.audibility {
            Some(known) if known.is_for(&patterns, in_room, faintest, loss_per_m) => known,
            audibility => audibility.insert(Audibility::new(patterns, in_room, faintest, loss_per_m)),
        };
        for (emitter, pose) in emitters.iter().enumerate() {
            let heading_rad = pose.rotation.angle();
            audibility.aim(heading_rad, sensors.iter().map(|sensor| sensor.rotation * Vector::x()));
            // The wave correction may slightly raise a pole's echo.
            let audibility = if tracer.pole_waves { None } else { Some(&*audibility) };
            let source = Point::from(pose.translation.vector);
            // The mounting may carry louder sound than the patterns allow.
            self.straight.clear();
            let source_m = heights_m[0].get(emitter).copied().unwrap_or(Heights::DEFAULT.source_m);
            let heights = Heights { source_m, receivers_m: heights_m[1] };
            let coupled = Limits { max_order: 0, ..limits };
            let traced = if coupling > 0.0 {
                tracer.trace_audible(
                    None,
                    matters,
                    scene,
                    source,
                    &self.positions,
                    heights,
                    coupled,
                    Asked::Once,
                    &mut self.straight,
                )
            } else {
                Ok(())
            };
            let traced = traced.and_then(|()| {
                let asked = match emitter {
                    _ if emitters.len() == 1 => Asked::Once,
                    0 => Asked::First,
                    _ => Asked::Again,
                };
                tracer.trace_audible(
                    audibility,
                    matters,
                    scene,
                    source,
                    &self.positions,
                    heights,
                    limits,
                    asked,
                    &mut self.found,
                )
            });
            if let Err(error) = traced {
                self.paths.clear();
                self.starts.clear();
                return Err(error);
            }
            let mut next = 0;
            for (receiver, listener) in sensors.iter().enumerate() {
                self.starts.push(self.paths.len() as u32);
                let range = next..self.found.of(receiver as u32).end;
                next = range.end;
                let straight = self.straight.of(receiver as u32);
                if range.is_empty() && straight.is_empty() {
                    continue;
                }
                let listens_rad = listener.rotation.angle();
                let straight = straight.map(|k| (&self.straight, k, coupling));
                let others = range.map(|k| (&self.found, k, 0.0));
                for (found, k, least) in straight.chain(others) {
                    let bare = found.amplitude[k];
                    // The patterns can only reduce the amplitude, and are the most expensive step here.
                    if transducer.received(bare, found.length_m[k], air) < floor {
                        continue;
                    }
                    // Straight paths were found separately.
                    if coupling > 0.0 && least == 0.0 && found.order[k] == 0 {
                        continue;
                    }
                    let elevations_rad = found.elevations_rad(k);
                    let [departs, arrives] = [found.departure_rad[k] - heading_rad, found.arrival_rad[k] - listens_rad];
                    let off = |azimuth: f64, elevation: f64| if in_room { raised(azimuth, elevation) } else { azimuth };
                    let mut amplitude = bare
                        * departing.pattern(off(departs, elevations_rad[0]))
                        * arriving.pattern(off(arrives, elevations_rad[1]));
                    if amplitude < bare * least {
                        amplitude = bare * least;
                    }
                    if transducer.received(amplitude, found.length_m[k], air) < floor {
                        continue;
                    }
                    let start = self.bounces.len() as u32;
                    self.bounces.extend_from_slice(found.bounces(k));
                    self.paths.push(CriticalPath {
                        emitter: emitter as u32,
                        receiver: receiver as u32,
                        length_m: found.length_m[k],
                        amplitude,
                        bare,
                        order: found.order[k],
                        departure_rad: found.departure_rad[k],
                        arrival_rad: found.arrival_rad[k],
                        elevations_rad,
                        bounces: [start, self.bounces.len() as u32],
                    });
                }
            }
        }
        self.starts.push(self.paths.len() as u32);
        (self.emitters, self.sensors) = (emitters.len(), sensors.len());
        Ok(())
    }

    /// Adds the paths of another matrix between some of this ring's sensors, given by their numbers here. Call
    /// [`sort`](Self::sort) after the last part.
    pub(crate) fn absorb(&mut self, part: &Self, emitters: &[usize], sensors: &[usize]) {
        let before = self.bounces.len() as u32;
        self.bounces.extend_from_slice(&part.bounces);
        let number = |of: &[usize], index: u32| of.get(index as usize).map_or(index, |&number| number as u32);
        self.paths.extend(part.paths.iter().map(|path| CriticalPath {
            emitter: number(emitters, path.emitter),
            receiver: number(sensors, path.receiver),
            bounces: path.bounces.map(|at| at + before),
            ..*path
        }));
    }

    /// Sorts all added paths, for a ring of this many sensors.
    pub(crate) fn sort(&mut self, sensors: usize) {
        let pair = |path: &CriticalPath| path.emitter as usize * sensors + path.receiver as usize;
        self.paths.sort_by(|a, b| pair(a).cmp(&pair(b)).then(a.length_m.total_cmp(&b.length_m)));
        let start = |first: usize| self.paths.partition_point(|path| pair(path) < first) as u32;
        self.starts = (0..=sensors * sensors).map(start).collect();
        (self.emitters, self.sensors) = (sensors, sensors);
    }

    /// Returns the number of sensors of the ring.
    pub fn sensors(&self) -> usize {
        self.sensors
    }

    /// Returns the paths from an emitter to a receiver, shortest first; none for sensors that do not exist.
    pub fn between(&self, emitter: usize, receiver: usize) -> &[CriticalPath] {
        if emitter >= self.emitters || receiver >= self.sensors {
            return &[];
        }
        let pair = emitter * self.sensors + receiver;
        &self.paths[self.starts[pair] as usize..self.starts[pair + 1] as usize]
    }

    /// Returns all paths, by emitter, receiver and length.
    pub fn paths(&self) -> &[CriticalPath] {
        &self.paths
    }

    /// Returns the bounces of one of this matrix's paths, emitter to receiver.
    pub fn bounces(&self, path: &CriticalPath) -> &[Bounce] {
        self.bounces.get(path.bounces[0] as usize..path.bounces[1] as usize).unwrap_or(&[])
    }

    /// Returns all bounces of all paths, for renumbering.
    pub(crate) fn bounces_mut(&mut self) -> &mut [Bounce] {
        &mut self.bounces
    }
}

/// Data for adapting paths whose ends have moved a little since they were found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    /// The emitters' and the receivers' patterns.
    pub(crate) patterns: [Piston; 2],
    /// The query's [`coupling`](CrosstalkQuery::coupling).
    pub(crate) coupling: f64,
}

impl Moved {
    /// Returns a path adapted to new poses of its emitter and receiver. Its length changes by their motion along the
    /// path, its amplitude by the patterns in its new directions.
    pub(crate) fn carried(&self, path: &CriticalPath, ends: [[&Pose; 2]; 2]) -> CriticalPath {
        let directions = [path.departure_rad, path.arrival_rad];
        let gone_m = |end: usize| {
            let [then, now] = ends[end].map(|pose| pose.translation.vector);
            let towards = Vector::new(libm::cos(directions[end]), libm::sin(directions[end]));
            (now - then).dot(&towards) * libm::cos(path.elevations_rad[end])
        };
        let length_m = (path.length_m - gone_m(0) - gone_m(1)).max(0.5 * path.length_m);
        let mut patterns = path.amplitude;
        if ends.iter().any(|[then, now]| then.rotation != now.rotation) {
            let of = |end: usize| {
                let off_rad = directions[end] - ends[end][1].rotation.angle();
                self.patterns[end].pattern(raised(off_rad, path.elevations_rad[end]))
            };
            let least = if path.order == 0 { self.coupling } else { 0.0 };
            patterns = path.bare * (of(0) * of(1)).max(least);
        }
        CriticalPath { length_m, amplitude: patterns * path.length_m / length_m, ..*path }
    }
}

/// Returns the angle between a level axis and a direction with an azimuth from the axis and an elevation.
fn raised(azimuth_rad: f64, elevation_rad: f64) -> f64 {
    libm::acos((libm::cos(azimuth_rad) * libm::cos(elevation_rad)).clamp(-1.0, 1.0))
}
