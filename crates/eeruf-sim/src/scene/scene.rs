//! A scene: checked walls and poles in air, with everything that is derived from them once (mesh, mirrors, broad
//! phase). Robots, noise and seeds wrap around it; a scene itself never changes.

use super::air::Air;
use super::error::{MAX_COORDINATE_M, MAX_POLE_M, MAX_WALLS, MIN_WALL_M, SceneError};
use super::mesh::Mesh;
use super::mesh::edges::{Edge, edges_of};
use super::mesh::extents::Extents;
use super::mesh::joints::{join_walls, wall_box};
use super::pole::Pole;
use super::room::Room;
use super::wall::Wall;
use crate::geometry::{Mirror, Point, TOUCH_M};
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy};
use std::sync::OnceLock;

/// Walls, poles and air, checked and ready for questions.
#[derive(Debug)]
pub struct Scene {
    walls: Vec<Wall>,
    poles: Vec<Pole>,
    air: Air,
    room: Option<Room>,
    pub(crate) mesh: Mesh,
    pub(crate) mirrors: Vec<Mirror>,
    pub(crate) wall_boxes: Bvh,
    /// Overlaps of triangles and poles' discs: (triangle, pole).
    pub(crate) pole_triangles: Vec<(u32, u32)>,
    edges: Vec<Edge>,
    /// The triangles that each edge is a corner of; found when first asked for.
    edge_triangles: OnceLock<Vec<Box<[u32]>>>,
    /// Extents of walls; found when first asked for.
    extents: OnceLock<Extents>,
    /// True if any surface is rough.
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
        let (vertices, pieces) = join_walls(&walls, &wall_boxes)?;
        let edges = edges_of(&vertices, &pieces, &walls);
        let mesh = Mesh::build(vertices, &pieces, &walls, poles.iter().map(|pole| pole.centre))?;
        let mirrors = walls.iter().map(|wall| Mirror::through(wall.from, wall.to, wall.material.reflection)).collect();
        let materials = walls.iter().map(|wall| wall.material).chain(poles.iter().map(|pole| pole.material));
        let rough = materials.into_iter().any(|material| material.roughness_m > 0.0);
        let mut pole_triangles = Vec::new();
        for (index, pole) in poles.iter().enumerate() {
            let near = mesh.near(pole.centre, pole.radius_m * (1.0 + 1e-9));
            pole_triangles.extend(near.into_iter().map(|triangle| (triangle, index as u32)));
        }
        Ok(Self {
            walls,
            poles,
            air,
            room: None,
            mesh,
            mirrors,
            wall_boxes,
            pole_triangles,
            edges,
            edge_triangles: OnceLock::new(),
            extents: OnceLock::new(),
            rough,
        })
    }

    /// The same scene between floor and ceiling, or flat without them: all sound in one plane, as
    /// [`Scene::new`] makes it.
    ///
    /// # Errors
    /// [`SceneError::Ceiling`] or [`SceneError::RoomMaterial`] for an invalid room.
    pub fn with_room(self, room: Option<Room>) -> Result<Self, SceneError> {
        room.as_ref().map_or(Ok(()), Room::check)?;
        Ok(Self { room, ..self })
    }

    /// Floor and ceiling; none if the scene is flat.
    pub fn room(&self) -> Option<&Room> {
        self.room.as_ref()
    }

    /// The walls, in the order given.
    pub fn walls(&self) -> &[Wall] {
        &self.walls
    }

    /// The poles, in the order given.
    pub fn poles(&self) -> &[Pole] {
        &self.poles
    }

    /// The free ends of walls and the corners that jut out, which sound bends around if
    /// [`Physics::edges`](crate::Physics::edges) says so. Those of solid regions, seen from within, are among them.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The triangles that an edge is a corner of.
    pub(crate) fn triangles_at(&self, edge: usize) -> &[u32] {
        let of_all = self.edge_triangles.get_or_init(|| {
            let mut triangles = Vec::new();
            let each = self.edges.iter().map(|edge| {
                self.mesh.containing(edge.at, &mut triangles);
                triangles.as_slice().into()
            });
            each.collect()
        });
        of_all.get(edge).map_or(&[], |triangles| triangles)
    }

    /// Extents of walls, for [`Physics::narrow_panels`](crate::Physics::narrow_panels).
    pub(crate) fn extents(&self) -> &Extents {
        self.extents.get_or_init(|| {
            // The same walls were joined when the scene was made.
            let (vertices, pieces) = join_walls(&self.walls, &self.wall_boxes).unwrap_or_default();
            Extents::new(&vertices, &pieces, &self.walls, &self.edges)
        })
    }

    /// The air.
    pub fn air(&self) -> Air {
        self.air
    }

    /// Returns true if a point lies inside something solid: within a pillar, or outside a closed room. A point in a
    /// pole is not; see [`contact`](Self::contact).
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
            if value.is_nan() || value.abs() > MAX_COORDINATE_M {
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
            if value.is_nan() || value.abs() > MAX_COORDINATE_M {
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
