//! The beam tree: every wall sequence along which something of the source's sound really gets through.
//!
//! A beam is an image of the source and a cone that looks through one visible piece of wall. It is walked through the
//! triangles of the mesh; a corner inside the cone splits it, a wall turns it into a beam of the next order. The limits of a
//! cone always point at mirrored *corners* of the scene, never at computed points of intersection, so that errors do not
//! build up: a node is one piece of wall that is truly seen, and the tree grows about quadratically with the order.

use crate::{
    gate::Gate,
    mesh::{Beyond, Exit, Mesh, NONE},
    plane::{Mirror, Point, SAME_DIRECTION, TOUCH_M, Vector, cross},
    pole::Pole,
};

/// Marks a target as a pole.
const POLE: u32 = 1 << 31;
/// Room for receivers that are tested as one block before a beam of the last order is walked at all.
const BLOCK: usize = 32;

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    /// The source, mirrored in every wall of the sequence.
    pub(crate) image: Point,
    left: Vector,
    right: Vector,
    /// The last wall's side of the mesh, by which the beam enters.
    gate: u32,
    /// The beam that it came from; [`NONE`] for the source's own.
    pub(crate) parent: u32,
    /// The last wall.
    pub(crate) wall: u32,
    pub(crate) order: u32,
    /// Directions in the image's world are `turn + d` after an even number of bounces, `turn - d` after an odd one, with `d`
    /// the direction of departure.
    pub(crate) turn: f64,
    /// The product of the walls' reflections.
    kept: f64,
}

/// A receiver that sees an image of the source.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sighting {
    pub(crate) length_m: f64,
    pub(crate) image: Point,
    pub(crate) turn: f64,
    /// The product of the walls' reflections, if all were flat.
    pub(crate) kept: f64,
    pub(crate) receiver: u32,
    pub(crate) order: u32,
    /// The beam before the last wall, or [`NONE`] when there was no wall.
    pub(crate) parent: u32,
    /// The last wall.
    pub(crate) wall: u32,
}

/// A cone that passes a triangle in which a pole stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoleCone {
    pub(crate) pole: u32,
    pub(crate) triangle: u32,
    pub(crate) beam: u32,
    left: Vector,
    right: Vector,
}

impl PoleCone {
    /// Whether a point seen from the beam's image is in the cone, its limits included.
    pub(crate) fn holds(&self, ahead: Vector) -> bool {
        cone_holds(self.left, self.right, ahead)
    }
}

/// Inclusive, with the relative tolerance that makes a path through the apex of a corner visible to both walls.
#[inline(always)]
fn cone_holds(left: Vector, right: Vector, ahead: Vector) -> bool {
    let (l, r) = (cross(ahead, left), cross(right, ahead));
    if l >= 0.0 && r >= 0.0 {
        return true;
    }
    let near = SAME_DIRECTION * (ahead.x.abs() + ahead.y.abs());
    l >= -near * (left.x.abs() + left.y.abs())
        && r >= -near * (right.x.abs() + right.y.abs())
        && (ahead.dot(&left) > 0.0 || ahead.dot(&right) > 0.0)
}

/// Something to be found in a triangle; a list per triangle.
#[derive(Clone, Copy, Debug)]
struct Target {
    at: Point,
    /// A receiver, or a pole with its bit set.
    what: u32,
    triangle: u32,
    next: u32,
}

#[derive(Clone, Copy, Debug)]
struct Cone {
    gate: u32,
    left: Vector,
    right: Vector,
}

/// The tree and its buffers; used again and again without allocating.
#[derive(Debug, Default)]
pub(crate) struct BeamTree {
    pub(crate) beams: Vec<Beam>,
    pub(crate) sightings: Vec<Sighting>,
    pub(crate) pole_cones: Vec<PoleCone>,
    /// First target of each triangle; all [`NONE`] between questions.
    heads: Vec<u32>,
    targets: Vec<Target>,
    stack: Vec<Cone>,
    triangles: Vec<u32>,
    block: Block,
}

/// What a tree is grown for.
pub(crate) struct Growth<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) mirrors: &'a [Mirror],
    pub(crate) poles: &'a [Pole],
    pub(crate) pole_triangles: &'a [(u32, u32)],
    pub(crate) max_order: u32,
    pub(crate) max_length_m: f64,
    pub(crate) budget: usize,
    /// Beams of the last order serve receivers only, not poles, and may be dropped where no receiver is.
    pub(crate) last_for_receivers: bool,
    /// Where the source heads, if no sound leaves it at right angles to that or further behind.
    pub(crate) front: Option<Vector>,
}

