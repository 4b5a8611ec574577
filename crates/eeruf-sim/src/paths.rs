//! Critical paths: every specular way from a source to its receivers, as flat arrays that are used again from question to
//! question.

use crate::{
    amplitude::reflected,
    beam::{Beam, BeamTree, Growth, Sighting},
    error::PathsError,
    mesh::NONE,
    plane::{Point, TOUCH_M, wrap_angle},
    pole_paths::{PolePath, PoleSearch},
    scene::Scene,
};

/// The highest order that may be asked for.
pub const MAX_ORDER: u32 = 1000;
/// The most beams that one question may grow, some hundreds of megabytes.
pub const MAX_BEAMS: usize = 1 << 23;
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
    tree: BeamTree,
    poles: PoleSearch,
    ranks: Vec<Rank>,
    starts: Vec<u32>,
    sequence: Vec<Bounce>,
    other: Vec<Bounce>,
}

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
            tree: BeamTree::default(),
            poles: PoleSearch::default(),
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
        paths.clear();
        self.sight(scene, source, receivers, limits)?;
        if !self.poles.search(scene, &self.tree, source, receivers, limits, MAX_BEAMS) {
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
        check(scene, source, receivers, limits)?;
        let growth = Growth {
            mesh: &scene.mesh,
            mirrors: &scene.mirrors,
            poles: scene.poles(),
            pole_triangles: &scene.pole_triangles,
            max_order: limits.max_order,
            max_length_m: limits.max_length_m,
            budget: MAX_BEAMS,
            last_for_receivers: true,
        };
        if !self.tree.grow(&growth, source, receivers) {
            return Err(PathsError::Budget { beams: MAX_BEAMS });
        }
        Ok(self.tree.sightings.len())
    }

    /// How many beams the last question grew.
    pub fn beams(&self) -> usize {
        self.tree.beams.len()
    }

    /// Sorts by receiver, then length: a counting sort over receivers and a short sort within each.
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
        self.ranks.clear();
        self.ranks.resize(self.tree.sightings.len() + self.poles.found.len(), Rank { length_m: 0.0, index: 0 });
        for (index, (receiver, length_m)) in walls.chain(poles).enumerate() {
            let place = &mut self.starts[receiver as usize + 1];
            self.ranks[*place as usize] = Rank { length_m, index: index as u32 };
            *place += 1;
        }
        for receiver in 0..receivers {
            let range = self.starts[receiver] as usize..self.starts[receiver + 1] as usize;
            // Lengths are positive, so their bits are in the same order and compare faster.
            self.ranks[range].sort_unstable_by_key(|rank| (rank.length_m.to_bits(), rank.index));
        }
    }

    /// Keeps one of several paths with the same order and image: what both wall orders of a right-angle corner, or two
    /// pieces of one straight wall, find at their common point.
    fn remove_doubles(&mut self, receivers: usize) {
        let mut kept_to = 0;
        let mut from = 0;
        for receiver in 0..receivers {
            let to = self.starts[receiver + 1] as usize;
            let group = kept_to;
            for at in from..to {
                let rank = self.ranks[at];
                let double = (group..kept_to)
                    .rev()
                    .take_while(|&k| rank.length_m - self.ranks[k].length_m <= TOUCH_M)
                    .find(|&k| self.is_double(self.ranks[k].index, rank.index));
                match double {
                    None => {
                        self.ranks[kept_to] = rank;
                        kept_to += 1;
                    }
                    Some(k) => {
                        // The smaller wall sequence stays, whatever the mesh looked like.
                        self.read_bounces(self.ranks[k].index);
                        core::mem::swap(&mut self.sequence, &mut self.other);
                        self.read_bounces(rank.index);
                        if self.sequence < self.other {
                            self.ranks[k].index = rank.index;
                        }
                    }
                }
            }
            from = to;
        }
        self.ranks.truncate(kept_to);
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

    fn write(&self, scene: &Scene, receivers: &[Point], paths: &mut Paths) {
        let loss_per_m = -scene.air().absorption_db_per_m(self.frequency_hz) * core::f64::consts::LN_10 / 20.0;
        let wave_number = core::f64::consts::TAU * self.frequency_hz / scene.air().speed_of_sound();
        for rank in &self.ranks {
            let start = paths.bounces.len();
            let (receiver, order, departure, arrival, spread) = match self.entry(rank.index) {
                Entry::Walls(s) => {
                    push_walls(&self.tree.beams, s, &mut paths.bounces);
                    let at = receivers[s.receiver as usize];
                    let ahead = at - s.image;
                    let there = ahead.y.atan2(ahead.x);
                    let departure = if s.order.is_multiple_of(2) { there - s.turn } else { s.turn - there };
                    (
                        s.receiver,
                        s.order,
                        wrap_angle(departure),
                        wrap_angle(there + core::f64::consts::PI),
                        1.0 / s.length_m,
                    )
                }
                Entry::Pole(p) => {
                    paths.bounces.extend_from_slice(self.poles.bounces(p));
                    (p.receiver, p.order, p.departure_rad, p.arrival_rad, p.spread)
                }
            };
            let hits = self.pole_hits(rank.index);
            let reflected = reflected(scene, &paths.bounces[start..], [departure, arrival], hits, wave_number);
            paths.receiver.push(receiver);
            paths.length_m.push(rank.length_m);
            paths.order.push(order);
            paths.departure_rad.push(departure);
            paths.arrival_rad.push(arrival);
            paths.amplitude.push(spread * reflected * (loss_per_m * rank.length_m).exp());
            paths.ends.push(paths.bounces.len() as u32);
        }
    }

    /// Cosines of incidence at the poles of a path.
    fn pole_hits(&self, index: u32) -> [f64; 2] {
        match self.entry(index) {
            Entry::Walls(_) => [1.0; 2],
            Entry::Pole(path) => path.cos_incidence,
        }
    }
}

enum Entry<'a> {
    Walls(&'a Sighting),
    Pole(&'a PolePath),
}

/// Appends the walls of a sighting, source to receiver.
fn push_walls(beams: &[Beam], sighting: &Sighting, bounces: &mut Vec<Bounce>) {
    if sighting.wall == NONE {
        return;
    }
    let start = bounces.len();
    bounces.push(Bounce::Wall(sighting.wall));
    push_chain(beams, sighting.parent, bounces);
    bounces[start..].reverse();
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
    if !(limits.max_length_m > 0.0) {
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
