//! A scene: checked walls and poles in air, with the data derived from them (mesh, mirrors, broad phase). A scene never
//! changes; robots, noise and seeds belong to the world around it.

use super::error::{MAX_COORDINATE_M, MAX_POLE_M, MAX_WALLS, MIN_WALL_M, SceneError};
use super::mesh::Mesh;
use super::mesh::edges::{Edge, edges_of};
use super::mesh::extents::Extents;
use super::mesh::joints::{join_walls, wall_box};
use super::pole::Pole;
use super::room::Room;
use super::wall::Wall;
use crate::geometry::{Mirror, Point, TOUCH_M};
use eeruf_modules::Air;
use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy};
use std::sync::{Arc, OnceLock};

fn check(air: &Air) -> Result<(), SceneError> {
    for (quantity, value, low, high, expected) in [
        ("temperature", air.temperature_c, -50.0, 60.0, "-50 to 60 C"),
        ("humidity", air.humidity_percent, 0.0, 100.0, "0 to 100 %"),
        ("pressure", air.pressure_kpa, 20.0, 200.0, "20 to 200 kPa"),
    ] {
        if !(low..=high).contains(&value) {
            return Err(SceneError::Air { quantity, value, expected });
        }
    }
    Ok(())
}

/// Walls, poles and air, checked and ready for path searches.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Derived data, shared by scenes that differ only in their poles.
    built: Arc<Built>,
    poles: Vec<Pole>,
    air: Air,
    room: Option<Room>,
    /// Pairs (triangle, pole) of overlapping triangles and poles.
    pub(crate) pole_triangles: Vec<(u32, u32)>,
    /// True if any surface is rough.
    pub(crate) rough: bool,
}

/// Walls, with the data derived from them.
#[derive(Debug)]
struct Built {
    walls: Vec<Wall>,
    mesh: Mesh,
    mirrors: Vec<Mirror>,
    boxes: Bvh,
    edges: Vec<Edge>,
    /// For each edge, the triangles that have it as a corner; computed on demand.
    edge_triangles: OnceLock<Vec<Box<[u32]>>>,
    /// Pairs of a triangle and an edge that is its corner, in order; computed on demand.
    triangle_edges: OnceLock<Vec<(u32, u32)>>,
    /// The edges by position; computed on demand.
    edge_boxes: OnceLock<Bvh>,
    /// Extents of walls; computed on demand.
    extents: OnceLock<Extents>,
}

impl Scene {
    /// Checks walls and poles and builds the mesh.
    ///
    /// Walls may share end points, and one may end on another; they may not cross or overlap. Building takes about a
    /// microsecond per wall and is done once per map.
    ///
    /// # Errors
    /// The first error found, naming the wall or pole by its index.
    ///
    /// ```
    /// use eeruf_sim::{Air, Scene, Wall};
    /// let crossing = vec![Wall::new(0.0, 0.0, 2.0, 2.0), Wall::new(0.0, 2.0, 2.0, 0.0)];
    /// let error = Scene::new(crossing, vec![], Air::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "walls 0 and 1 cross at (1.0000, 1.0000); end one of them there");
    /// ```
    pub fn new(walls: Vec<Wall>, poles: Vec<Pole>, air: Air) -> Result<Self, SceneError> {
        check(&air)?;
        check_walls(&walls)?;
        check_poles(&poles)?;
        let boxes =
            Bvh::from_iter(BvhBuildStrategy::Binned, walls.iter().enumerate().map(|(i, wall)| (i, wall_box(wall))));
        let (vertices, pieces) = join_walls(&walls, &boxes)?;
        let edges = edges_of(&vertices, &pieces, &walls);
        let mesh = Mesh::build(vertices, &pieces, &walls, poles.iter().map(|pole| pole.centre))?;
        let mirrors = walls.iter().map(|wall| Mirror::through(wall.from, wall.to, wall.material.reflection)).collect();
        let (edge_triangles, triangle_edges) = (OnceLock::new(), OnceLock::new());
        let (edge_boxes, extents) = (OnceLock::new(), OnceLock::new());
        let built = Built { walls, mesh, mirrors, boxes, edges, edge_triangles, triangle_edges, edge_boxes, extents };
        Ok(Self::over(Arc::new(built), poles, air))
    }

    fn over(built: Arc<Built>, poles: Vec<Pole>, air: Air) -> Self {
        let rough = built.walls.iter().any(|wall| wall.material.roughness_m > 0.0);
        let none = Self { built, poles: Vec::new(), air, room: None, pole_triangles: Vec::new(), rough };
        none.among(poles)
    }

    /// Appends these poles to the scene's own.
    fn among(mut self, more: Vec<Pole>) -> Self {
        for (index, pole) in (self.poles.len() as u32..).zip(&more) {
            let near = self.built.mesh.near(pole.centre, pole.radius_m * (1.0 + 1e-9));
            self.pole_triangles.extend(near.into_iter().map(|triangle| (triangle, index)));
            self.rough |= pole.material.roughness_m > 0.0;
        }
        self.poles.extend(more);
        self
    }

    /// Returns the scene with more poles. The mesh is shared, or built again if a pole lies outside it.
    pub(crate) fn with_more_poles(&self, more: Vec<Pole>) -> Result<Self, SceneError> {
        let Self { built, air, room, rough, .. } = self;
        if !more.iter().all(|pole| built.mesh.covers(pole.centre)) {
            let poles = [&self.poles, &more[..]].concat();
            return Self::new(built.walls.clone(), poles, *air)?.with_room(*room);
        }
        let (poles, pole_triangles) = (self.poles.clone(), self.pole_triangles.clone());
        let (built, air, room, rough) = (Arc::clone(built), *air, *room, *rough);
        let scene = Self { built, poles, air, room, pole_triangles, rough }.among(more);
        check_poles(&scene.poles)?;
        Ok(scene)
    }