impl Growth<'_> {
    /// The part of a cone from the source into which sound leaves.
    fn lit(&self, left: Vector, right: Vector) -> Option<(Vector, Vector)> {
        let Some(front) = self.front else { return Some((left, right)) };
        let ahead = |limit: Vector| limit.dot(&front) > -SAME_DIRECTION * (limit.x.abs() + limit.y.abs());
        match (ahead(left), ahead(right)) {
            (true, true) => Some((left, right)),
            (true, false) => Some((left, Vector::new(front.y, -front.x))),
            (false, true) => Some((Vector::new(-front.y, front.x), right)),
            // A cone through the side of a triangle is narrower than what is lit.
            (false, false) => None,
        }
    }
}

impl BeamTree {
    /// Grows the tree of a source. All points must be covered by the mesh. Returns whether the budget sufficed.
    pub(crate) fn grow(&mut self, growth: &Growth<'_>, source: Point, receivers: &[Point]) -> bool {
        self.beams.clear();
        self.sightings.clear();
        self.pole_cones.clear();
        self.place(growth, receivers);
        let complete = self.spread(growth, source);
        for target in &self.targets {
            self.heads[target.triangle as usize] = NONE;
        }
        self.targets.clear();
        complete
    }

    fn place(&mut self, growth: &Growth<'_>, receivers: &[Point]) {
        if self.heads.len() < growth.mesh.len() {
            self.heads.resize(growth.mesh.len(), NONE);
        }
        let mut triangles = core::mem::take(&mut self.triangles);
        for (receiver, &at) in receivers.iter().enumerate() {
            growth.mesh.containing(at, &mut triangles);
            for &triangle in &triangles {
                self.put(at, receiver as u32, triangle);
            }
        }
        self.triangles = triangles;
        for &(triangle, pole) in growth.pole_triangles {
            self.put(growth.poles[pole as usize].centre, POLE | pole, triangle);
        }
        self.block.fill(receivers);
    }

    fn put(&mut self, at: Point, what: u32, triangle: u32) {
        let head = &mut self.heads[triangle as usize];
        let target = Target { at, what, triangle, next: *head };
        *head = self.targets.len() as u32;
        self.targets.push(target);
    }

    fn spread(&mut self, growth: &Growth<'_>, source: Point) -> bool {
        self.beams.push(Beam {
            image: source,
            left: Vector::zeros(),
            right: Vector::zeros(),
            gate: NONE,
            parent: NONE,
            wall: NONE,
            order: 0,
            turn: 0.0,
            kept: 1.0,
        });
        let mut triangles = core::mem::take(&mut self.triangles);
        growth.mesh.containing(source, &mut triangles);
        self.leave(growth, source, &triangles);
        self.triangles = triangles;
        let mut next = 1;
        while let Some(&beam) = self.beams.get(next) {
            if self.beams.len() + self.sightings.len() + self.pole_cones.len() > growth.budget {
                return false;
            }
            self.stack.push(Cone { gate: beam.gate, left: beam.left, right: beam.right });
            self.walk(growth, &beam, next as u32, beam.order < growth.max_order);
            next += 1;
        }
        true
    }

    /// From the source's own triangle (two on a side, a fan on a corner) out through its sides.
    fn leave(&mut self, growth: &Growth<'_>, source: Point, triangles: &[u32]) {
        let beam = self.beams[0];
        for &triangle in triangles {
            let mut target = self.heads[triangle as usize];
            while target != NONE {
                let Target { at, what, next, .. } = self.targets[target as usize];
                // All around the source lies in its triangle, so there is no cone to test.
                let ahead = at - source;
                if what & POLE != 0 {
                    for (left, right) in [(Vector::y(), -Vector::y()), (-Vector::y(), Vector::y())] {
                        self.pole_cones.push(PoleCone { pole: what & !POLE, triangle, beam: 0, left, right });
                    }
                } else if ahead.norm() <= growth.max_length_m {
                    self.see(&beam, NONE, what, ahead.norm());
                }
                target = next;
            }
            for side in growth.mesh.sides(triangle) {
                let (left, right) = (side.left - source, side.right - source);
                // A side through the source shows it nothing; what is behind it belongs to a triangle of the list too.
                if cross(right, left) <= SAME_DIRECTION * (left - right).norm() * (left.norm() + right.norm()) {
                    continue;
                }
                if let Some((left, right)) = growth.lit(left, right) {
                    let go_on = growth.max_order > 0;
                    if let Some(gate) = self.meet(growth, &beam, 0, side.exit, left, right, go_on) {
                        self.stack.push(Cone { gate, left, right });
                    }
                }
            }
        }
        self.walk(growth, &beam, 0, growth.max_order > 0);
    }

