//! A scene: checked walls and poles in air, with everything that is derived from them once (mesh, mirrors, broad phase).
//! Robots, noise and seeds wrap around it; a scene itself never changes.

use crate::{
    air::Air,
    error::SceneError,
    mesh::{Mesh, Piece},
    plane::{Mirror, Point, TOUCH_M, cross},
    pole::Pole,
    wall::Wall,
};
use parry2d_f64::{
    bounding_volume::Aabb,
    partitioning::{Bvh, BvhBuildStrategy},
};

/// The most walls a scene may have.
pub const MAX_WALLS: usize = 10_000_000;
/// No coordinate may be farther from the origin, in metres.
pub const MAX_COORDINATE_M: f64 = 1e5;
/// The shortest wall, in metres.
pub const MIN_WALL_M: f64 = 1e-6;
/// The thickest pole's radius, in metres.
pub const MAX_POLE_M: f64 = 100.0;

/// Walls, poles and air, checked and ready for questions.
#[derive(Debug)]
pub struct Scene {
    walls: Vec<Wall>,
    poles: Vec<Pole>,
    air: Air,
    pub(crate) mesh: Mesh,
    pub(crate) mirrors: Vec<Mirror>,
    pub(crate) wall_boxes: Bvh,
    /// Which triangles each pole's disc overlaps: (triangle, pole).
    pub(crate) pole_triangles: Vec<(u32, u32)>,
    /// Whether any surface is rough.
    pub(crate) rough: bool,
}

impl Scene {
    /// Checks walls and poles and builds the mesh.
    ///
    /// Walls may share end points, and one may end on another; they may not cross or overlap. Building takes about a
    /// microsecond per wall and is done once per map.
    ///
    /// # Errors
    /// The first thing found wrong, naming the wall or pole by its index.
    ///
    /// ```
    /// use eeruf_sim::{Air, Scene, Wall};
    /// let crossing = vec![Wall::new(0.0, 0.0, 2.0, 2.0), Wall::new(0.0, 2.0, 2.0, 0.0)];
    /// let error = Scene::new(crossing, vec![], Air::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "walls 0 and 1 cross at (1.0000, 1.0000); end one of them there");
    /// ```
    pub fn new(walls: Vec<Wall>, poles: Vec<Pole>, air: Air) -> Result<Self, SceneError> {
        air.check()?;
        check_walls(&walls)?;
        check_poles(&poles)?;
        let wall_boxes =
            Bvh::from_iter(BvhBuildStrategy::Binned, walls.iter().enumerate().map(|(i, wall)| (i, wall_box(wall))));
        let (vertices, pieces) = join(&walls, &wall_boxes)?;
        let mesh = Mesh::build(vertices, &pieces, &walls, poles.iter().map(|pole| pole.centre))?;
        let mirrors = walls.iter().map(|wall| Mirror::through(wall.from, wall.to, wall.material.reflection)).collect();
        let materials = walls.iter().map(|wall| wall.material).chain(poles.iter().map(|pole| pole.material));
        let rough = materials.into_iter().any(|material| material.roughness_m > 0.0);
        let mut pole_triangles = Vec::new();
        for (index, pole) in poles.iter().enumerate() {
            let near = mesh.near(pole.centre, pole.radius_m * (1.0 + 1e-9));
            pole_triangles.extend(near.into_iter().map(|triangle| (triangle, index as u32)));
        }
        Ok(Self { walls, poles, air, mesh, mirrors, wall_boxes, pole_triangles, rough })
    }

    /// The walls, in the order given.
    pub fn walls(&self) -> &[Wall] {
        &self.walls
    }

    /// The poles, in the order given.
    pub fn poles(&self) -> &[Pole] {
        &self.poles
    }

    /// The air.
    pub fn air(&self) -> Air {
        self.air
    }

