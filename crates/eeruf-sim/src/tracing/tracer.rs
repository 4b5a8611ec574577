//! The tracer: grows the beam tree of a source, searches for paths over poles, and writes all of them in order.

use super::audibility::Audibility;
use super::beam::{BeamTree, Growth};
use super::bounce_points::Corners;
use super::edges::{EdgeQuery, EdgeSearch};
use super::ends::Ends;
use super::error::PathsError;
use super::limits::{DEFAULT_FREQUENCY_HZ, Limits, MAX_BEAMS, MAX_ORDER, Matters};
use super::paths::Paths;
use super::poles::{Asked, PoleQuery, PoleSearch};
use super::ranking::{Found, Ranking};
use super::write::InRoom;
use crate::{
    acoustics::{LOUDEST_PANEL, Physics, Transducer},
    geometry::Point,
    scene::{Air, Contact, DEFAULT_HEIGHT_M, Scene},
    threads::Stop,
};

/// The heights of a source and of receivers above the floor, in metres; ignored in a flat scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights<'a> {
    /// The source's height.
    pub source_m: f64,
    /// The receivers' heights; [`DEFAULT_HEIGHT_M`] for receivers without one.
    pub receivers_m: &'a [f64],
}

impl Heights<'_> {
    /// Heights of [`DEFAULT_HEIGHT_M`] for all.
    pub const DEFAULT: Self = Self { source_m: DEFAULT_HEIGHT_M, receivers_m: &[] };

    /// Returns the height of a receiver.
    pub(super) fn receiver_m(&self, receiver: usize) -> f64 {
        self.receivers_m.get(receiver).copied().unwrap_or(DEFAULT_HEIGHT_M)
    }
}

/// A finder of paths. Its buffers are reused, so that repeated queries do not allocate. Keep one per thread.
#[derive(Debug)]
pub struct Tracer {
    /// The frequency for absorption and roughness, in Hz.
    pub frequency_hz: f64,
    /// True if poles reflect like rigid cylinders at this frequency instead of by geometric optics; see
    /// [`pole_wave_correction`](crate::pole_wave_correction). Off by default.
    pub pole_waves: bool,
    /// True if poles thicker than the first Fresnel zone shade the space behind them; see
    /// [`Physics::shadows`](crate::Physics::shadows). Off by default.
    pub pole_shadows: bool,
    /// True if free ends of walls and corners that jut out diffract; see [`Physics::edges`](crate::Physics::edges). Off
    /// by default.
    pub edges: bool,
    /// True if a wall reflects according to its width; see [`Physics::narrow_panels`](crate::Physics::narrow_panels).
    /// Off by default.
    pub narrow_panels: bool,
    /// Length of the burst, in cycles. With [`narrow_panels`](Self::narrow_panels), paths over a wall's two ends that
    /// differ by less are heard as one. A [`CrosstalkMatrix`](crate::CrosstalkMatrix) sets it to the emitter's.
    pub burst_cycles: u32,
    /// Largest number of bounces of a path with a pole, at most the limit for others. The default is [`MAX_ORDER`].
    pub pole_order: u32,
    /// Switch that ends a running query with [`PathsError::Stopped`].
    pub stop: Stop,
    /// Loss in the air, for the last air and frequency.
    loss: Option<(Air, f64, f64)>,
    ends: Ends,
    pub(super) tree: BeamTree,
    pub(super) poles: PoleSearch,
    pub(super) around: EdgeSearch,
    pub(super) ranking: Ranking,
    pub(super) in_room: InRoom,
    pub(super) corners: Corners,
}

/// A clone with the same settings and switch, and its own buffers.
impl Clone for Tracer {
    fn clone(&self) -> Self {
        let &Self { pole_waves, pole_shadows, edges, narrow_panels, burst_cycles, pole_order, ref stop, .. } = self;
        let stop = stop.clone();
        let new = Self::at(self.frequency_hz);
        Self { pole_waves, pole_shadows, edges, narrow_panels, burst_cycles, pole_order, stop, ..new }
    }
}

impl Default for Tracer {
    fn default() -> Self {
        Self::new()
    }
}

impl Tracer {
    /// Makes a tracer at [`DEFAULT_FREQUENCY_HZ`].
    pub fn new() -> Self {
        Self::at(DEFAULT_FREQUENCY_HZ)
    }