    /// Follows the cones on the stack through the mesh to the walls.
    fn walk(&mut self, growth: &Growth<'_>, beam: &Beam, index: u32, go_on: bool) {
        let gates = growth.mesh.gates.as_slice();
        while let Some(Cone { mut gate, mut left, right }) = self.stack.pop() {
            loop {
                let head = self.heads[gate as usize / 3];
                if head != NONE {
                    self.look(growth, beam, index, head, gate / 3, left, right);
                }
                let here = &gates[gate as usize];
                let apex = here.apex - beam.image;
                // A corner on a limit counts as outside: a cone without width sees nothing.
                let exit = if cross(left, apex) >= 0.0 {
                    here.right
                } else if cross(right, apex) <= 0.0 {
                    here.left
                } else {
                    if let Some(gate) = self.meet(growth, beam, index, here.left, left, apex, go_on) {
                        self.stack.push(Cone { gate, left, right: apex });
                    }
                    left = apex;
                    here.right
                };
                match self.meet(growth, beam, index, exit, left, right, go_on) {
                    Some(next) => gate = next,
                    None => break,
                }
            }
        }
    }

    /// Goes through an exit: into the next triangle (returned), or to a wall, where the beam of the next order starts.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "the parts of a beam in flight, kept in registers")]
    fn meet(
        &mut self,
        growth: &Growth<'_>,
        beam: &Beam,
        index: u32,
        exit: Exit,
        left: Vector,
        right: Vector,
        go_on: bool,
    ) -> Option<u32> {
        match exit.beyond() {
            Beyond::Gate(gate) => return Some(gate),
            Beyond::Wall(gate) if go_on => self.reflect(growth, beam, index, gate, left, right),
            Beyond::Wall(_) | Beyond::Swallow => {}
        }
        None
    }

    #[inline]
    fn reflect(&mut self, growth: &Growth<'_>, beam: &Beam, index: u32, gate: u32, left: Vector, right: Vector) {
        let wall = growth.mesh.walls[gate as usize];
        let mirror = &growth.mirrors[wall as usize];
        let distance = mirror.distance(beam.image);
        if distance.abs() > growth.max_length_m {
            return;
        }
        let next = Beam {
            image: mirror.image(beam.image, distance),
            // Mirroring swaps the sides.
            left: mirror.turned(right),
            right: mirror.turned(left),
            gate,
            parent: index,
            wall,
            order: beam.order + 1,
            turn: mirror.turn - beam.turn,
            kept: beam.kept * mirror.reflection,
        };
        if growth.last_for_receivers
            && next.order == growth.max_order
            && !self.block.may_see(next.image, next.left, next.right)
        {
            return;
        }
        self.beams.push(next);
    }

    /// Looks for receivers and poles in a triangle that the cone passes.
    #[inline]
    #[allow(clippy::too_many_arguments, reason = "the parts of a beam in flight")]
    fn look(
        &mut self,
        growth: &Growth<'_>,
        beam: &Beam,
        index: u32,
        head: u32,
        triangle: u32,
        left: Vector,
        right: Vector,
    ) {
        let mut target = head;
        while target != NONE {
            let Target { at, what, next, .. } = self.targets[target as usize];
            target = next;
            let ahead = at - beam.image;
            if what & POLE != 0 {
                let cone = PoleCone { pole: what & !POLE, triangle, beam: index, left, right };
                self.pass_pole(growth, ahead, cone);
            } else if cone_holds(left, right, ahead) {
                let length = ahead.norm();
                if length <= growth.max_length_m {
                    self.see(beam, beam.wall, what, length);
                }
            }
        }
    }

    #[cold]
    fn pass_pole(&mut self, growth: &Growth<'_>, ahead: Vector, cone: PoleCone) {
        let radius = growth.poles[cone.pole as usize].radius_m * (1.0 + 1e-9);
        if cross(ahead, cone.left) >= -radius * cone.left.norm()
            && cross(cone.right, ahead) >= -radius * cone.right.norm()
        {
            self.pole_cones.push(cone);
        }
    }