    /// Returns the scene between floor and ceiling, or without them flat: all sound stays in one plane, as after
    /// [`Scene::new`].
    ///
    /// # Errors
    /// [`SceneError::Ceiling`] or [`SceneError::RoomMaterial`] for an invalid room.
    pub fn with_room(self, room: Option<Room>) -> Result<Self, SceneError> {
        room.as_ref().map_or(Ok(()), Room::check)?;
        Ok(Self { room, ..self })
    }

    /// Returns floor and ceiling; `None` if the scene is flat.
    pub fn room(&self) -> Option<&Room> {
        self.room.as_ref()
    }

    /// Returns the walls, in the order given.
    pub fn walls(&self) -> &[Wall] {
        &self.built.walls
    }

    /// Returns the poles, in the order given.
    pub fn poles(&self) -> &[Pole] {
        &self.poles
    }

    /// Returns the free ends of walls and the corners that jut out. Sound bends around them with
    /// [`Physics::edges`](crate::Physics::edges). They include edges of solid regions, seen from within.
    pub fn edges(&self) -> &[Edge] {
        &self.built.edges
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.built.mesh
    }

    /// Returns the mirrors of the walls.
    pub(crate) fn mirrors(&self) -> &[Mirror] {
        &self.built.mirrors
    }

    /// Returns the boxes around the walls.
    pub(crate) fn wall_boxes(&self) -> &Bvh {
        &self.built.boxes
    }

    /// Returns the triangles that have an edge as a corner.
    pub(crate) fn triangles_at(&self, edge: usize) -> &[u32] {
        let built = &*self.built;
        let of_all = built.edge_triangles.get_or_init(|| {
            let mut triangles = Vec::new();
            let each = built.edges.iter().map(|edge| {
                built.mesh.containing(edge.at, &mut triangles);
                triangles.as_slice().into()
            });
            each.collect()
        });
        of_all.get(edge).map_or(&[], |triangles| triangles)
    }

    /// Finds the edges that are visible from a point within reach, and some others, in order. `starts` are the
    /// triangles that contain the point.
    pub(crate) fn edges_seen(&self, from: Point, starts: &[u32], reach_m: f64, seen: &mut Vec<u32>) {
        let pairs = self.built.triangle_edges.get_or_init(|| {
            let corner = |edge: u32| self.triangles_at(edge as usize).iter().map(move |&triangle| (triangle, edge));
            let mut pairs: Vec<(u32, u32)> = (0..self.built.edges.len() as u32).flat_map(corner).collect();
            pairs.sort_unstable();
            pairs
        });
        self.mesh().visit_seen(from, starts, reach_m, |triangle| {
            let first = pairs.partition_point(|(other, _)| *other < triangle);
            seen.extend(pairs[first..].iter().take_while(|(other, _)| *other == triangle).map(|(_, edge)| edge));
        });
        seen.sort_unstable();
        seen.dedup();
    }

    /// Returns the edges by position.
    pub(crate) fn edge_boxes(&self) -> &Bvh {
        let Built { edges, edge_boxes, .. } = &*self.built;
        edge_boxes.get_or_init(|| {
            let each = edges.iter().map(|edge| edge.at.coords.into());
            Bvh::from_iter(BvhBuildStrategy::Binned, each.map(|at| Aabb::new(at, at)).enumerate())
        })
    }

    /// Extents of walls, for [`Physics::narrow_panels`](crate::Physics::narrow_panels).
    pub(crate) fn extents(&self) -> &Extents {
        let Built { walls, boxes, edges, extents, .. } = &*self.built;
        extents.get_or_init(|| {
            // These walls were joined before, when the scene was made.
            let (vertices, pieces) = join_walls(walls, boxes).unwrap_or_default();
            Extents::new(&vertices, &pieces, walls, edges)
        })
    }

    /// Returns the air.
    pub fn air(&self) -> Air {
        self.air
    }

    /// Returns true if a point lies inside a solid: within a pillar, or outside a closed room. A point in a pole is not
    /// solid; see [`contact`](Self::contact).
    pub fn is_solid(&self, point: Point) -> bool {
        self.built.mesh.is_solid(point)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    #[test]
    fn poles_added_later_are_as_those_from_the_start() {
        let walls: Vec<_> = Wall::polyline(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]]).collect();
        let rough = Material { roughness_m: 1e-3, ..Material::SMOOTH };
        let poles = [[1.0, 1.0], [4.5, 1.2], [0.3, 3.8]].map(|[x, y]| Pole::new(x, y, 0.25));
        let poles = [poles[0], poles[1], Pole { material: rough, ..poles[2] }];
        let scene =
            |poles: &[Pole]| Scene::new(walls.clone(), poles.to_vec(), Air::default())?.with_room(Some(Room::DEFAULT));
        let (whole, first) = (scene(&poles).unwrap(), scene(&poles[..1]).unwrap());
        let more = first.with_more_poles(poles[1..].to_vec()).unwrap();
        assert_eq!(more.pole_triangles, whole.pole_triangles);
        assert_eq!((more.poles(), more.room(), more.rough), (whole.poles(), whole.room(), true));
        // The pole lies beyond the mesh, which ends a kilometre and more from the walls.
        let far = Pole::new(5000.0, 0.0, 0.25);
        assert!(first.with_more_poles(vec![far]).unwrap().mesh().covers(far.centre));
        let same = first.with_more_poles(vec![poles[0]]).unwrap_err().to_string();
        assert!(same.contains("poles 0 and 1"), "{same}");
    }
}
