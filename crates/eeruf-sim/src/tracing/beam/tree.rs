//! Growth of the beam tree: beams leave the source, pass through the mesh and are reflected at walls.

use super::growth::Growth;
use super::receiver_block::ReceiverBlock;
use super::{Beam, PoleCone, VisibleImage, cone_holds};
use crate::{
    geometry::{Point, SAME_DIRECTION, TOUCH_M, Vector, cross},
    scene::{Beyond, Exit, Gate, NONE},
    tracing::ends::Ends,
};

/// Number of beams between two checks of the stop switch.
const BEAMS_PER_LOOK: usize = 256;
/// Marker of a target that is a pole.
const POLE: u32 = 1 << 31;
/// A point to be found in a triangle; each triangle has a list of them.
#[derive(Clone, Copy, Debug)]
struct Target {
    at: Point,
    /// The index of a receiver, or of a pole with the bit [`POLE`] set.
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

/// A beam in flight through the mesh.
#[derive(Clone, Copy)]
struct Flight<'a> {
    growth: &'a Growth<'a>,
    beam: &'a Beam,
    /// The beam's number in the tree.
    index: u32,
    /// True if walls reflect the beam: for all orders except the last.
    reflects: bool,
}

/// The tree and its buffers, which are reused without allocating.
#[derive(Debug, Default)]
pub(crate) struct BeamTree {
    pub(crate) beams: Vec<Beam>,
    pub(crate) visible_images: Vec<VisibleImage>,
    pub(crate) pole_cones: Vec<PoleCone>,
    /// First target of each triangle; all [`NONE`] between queries.
    heads: Vec<u32>,
    targets: Vec<Target>,
    stack: Vec<Cone>,
    block: ReceiverBlock,
}

impl BeamTree {
    /// Grows the tree of a source in these triangles. Returns true if it is complete: the budget was not exceeded, and
    /// the work was not stopped.
    pub(crate) fn grow(
        &mut self,
        growth: &Growth<'_>,
        (source, triangles): (Point, &[u32]),
        receivers: &[Point],
        ends: &Ends,
    ) -> bool {
        self.beams.clear();
        self.visible_images.clear();
        self.pole_cones.clear();
        self.set_targets(growth, receivers, ends);
        let complete = self.spread(growth, source, triangles);
        for target in &self.targets {
            self.heads[target.triangle as usize] = NONE;
        }
        self.targets.clear();
        complete
    }