    /// Makes a tracer for amplitudes at a frequency.
    pub fn at(frequency_hz: f64) -> Self {
        Self {
            frequency_hz,
            pole_waves: false,
            pole_shadows: false,
            edges: false,
            narrow_panels: false,
            burst_cycles: Transducer::POLAROID_6500.cycles,
            pole_order: MAX_ORDER,
            stop: Stop::default(),
            loss: None,
            ends: Ends::default(),
            tree: BeamTree::default(),
            poles: PoleSearch::default(),
            around: EdgeSearch::default(),
            ranking: Ranking::default(),
            in_room: InRoom::default(),
            corners: Corners::default(),
        }
    }

    /// Sets the effects on paths: shadows, edges and narrow panels.
    pub fn follow(&mut self, physics: &Physics) {
        self.pole_shadows = physics.shadows;
        self.edges = physics.edges;
        self.narrow_panels = physics.narrow_panels;
    }

    /// Returns the largest factor by which a path may be louder than with endless walls.
    pub(crate) fn loudest(&self) -> f64 {
        if self.narrow_panels { LOUDEST_PANEL } else { 1.0 }
    }

    /// Writes every specular path from the source to each receiver into `paths`.
    ///
    /// A path may bounce at walls, at walls with one pole anywhere among them, or at two poles in turn. In a scene with
    /// [floor and ceiling](Scene::room) source and receivers are [`DEFAULT_HEIGHT_M`] high; see
    /// [`trace_at`](Self::trace_at). A path through the apex of a convex right-angle corner is found once. A receiver
    /// on top of the source does not hear the direct path of length 0.
    ///
    /// # Errors
    /// A position is not a number, out of reach or inside a solid; an order or a length is out of range; the tree
    /// outgrows [`MAX_BEAMS`]; or [`stop`](Self::stop) was used. `paths` is then empty.
    pub fn trace(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
        paths: &mut Paths,
    ) -> Result<(), PathsError> {
        self.trace_at(scene, source, receivers, Heights::DEFAULT, limits, paths)
    }

    /// Traces like [`trace`](Self::trace), at given heights. In a room each path of the plan is heard directly and over
    /// floor and ceiling. These add up to [`VERTICAL_ORDER`](super::VERTICAL_ORDER) bounces, which count towards
    /// `limits.max_order`. Heights do not matter in a flat scene.
    ///
    /// # Errors
    /// Errors of [`trace`](Self::trace), and a height that is not between floor and ceiling.
    pub fn trace_at(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        heights: Heights<'_>,
        limits: Limits,
        paths: &mut Paths,
    ) -> Result<(), PathsError> {
        self.trace_audible(None, None, scene, source, receivers, heights, limits, Asked::Once, paths)
    }

    /// Traces like [`trace`](Self::trace), without paths that are certainly too faint or do not matter.
    #[expect(clippy::too_many_arguments, reason = "one question")]
    pub(crate) fn trace_audible(
        &mut self,
        audibility: Option<&Audibility>,
        matters: Option<Matters<'_>>,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        heights: Heights<'_>,
        limits: Limits,
        asked: Asked,
        paths: &mut Paths,
    ) -> Result<(), PathsError> {
        paths.clear();
        check_heights(scene, receivers.len(), heights)?;
        let at_poles = Limits { max_order: limits.max_order.min(self.pole_order), ..limits };
        self.grow(audibility, scene, source, receivers, limits, at_poles)?;
        if let Some(audibility) = audibility {
            // In a room the path in the plan does not give the length.
            let by_length = matters.filter(|_| scene.room().is_none());
            self.tree.drop_faint(audibility, by_length, receivers);
        }
        let (tree, ends, budget, stop) = (&self.tree, &self.ends, MAX_BEAMS, &self.stop);
        let query = PoleQuery { scene, tree, source, ends, limits: at_poles, audibility, asked, budget, stop };
        if !self.poles.search(&query, receivers) {
            return Err(self.incomplete());
        }
        self.around.clear();
        if self.edges {
            let wave_number = core::f64::consts::TAU * self.frequency_hz / scene.air().speed_of_sound();
            let burst_m = f64::from(self.burst_cycles) * core::f64::consts::TAU / wave_number;
            let joined_m = self.narrow_panels.then_some(burst_m);
            let query = EdgeQuery { scene, audibility, source, receivers, ends, limits, wave_number, joined_m };
            if !self.around.search(&query, &self.stop) {
                return Err(PathsError::Stopped);
            }
        }
        let found = Found { tree: &self.tree, poles: &self.poles, edges: &self.around };
        self.ranking.rank(found, receivers.len());
        match scene.room() {
            None => self.write(scene, source, receivers, matters, paths),
            Some(room) => {
                let most = [limits, at_poles];
                self.write_in_room(audibility, matters, scene, room, source, receivers, heights, most, paths);
            }
        }
        Ok(())
    }

