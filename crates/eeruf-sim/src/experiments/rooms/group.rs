//! Rooms of one kind, of the caller's own, or of a map.

use super::plan::{DRIVING_S, RoomKind, RoomPlan};
use crate::{maps::OccupancyGrid, world::World};

/// Rooms whose figures are combined.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomGroup {
    /// The name in tables and in JSON.
    pub name: String,
    /// The rooms.
    pub rooms: Vec<RoomPlan>,
}

impl RoomGroup {
    /// Rooms of one kind with consecutive numbers, for a robot that needs a circle of this radius. Ways are chosen on
    /// numbers below 2,000, and reported from [`FIRST`](crate::experiments::FIRST) on.
    pub fn of_kind(kind: RoomKind, numbers: core::ops::Range<u64>, radius_m: f64) -> Self {
        let rooms = numbers.map(|number| RoomPlan::random(kind, number, radius_m)).collect();
        Self { name: kind.to_string(), rooms }
    }

    /// The room of a world, for a ring in the place of the world's first robot, with the same free way; `None` for a
    /// world without a robot.
    pub fn of_world(name: String, number: u64, world: &World) -> Option<Self> {
        let robot = world.robots().first()?;
        let way_m = robot.motion.at(&robot.pose, DRIVING_S).pose.translation.vector - robot.pose.translation.vector;
        let scene = world.scene();
        let plan = RoomPlan::own(number, scene.walls().to_vec(), scene.poles().to_vec(), robot.pose, way_m.norm());
        Some(Self { name, rooms: vec![plan] })
    }

    /// Places in the known free space of a map, like the rooms of [`of_kind`](Self::of_kind): half of the robots stand
    /// square to it.
    ///
    /// # Errors
    /// The width for which no free space was found.
    pub fn of_map(
        name: String,
        grid: &OccupancyGrid,
        numbers: core::ops::Range<u64>,
        radius_m: f64,
    ) -> Result<Self, String> {
        let (free, walls) = (grid.free_m(), grid.walls(grid.default_tolerance_m()));
        let rooms = numbers.map(|number| {
            RoomPlan::in_map(grid, &free, &walls, number, radius_m).ok_or_else(|| {
                let cells = free.len();
                format!(
                    "{cells} free cells; expected some with space around them for a robot {:.2} m wide",
                    2.0 * radius_m
                )
            })
        });
        Ok(Self { name, rooms: rooms.collect::<Result<_, _>>()? })
    }
}