    fn set_targets(&mut self, growth: &Growth<'_>, receivers: &[Point], ends: &Ends) {
        if self.heads.len() < growth.mesh.len() {
            self.heads.resize(growth.mesh.len(), NONE);
        }
        for (receiver, &at) in receivers.iter().enumerate() {
            for &triangle in ends.of_receiver(receiver) {
                self.put(at, receiver as u32, triangle);
            }
        }
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

    fn spread(&mut self, growth: &Growth<'_>, source: Point, triangles: &[u32]) -> bool {
        self.beams.push(Beam {
            image: source,
            left: Vector::zeros(),
            right: Vector::zeros(),
            gate: NONE,
            parent: NONE,
            wall: NONE,
            order: 0,
            turn: 0.0,
            reflection_gain: 1.0,
            axis: growth.aim.map_or(Vector::zeros(), |aim| aim.axis()),
            reach_m: growth.aim.map_or(f64::INFINITY, |aim| aim.longest_m()).min(growth.max_length_m),
        });
        self.leave(growth, source, triangles);
        let mut next = 1;
        while let Some(&beam) = self.beams.get(next) {
            let size = self.beams.len() + self.visible_images.len() + self.pole_cones.len();
            if size > growth.budget || next.is_multiple_of(BEAMS_PER_LOOK) && growth.stop.is_stopped() {
                return false;
            }
            self.stack.push(Cone { gate: beam.gate, left: beam.left, right: beam.right });
            let reflects = beam.order < growth.max_order;
            self.walk(&Flight { growth, beam: &beam, index: next as u32, reflects });
            next += 1;
        }
        true
    }

    /// Starts from the source's own triangles (two at a side, a fan at a corner) through their sides.
    fn leave(&mut self, growth: &Growth<'_>, source: Point, triangles: &[u32]) {
        let beam = self.beams[0];
        let flight = Flight { growth, beam: &beam, index: 0, reflects: growth.max_order > 0 };
        for &triangle in triangles {
            let mut target = self.heads[triangle as usize];
            while target != NONE {
                let Target { at, what, next, .. } = self.targets[target as usize];
                // The source sees every point of its triangle, so there is no cone to test.
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
                // A side through the source hides everything behind it, which belongs to another triangle of the list.
                if cross(right, left) <= SAME_DIRECTION * (left - right).norm() * (left.norm() + right.norm()) {
                    continue;
                }
                if let Some((left, right)) = growth.ensonified(left, right)
                    && let Some(gate) = self.leave_through(&flight, side.exit, left, right)
                {
                    self.stack.push(Cone { gate, left, right });
                }
            }
        }
        self.walk(&flight);
    }

    /// Follows the cones on the stack through the mesh to the walls.
    fn walk(&mut self, flight: &Flight<'_>) {
        let beam = flight.beam;
        let gates = flight.growth.mesh.gates.as_slice();
        let reach2 = beam.reach_m * beam.reach_m;
        while let Some(Cone { mut gate, mut left, right }) = self.stack.pop() {
            for step in 1_u32.. {
                // The check is made only sometimes, so that it costs nothing if walls are near.
                if step.is_multiple_of(4) && is_beyond(gates, gate, beam.image, reach2) {
                    break;
                }
                let head = self.heads[gate as usize / 3];
                if head != NONE {
                    self.look(flight, head, gate / 3, left, right);
                }
                let here = &gates[gate as usize];
                let apex = here.apex - beam.image;
                // A corner on a limit counts as outside: a cone without width sees nothing.
                let exit = if cross(left, apex) >= 0.0 {
                    here.right
                } else if cross(right, apex) <= 0.0 {
                    here.left
                } else {
                    if let Some(gate) = self.leave_through(flight, here.left, left, apex) {
                        self.stack.push(Cone { gate, left, right: apex });
                    }
                    left = apex;
                    here.right
                };
                match self.leave_through(flight, exit, left, right) {
                    Some(next) => gate = next,
                    None => break,
                }
            }
        }
    }

    /// Passes an exit: returns the next triangle, or at a wall starts the beam of the next order and returns `None`.
    #[inline(always)]
    fn leave_through(&mut self, flight: &Flight<'_>, exit: Exit, left: Vector, right: Vector) -> Option<u32> {
        match exit.beyond() {
            Beyond::Gate(gate) => return Some(gate),
            Beyond::Wall(gate) if flight.reflects => self.reflect(flight, gate, left, right),
            Beyond::Wall(_) | Beyond::Swallow => {}
        }
        None
    }

    #[inline]
    fn reflect(&mut self, flight: &Flight<'_>, gate: u32, left: Vector, right: Vector) {
        let Flight { growth, beam, index, .. } = *flight;
        let wall = growth.mesh.walls[gate as usize];
        let mirror = &growth.mirrors[wall as usize];
        let distance = mirror.distance(beam.image);
        if distance.abs() > beam.reach_m {
            return;
        }
        let image = mirror.image(beam.image, distance);
        // Mirroring swaps the sides.
        let (left, right) = (mirror.turned(right), mirror.turned(left));
        let last = growth.last_for_receivers && beam.order + 1 == growth.max_order;
        if last && !self.block.may_see(image, left, right) {
            return;
        }
        let (axis, reflection_gain) = (mirror.turned(beam.axis), beam.reflection_gain * mirror.reflection);
        let reach_m = growth.reach_m(axis, left, right, reflection_gain);
        if distance.abs() > reach_m || last && self.block.is_beyond(image, reach_m) {
            return;
        }
        self.beams.push(Beam {
            image,
            left,
            right,
            gate,
            parent: index,
            wall,
            order: beam.order + 1,
            turn: mirror.turn - beam.turn,
            reflection_gain,
            axis,
            reach_m,
        });
    }

    /// Finds receivers and poles in a triangle that the cone passes.
    #[inline]
    fn look(&mut self, flight: &Flight<'_>, head: u32, triangle: u32, left: Vector, right: Vector) {
        let Flight { growth, beam, index, .. } = *flight;
        let mut target = head;
        while target != NONE {
            let Target { at, what, next, .. } = self.targets[target as usize];
            target = next;
            let ahead = at - beam.image;
            if what & POLE != 0 {
                if beam.order < growth.pole_order {
                    let cone = PoleCone { pole: what & !POLE, triangle, beam: index, left, right };
                    self.pass_pole(growth, ahead, cone);
                }
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

    #[inline]
    fn see(&mut self, beam: &Beam, wall: u32, receiver: u32, length_m: f64) {
        if beam.order == 0 && length_m <= TOUCH_M {
            return; // a sensor does not hear itself along a path of no length
        }
        self.visible_images.push(VisibleImage {
            length_m,
            image: beam.image,
            turn: beam.turn,
            reflection_gain: beam.reflection_gain,
            receiver,
            order: beam.order,
            parent: beam.parent,
            wall,
            axis: beam.axis,
        });
    }
}

/// Returns true if the line of a gate, and so everything behind it, is farther from a point than a length. `length2` is
/// the square of the length.
#[inline]
fn is_beyond(gates: &[Gate], gate: u32, from: Point, length2: f64) -> bool {
    let first = gate - gate % 3;
    let end = |turn: u32| gates[(first + (gate + turn) % 3) as usize].apex;
    let (near, along) = (end(1), end(2) - end(1));
    let area = cross(along, from - near);
    area * area > length2 * along.norm_squared()
}
