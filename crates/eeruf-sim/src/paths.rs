//! Critical paths: every specular way from a source to its receivers, as flat arrays that are used again from question to
//! question.

use rayon::prelude::*;

use crate::{
    air::Air,
    amplitude::reflected,
    beam::{Beam, BeamTree, Growth, Sighting},
    error::PathsError,
    gate::Gate,
    mesh::NONE,
    plane::{Point, TOUCH_M, opposite, wrap_angle},
    pole_paths::{PolePath, PoleSearch},
    scatter::pole_wave_correction,
    scene::Scene,
};

/// The highest order that may be asked for.
pub const MAX_ORDER: u32 = 1000;
/// The most beams that one question may grow, some hundreds of megabytes.
pub const MAX_BEAMS: usize = 1 << 22;
/// The frequency that amplitudes are given for unless another is asked for: Polaroid's 49.4 kHz.
pub const DEFAULT_FREQUENCY_HZ: f64 = 49_400.0;

/// One bounce of a path.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Bounce {
    /// At the wall with this index.
    Wall(u32),
    /// At the pole with this index.
    Pole(u32),
}

/// Paths as arrays of equal length, sorted by receiver, then by length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Paths {
    /// Index of the receiver.
    pub receiver: Vec<u32>,
    /// Length in metres.
    pub length_m: Vec<f64>,
    /// How many bounces, those at poles included.
    pub order: Vec<u32>,
    /// Direction in which the path leaves the source, in (-pi, pi].
    pub departure_rad: Vec<f64>,
    /// Direction from which it reaches the receiver: where the receiver looks to see it, in (-pi, pi].
    pub arrival_rad: Vec<f64>,
    /// Amplitude relative to 1 m in free air, with the transducers' patterns left out.
    pub amplitude: Vec<f64>,
    ends: Vec<u32>,
    bounces: Vec<Bounce>,
}

impl Paths {
    /// How many paths there are.
    pub fn len(&self) -> usize {
        self.length_m.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.length_m.is_empty()
    }

    /// The bounces of a path from source to receiver; empty for one that does not exist.
    pub fn bounces(&self, path: usize) -> &[Bounce] {
        let end_of = |path: usize| self.ends.get(path).map_or(0, |end| *end as usize);
        let start = if path == 0 { 0 } else { end_of(path - 1) };
        self.bounces.get(start..end_of(path)).unwrap_or(&[])
    }

    /// The indices of one receiver's paths.
    pub fn of(&self, receiver: u32) -> core::ops::Range<usize> {
        self.receiver.partition_point(|&r| r < receiver)..self.receiver.partition_point(|&r| r <= receiver)
    }

    fn reserve(&mut self, more: usize) {
        self.receiver.reserve(more);
        self.length_m.reserve(more);
        self.order.reserve(more);
        self.departure_rad.reserve(more);
        self.arrival_rad.reserve(more);
        self.amplitude.reserve(more);
        self.ends.reserve(more);
    }

    /// Forgets the paths, keeps the memory.
    pub fn clear(&mut self) {
        self.receiver.clear();
        self.length_m.clear();
        self.order.clear();
        self.departure_rad.clear();
        self.arrival_rad.clear();
        self.amplitude.clear();
        self.ends.clear();
        self.bounces.clear();
    }
}

/// How far to follow the sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The most bounces.
    pub max_order: u32,
    /// The longest path in metres; infinity for no limit.
    pub max_length_m: f64,
}

impl Limits {
    /// Up to an order, at any length.
    pub const fn order(max_order: u32) -> Self {
        Self { max_order, max_length_m: f64::INFINITY }
    }
}

/// Finds paths; holds the buffers, so that asking again does not allocate. Keep one per thread.
#[derive(Debug)]
pub struct Tracer {
    /// The frequency that absorption and roughness are taken at, in Hz.
    pub frequency_hz: f64,
    /// Whether poles return what a rigid cylinder does at this frequency instead of what geometric optics says; see
    /// [`pole_wave_correction`]. Off by default.
    pub pole_waves: bool,
    /// The most bounces of a path with a pole, at most those of all others. [`MAX_ORDER`] to begin with.
    pub pole_order: u32,
    /// What the air takes, for the air and the frequency asked for last.
    loss: Option<(Air, f64, f64)>,
    tree: BeamTree,
    poles: PoleSearch,
    keys: Vec<u64>,
    ranks: Vec<Rank>,
    starts: Vec<u32>,
    sequence: Vec<Bounce>,
    other: Vec<Bounce>,
}

/// The low bits of a sorting key hold the index of the path, the high ones those of its length: lengths are positive, so
/// their bits are in the same order as they are.
const INDEX: u64 = (1 << 24) - 1;
const _: () = assert!(MAX_BEAMS as u64 <= INDEX);