    /// Forgets what is certainly too faint.
    pub(crate) fn drop_faint(&mut self, gate: &Gate, receivers: &[Point]) {
        // Sightings of one beam follow each other.
        let (mut turn, mut order, mut axis) = (f64::NAN, 0, Vector::zeros());
        self.sightings.retain(|sighting| {
            if turn != sighting.turn || order != sighting.order % 2 {
                (turn, order) = (sighting.turn, sighting.order % 2);
                // Where the source heads, as seen in the image's world.
                let heading = if order == 0 { gate.source_rad() + turn } else { turn - gate.source_rad() };
                axis = Vector::new(heading.cos(), heading.sin());
            }
            let Some(at) = receivers.get(sighting.receiver as usize) else { return true };
            let ahead = at - sighting.image;
            let departure_cos = ahead.dot(&axis) / sighting.length_m;
            gate.walls(departure_cos, sighting.receiver as usize, -ahead, sighting.length_m, sighting.kept)
        });
    }

    #[inline]
    fn see(&mut self, beam: &Beam, wall: u32, receiver: u32, length_m: f64) {
        if beam.order == 0 && length_m <= TOUCH_M {
            return; // a sensor does not hear itself along a path of no length
        }
        self.sightings.push(Sighting {
            length_m,
            image: beam.image,
            turn: beam.turn,
            kept: beam.kept,
            receiver,
            order: beam.order,
            parent: beam.parent,
            wall,
        });
    }
}

/// The receivers as one block of numbers, to drop beams of the last order that point at none of them.
#[derive(Debug)]
struct Block {
    x: [f64; BLOCK],
    y: [f64; BLOCK],
    len: usize,
    all: bool,
    /// A disc around all of them, to be quicker when they stand together.
    middle: Point,
    radius: f64,
}

impl Default for Block {
    fn default() -> Self {
        Self { x: [0.0; BLOCK], y: [0.0; BLOCK], len: 0, all: false, middle: Point::origin(), radius: 0.0 }
    }
}

impl Block {
    fn fill(&mut self, receivers: &[Point]) {
        self.all = receivers.len() > BLOCK;
        self.enclose(receivers);
        // Filled up with repetitions to whole groups of four, which the compiler turns into vector instructions.
        self.len = if self.all { 0 } else { receivers.len().next_multiple_of(4) };
        for k in 0..self.len {
            let receiver = receivers[k.min(receivers.len() - 1)];
            self.x[k] = receiver.x;
            self.y[k] = receiver.y;
        }
    }

    fn enclose(&mut self, receivers: &[Point]) {
        let count = receivers.len().max(1) as f64;
        let sum = receivers.iter().fold(Vector::zeros(), |sum, at| sum + at.coords);
        self.middle = Point::from(sum / count);
        let far = receivers.iter().map(|at| (at - self.middle).norm());
        self.radius = far.fold(0.0, f64::max) * (1.0 + 1e-9) + TOUCH_M;
    }

    /// Whether any receiver may be in the cone; never wrong when it says no.
    #[inline]
    fn may_see(&self, image: Point, left: Vector, right: Vector) -> bool {
        let ahead = self.middle - image;
        // The sum of a vector's coordinates is no less than its length.
        let reach = |limit: Vector| -self.radius * (limit.x.abs() + limit.y.abs());
        if cross(ahead, left) < reach(left) || cross(right, ahead) < reach(right) {
            return false;
        }
        if self.all {
            return true;
        }
        let size = |v: Vector| v.x.abs() + v.y.abs();
        let (slack_l, slack_r) = (2.0 * SAME_DIRECTION * size(left), 2.0 * SAME_DIRECTION * size(right));
        let groups = self.x[..self.len].chunks_exact(4).zip(self.y[..self.len].chunks_exact(4));
        for (xs, ys) in groups {
            let mut any = false;
            for k in 0..4 {
                let (x, y) = (xs[k] - image.x, ys[k] - image.y);
                let size = x.abs() + y.abs();
                let l = x * left.y - y * left.x;
                let r = right.x * y - right.y * x;
                any |= (l >= -slack_l * size) & (r >= -slack_r * size);
            }
            if any {
                return true;
            }
        }
        false
    }
}