    /// Runs only the core: finds the images that each receiver sees over walls and returns their number, unsorted and
    /// with duplicates at corners. Use it for comparison with other image-source programs.
    ///
    /// # Errors
    /// See [`trace`](Self::trace).
    pub fn visible_images(
        &mut self,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
    ) -> Result<usize, PathsError> {
        self.grow(None, scene, source, receivers, limits, limits)?;
        Ok(self.tree.visible_images.len())
    }

    fn grow(
        &mut self,
        audibility: Option<&Audibility>,
        scene: &Scene,
        source: Point,
        receivers: &[Point],
        limits: Limits,
        at_poles: Limits,
    ) -> Result<(), PathsError> {
        check(scene, source, receivers, limits)?;
        self.ends.find(scene.mesh(), source, receivers);
        check_free(scene, source, self.ends.of_source())?;
        let mut each = receivers.iter().enumerate();
        each.try_for_each(|(receiver, &at)| check_free(scene, at, self.ends.of_receiver(receiver)))?;
        let growth = Growth {
            mesh: scene.mesh(),
            mirrors: scene.mirrors(),
            poles: scene.poles(),
            // A pole that is the only bounce is searched for without beams.
            pole_triangles: if at_poles.max_order > 1 { &scene.pole_triangles } else { &[] },
            pole_order: at_poles.max_order,
            max_order: limits.max_order,
            max_length_m: limits.max_length_m,
            budget: MAX_BEAMS,
            last_for_receivers: true,
            aim: audibility.map(Audibility::of_source),
            stop: &self.stop,
        };
        if self.tree.grow(&growth, (source, self.ends.of_source()), receivers, &self.ends) {
            Ok(())
        } else {
            Err(self.incomplete())
        }
    }

    /// Returns the reason why the results are incomplete.
    fn incomplete(&self) -> PathsError {
        if self.stop.is_stopped() { PathsError::Stopped } else { PathsError::Budget { beams: MAX_BEAMS } }
    }

    /// Returns the number of beams of the last query.
    pub fn beams(&self) -> usize {
        self.tree.beams.len()
    }

    /// Returns the natural logarithm of the air's attenuation per metre, which is negative.
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
}

fn check(scene: &Scene, source: Point, receivers: &[Point], limits: Limits) -> Result<(), PathsError> {
    let reach_m = scene.mesh().reach_m;
    if limits.max_order > MAX_ORDER {
        return Err(PathsError::Order { max_order: limits.max_order });
    }
    if limits.max_length_m.is_nan() || limits.max_length_m <= 0.0 {
        return Err(PathsError::Length { max_length_m: limits.max_length_m });
    }
    if !scene.mesh().covers(source) {
        return Err(PathsError::Source { at: [source.x, source.y], reach_m });
    }
    match receivers.iter().position(|&at| !scene.mesh().covers(at)) {
        Some(receiver) => {
            Err(PathsError::Receiver { receiver, at: [receivers[receiver].x, receivers[receiver].y], reach_m })
        }
        None => Ok(()),
    }
}

/// Checks that a point is free: not in a pole or a pillar, and not outside the room.
fn check_free(scene: &Scene, at: Point, triangles: &[u32]) -> Result<(), PathsError> {
    let pole = scene.poles().iter().position(|pole| (at - pole.centre).norm() < pole.radius_m);
    let what = match pole {
        Some(pole) => Contact::Pole(pole),
        None if scene.mesh().is_solid_at(triangles) => Contact::Solid,
        None => return Ok(()),
    };
    Err(PathsError::Inside { at: [at.x, at.y], what })
}

/// Checks that source and receivers are between floor and ceiling, if the scene has them.
fn check_heights(scene: &Scene, receivers: usize, heights: Heights<'_>) -> Result<(), PathsError> {
    let Some(room) = scene.room() else { return Ok(()) };
    let all = core::iter::once(heights.source_m).chain((0..receivers).map(|receiver| heights.receiver_m(receiver)));
    match all.into_iter().find(|&height_m| !room.holds(height_m)) {
        Some(height_m) => Err(PathsError::Height { height_m, ceiling_m: room.ceiling_m }),
        None => Ok(()),
    }
}