/// A path's place in the order of lengths.
#[derive(Clone, Copy, Debug)]
struct Rank {
    length_m: f64,
    index: u32,
}

impl Default for Tracer {
    fn default() -> Self {
        Self::new()
    }
}

impl Tracer {
    /// A tracer at [`DEFAULT_FREQUENCY_HZ`].
    pub fn new() -> Self {
        Self::at(DEFAULT_FREQUENCY_HZ)
    }

    /// A tracer for amplitudes at a frequency.
    pub fn at(frequency_hz: f64) -> Self {
        Self {
            frequency_hz,
            pole_waves: false,
            pole_order: MAX_ORDER,
            loss: None,
            tree: BeamTree::default(),
            poles: PoleSearch::default(),
            keys: Vec::new(),
            ranks: Vec::new(),
            starts: Vec::new(),
            sequence: Vec::new(),
            other: Vec::new(),
        }
    }

    /// Writes every specular path from the source to each receiver into `paths`.
    ///
    /// A path may bounce at walls, at walls with one pole anywhere among them, or at two poles in turn. One through the
    /// apex of a convex right-angle corner is found once. A receiver on top of the source does not hear the direct path of
    /// no length.
    ///
    /// # Errors
    /// A position that is not a number or far outside, an order or a length out of range, or a tree that outgrows
    /// [`MAX_BEAMS`]. `paths` is empty then.
    pub fn trace(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
        paths: &mut Paths,
    ) -> Result<(), PathsError> {
        self.trace_through(None, scene, source, receivers, limits, paths)
    }

    /// As [`trace`](Self::trace), without paths that a gate keeps back as too faint.
    pub(crate) fn trace_through(
        &mut self,
        gate: Option<&Gate>,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
        paths: &mut Paths,
    ) -> Result<(), PathsError> {
        paths.clear();
        let at_poles = Limits { max_order: limits.max_order.min(self.pole_order), ..limits };
        self.grow(gate, scene, source, receivers, limits, at_poles)?;
        if let Some(gate) = gate {
            self.tree.drop_faint(gate, receivers);
        }
        if !self.poles.search(scene, &self.tree, source, receivers, at_poles, gate, MAX_BEAMS) {
            return Err(PathsError::Budget { beams: MAX_BEAMS });
        }
        self.rank(receivers.len());
        self.remove_doubles(receivers.len());
        self.write(scene, receivers, paths);
        Ok(())
    }

    /// The core alone: finds the images that each receiver sees over walls and returns how many, unsorted and with the
    /// doubles of corners. This is what other image-source programs time as their own.
    ///
    /// # Errors
    /// As [`trace`](Self::trace).
    pub fn sight(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
    ) -> Result<usize, PathsError> {
        self.grow(None, scene, source, receivers, limits, limits)?;
        Ok(self.tree.sightings.len())
    }

    fn grow(
        &mut self,
        gate: Option<&Gate>,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
        at_poles: Limits,
    ) -> Result<(), PathsError> {
        check(scene, source, receivers, limits)?;
        let growth = Growth {
            mesh: &scene.mesh,
            mirrors: &scene.mirrors,
            poles: scene.poles(),
            // A pole that is the only bounce is looked for without beams.
            pole_triangles: if at_poles.max_order > 1 { &scene.pole_triangles } else { &[] },
            max_order: limits.max_order,
            max_length_m: limits.max_length_m,
            budget: MAX_BEAMS,
            last_for_receivers: true,
            front: gate.map(Gate::source),
        };
        if self.tree.grow(&growth, source, receivers) { Ok(()) } else { Err(PathsError::Budget { beams: MAX_BEAMS }) }
    }

    /// How many beams the last question grew.
    pub fn beams(&self) -> usize {
        self.tree.beams.len()
    }

    /// Sorts by receiver, then length: a counting sort over receivers and a short sort of plain numbers within each.
    fn rank(&mut self, receivers: usize) {
        let walls = self.tree.sightings.iter().map(|s| (s.receiver, s.length_m));
        let poles = self.poles.found.iter().map(|p| (p.receiver, p.length_m));
        self.starts.clear();
        self.starts.resize(receivers + 2, 0);
        for (receiver, _) in walls.clone().chain(poles.clone()) {
            self.starts[receiver as usize + 2] += 1;
        }
        for receiver in 2..self.starts.len() {
            self.starts[receiver] += self.starts[receiver - 1];
        }
        self.keys.clear();
        self.keys.resize(self.tree.sightings.len() + self.poles.found.len(), 0);
        for (index, (receiver, length_m)) in walls.chain(poles).enumerate() {
            let place = &mut self.starts[receiver as usize + 1];
            self.keys[*place as usize] = (length_m.to_bits() & !INDEX) | index as u64;
            *place += 1;
        }
        for receiver in 0..receivers {
            let range = self.starts[receiver] as usize..self.starts[receiver + 1] as usize;
            self.keys[range].sort_unstable();
        }
    }