    /// Whether a point lies inside something solid: within a pillar, or outside a closed room. A point in a pole is not;
    /// see [`contact`](Self::contact).
    pub fn is_solid(&self, point: Point) -> bool {
        self.mesh.is_solid(point)
    }
}

fn check_walls(walls: &[Wall]) -> Result<(), SceneError> {
    if walls.len() > MAX_WALLS {
        return Err(SceneError::TooManyWalls { count: walls.len() });
    }
    for (index, wall) in walls.iter().enumerate() {
        for value in [wall.from.x, wall.from.y, wall.to.x, wall.to.y] {
            if !(value.abs() <= MAX_COORDINATE_M) {
                return Err(SceneError::WallCoordinate { wall: index, value });
            }
        }
        if wall.length_m() < MIN_WALL_M {
            return Err(SceneError::WallTooShort { wall: index, length_m: wall.length_m() });
        }
        if !wall.material.is_valid() {
            return Err(SceneError::WallMaterial { wall: index });
        }
    }
    Ok(())
}

fn check_poles(poles: &[Pole]) -> Result<(), SceneError> {
    for (index, pole) in poles.iter().enumerate() {
        for value in [pole.centre.x, pole.centre.y] {
            if !(value.abs() <= MAX_COORDINATE_M) {
                return Err(SceneError::Pole { pole: index, value });
            }
        }
        if !(pole.radius_m > 0.0 && pole.radius_m <= MAX_POLE_M) {
            return Err(SceneError::Pole { pole: index, value: pole.radius_m });
        }
        if !pole.material.is_valid() {
            return Err(SceneError::PoleMaterial { pole: index });
        }
    }
    let mut by_x: Vec<usize> = (0..poles.len()).collect();
    by_x.sort_by(|&a, &b| poles[a].centre.x.total_cmp(&poles[b].centre.x));
    for (rank, &a) in by_x.iter().enumerate() {
        let near = by_x[rank + 1..].iter().take_while(|&&b| poles[b].centre.x - poles[a].centre.x <= TOUCH_M);
        for &b in near {
            if (poles[a].centre - poles[b].centre).norm() <= TOUCH_M {
                return Err(SceneError::SamePole { poles: [a.min(b), a.max(b)] });
            }
        }
    }
    Ok(())
}

fn wall_box(wall: &Wall) -> Aabb {
    let (low, high) = (wall.from.inf(&wall.to), wall.from.sup(&wall.to));
    Aabb::new(low.coords.into(), high.coords.into())
}