    /// Puts the sorted paths in exact order and keeps one of several with the same order and image: what both wall orders
    /// of a right-angle corner, or two pieces of one straight wall, find at their common point.
    fn remove_doubles(&mut self, receivers: usize) {
        self.ranks.clear();
        for receiver in 0..receivers {
            let group = self.ranks.len();
            for at in self.starts[receiver] as usize..self.starts[receiver + 1] as usize {
                let index = (self.keys[at] & INDEX) as u32;
                let length_m = match self.entry(index) {
                    Entry::Walls(sighting) => sighting.length_m,
                    Entry::Pole(path) => path.length_m,
                };
                // The keys ignore the last digits of the lengths, so a neighbour or two may have to give way.
                let mut place = self.ranks.len();
                while place > group && self.ranks[place - 1].length_m > length_m {
                    place -= 1;
                }
                let near = |rank: &Rank| (rank.length_m - length_m).abs() <= TOUCH_M;
                let below = (group..place).rev().take_while(|&k| near(&self.ranks[k]));
                let above = (place..self.ranks.len()).take_while(|&k| near(&self.ranks[k]));
                match below.chain(above).find(|&k| self.is_double(self.ranks[k].index, index)) {
                    None => self.ranks.insert(place, Rank { length_m, index }),
                    Some(k) => {
                        // The smaller wall sequence stays, whatever the mesh looked like.
                        self.read_bounces(self.ranks[k].index);
                        core::mem::swap(&mut self.sequence, &mut self.other);
                        self.read_bounces(index);
                        if self.sequence < self.other {
                            self.ranks[k].index = index;
                        }
                    }
                }
            }
        }
    }

    fn is_double(&self, a: u32, b: u32) -> bool {
        let ((order_a, image_a), (order_b, image_b)) = (self.key(a), self.key(b));
        order_a == order_b && (image_a - image_b).norm() <= TOUCH_M
    }

    fn key(&self, index: u32) -> (u32, Point) {
        match self.entry(index) {
            Entry::Walls(s) => (s.order, s.image),
            Entry::Pole(p) => (p.order, p.image),
        }
    }

    fn entry(&self, index: u32) -> Entry<'_> {
        match self.tree.sightings.get(index as usize) {
            Some(sighting) => Entry::Walls(sighting),
            None => Entry::Pole(&self.poles.found[index as usize - self.tree.sightings.len()]),
        }
    }

    /// Reads the bounces of a found path into `sequence`.
    fn read_bounces(&mut self, index: u32) {
        let mut sequence = core::mem::take(&mut self.sequence);
        sequence.clear();
        match self.entry(index) {
            Entry::Walls(sighting) => push_walls(&self.tree.beams, sighting, &mut sequence),
            Entry::Pole(path) => sequence.extend_from_slice(self.poles.bounces(path)),
        }
        self.sequence = sequence;
    }

    /// The natural logarithm of what the air leaves of an amplitude per metre; negative.
    pub(crate) fn loss_per_m(&mut self, air: Air) -> f64 {
        match self.loss {
            Some((known, frequency_hz, loss_per_m)) if known == air && frequency_hz == self.frequency_hz => loss_per_m,
            _ => {
                let loss_per_m = -air.absorption_db_per_m(self.frequency_hz) * core::f64::consts::LN_10 / 20.0;
                self.loss = Some((air, self.frequency_hz, loss_per_m));
                loss_per_m
            }
        }
    }

    fn write(&mut self, scene: &Scene, receivers: &[Point], paths: &mut Paths) {
        let loss_per_m = self.loss_per_m(scene.air());
        let wave_number = core::f64::consts::TAU * self.frequency_hz / scene.air().speed_of_sound();
        paths.reserve(self.ranks.len());
        for rank in &self.ranks {
            let start = paths.bounces.len();
            let amplitude;
            match self.entry(rank.index) {
                Entry::Walls(s) => {
                    push_walls(&self.tree.beams, s, &mut paths.bounces);
                    let ahead = receivers[s.receiver as usize] - s.image;
                    let there = ahead.y.atan2(ahead.x);
                    let departure = if s.order.is_multiple_of(2) { there - s.turn } else { s.turn - there };
                    let angles = [wrap_angle(departure), opposite(there)];
                    let kept = if scene.rough {
                        reflected(scene, &paths.bounces[start..], angles, [1.0; 2], wave_number)
                    } else {
                        s.kept
                    };
                    amplitude = kept / s.length_m;
                    paths.receiver.push(s.receiver);
                    paths.order.push(s.order);
                    paths.departure_rad.push(angles[0]);
                    paths.arrival_rad.push(angles[1]);
                }
                Entry::Pole(p) => {
                    paths.bounces.extend_from_slice(self.poles.bounces(p));
                    let angles = [p.departure_rad, p.arrival_rad];
                    let kept = reflected(scene, &paths.bounces[start..], angles, p.cos_incidence, wave_number);
                    amplitude = kept * p.spread * self.pole_waves(p, &paths.bounces[start..], scene, wave_number);
                    paths.receiver.push(p.receiver);
                    paths.order.push(p.order);
                    paths.departure_rad.push(angles[0]);
                    paths.arrival_rad.push(angles[1]);
                }
            }
            paths.length_m.push(rank.length_m);
            paths.amplitude.push(amplitude * (loss_per_m * rank.length_m).exp());
            paths.ends.push(paths.bounces.len() as u32);
        }
    }

    /// The wave correction of a path's poles, if it is asked for.
    fn pole_waves(&self, path: &PolePath, bounces: &[Bounce], scene: &Scene, wave_number: f64) -> f64 {
        if !self.pole_waves {
            return 1.0;
        }
        let poles = bounces.iter().filter_map(|bounce| match *bounce {
            Bounce::Pole(pole) => scene.poles().get(pole as usize),
            Bounce::Wall(_) => None,
        });
        let corrections = poles
            .zip(path.cos_incidence)
            .map(|(pole, cos)| pole_wave_correction(wave_number * pole.radius_m, cos.min(1.0).acos()));
        corrections.product()
    }
}