/// Merges end points that touch and cuts walls where others end on them.
fn join(walls: &[Wall], boxes: &Bvh) -> Result<(Vec<Point>, Vec<Piece>), SceneError> {
    // Corner 2 i is where wall i starts, 2 i + 1 where it ends; `same` leads from a corner to the first one at its place.
    let corner = |c: usize| {
        if c.is_multiple_of(2) { walls[c / 2].from } else { walls[c / 2].to }
    };
    let mut same: Vec<usize> = (0..2 * walls.len()).collect();
    let mut cuts: Vec<(usize, usize)> = Vec::new();
    for (b, wall) in walls.iter().enumerate() {
        let margin = parry2d_f64::math::Vector::splat(TOUCH_M);
        let mut grown = wall_box(wall);
        grown.mins -= margin;
        grown.maxs += margin;
        for a in boxes.intersect_aabb(&grown) {
            let a = a as usize;
            if a >= b {
                continue;
            }
            let meeting = meet(&walls[a], &walls[b]);
            let touching = meeting.joined.iter().flatten().count()
                + meeting.on_first.iter().chain(&meeting.on_second).filter(|on| **on).count();
            if touching > 1 {
                return Err(SceneError::WallsOverlap { walls: [a, b] });
            }
            for (end_a, ends) in meeting.joined.iter().enumerate() {
                if let Some(end_b) = ends {
                    let (ra, rb) = (root(&mut same, 2 * a + end_a), root(&mut same, 2 * b + end_b));
                    same[ra.max(rb)] = ra.min(rb);
                }
            }
            for end in 0..2 {
                if meeting.on_first[end] {
                    cuts.push((a, 2 * b + end));
                }
                if meeting.on_second[end] {
                    cuts.push((b, 2 * a + end));
                }
            }
            if let (0, Some(at)) = (touching, meeting.crossing) {
                return Err(SceneError::WallsCross { walls: [a, b], at: [at.x, at.y] });
            }
        }
    }

    let mut vertex_of = vec![usize::MAX; 2 * walls.len()];
    let mut vertices = Vec::new();
    for c in 0..2 * walls.len() {
        let first = root(&mut same, c);
        if vertex_of[first] == usize::MAX {
            vertex_of[first] = vertices.len();
            vertices.push(corner(first));
        }
        vertex_of[c] = vertex_of[first];
    }
    cuts.sort_unstable();
    let mut pieces = Vec::with_capacity(walls.len() + cuts.len());
    let mut cut = 0;
    let mut stops: Vec<(f64, usize)> = Vec::new();
    for (index, wall) in walls.iter().enumerate() {
        stops.clear();
        while let Some(&(_, c)) = cuts.get(cut).filter(|(cut_wall, _)| *cut_wall == index) {
            stops.push(((corner(c) - wall.from).dot(&(wall.to - wall.from)), vertex_of[c]));
            cut += 1;
        }
        stops.sort_by(|p, q| p.0.total_cmp(&q.0));
        let mut from = vertex_of[2 * index];
        for to in stops.iter().map(|stop| stop.1).chain([vertex_of[2 * index + 1]]) {
            if from != to {
                pieces.push(Piece { ends: [from, to], wall: index });
                from = to;
            }
        }
    }
    Ok((vertices, pieces))
}

fn root(same: &mut [usize], mut corner: usize) -> usize {
    while same[corner] != corner {
        same[corner] = same[same[corner]];
        corner = same[corner];
    }
    corner
}

/// How two walls meet.
#[derive(Default)]
struct Meeting {
    /// For each end of the first wall, the end of the second that it is joined to.
    joined: [Option<usize>; 2],
    /// Ends of the second wall that lie within the first.
    on_first: [bool; 2],
    /// Ends of the first wall that lie within the second.
    on_second: [bool; 2],
    crossing: Option<Point>,
}

fn meet(a: &Wall, b: &Wall) -> Meeting {
    let mut meeting = Meeting::default();
    let (ends_a, ends_b) = ([a.from, a.to], [b.from, b.to]);
    let mut joined_b = [false; 2];
    for i in 0..2 {
        for j in 0..2 {
            if (ends_a[i] - ends_b[j]).norm() <= TOUCH_M {
                meeting.joined[i] = Some(j);
                joined_b[j] = true;
            }
        }
    }
    for end in 0..2 {
        meeting.on_first[end] = !joined_b[end] && within(a, ends_b[end]);
        meeting.on_second[end] = meeting.joined[end].is_none() && within(b, ends_a[end]);
    }
    let (u, v) = (a.to - a.from, b.to - b.from);
    let side = |along, from, point| cross(along, point - from);
    let (s0, s1) = (side(u, a.from, b.from), side(u, a.from, b.to));
    let (t0, t1) = (side(v, b.from, a.from), side(v, b.from, a.to));
    if (s0 < 0.0) != (s1 < 0.0) && (t0 < 0.0) != (t1 < 0.0) {
        meeting.crossing = Some(b.from + v * (s0 / (s0 - s1)));
    }
    meeting
}

/// Whether a point lies on a wall, its ends aside.
fn within(wall: &Wall, point: Point) -> bool {
    let (along, to) = (wall.to - wall.from, point - wall.from);
    let length = along.norm();
    let (s, off) = (along.dot(&to) / length, cross(along, to) / length);
    off.abs() <= TOUCH_M && s > 0.0 && s < length
}