enum Entry<'a> {
    Walls(&'a Sighting),
    Pole(&'a PolePath),
}

/// Appends the walls of a sighting, source to receiver.
#[inline]
fn push_walls(beams: &[Beam], sighting: &Sighting, bounces: &mut Vec<Bounce>) {
    let start = bounces.len();
    bounces.resize(start + sighting.order as usize, Bounce::Wall(sighting.wall));
    let mut beam = sighting.parent;
    for bounce in bounces[start..].iter_mut().rev().skip(1) {
        let node = &beams[beam as usize];
        *bounce = Bounce::Wall(node.wall);
        beam = node.parent;
    }
}

/// Appends the walls of a beam from the last to the first.
pub(crate) fn push_chain(beams: &[Beam], mut beam: u32, bounces: &mut Vec<Bounce>) {
    while let Some(node) = beams.get(beam as usize).filter(|node| node.wall != NONE) {
        bounces.push(Bounce::Wall(node.wall));
        beam = node.parent;
    }
}

fn check(scene: &Scene, source: Point, receivers: &[Point], limits: Limits) -> Result<(), PathsError> {
    let reach_m = scene.mesh.reach_m;
    if limits.max_order > MAX_ORDER {
        return Err(PathsError::Order { max_order: limits.max_order });
    }
    if limits.max_length_m.is_nan() || limits.max_length_m <= 0.0 {
        return Err(PathsError::Length { max_length_m: limits.max_length_m });
    }
    if !scene.mesh.covers(source) {
        return Err(PathsError::Source { at: [source.x, source.y], reach_m });
    }
    match receivers.iter().position(|&at| !scene.mesh.covers(at)) {
        Some(receiver) => {
            Err(PathsError::Receiver { receiver, at: [receivers[receiver].x, receivers[receiver].y], reach_m })
        }
        None => Ok(()),
    }
}

/// The paths of many sources at once, on all cores, in the order of the sources.
///
/// # Errors
/// As [`Tracer::trace`], for the first source that has one.
pub fn paths_of_many(
    scene: &Scene,
    sources: &[Point],
    receivers: &[Point],
    limits: Limits,
) -> Result<Vec<Paths>, PathsError> {
    sources
        .par_iter()
        .map_init(Tracer::new, |tracer, &source| {
            let mut paths = Paths::default();
            tracer.trace(scene, source, receivers, limits, &mut paths).map(|()| paths)
        })
        .collect()
}

impl Scene {
    /// Every specular path from a source to each receiver, at [`DEFAULT_FREQUENCY_HZ`]; see [`Tracer::trace`], which also
    /// keeps the memory between questions.
    ///
    /// # Errors
    /// As [`Tracer::trace`].
    ///
    /// ```
    /// use eeruf_sim::{Air, Point, Scene, Wall};
    /// let room = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]).collect();
    /// let scene = Scene::new(room, vec![], Air::default())?;
    /// let paths = scene.paths(Point::new(1.0, 1.0), &[Point::new(2.5, 1.2)], 6, f64::INFINITY)?;
    /// assert_eq!(paths.len(), 1 + 2 * 6 * 7); // one for each image of a rectangle
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn paths(
        &self,
        source: Point,
        receivers: &[Point],
        max_order: u32,
        max_length_m: f64,
    ) -> Result<Paths, PathsError> {
        let mut paths = Paths::default();
        Tracer::new().trace(self, source, receivers, Limits { max_order, max_length_m }, &mut paths)?;
        Ok(paths)
    }
}
